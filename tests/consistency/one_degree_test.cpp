// The one-degree reduction against an integration of its equations by somebody else's solver, the
// full model with soft shafts, the balance of power, and the full model itself.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <boost/numeric/odeint.hpp>
#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "core/numerics/square.h"
#include "core/refusal.h"
#include "core/study/operating_point.h"
#include "core/study/speed_sweep.h"
#include "tests/support/cruise.h"
#include "tests/support/figure_error.h"
#include "tests/support/realistic_contacts.h"
#include "tests/support/reference_scene.h"
#include "tests/support/run_length.h"

namespace tribodyn {
namespace {

PointOptions one_degree(double tolerance = 1e-3) {
  PointOptions options;
  options.model = PointModel::kOneDegree;
  options.tolerance = tolerance;
  return options;
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
/// of the test's own; contacts by the reference kernel, one by one.
class TwoRotors {
 public:
  enum { kPinionAngle, kPinionSpeed, kWinding, kGearSpeed, kLoss, kLossSquared, kSize };
  using State = std::array<double, kSize>;
  static constexpr double kLength = 1e-5;  // unit of the winding [m]

  TwoRotors(const Scene& scene, const PointResult& r)
      : scene_(scene),
        tables_(scene.gear_set),
        contact_(contact_model(scene)),
        torque_(r.pinion_torque),
        wheel_torque_(r.wheel_torque),
        shaft_speed_(r.mean_pinion_speed) {}

  /// x by eq 6 in closed form.
  double transmission_error(const State& y) const { return at(y).x; }
  /// The winding that belongs to x + e at the section.
  double winding_of(double mesh_deflection) const {
    double winding = 0;
    for (int i = 0; i < 60; ++i) {
      State y{};
      y[kWinding] = winding / kLength;
      winding += mesh_deflection - at(y).x - at(y).e;
    }
    return winding;
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
    dy[kWinding] =
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
    const double winding = y[kWinding] * kLength;
    const double mean_pinion = set.series.pinion_contact_radius.mean;
    const double mean_gear = mean_pinion * set.gear_teeth / set.pinion_teeth;
    const double theta_p = set.pinion_teeth * y[kPinionAngle];
    const double theta_g = theta_p - set.gear_teeth * winding / mean_gear;
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
            set.dynamics.half_backlash + winding + pinion.integral - gear.integral - e.value};
  }

  const Scene& scene_;
  MeshData tables_;
  FlankContactModel contact_;
  double torque_, wheel_torque_, shaft_speed_;
};

class IntegratedByOdeint : public testing::TestWithParam<double> {};

TEST_P(IntegratedByOdeint, AMeshCycleLeadsBackAndHasTheSameFigures) {
  using Solver = boost::numeric::odeint::runge_kutta_dopri5<TwoRotors::State>;
  constexpr int kSamples = 1000;
  const Scene scene = reference_scene();
  const PointResult r = solve_operating_point(scene, cruise(GetParam()), one_degree(1e-6));
  ASSERT_EQ(r.model, PointModel::kOneDegree);
  ASSERT_EQ(r.period_in_mesh_cycles, 1);
  EXPECT_EQ(r.contact_loss, GetParam() == 72.5);

  const TwoRotors rotors(scene, r);
  TwoRotors::State y{};
  y[TwoRotors::kPinionSpeed] = r.section_state.pinion_speed;
  y[TwoRotors::kGearSpeed] = r.section_state.gear_speed;
  y[TwoRotors::kWinding] = rotors.winding_of(r.section_state.mesh_deflection) / TwoRotors::kLength;
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
  EXPECT_NEAR(y[TwoRotors::kPinionAngle], angle, 2e-8 * angle);
  EXPECT_NEAR(y[TwoRotors::kPinionSpeed], start[TwoRotors::kPinionSpeed], 2e-5);
  EXPECT_NEAR(y[TwoRotors::kGearSpeed], start[TwoRotors::kGearSpeed], 2e-5);
  EXPECT_NEAR(y[TwoRotors::kWinding], start[TwoRotors::kWinding], 2e-5);
  const double input = r.pinion_torque * angle;
  EXPECT_NEAR(100 * y[TwoRotors::kLoss] / input / r.inefficiency_energy_mean.value(), 1, 1e-5);
  EXPECT_NEAR(100 * std::sqrt(y[TwoRotors::kLossSquared] / duration) / r.pinion_torque /
                  r.inefficiency_rms.value(),
              1, 1e-5);
  const Extremes& x = r.dynamic_transmission_error;
  EXPECT_NEAR(low, x.minimum, 3e-5 * x.maximum);
  EXPECT_NEAR(high, x.maximum, 3e-5 * x.maximum);
}

INSTANTIATE_TEST_SUITE_P(Speeds, IntegratedByOdeint, testing::Values(45.0, 72.5, 100.0),
                         [](const auto& place) {
                           return "v" + std::to_string(static_cast<int>(place.param));
                         });

TEST(OneDegree, IsWhatTheFullModelTendsToWithSoftShafts) {
  for (const double speed : {45.0, 80.0, 100.0}) {
    if (kShortRun && speed != 80) continue;
    Scene scene = reference_scene();
    const PointResult limit = solve_operating_point(scene, cruise(speed), one_degree(1e-5));
    double last = 1;
    for (const double softer : {1.0, 30.0, 1000.0}) {
      SCOPED_TRACE(testing::Message() << speed << " km/h, softer by " << softer);
      scene.gear_set.dynamics = reference_gear_set().dynamics;
      DrivelineDynamics& d = scene.gear_set.dynamics;
      for (double* part : {&d.pinion_shaft_stiffness, &d.gear_shaft_stiffness,
                           &d.pinion_shaft_damping, &d.gear_shaft_damping}) {
        *part /= softer;
      }
      PointOptions full = one_degree(1e-5);
      full.model = PointModel::kFull;
      const double error = true_error(limit, solve_operating_point(scene, cruise(speed), full));
      EXPECT_LT(error, 0.1 * last);
      last = error;
    }
    EXPECT_LT(last, 5e-5);
  }
}

TEST(OneDegree, KnowsNothingOfWhatIsBehindTheShafts) {
  Scene scene = reference_scene();
  PointOptions options = one_degree();
  const PointResult expected = solve_operating_point(scene, cruise(80), options);
  DrivelineDynamics& d = scene.gear_set.dynamics;
  d.pinion_shaft_inertia *= 3;
  d.wheel_inertia /= 2;
  d.pinion_shaft_stiffness *= 7;
  d.gear_shaft_damping *= 5;
  const PointResult r = solve_operating_point(scene, cruise(80), options);
  EXPECT_TRUE(r.contact_loss);
  EXPECT_EQ(r.inefficiency_rms, expected.inefficiency_rms);
  EXPECT_EQ(r.pinion_torque, expected.pinion_torque);
  EXPECT_EQ(r.statistics.largest_multiplier, expected.statistics.largest_multiplier);
}

TEST(OneDegree, PowerBalancesWhereTheTorquesAct) {
  Scene scene = reference_scene();
  for (const bool energy_consistent : {false, true}) {
    scene.options.energy_consistent = energy_consistent;
    for (const double speed : {20.0, 37.5, 72.5, 100.0, 140.0}) {
      for (const SteadyStateMethod method :
           {SteadyStateMethod::kShooting, SteadyStateMethod::kMarch}) {
        if (kShortRun && method == SteadyStateMethod::kMarch) continue;
        SCOPED_TRACE(testing::Message() << speed << " km/h by method " << static_cast<int>(method));
        PointOptions options = one_degree(1e-6);
        options.method = method;
        const PointResult r = solve_operating_point(scene, cruise(speed), options);
        EXPECT_EQ(r.model, PointModel::kOneDegree);
        const PowerBalance& p = r.power_balance;
        EXPECT_NEAR(p.input - p.output - p.friction - p.mesh_damping - p.parametric - p.stored, 0,
                    1e-6 * p.input);
        EXPECT_EQ(p.shaft_damping, 0);
        EXPECT_GT(p.friction, 0);
        const double input = r.pinion_torque * r.mean_pinion_speed;
        EXPECT_NEAR(r.input_power / input, 1, 1e-7);
        EXPECT_NEAR(r.inefficiency_energy_mean.value(), 100 * r.mesh_loss_power / r.input_power,
                    1e-12);
      }
    }
  }
}

TEST(OneDegree, HoldsThePrescribedTorqueOnEitherSideOfTheFlanks) {
  OperatingCondition condition;
  condition.kind = OperatingCondition::Kind::kPrescribedTorque;
  condition.pinion_speed = 300;
  for (const double torque : {60.0, -40.0}) {
    condition.pinion_torque = torque;
    const PointResult r = solve_operating_point(reference_scene(), condition, one_degree());
    EXPECT_EQ(r.pinion_torque, torque);
    EXPECT_EQ(r.method, SteadyStateMethod::kShooting);
    EXPECT_EQ(r.coast_side_contact, torque < 0);
    // Friction takes from what reaches the wheel, or asks for more of it.
    EXPECT_LT(r.wheel_torque * 13 / 36, torque);
  }
}

TEST(OneDegree, ShootingFindsWhatMarchingFinds) {
  if (kShortRun) GTEST_SKIP() << "minutes under sanitizers";
  for (const double speed : {37.5, 72.5, 100.0}) {
    SCOPED_TRACE(speed);
    PointOptions options = one_degree(1e-5);
    const PointResult shot = solve_operating_point(reference_scene(), cruise(speed), options);
    EXPECT_EQ(shot.method, SteadyStateMethod::kShooting);
    options.method = SteadyStateMethod::kMarch;
    const PointResult marched = solve_operating_point(reference_scene(), cruise(speed), options);
    EXPECT_LT(true_error(shot, marched), 1e-5);
    EXPECT_NEAR(shot.statistics.largest_multiplier, marched.statistics.largest_multiplier, 4e-3);
    // A march does not tell the model's own error.
    EXPECT_FALSE(marched.estimated_relative_error.has_value());
  }
}

TEST(OneDegree, HasBothBranchesBetweenItsFolds) {
  const Scene scene = reference_scene();
  PointOptions options = one_degree();
  options.probe_coexisting_response = true;
  const PointResult quiet = solve_operating_point(scene, cruise(69), options);
  EXPECT_FALSE(quiet.contact_loss);
  ASSERT_TRUE(quiet.coexisting_response.has_value());
  EXPECT_TRUE(quiet.coexisting_response->contact_loss);
  options.start = PointStart::kLargeVibration;
  const PointResult loud = solve_operating_point(scene, cruise(69), options);
  EXPECT_TRUE(loud.contact_loss);
  EXPECT_EQ(loud.model, PointModel::kOneDegree);
  EXPECT_FALSE(loud.estimated_relative_error.has_value());
  EXPECT_GT(loud.inefficiency_rms.value(), 1.3 * quiet.inefficiency_rms.value());

  SweepOptions sweep;
  sweep.point.model = PointModel::kOneDegree;
  for (const SweepDirection direction : {SweepDirection::kUp, SweepDirection::kDown}) {
    sweep.direction = direction;
    const auto points = sweep_speed(scene, {60 / 3.6, 69 / 3.6, 72.5 / 3.6}, 0, sweep, {});
    EXPECT_EQ(points[1].result.value().contact_loss, direction == SweepDirection::kDown);
    EXPECT_EQ(points[1].result.value().model, PointModel::kOneDegree);
  }
}

TEST(OneDegree, HistoriesHaveConstantTorquesAndSpeedsBehindTheShafts) {
  for (const SteadyStateMethod method : {SteadyStateMethod::kShooting, SteadyStateMethod::kMarch}) {
    PointOptions options = one_degree();
    options.method = method;
    options.history.columns = {HistoryColumn::kPinionShaftTorque, HistoryColumn::kGearShaftTorque,
                               HistoryColumn::kPinionShaftSpeed, HistoryColumn::kPinionSpeed};
    const PointResult r = solve_operating_point(reference_scene(), cruise(45), options);
    const auto& v = r.history.values;
    ASSERT_EQ(v[0].size(), 192u);
    double ripple = 0;
    for (std::size_t i = 0; i < v[0].size(); ++i) {
      EXPECT_EQ(v[0][i], r.pinion_torque);
      EXPECT_EQ(v[1][i], r.wheel_torque);
      EXPECT_NEAR(v[2][i], r.mean_pinion_speed, 1e-12 * r.mean_pinion_speed);
      ripple = std::max(ripple, std::abs(v[3][i] / r.mean_pinion_speed - 1));
    }
    EXPECT_GT(ripple, 1e-5);
    const DrivelineDynamics& d = reference_scene().gear_set.dynamics;
    EXPECT_EQ(r.section_state.pinion_shaft_twist, r.pinion_torque / d.pinion_shaft_stiffness);
    EXPECT_EQ(r.section_state.gear_shaft_twist, r.wheel_torque / d.gear_shaft_stiffness);
  }
}

// What stands still must not be disturbed in search of it.
TEST(OneDegree, BeyondADoublingTheShaftsTurnAtTheMeanSpeed) {
  const PointResult r = solve_operating_point(reference_scene(), cruise(147.5), one_degree());
  EXPECT_EQ(r.method, SteadyStateMethod::kShooting);
  EXPECT_EQ(r.period_in_mesh_cycles, 2);
  EXPECT_EQ(r.section_state.pinion_shaft_speed, r.mean_pinion_speed);
  EXPECT_EQ(r.section_state.pinion_shaft_twist,
            r.pinion_torque / reference_scene().gear_set.dynamics.pinion_shaft_stiffness);
}

TEST(OneDegree, FiguresAreThoseOfTheWholeResultAndScreenedOnesTheSameBitsInCompany) {
  const Scene thin = reference_scene(1, 90), thick = reference_scene(2, 20);
  const auto shared = std::make_shared<PreparedGearSet>(thin.gear_set, thin.solid, thin.options);
  PreparedScene first(thick, shared), second(thin, shared);
  PointOptions full = one_degree();
  full.model = PointModel::kFull;
  for (const double speed : {45.0, 72.5, 100.0}) {
    SCOPED_TRACE(speed);
    screen_point(first, cruise(speed), full);
    screen_point(first, cruise(speed), one_degree());
    const PointFigures company = screen_point(second, cruise(speed), one_degree());
    PreparedScene lonely(thin);
    const PointFigures alone = screen_point(lonely, cruise(speed), one_degree());
    const PointResult whole = solve_operating_point(thin, cruise(speed), one_degree());
    EXPECT_EQ(company.model, PointModel::kOneDegree);
    EXPECT_EQ(alone.inefficiency_rms, company.inefficiency_rms);
    EXPECT_EQ(alone.pinion_torque, company.pinion_torque);
    EXPECT_EQ(alone.dte_minimum, company.dte_minimum);
    EXPECT_EQ(alone.estimated_relative_error, company.estimated_relative_error);
    EXPECT_EQ(alone.contact_solutions, company.contact_solutions);
    const PointFigures figures = solve_point_figures(lonely, cruise(speed), one_degree());
    EXPECT_EQ(figures.model, PointModel::kOneDegree);
    EXPECT_EQ(figures.pinion_torque, whole.pinion_torque);
    EXPECT_EQ(figures.dte_maximum, whole.dynamic_transmission_error.maximum);
    EXPECT_EQ(figures.estimated_relative_error, whole.estimated_relative_error);
    EXPECT_EQ(figures.estimated_relative_error.has_value(), speed != 72.5);
    EXPECT_EQ(alone.estimated_relative_error.has_value(), speed != 72.5);
  }
}

TEST(OneDegreeEstimate, BoundsTheDistanceFromTheFullModelOverSpeedsAndFluids) {
  for (const int fluid : {1, 2, 3}) {
    const Scene scene = reference_scene(fluid);
    PreparedScene prepared(scene);
    for (const double speed : {2.0, 10.0, 20.0, 37.5, 45.0, 55.0, 60.0, 65.0, 85.0, 100.0, 140.0}) {
      SCOPED_TRACE(testing::Message() << "fluid " << fluid << " at " << speed << " km/h");
      PointOptions full = one_degree(1e-6);
      full.model = PointModel::kFull;
      const PointResult r = solve_prepared_point(prepared, cruise(speed), one_degree(1e-5));
      const PointResult exact = solve_prepared_point(prepared, cruise(speed), full);
      const double error = true_error(r, exact);
      EXPECT_LT(error, r.estimated_relative_error.value());
      EXPECT_LT(r.estimated_relative_error.value(), 10 * error);
    }
  }
}

TEST(OneDegreeEstimate, SaysThatItCannotTellWhereTheShaftsDecide) {
  // The end of the quiet branch, contact loss, doubled periods.
  for (const double speed : {69.5, 72.5, 80.0, 146.0, 150.0}) {
    SCOPED_TRACE(speed);
    const PointResult r = solve_operating_point(reference_scene(), cruise(speed), one_degree());
    EXPECT_FALSE(r.estimated_relative_error.has_value());
    EXPECT_TRUE(std::any_of(r.warnings.begin(), r.warnings.end(), [](const RangeWarning& w) {
      return w.code == "ONE_DEGREE" && w.sentence.find("cannot be told") != std::string::npos;
    }));
  }
  // With half of the damping the full model's period is doubled here, and that of this one is not.
  Scene scene = reference_scene();
  scene.gear_set.dynamics.mesh_damping /= 2;
  const PointResult r = solve_operating_point(scene, cruise(157.5), one_degree());
  EXPECT_EQ(r.period_in_mesh_cycles, 1);
  EXPECT_FALSE(r.estimated_relative_error.has_value());
  const PointResult known = solve_operating_point(reference_scene(), cruise(100), one_degree());
  EXPECT_TRUE(std::any_of(known.warnings.begin(), known.warnings.end(), [](const RangeWarning& w) {
    return w.code == "ONE_DEGREE" && w.sentence.find("estimated to be") != std::string::npos;
  }));
}

}  // namespace
}  // namespace tribodyn
