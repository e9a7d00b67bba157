#include "core/integrate/step_block.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/contact/hertz.h"
#include "core/integrate/rk4_with_events.h"
#include "core/periodic/multiple_shooting.h"
#include "core/periodic/orbit_solver.h"
#include "core/periodic/single_shooting.h"
#include "core/periodic/steady_state.h"
#include "tests/support/contact_batch.h"
#include "tests/support/reference_scene.h"

// Steps taken side by side, with every set of instructions, against the same steps one by one.
namespace tribodyn {
namespace {

struct StepCase {
  std::string name;
  double pinion_torque;  ///< [N m]
  std::function<void(Scene&)> change;
};

void PrintTo(const StepCase& c, std::ostream* out) { *out << c.name; }

/// A gear pair that runs, with a march of kept flanks over one mesh cycle to compare with.
struct PointBench {
  static constexpr double kSpeed = 230;  // of the pinion [rad/s]

  PointBench(const StepCase& c, int steps, bool wheel_torque)
      : scene(changed(c)),
        mesh(scene.gear_set),
        system(mesh, scene.gear_set.dynamics, scene.options),
        torques{c.pinion_torque, c.pinion_torque * 41 / 13},
        regime{c.pinion_torque > 0 ? 1 : -1, true},
        grid(mesh, scene.gear_set.dynamics.half_backlash, steps,
             reduced_modulus(scene.solid.youngs_modulus, scene.solid.poissons_ratio),
             scene.options),
        solve_wheel_torque(wheel_torque) {
    // Any friction will do that varies.
    for (int n = 0; n <= 2 * steps; ++n) {
      const double phase = 0.5 * n / steps;
      friction.add(phase, {-1e-3 * (1 + std::sin(6 * phase)), -2e-3 * (1 - 0.5 * phase)}, 1);
    }
    start = static_start(system, torques, kSpeed, 0, 0, 0);
    const MarchScales scales = march_scales(system, torques, kSpeed);
    Rk4WithEvents march(system, scales, grid, 1, solve_wheel_torque, 1e-9,
                        InstructionSet::kPortable);
    MarchState y = start;
    marched = march.run(torques, friction, true, y, &sensitivity, &pieces);
    for (Columns* columns : {&frozen.start, &frozen.middle}) {
      columns->resize(kFrictionRows, steps + 1);
    }
    for (int n = 0; n <= 2 * steps; ++n) {
      const FrictionArms at = friction.at(0.5 * n / steps);
      Columns& to = n % 2 == 0 ? frozen.start : frozen.middle;
      to[kPinionFrictionRow][n / 2] = at.pinion;
      to[kGearFrictionRow][n / 2] = at.gear;
    }
    response.start.resize(kResponseRows, steps + 1);
    response.middle.resize(kResponseRows, steps + 1);
    response.rate.resize(kWheelSpeed + 1, steps + 1);
    for (int i = kTime; i <= kWheelSpeed; ++i) {
      for (int s = 0; s < steps; ++s) response.start[i][s] = pieces[s].start[i];
      response.start[i][steps] = pieces.back().end[i];
    }
  }
  static Scene changed(const StepCase& c) {
    Scene scene = reference_scene();
    if (c.change) c.change(scene);
    return scene;
  }
  StepBlock block() const {
    return {system, torques, grid, regime.side, solve_wheel_torque, frozen};
  }
  double scale(int component) const {
    return march_scales(system, torques, kSpeed).of(mesh, component);
  }

