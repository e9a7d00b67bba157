// The full model with soft shafts against the one-degree model of the literature, in which constant
// torques act on pinion and gear themselves, integrated by boost's solver.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <boost/numeric/odeint.hpp>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "core/numerics/square.h"
#include "core/study/operating_point.h"
#include "tests/support/cruise.h"
#include "tests/support/realistic_contacts.h"
#include "tests/support/reference_scene.h"

namespace tribodyn {
namespace {

/// The reference scene, its shafts softer by 1000, as the refusal of the removed model advises.
Scene soft_scene() {
  Scene scene = reference_scene();
  DrivelineDynamics& d = scene.gear_set.dynamics;
  for (double* part : {&d.pinion_shaft_stiffness, &d.gear_shaft_stiffness, &d.pinion_shaft_damping,
                       &d.gear_shaft_damping}) {
    *part /= 1000;
  }
  return scene;
}

/// A Fourier series in theta = teeth phi: value, slope and mean-free integral by phi.
struct SeriesAt {
  double value, slope, integral;
  SeriesAt(const FourierSeries& s, double theta, int teeth) : value(s.mean), slope(0), integral(0) {
    for (std::size_t i = 0; i < s.sine.size(); ++i) {
      const double order = static_cast<double>(i + 1);
      const double sine = std::sin(order * theta), cosine = std::cos(order * theta);
      value += s.sine[i] * sine + s.cosine[i] * cosine;
      slope += order * teeth * (s.sine[i] * cosine - s.cosine[i] * sine);
      integral += (s.cosine[i] * sine - s.sine[i] * cosine) / (order * teeth);
    }
  }
};

/// I_p phi_p'' = T_s - R_p F + T_fr,p and I_g phi_g'' = R_g F - T_w + T_fr,g in time, by formulas
/// of the test's own; contacts by the scalar kernel, one by one.
class TwoRotors {
 public:
  enum { kPinionAngle, kPinionSpeed, kMeshApproach, kGearSpeed, kLoss, kLossSquared, kSize };
  using State = std::array<double, kSize>;
  static constexpr double kLength = 1e-5;  // unit of the mesh approach [m]

  TwoRotors(const Scene& scene, const PointResult& r)
      : scene_(scene),
        tables_(scene.gear_set),
        contact_(contact_model(scene)),
        torque_(r.pinion_torque),
        wheel_torque_(r.wheel_torque),
        shaft_speed_(r.mean_pinion_speed) {}

  /// x by eq 6 in closed form.
  double transmission_error(const State& y) const { return at(y).x; }
  /// The mesh approach that belongs to x + e at the section.
  double approach_of(double mesh_deflection) const {
    double approach = 0;
    for (int i = 0; i < 60; ++i) {
      State y{};
      y[kMeshApproach] = approach / kLength;
      approach += mesh_deflection - at(y).x - at(y).e;
    }
    return approach;
  }

  void operator()(const State& y, State& dy, double) const {
    const Place p = at(y);
    const GearSet& set = scene_.gear_set;
    const double b = set.dynamics.half_backlash;
    const double deflection = p.x > b ? p.x - b : p.x < -b ? p.x + b : 0;
    const double velocity =
        (p.pinion_radius - p.e_slope) * y[kPinionSpeed] - p.gear_radius * y[kGearSpeed];
    const double force = p.stiffness * deflection + set.dynamics.mesh_damping * velocity;
    const double load = deflection * force > 0 ? std::abs(force) : 0;
    const double cycles = y[kPinionAngle] * set.pinion_teeth / (2 * std::numbers::pi);
    const double phase = cycles - std::floor(cycles);
    std::array<FlankKinematics, kFlankPairs> flanks;
    const int interval =
        std::min(static_cast<int>(phase * tables_.intervals()), tables_.intervals() - 1);
    tables_.flanks(interval, phase, flanks);
    double pinion_friction = 0, gear_friction = 0, loss = 0;
    for (const FlankKinematics& flank : flanks) {
      if (!(flank.load_share * load > 0)) continue;
      const FlankMotion m = flank_motion(flank, y[kPinionSpeed], y[kGearSpeed]);
      const double friction = contact_
                                  .solve({flank.load_share * load, flank.radius_x, flank.radius_y,
                                          m.pinion_x, m.pinion_y, m.gear_x, m.gear_y})
                                  .friction;
      pinion_friction += m.pinion_friction_arm * friction;
      gear_friction += m.gear_friction_arm * friction;
      loss += m.sliding_speed * friction;
    }
    dy[kPinionAngle] = y[kPinionSpeed];
    dy[kPinionSpeed] =
        (torque_ - p.pinion_radius * force + pinion_friction) / set.dynamics.pinion_inertia;
    dy[kMeshApproach] =
        (p.mean_pinion_radius * y[kPinionSpeed] - p.mean_gear_radius * y[kGearSpeed]) / kLength;
    dy[kGearSpeed] =
        (p.gear_radius * force - wheel_torque_ + gear_friction) / set.dynamics.gear_inertia;
    dy[kLoss] = loss;
    dy[kLossSquared] = square(loss / shaft_speed_);
  }

