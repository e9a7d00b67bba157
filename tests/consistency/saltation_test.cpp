// Derivatives of a response across contact loss and regain, held against differences of whole
// marches and against the multipliers of the adaptive march, which has no variational equations.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "core/contact/hertz.h"
#include "core/integrate/rk4_with_events.h"
#include "core/periodic/poincare_map_jacobian.h"
#include "core/periodic/steady_state.h"
#include "core/study/operating_point.h"
#include "tests/support/cruise.h"
#include "tests/support/reference_scene.h"

namespace tribodyn {
namespace {

struct GapCase {
  std::string name;
  double pinion_torque;  ///< [N m]
  std::function<void(Scene&)> change;
};

void PrintTo(const GapCase& c, std::ostream* out) { *out << c.name; }

/// Two mesh cycles of a gear pair that is let go 60 um beyond its static deflection: flanks part
/// and meet again.
class GapMarch {
 public:
  static constexpr double kSpeed = 230;  // of the pinion [rad/s]
  static constexpr int kSteps = 384, kPeriod = 2, kUnknowns = PoincareMapJacobian::kUnknowns;
  using Derivatives = Eigen::Matrix<double, kUnknowns, kUnknowns>;

  explicit GapMarch(const GapCase& c)
      : scene_(changed(c)),
        mesh_(scene_.gear_set),
        system_(mesh_, scene_.gear_set.dynamics, scene_.options),
        torques_{c.pinion_torque, c.pinion_torque * 36 / 13},
        grid_(mesh_, scene_.gear_set.dynamics.half_backlash, kSteps,
              reduced_modulus(scene_.solid.youngs_modulus, scene_.solid.poissons_ratio),
              scene_.options) {
    scales_ = march_scales(system_, torques_, kSpeed);
    start_ = static_start(system_, torques_, kSpeed, 0, 0, 60e-6);
    // Friction of several percent that varies.
    for (int n = 0; n <= 2 * kSteps * kPeriod; ++n) {
      const double phase = 0.5 * n / kSteps;
      friction_.add(phase, {-1e-3 * (1 + std::sin(6 * phase)), -2e-3 * (1 - 0.25 * phase)}, 1);
    }
  }

  /// By the variational equations: rows are time and the seven states, columns the seven states at
  /// the start and T_s; scaled.
  Derivatives by_variation() {
    Sensitivity sensitivity;
    end_of(start_, torques_, &sensitivity);
    Derivatives out;
    for (int i = 0; i < kUnknowns; ++i) {
      for (int j = 0; j < kUnknowns; ++j) {
        out(i, j) = sensitivity[i](j) * scale_of_column(j) / scale(i);
      }
    }
    return out;
  }

  /// By central differences of marches.
  Derivatives by_differences() {
    constexpr double kStep = 1e-4;  // scaled: truncation 1e-8, rounding of events 1e-8
    Derivatives out;
    for (int j = 0; j < kUnknowns; ++j) {
      MarchState ends[2];
      for (const int side : {0, 1}) {
        const double change = (side == 0 ? -1 : 1) * kStep * scale_of_column(j);
        MarchState start = start_;
        Torques changed = torques_;
        (j + 1 < kUnknowns ? start[j + 1] : changed.pinion) += change;
        ends[side] = end_of(start, changed, nullptr);
      }
      for (int i = 0; i < kUnknowns; ++i) {
        out(i, j) = (ends[1][i] - ends[0][i]) / (2 * kStep * scale(i));
      }
    }
    return out;
  }

  /// How often flanks part or meet.
  int changes_of_side() const {
    int count = 0;
    for (std::size_t i = 1; i < pieces_.size(); ++i) {
      count += pieces_[i].regime.side != pieces_[i - 1].regime.side;
    }
    return count;
  }

 private:
  static Scene changed(const GapCase& c) {
    Scene scene = reference_scene();
    if (c.change) c.change(scene);
    return scene;
  }
  double scale(int component) const { return scales_.of(mesh_, component); }
  double scale_of_column(int j) const { return j + 1 < kUnknowns ? scale(j + 1) : scales_.torque; }
  MarchState end_of(MarchState y, const Torques& torques, Sensitivity* sensitivity) {
    Rk4WithEvents march(system_, scales_, grid_, kPeriod, false, 1e-12, InstructionSet::kPortable);
    EXPECT_TRUE(march.run(torques, friction_, false, y, sensitivity, &pieces_));
    return y;
  }