  Scene scene;
  MeshData mesh;
  GearPairSystem system;
  Torques torques;
  ContactRegime regime;
  MeshGrid grid;
  bool solve_wheel_torque;
  FrozenFriction friction;
  MarchState start;
  Sensitivity sensitivity;
  std::vector<OrbitPiece> pieces;
  bool marched;
  CycleFriction frozen;
  CycleResponse response;
};

class StepsSideBySide : public testing::TestWithParam<StepCase> {};

TEST_P(StepsSideBySide, LeadWhereEachLeadsAlone) {
  for (const int steps : {5, 12, 16, 31}) {
    SCOPED_TRACE(steps);
    PointBench bench(GetParam(), steps, false);
    ASSERT_TRUE(bench.marched);
    for (const InstructionSet set : supported_instruction_sets()) {
      SCOPED_TRACE(FlankContactBatch::name(set));
      Columns end(kWheelSpeed + 1, steps);
      ASSERT_TRUE(rk4_steps(set, bench.block(), bench.response, end, nullptr));
      for (int s = 0; s < steps; ++s) {
        const OrbitPiece& piece = bench.pieces[s];
        EXPECT_NEAR(end[kTime][s], piece.end[kTime] - piece.start[kTime], 1e-13 * piece.end[kTime]);
        for (int i = kPinionShaftTwist; i <= kWheelSpeed; ++i) {
          const double size = std::max(std::abs(piece.end[i]), bench.scale(i));
          EXPECT_NEAR(end[i][s], piece.end[i], 1e-13 * size) << "step " << s << " component " << i;
        }
      }
    }
  }
}

TEST_P(StepsSideBySide, HaveTheDerivativesOfTheWholeMarch) {
  constexpr int kSteps = 20;
  for (const bool wheel : {false, true}) {
    PointBench bench(GetParam(), kSteps, wheel);
    for (const InstructionSet set : supported_instruction_sets()) {
      SCOPED_TRACE(FlankContactBatch::name(set));
      Columns end(kWheelSpeed + 1, kSteps);
      Columns derivatives(CycleDerivatives::kMatrix, kSteps);
      ASSERT_TRUE(rk4_steps(set, bench.block(), bench.response, end, &derivatives));
      CycleDerivatives composed(kSteps);
      compose_derivatives(set, derivatives, composed);
      const double* const whole = composed.from_section.get() + CycleDerivatives::kMatrix * kSteps;
      for (int j = 0; j < kStepUnknowns; ++j) {
        // By components' sizes: their derivatives have many units.
        const bool by_torque = j + 1 == kStepUnknowns;
        const double by = by_torque
                              ? march_scales(bench.system, bench.torques, PointBench::kSpeed).torque
                              : bench.scale(j + 1);
        for (int i = kPinionShaftTwist; i <= kWheelSpeed; ++i) {
          EXPECT_NEAR(whole[kStepUnknowns * j + i - 1] * by / bench.scale(i),
                      bench.sensitivity[i](j) * by / bench.scale(i), 1e-11)
              << i << " by " << j;
        }
        double time = 0;
        for (int s = 1; s <= kSteps; ++s) {
          time +=
              composed.from_section[CycleDerivatives::kMatrix * s + kStepUnknowns * (j + 1) - 1];
        }
        EXPECT_NEAR(time * by, bench.sensitivity[kTime](j) * by,
                    1e-11 * bench.pieces.back().end[kTime]);
      }
    }
  }
}

TEST_P(StepsSideBySide, GiveTheForcesMiddlesAndContactConditionsOfTheGearPairSystem) {
  constexpr int kSteps = 12;
  PointBench bench(GetParam(), kSteps, false);
  const GearPairSystem& system = bench.system;
  for (const InstructionSet set : supported_instruction_sets()) {
    SCOPED_TRACE(FlankContactBatch::name(set));
    CycleResponse filled = bench.response;
    ASSERT_TRUE(complete_midpoints(set, bench.block(), filled));
    for (int node = 0; node <= 2 * kSteps; ++node) {
      Columns& at = node % 2 == 0 ? filled.start : filled.middle;
      const int lane = node / 2;
      MarchState y{};
      for (int i = kTime; i <= kWheelSpeed; ++i) y[i] = at[i][lane];
      Mechanics expected;
      system.mechanics(bench.grid.at(node), bench.regime, y.data(), expected);
      const double force = std::abs(expected.mesh_force);
      EXPECT_NEAR(at[kMeshForceRow][lane], expected.mesh_force, 1e-11 * force);
      EXPECT_NEAR(at[kTransmissionErrorRow][lane], expected.transmission_error, 1e-17);
      EXPECT_NEAR(at[kTransmissionVelocityRow][lane], expected.transmission_velocity, 1e-13);
      // The middles are those of the march but for the rate at the end, which it takes from the
      // last stage.
      if (node % 2 == 0) continue;
      const OrbitPiece& piece = bench.pieces[lane];
      for (int i = kPinionShaftTwist; i <= kWheelSpeed; ++i) {
        EXPECT_NEAR(at[i][lane], piece.middle[i], 0.02 * bench.scale(i));
      }
    }
    for (const GridContacts* contacts :
         {&bench.grid.contacts(), &bench.grid.contacts_at_starts()}) {
      Columns conditions(kGatheredRows, contacts->node.size());
      gather_contact_conditions(set, bench.block(), *contacts, filled, conditions);
      for (int place = 0, node = 0; node <= 2 * kSteps; ++place, node += contacts->stride) {
        const Columns& at = node % 2 == 0 ? filled.start : filled.middle;
        MarchState y{};
        for (int i = kTime; i <= kWheelSpeed; ++i) y[i] = at[i][node / 2];
        int n = contacts->first[place];
        for (const FlankKinematics& flank : bench.grid.flanks(node)) {
          if (!(flank.load_share > 0)) continue;
          const double load = flank.load_share * bench.regime.load(at[kMeshForceRow][node / 2]);
          FlankMotion motion;
          const ContactConditions c = system.contact_conditions(flank, load, y.data(), motion);
          EXPECT_NEAR(conditions[kGatheredLoad][n], c.load, 1e-12 * (c.load + 1));
          EXPECT_NEAR(conditions[kGatheredPinionX][n], c.velocity_1_x, 1e-12);
          EXPECT_NEAR(conditions[kGatheredPinionY][n], c.velocity_1_y, 1e-12);
          EXPECT_NEAR(conditions[kGatheredGearX][n], c.velocity_2_x, 1e-12);
          EXPECT_NEAR(conditions[kGatheredGearY][n], c.velocity_2_y, 1e-12);
          EXPECT_NEAR(conditions[kGatheredSlidingSpeed][n], motion.sliding_speed, 1e-12);
          EXPECT_NEAR(conditions[kGatheredPinionArm][n], motion.pinion_friction_arm, 1e-12);
          EXPECT_NEAR(conditions[kGatheredGearArm][n], motion.gear_friction_arm, 1e-12);
          ++n;
        }
        EXPECT_EQ(n, contacts->first[place + 1]);
      }
    }
  }
}

TEST_P(StepsSideBySide, AreGivenUpWhereTheyMeanNothing) {
  constexpr int kSteps = 12;
  PointBench bench(GetParam(), kSteps, false);
  for (const InstructionSet set : supported_instruction_sets()) {
    SCOPED_TRACE(FlankContactBatch::name(set));
    Columns end(kWheelSpeed + 1, kSteps);
    const auto is_refused = [&](int component, double value) {
      CycleResponse wild = bench.response;
      wild.start[component][kSteps - 1] = value;
      return !rk4_steps(set, bench.block(), wild, end, nullptr);
    };
    EXPECT_TRUE(is_refused(kPinionSpeed, 0));
    EXPECT_TRUE(is_refused(kPinionSpeed, -100));
    EXPECT_TRUE(is_refused(kMeshApproach, 1));  // far beyond the series
    EXPECT_TRUE(is_refused(kGearSpeed, std::nan("")));
    EXPECT_FALSE(is_refused(kMeshApproach, bench.response.start[kMeshApproach][0]));
  }
}

/// Everything that a block of steps gives.
struct Given {
  Given(InstructionSet set, const PointBench& bench)
      : steps(bench.grid.steps()),
        end(kWheelSpeed + 1, steps),
        derivatives(CycleDerivatives::kMatrix, steps),
        composed(steps),
        filled(bench.response),
        particular(kStepUnknowns * (steps + 1)),
        conditions(kGatheredRows, bench.grid.contacts().node.size()) {
    EXPECT_TRUE(rk4_steps(set, bench.block(), bench.response, end, &derivatives));
    compose_derivatives(set, derivatives, composed);
    EXPECT_TRUE(complete_midpoints(set, bench.block(), filled));
    condense_residuals(set, composed, bench.response, end, particular.data());
    // Of the states, then of the torque.
    constexpr double kSection[] = {1e-6, -2e-7, 3e-6, 0.1, -0.2, 0.05, 0.03, 0.5};
    constexpr double kPerScale[] = {1e5, 1e6, 1e5, 10, 10, 30, 30, 0};
    longest = expand_section_update(set, composed, kSection, kPerScale, particular.data());
    gather_contact_conditions(set, bench.block(), bench.grid.contacts(), filled, conditions);
  }