 private:
  struct Place {
    double pinion_radius, gear_radius, mean_pinion_radius, mean_gear_radius;
    double stiffness, e, e_slope, x;
  };
  Place at(const State& y) const {
    const GearSet& set = scene_.gear_set;
    const double approach = y[kMeshApproach] * kLength;
    const double mean_pinion = set.series.pinion_contact_radius.mean;
    const double mean_gear = mean_pinion * set.gear_teeth / set.pinion_teeth;
    const double theta_p = set.pinion_teeth * y[kPinionAngle];
    const double theta_g = theta_p - set.gear_teeth * approach / mean_gear;
    const SeriesAt pinion(set.series.pinion_contact_radius, theta_p, set.pinion_teeth);
    FourierSeries gear_series = set.series.gear_contact_radius;
    gear_series.mean = mean_gear;
    const SeriesAt gear(gear_series, theta_g, set.gear_teeth);
    const SeriesAt e(set.series.static_transmission_error, theta_p, set.pinion_teeth);
    const SeriesAt k(set.series.mesh_stiffness, theta_p, set.pinion_teeth);
    return {pinion.value,
            gear.value,
            mean_pinion,
            mean_gear,
            k.value,
            e.value,
            e.slope,
            set.dynamics.half_backlash + approach + pinion.integral - gear.integral - e.value};
  }

  const Scene& scene_;
  MeshData tables_;
  FlankContactModel contact_;
  double torque_, wheel_torque_, shaft_speed_;
};

class SoftShafts : public testing::TestWithParam<double> {};

TEST_P(SoftShafts, GiveTheFiguresOfConstantTorquesOnTheGears) {
  using Solver = boost::numeric::odeint::runge_kutta_dopri5<TwoRotors::State>;
  constexpr int kSamples = 1000;
  const Scene scene = soft_scene();
  PointOptions options;
  options.model = PointModel::kFull;
  options.tolerance = 1e-6;
  options.method = SteadyStateMethod::kMarch;
  const PointResult r = solve_operating_point(scene, cruise(GetParam()), options);
  ASSERT_EQ(r.period_in_mesh_cycles, 1);
  EXPECT_EQ(r.contact_loss, GetParam() == 72.5);

  const TwoRotors rotors(scene, r);
  TwoRotors::State y{};
  y[TwoRotors::kPinionSpeed] = r.section_state.pinion_speed;
  y[TwoRotors::kGearSpeed] = r.section_state.gear_speed;
  y[TwoRotors::kMeshApproach] =
      rotors.approach_of(r.section_state.mesh_deflection) / TwoRotors::kLength;
  const TwoRotors::State start = y;
  const double angle = 2 * std::numbers::pi / scene.gear_set.pinion_teeth;
  const double duration = angle / r.mean_pinion_speed;
  double low = 1, high = -1;
  for (int i = 0; i < kSamples; ++i) {
    boost::numeric::odeint::integrate_adaptive(
        boost::numeric::odeint::make_controlled(1e-10, 1e-10, Solver()), std::cref(rotors), y,
        duration * i / kSamples, duration * (i + 1) / kSamples, duration / kSamples);
    low = std::min(low, rotors.transmission_error(y));
    high = std::max(high, rotors.transmission_error(y));
  }
  EXPECT_NEAR(y[TwoRotors::kPinionAngle], angle, 1e-7 * angle);
  EXPECT_NEAR(y[TwoRotors::kPinionSpeed], start[TwoRotors::kPinionSpeed], 1e-4);
  EXPECT_NEAR(y[TwoRotors::kGearSpeed], start[TwoRotors::kGearSpeed], 1e-4);
  EXPECT_NEAR(y[TwoRotors::kMeshApproach], start[TwoRotors::kMeshApproach], 1e-3);
  const double input = r.pinion_torque * angle;
  EXPECT_NEAR(100 * y[TwoRotors::kLoss] / input / r.inefficiency_energy_mean.value(), 1, 5e-5);
  EXPECT_NEAR(100 * std::sqrt(y[TwoRotors::kLossSquared] / duration) / r.pinion_torque /
                  r.inefficiency_rms.value(),
              1, 5e-5);
  const Extremes& x = r.dynamic_transmission_error;
  EXPECT_NEAR(low, x.minimum, 5e-5 * x.maximum);
  EXPECT_NEAR(high, x.maximum, 5e-5 * x.maximum);
}

INSTANTIATE_TEST_SUITE_P(Speeds, SoftShafts, testing::Values(45.0, 72.5, 100.0),
                         [](const auto& place) {
                           return "v" + std::to_string(static_cast<int>(place.param));
                         });

}  // namespace
}  // namespace tribodyn