  Scene scene_;
  MeshData mesh_;
  GearPairSystem system_;
  Torques torques_;
  MeshGrid grid_;
  MarchScales scales_;
  FrozenFriction friction_;
  MarchState start_;
  std::vector<OrbitPiece> pieces_;
};

class AcrossGaps : public testing::TestWithParam<GapCase> {};

TEST_P(AcrossGaps, DerivativesAreThoseOfDifferences) {
  GapMarch march(GetParam());
  const GapMarch::Derivatives exact = march.by_differences();
  const GapMarch::Derivatives found = march.by_variation();
  EXPECT_GE(march.changes_of_side(), 2);
  const double size = exact.cwiseAbs().maxCoeff();
  EXPECT_LT((found - exact).cwiseAbs().maxCoeff(), 1e-6 * size);
}

void damp_in_contact_only(Scene& scene) { scene.options.damping_in_contact_only = true; }

INSTANTIATE_TEST_SUITE_P(
    Scenes, AcrossGaps,
    testing::Values(GapCase{"damped_everywhere", 33, nullptr},
                    GapCase{"damped_in_contact", 33, damp_in_contact_only},
                    GapCase{"damped_in_contact_on_coast", -33, damp_in_contact_only},
                    GapCase{"energy_consistent", 33,
                            [](Scene& scene) {
                              damp_in_contact_only(scene);
                              scene.options.energy_consistent = true;
                            }},
                    GapCase{"without_backlash", 33,
                            [](Scene& scene) { scene.gear_set.dynamics.half_backlash = 0; }}),
    [](const auto& c) { return c.param.name; });

/// The reference scene with its damper in contact only, and without any friction.
Scene frictionless_scene() {
  Scene scene = reference_scene();
  scene.options.damping_in_contact_only = true;
  scene.options.no_boundary_friction = true;
  scene.lubricant.limiting_shear_stress_at_zero_pressure = 0;
  scene.lubricant.limiting_shear_stress_coefficient = 0;
  return scene;
}

// Without friction the frozen friction of shooting changes nothing: both are the same response.
TEST(MultiplierAcrossGaps, IsThatOfTheAdaptiveMarch) {
  PointOptions shoot;
  shoot.model = PointModel::kFull;
  shoot.start = PointStart::kLargeVibration;
  shoot.tolerance = 1e-5;
  const PointResult shot = solve_operating_point(frictionless_scene(), cruise(72.5), shoot);
  ASSERT_EQ(shot.method, SteadyStateMethod::kShooting);
  ASSERT_TRUE(shot.contact_loss);
  PointOptions march = shoot;
  march.method = SteadyStateMethod::kMarch;
  march.carried_state = carried_from(shot);
  march.march_step_tolerance = 1e-9;
  const PointResult marched = solve_operating_point(frictionless_scene(), cruise(72.5), march);
  ASSERT_TRUE(marched.settled);
  ASSERT_TRUE(marched.contact_loss);
  EXPECT_NEAR(shot.statistics.largest_multiplier, marched.statistics.largest_multiplier, 2e-4);
}

// Without the saltation matrix Newton's method fails there, and 115 cycles are marched and more.
TEST(ShootingAcrossGaps, TakesFewCyclesWhereTheDamperActsInContactOnly) {
  Scene scene = reference_scene();
  scene.options.damping_in_contact_only = true;
  PointOptions loud;
  loud.start = PointStart::kLargeVibration;
  for (const double speed : {66.75, 67.0}) {
    SCOPED_TRACE(speed);
    const PointResult r = solve_operating_point(scene, cruise(speed), loud);
    EXPECT_EQ(r.method, SteadyStateMethod::kShooting);
    EXPECT_TRUE(r.contact_loss);
    EXPECT_LE(r.statistics.mesh_cycles, 50);
  }
}

}  // namespace
}  // namespace tribodyn