  int steps;
  Columns end, derivatives;
  CycleDerivatives composed;
  CycleResponse filled;
  std::vector<double> particular;
  double longest = 0;
  Columns conditions;
};

testing::AssertionResult same_bits(const double* a, const double* b, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    if (std::bit_cast<std::uint64_t>(a[i]) == std::bit_cast<std::uint64_t>(b[i])) continue;
    return testing::AssertionFailure() << "number " << i << ": " << a[i] << " and " << b[i];
  }
  return testing::AssertionSuccess();
}

testing::AssertionResult same_bits(const Columns& a, const Columns& b, int rows,
                                   std::size_t length) {
  for (int row = 0; row < rows; ++row) {
    const auto same = same_bits(a[row], b[row], length);
    if (!same) return testing::AssertionFailure() << "row " << row << ", " << same.message();
  }
  return testing::AssertionSuccess();
}

TEST_P(StepsSideBySide, AreTheSameBitsInEveryWidthWithFusedMultiplyAdds) {
  if (!FlankContactBatch::supported(InstructionSet::kAvx512)) GTEST_SKIP() << "no AVX-512 here";
  for (const int steps : {5, 16, 31}) {
    SCOPED_TRACE(steps);
    const PointBench bench(GetParam(), steps, false);
    const Given narrow(InstructionSet::kAvx2, bench), wide(InstructionSet::kAvx512, bench);
    const auto count = static_cast<std::size_t>(steps);
    EXPECT_TRUE(same_bits(narrow.end, wide.end, kWheelSpeed + 1, count));
    constexpr std::size_t kMatrix = CycleDerivatives::kMatrix;
    EXPECT_TRUE(same_bits(narrow.derivatives, wide.derivatives, static_cast<int>(kMatrix), count));
    EXPECT_TRUE(same_bits(narrow.composed.step.get(), wide.composed.step.get(), kMatrix * count));
    EXPECT_TRUE(same_bits(narrow.composed.from_section.get(), wide.composed.from_section.get(),
                          kMatrix * (count + 1)));
    EXPECT_TRUE(
        same_bits(narrow.particular.data(), wide.particular.data(), narrow.particular.size()));
    EXPECT_EQ(narrow.longest, wide.longest);
    EXPECT_TRUE(same_bits(narrow.filled.start, wide.filled.start, kResponseRows, count + 1));
    EXPECT_TRUE(same_bits(narrow.filled.middle, wide.filled.middle, kResponseRows, count));
    EXPECT_TRUE(same_bits(narrow.filled.rate, wide.filled.rate, kWheelSpeed + 1, count + 1));
    EXPECT_TRUE(same_bits(narrow.conditions, wide.conditions, kGatheredRows,
                          bench.grid.contacts().node.size()));
  }
}

// Without fused multiply-adds sums are rounded once more; nothing else may differ.
TEST_P(StepsSideBySide, DifferInTheLastDigitsWithoutFusedMultiplyAdds) {
  constexpr int kSteps = 16;
  const PointBench bench(GetParam(), kSteps, false);
  const Given plain(InstructionSet::kPortable, bench);
  for (const InstructionSet set : supported_instruction_sets()) {
    SCOPED_TRACE(FlankContactBatch::name(set));
    const Given fused(set, bench);
    for (int i = kPinionShaftTwist; i <= kWheelSpeed; ++i) {
      for (int s = 0; s < kSteps; ++s) {
        const double size = std::max(std::abs(plain.end[i][s]), bench.scale(i));
        EXPECT_NEAR(fused.end[i][s], plain.end[i][s], 1e-13 * size);
      }
    }
    EXPECT_NEAR(fused.longest, plain.longest, 1e-11 * plain.longest);
  }
}

TEST_P(StepsSideBySide, AreTheSameBitsWhateverTheStatesOfOtherSteps) {
  constexpr int kSteps = 16;
  const PointBench bench(GetParam(), kSteps, false);
  for (const InstructionSet set : supported_instruction_sets()) {
    SCOPED_TRACE(FlankContactBatch::name(set));
    Columns end(kWheelSpeed + 1, kSteps), end_in_company(kWheelSpeed + 1, kSteps);
    ASSERT_TRUE(rk4_steps(set, bench.block(), bench.response, end, nullptr));
    for (const int kept : {0, 3, 7, 8, kSteps - 1}) {
      CycleResponse company = bench.response;
      for (int s = 0; s < kSteps; ++s) {
        if (s == kept) continue;
        company.start[kPinionSpeed][s] *= 1.5;
        company.start[kMeshApproach][s] *= 0.5;
      }
      rk4_steps(set, bench.block(), company, end_in_company, nullptr);
      for (int i = kTime; i <= kWheelSpeed; ++i) {
        EXPECT_TRUE(same_bits(end[i] + kept, end_in_company[i] + kept, 1)) << i << ' ' << kept;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    Cases, StepsSideBySide,
    testing::Values(
        StepCase{"drive", 40, {}}, StepCase{"coast", -25, {}},
        StepCase{"energy_consistent", 40, [](Scene& s) { s.options.energy_consistent = true; }},
        StepCase{"tabulated_arms", 40, [](Scene& s) { s.options.tabulated_friction_arms = true; }},
        StepCase{"contact_point_motion", 40,
                 [](Scene& s) { s.options.subtract_contact_point_motion = true; }},
        StepCase{"gear_set_b", 60, [](Scene& s) { s.gear_set = reference_gear_set("B"); }},
        StepCase{"no_damping", 40, [](Scene& s) { s.gear_set.dynamics.mesh_damping = 0; }},
        StepCase{"energy_consistent_coast", -25,
                 [](Scene& s) { s.options.energy_consistent = true; }}),
    [](const auto& place) { return place.param.name; });

/// A system at a speed and under a torque with all that its periodic responses need.
struct OrbitBench {
  OrbitBench(double pinion_torque, double pinion_speed, bool wheel_torque = false,
             std::optional<InstructionSet> set = std::nullopt)
      : scene(reference_scene()),
        mesh(scene.gear_set),
        contacts({scene.lubricant, scene.solid, scene.roughness, scene.boundary,
                  scene.sump_temperature, scene.inlet_temperature_rise, scene.options}),
        batch(set ? FlankContactBatch(contacts, *set) : FlankContactBatch(contacts)),
        system(mesh, scene.gear_set.dynamics, scene.options),
        grids(mesh, scene.gear_set.dynamics.half_backlash,
              reduced_modulus(scene.solid.youngs_modulus, scene.solid.poissons_ratio),
              scene.options),
        problem{system, batch, grids, tally, {}, 0, false, 1e-5, {}},
        solver(problem, work) {
    aim(pinion_torque, pinion_speed, wheel_torque);
  }

  void aim(double pinion_torque, double pinion_speed, bool wheel_torque) {
    problem.mean_pinion_speed = pinion_speed;
    problem.solve_wheel_torque = wheel_torque;
    options = {};
    options.bilateral_contact = true;
    options.tolerance = 1e-9;  // contacts are solved to 1e-10
    origin = {};
    origin.torques = {pinion_torque, pinion_torque * 36 / 13};
    origin.state = static_start(system, origin.torques, pinion_speed, 0, 0, 0);
  }

  bool solve(int steps, PeriodicOrbit& orbit) { return solve(steps, orbit, solver); }
  bool solve(int steps, PeriodicOrbit& orbit, OrbitSolver& by) {
    const MeshGrid& grid = grids.with_steps(steps);
    orbit = origin;
    return by.solve_without_friction(grid, options, orbit) && by.solve(grid, options, orbit);
  }

  /// By one march of the whole cycle after the other.
  PeriodicOrbit alone(int steps) {
    OrbitFriction friction(system, batch, tally, problem.tolerance);
    PeriodicOrbit orbit = origin;
    SingleShooting shooting(problem, friction, grids.with_steps(steps), options, orbit);
    EXPECT_TRUE(shooting.solve(1e-3));
    for (int iteration = 0; iteration < 12; ++iteration) {
      EXPECT_TRUE(shooting.evaluate_friction());
      EXPECT_TRUE(shooting.solve(1e-10));
    }
    EXPECT_TRUE(shooting.evaluate_friction());
    shooting.finish(work);
    return orbit;
  }

  Scene scene;
  MeshData mesh;
  FlankContactModel contacts;
  FlankContactBatch batch;
  GearPairSystem system;
  MeshGrids grids;
  ContactTally tally;
  SolverWork work;
  PeriodicProblem problem;
  OrbitSolver solver;
  ShootingOptions options;
  PeriodicOrbit origin;
};

void expect_near(const PeriodicOrbit& a, const PeriodicOrbit& b) {
  EXPECT_NEAR(a.torques.pinion, b.torques.pinion, 1e-6 * std::abs(b.torques.pinion));
  EXPECT_NEAR(a.torques.wheel, b.torques.wheel, 1e-6 * std::abs(b.torques.wheel));
  // The middles of steps are by other rates: no better than the steps themselves.
  EXPECT_LT(a.figures.distance(b.figures), 3e-4);
}

void expect_same_bits(const PeriodicOrbit& a, const PeriodicOrbit& b) {
  EXPECT_TRUE(same_bits(a.state.data(), b.state.data(), a.state.size()));
  EXPECT_EQ(a.torques.pinion, b.torques.pinion);
  EXPECT_EQ(a.torques.wheel, b.torques.wheel);
  EXPECT_EQ(a.figures.loss_rms, b.figures.loss_rms);
  EXPECT_EQ(a.figures.loss_energy, b.figures.loss_energy);
  EXPECT_EQ(a.figures.dte_minimum, b.figures.dte_minimum);
  EXPECT_EQ(a.figures.dte_maximum, b.figures.dte_maximum);
  EXPECT_EQ(a.picard_error, b.picard_error);
  EXPECT_EQ(a.contact_loss, b.contact_loss);
  EXPECT_EQ(a.least_pressing_force, b.least_pressing_force);
  EXPECT_EQ(a.jacobian->largest_multiplier(), b.jacobian->largest_multiplier());
  ASSERT_EQ(a.pieces.size(), b.pieces.size());
  for (std::size_t i = 0; i < a.pieces.size(); ++i) {
    EXPECT_TRUE(same_bits(a.pieces[i].middle.data(), b.pieces[i].middle.data(), kWheelSpeed + 1));
  }
}

TEST(MultipleShooting, FindsWhatSingleShootingFindsForEitherTorque) {
  constexpr double kNear = 2e-3;  // by maps from near
  for (const bool wheel : {false, true}) {
    for (const double torque : {40.0, -25.0}) {
      for (const double speed : {60.0, 230.0, 400.0}) {
        SCOPED_TRACE(testing::Message() << torque << " N m at " << speed << " rad/s, " << wheel);
        OrbitBench bench(torque, speed, wheel);
        PeriodicOrbit together;
        ASSERT_TRUE(
            MultipleShooting::applies(bench.grids.with_steps(24), bench.options, bench.origin));
        ASSERT_TRUE(bench.solve(24, together));
        const PeriodicOrbit alone = bench.alone(24);
        expect_near(together, alone);
        const double expected = alone.jacobian->largest_multiplier();
        EXPECT_NEAR(together.jacobian->largest_multiplier(), expected, kNear);
        EXPECT_TRUE(together.jacobian->floquet_radius_below(1.01 * expected + 0.5 * kNear));
        EXPECT_FALSE(together.jacobian->floquet_radius_below(0.99 * expected));
      }
    }
  }
}

// Kept together where they would part: there, friction is not told by the newton.
TEST(MultipleShooting, FindsWhatSingleShootingFindsWhereFlanksPull) {
  for (const bool wheel : {false, true}) {
    int pulled = 0;
    for (const double speed : {198.5, 200.0, 202.0}) {
      SCOPED_TRACE(speed);
      OrbitBench bench(20.1, speed, wheel);
      PeriodicOrbit orbit = bench.origin;
      const MeshGrid& grid = bench.grids.with_steps(48);
      OrbitFriction friction(bench.system, bench.batch, bench.tally, bench.problem.tolerance);
      CycleStorage storage;
      MultipleShooting shooting(bench.problem, friction, storage, grid, bench.options, orbit);
      ASSERT_TRUE(shooting.solve(1e-3));
      for (int iteration = 0; iteration < 12; ++iteration) {
        ASSERT_TRUE(shooting.evaluate_friction());
        ASSERT_TRUE(shooting.solve(1e-10));
      }
      ASSERT_TRUE(shooting.evaluate_friction());
      shooting.finish(bench.work);
      const PeriodicOrbit alone = bench.alone(48);
      expect_near(orbit, alone);
      EXPECT_NEAR(orbit.least_pressing_force, alone.least_pressing_force, 1e-3);
      EXPECT_FALSE(orbit.contact_loss);
      pulled += orbit.least_pressing_force < 0;
    }
    EXPECT_EQ(pulled, 3);
  }
}

// By one instant after the other: where flanks press together all the time, where they are kept
// together though they pull, and where they part.
TEST(OrbitSolver, HandsOverTheContactsOfTheResponse) {
  const auto expect_contacts = [](OrbitBench& bench, PeriodicOrbit& orbit) {
    ASSERT_TRUE(bench.solve(48, orbit));
    const SolvedPieces solved = solved_pieces(bench.system, bench.grids.with_steps(48),
                                              orbit.pieces, *orbit.contacts, bench.contacts);
    ContactSolver by_scalar_kernel(bench.contacts, bench.tally);
    const auto expect_close = [](double a, double b) {
      EXPECT_NEAR(a, b, 1e-8 * std::abs(b) + 1e-9);
    };
    for (std::size_t i = 0; i < orbit.pieces.size(); ++i) {
      const OrbitPiece& p = orbit.pieces[i];
      const MarchState* states[3] = {&p.start, &p.middle, &p.end};
      for (int part = 0; part < 3; ++part) {
        const double phase = std::min(p.phase + 0.5 * part * p.length, 1.0);
        Instant expected;
        bench.system.evaluate(phase, bench.mesh.interval_at(phase), p.regime, states[part]->data(),
                              by_scalar_kernel, expected);
        const Instant& at = solved.of(i)[part];
        expect_close(at.mesh_force, expected.mesh_force);
        expect_close(at.pinion_friction_torque, expected.pinion_friction_torque);
        expect_close(at.gear_friction_torque, expected.gear_friction_torque);
        expect_close(at.loss_power, expected.loss_power);
        for (int k = 0; k < kFlankPairs; ++k) {
          expect_close(at.load[k], expected.load[k]);
          expect_close(at.contact[k].viscous_friction, expected.contact[k].viscous_friction);
          expect_close(at.contact[k].contact_temperature, expected.contact[k].contact_temperature);
          expect_close(at.contact[k].film_ratio, expected.contact[k].film_ratio);
        }
      }
    }
  };
  OrbitBench pressed(40, 230), pulled(20.1, 200), parted(20.1, 200);
  parted.options.bilateral_contact = false;
  parted.options.first_cycles = 60;
  PeriodicOrbit orbit;
  expect_contacts(pressed, orbit);
  EXPECT_GT(orbit.least_pressing_force, 0);
  expect_contacts(pulled, orbit);
  EXPECT_LT(orbit.least_pressing_force, 0);
  expect_contacts(parted, orbit);
  EXPECT_TRUE(orbit.contact_loss);
}

TEST(MultipleShooting, GoesOnFromPiecesOfAnotherGrid) {
  for (const bool wheel : {false, true}) {
    OrbitBench bench(40, 230, wheel);
    for (const int coarse : {17, 24, 96}) {
      for (const int fine : {24, 31, 48}) {
        SCOPED_TRACE(testing::Message() << "from " << coarse << " to " << fine);
        PeriodicOrbit carried, fresh;
        ASSERT_TRUE(bench.solve(coarse, carried));
        const long before = bench.work.right_hand_sides;
        ASSERT_TRUE(bench.solver.solve(bench.grids.with_steps(fine), bench.options, carried));
        const long on_the_way = bench.work.right_hand_sides - before;
        ASSERT_TRUE(bench.solve(fine, fresh));
        EXPECT_EQ(carried.pieces.size(), static_cast<std::size_t>(fine));
        EXPECT_LT(carried.figures.distance(fresh.figures), 1e-8);
        EXPECT_NEAR(carried.torques.pinion, fresh.torques.pinion, 1e-7);
        EXPECT_NEAR(carried.torques.wheel, fresh.torques.wheel, 1e-7);
        EXPECT_LE(on_the_way, bench.work.right_hand_sides - before - on_the_way)
            << "and is not slower for it";
      }
    }
  }
}

TEST(OrbitSolver, UsedForManySearchesFindsTheSameBitsAsAFreshOne) {
  struct Search {
    double torque, speed;
    bool wheel, bilateral_contact;
    int steps;
  };
  OrbitBench reused(40, 230);
  for (const Search& at : {Search{40, 230, false, true, 24}, Search{40, 230, false, true, 96},
                           Search{-25, 60, true, true, 12}, Search{20.1, 200, false, true, 48},
                           Search{20.1, 200, false, false, 48}, Search{40, 400, true, true, 31},
                           Search{-25, 230, false, true, 24}, Search{40, 230, false, true, 24}}) {
    SCOPED_TRACE(testing::Message()
                 << at.torque << " N m at " << at.speed << " rad/s on " << at.steps);
    OrbitBench fresh(at.torque, at.speed, at.wheel);
    reused.aim(at.torque, at.speed, at.wheel);
    for (OrbitBench* bench : {&fresh, &reused}) {
      bench->options.bilateral_contact = at.bilateral_contact;
      bench->options.first_cycles = at.bilateral_contact ? 0 : 60;
    }
    PeriodicOrbit a, b;
    ASSERT_TRUE(fresh.solve(at.steps, a));
    ASSERT_TRUE(reused.solve(at.steps, b));
    expect_same_bits(a, b);
  }
}

TEST(OrbitSolver, FindsTheSameBitsInEveryWidthWithFusedMultiplyAdds) {
  if (!FlankContactBatch::supported(InstructionSet::kAvx512)) GTEST_SKIP() << "no AVX-512 here";
  for (const bool wheel : {false, true}) {
    for (const double speed : {60.0, 230.0}) {
      OrbitBench narrow(40, speed, wheel, InstructionSet::kAvx2);
      OrbitBench wide(40, speed, wheel, InstructionSet::kAvx512);
      PeriodicOrbit a, b;
      ASSERT_TRUE(narrow.solve(31, a));
      ASSERT_TRUE(wide.solve(31, b));
      expect_same_bits(a, b);
    }
  }
}

}  // namespace
}  // namespace tribodyn
