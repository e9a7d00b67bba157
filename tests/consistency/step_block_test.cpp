#include "core/dynamics/step_block.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "core/contact/hertz.h"
#include "core/dynamics/fixed_step_march.h"
#include "core/dynamics/multiple_shooting.h"
#include "core/dynamics/orbit_solver.h"
#include "core/dynamics/single_shooting.h"
#include "core/dynamics/steady_state.h"
#include "tests/support/contact_batch.h"
#include "tests/support/reference_scene.h"

// Steps taken side by side, with every set of instructions, against the same steps one by one.
namespace tribodyn {
namespace {

struct StepCase {
  std::string name;
  double pinion_torque;  ///< [N m]
  std::function<void(Scene&)> change;
  Driveline driveline = Driveline::kElasticShafts;
};

void PrintTo(const StepCase& c, std::ostream* out) { *out << c.name; }

/// A gear pair that runs, with a march of kept flanks over one mesh cycle to compare with.
struct Bench {
  static constexpr double kSpeed = 230;  // of the pinion [rad/s]

  Bench(const StepCase& c, int steps, bool wheel_torque)
      : scene(changed(c)),
        mesh(scene.gear_set),
        contacts({scene.lubricant, scene.solid, scene.roughness, scene.boundary,
                  scene.sump_temperature, scene.inlet_temperature_rise, scene.options}),
        system(mesh, contacts, scene.gear_set.dynamics, scene.options, c.driveline),
        grid(mesh, scene.gear_set.dynamics.half_backlash, steps,
             reduced_modulus(scene.solid.youngs_modulus, scene.solid.poissons_ratio),
             scene.options),
        solve_wheel_torque(wheel_torque) {
    system.set_torques({c.pinion_torque, c.pinion_torque * 41 / 13});
    system.regime = {c.pinion_torque > 0 ? 1 : -1, true};
    // Any friction will do that varies.
    for (int n = 0; n <= 2 * steps; ++n) {
      const double phase = 0.5 * n / steps;
      friction.add(phase, {-1e-3 * (1 + std::sin(6 * phase)), -2e-3 * (1 - 0.5 * phase)}, 1);
    }
    start = static_start(system, kSpeed, 0, 0, 0);
    const MarchScales scales = march_scales(system, kSpeed);
    FixedStepMarch march(system, scales, grid, 1, solve_wheel_torque, 1e-9,
                         InstructionSet::kPortable);
    MarchState y = start;
    marched = march.run(friction, true, y, &sensitivity, &pieces);
    for (Columns* columns : {&lagged.start, &lagged.middle}) {
      columns->resize(kFrictionRows, steps + 1);
    }
    for (int n = 0; n <= 2 * steps; ++n) {
      const FrictionPerLoad at = friction.at(0.5 * n / steps);
      Columns& to = n % 2 == 0 ? lagged.start : lagged.middle;
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
  StepBlock block() const { return {system, grid, system.regime.side, solve_wheel_torque, lagged}; }
  std::span<const int> moving() const { return states_of(system.driveline()).moving; }
  double scale(int component) const { return march_scales(system, kSpeed).of(mesh, component); }

  Scene scene;
  MeshData mesh;
  FlankContactModel contacts;
  GearPairSystem system;
  MeshGrid grid;
  bool solve_wheel_torque;
  LaggedFriction friction;
  MarchState start;
  Sensitivity sensitivity;
  std::vector<OrbitPiece> pieces;
  bool marched;
  CycleFriction lagged;
  CycleResponse response;
};

class StepsSideBySide : public testing::TestWithParam<StepCase> {};

TEST_P(StepsSideBySide, LeadWhereEachLeadsAlone) {
  for (const int steps : {5, 12, 16, 31}) {
    SCOPED_TRACE(steps);
    Bench bench(GetParam(), steps, false);
    ASSERT_TRUE(bench.marched);
    for (const InstructionSet set : supported_instruction_sets()) {
      SCOPED_TRACE(FlankContactBatch::name(set));
      Columns end(kWheelSpeed + 1, steps);
      ASSERT_TRUE(take_steps(set, bench.block(), bench.response, end, nullptr));
      for (int s = 0; s < steps; ++s) {
        const OrbitPiece& piece = bench.pieces[s];
        EXPECT_NEAR(end[kTime][s], piece.end[kTime] - piece.start[kTime], 1e-13 * piece.end[kTime]);
        for (const int i : bench.moving()) {
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
    Bench bench(GetParam(), kSteps, wheel);
    for (const InstructionSet set : supported_instruction_sets()) {
      SCOPED_TRACE(FlankContactBatch::name(set));
      Columns end(kWheelSpeed + 1, kSteps);
      const auto moving = bench.moving();
      const std::size_t unknowns = unknowns_of(bench.system.driveline());
      Columns derivatives(unknowns * unknowns, kSteps);
      ASSERT_TRUE(take_steps(set, bench.block(), bench.response, end, &derivatives));
      CycleDerivatives composed(kSteps, static_cast<int>(unknowns));
      compose_steps(set, derivatives, composed);
      const double* const whole = composed.from_section.get() + composed.matrix() * kSteps;
      for (std::size_t j = 0; j < unknowns; ++j) {
        // By components' sizes: their derivatives have many units.
        const bool by_torque = j == moving.size();
        const double by =
            by_torque ? march_scales(bench.system, Bench::kSpeed).torque : bench.scale(moving[j]);
        const int column = by_torque ? SectionMap::kUnknowns - 1 : moving[j] - 1;
        for (std::size_t i = 0; i < moving.size(); ++i) {
          EXPECT_NEAR(whole[unknowns * j + i] * by / bench.scale(moving[i]),
                      bench.sensitivity[moving[i]](column) * by / bench.scale(moving[i]), 1e-11)
              << moving[i] << " by " << j;
        }
        double time = 0;
        for (int s = 1; s <= kSteps; ++s) {
          time += composed.from_section[composed.matrix() * s + unknowns * (j + 1) - 1];
        }
        EXPECT_NEAR(time * by, bench.sensitivity[kTime](column) * by,
                    1e-11 * bench.pieces.back().end[kTime]);
      }
    }
  }
}

TEST_P(StepsSideBySide, KnowForcesMiddlesAndWhatContactsSee) {
  constexpr int kSteps = 12;
  Bench bench(GetParam(), kSteps, false);
  GearPairSystem& system = bench.system;
  for (const InstructionSet set : supported_instruction_sets()) {
    SCOPED_TRACE(FlankContactBatch::name(set));
    CycleResponse filled = bench.response;
    ASSERT_TRUE(fill_response(set, bench.block(), filled));
    for (int node = 0; node <= 2 * kSteps; ++node) {
      Columns& at = node % 2 == 0 ? filled.start : filled.middle;
      const int lane = node / 2;
      MarchState y{};
      for (int i = kTime; i <= kWheelSpeed; ++i) y[i] = at[i][lane];
      Mechanics expected;
      system.mechanics(bench.grid.at(node), y.data(), expected);
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
      Columns seen(kSeenRows, contacts->node.size());
      see_contacts(set, bench.block(), *contacts, filled, seen);
      for (int place = 0, node = 0; node <= 2 * kSteps; ++place, node += contacts->stride) {
        const Columns& at = node % 2 == 0 ? filled.start : filled.middle;
        MarchState y{};
        for (int i = kTime; i <= kWheelSpeed; ++i) y[i] = at[i][node / 2];
        int n = contacts->first[place];
        for (const FlankKinematics& flank : bench.grid.flanks(node)) {
          if (!(flank.load_share > 0)) continue;
          const double load = flank.load_share * system.regime.load(at[kMeshForceRow][node / 2]);
          FlankMotion motion;
          const ContactConditions c = system.contact_conditions(flank, load, y.data(), motion);
          EXPECT_NEAR(seen[kSeenLoad][n], c.load, 1e-12 * (c.load + 1));
          EXPECT_NEAR(seen[kSeenPinionX][n], c.pinion_velocity_x, 1e-12);
          EXPECT_NEAR(seen[kSeenPinionY][n], c.pinion_velocity_y, 1e-12);
          EXPECT_NEAR(seen[kSeenGearX][n], c.gear_velocity_x, 1e-12);
          EXPECT_NEAR(seen[kSeenGearY][n], c.gear_velocity_y, 1e-12);
          EXPECT_NEAR(seen[kSeenSlidingSpeed][n], motion.sliding_speed, 1e-12);
          EXPECT_NEAR(seen[kSeenPinionArm][n], motion.pinion_friction_arm, 1e-12);
          EXPECT_NEAR(seen[kSeenGearArm][n], motion.gear_friction_arm, 1e-12);
          ++n;
        }
        EXPECT_EQ(n, contacts->first[place + 1]);
      }
    }
  }
}

TEST_P(StepsSideBySide, AreGivenUpWhereTheyMeanNothing) {
  constexpr int kSteps = 12;
  Bench bench(GetParam(), kSteps, false);
  for (const InstructionSet set : supported_instruction_sets()) {
    SCOPED_TRACE(FlankContactBatch::name(set));
    Columns end(kWheelSpeed + 1, kSteps);
    const auto is_refused = [&](int component, double value) {
      CycleResponse wild = bench.response;
      wild.start[component][kSteps - 1] = value;
      return !take_steps(set, bench.block(), wild, end, nullptr);
    };
    EXPECT_TRUE(is_refused(kPinionSpeed, 0));
    EXPECT_TRUE(is_refused(kPinionSpeed, -100));
    EXPECT_TRUE(is_refused(kWinding, 1));  // far beyond the series
    EXPECT_TRUE(is_refused(kGearSpeed, std::nan("")));
    EXPECT_FALSE(is_refused(kWinding, bench.response.start[kWinding][0]));
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
        StepCase{"constant_torques", 40, {}, Driveline::kConstantTorques},
        StepCase{"constant_torques_coast", -25, {}, Driveline::kConstantTorques},
        StepCase{"constant_torques_energy_consistent", 40,
                 [](Scene& s) { s.options.energy_consistent = true; },
                 Driveline::kConstantTorques}),
    [](const auto& place) { return place.param.name; });

class MultipleShootingOn : public testing::TestWithParam<Driveline> {};

TEST_P(MultipleShootingOn, FindsWhatSingleShootingFinds) {
  for (const double torque : {40.0, -25.0}) {
    for (const double speed : {60.0, 230.0, 400.0}) {
      SCOPED_TRACE(speed);
      const StepCase c{"", torque, {}, GetParam()};
      Bench bench(c, 24, false);
      const FlankContactBatch batch(bench.contacts);
      OrbitRequest request;
      request.mean_pinion_speed = speed;
      request.keep_contact = true;
      request.tolerance = 1e-10;
      PeriodicOrbit origin;
      origin.torques = {torque, torque * 41 / 13};
      bench.system.set_torques(origin.torques);
      origin.state = static_start(bench.system, speed, 0, 0, 0);

      MarchStatistics statistics;
      long cycles = 0;
      OrbitSolver solver(bench.system, batch, statistics, cycles);
      PeriodicOrbit together = origin;
      ASSERT_TRUE(MultipleShooting::applies(bench.grid, request, together));
      ASSERT_TRUE(solver.approach_without_friction(bench.grid, request, together));
      ASSERT_TRUE(solver.solve(bench.grid, request, together));

      OrbitFriction friction(bench.system, batch);
      PeriodicOrbit alone = origin;
      SingleShooting shooting(bench.system, friction, bench.grid, request, alone);
      ASSERT_TRUE(shooting.converge(1e-3));
      for (int sweep = 0; sweep < 12; ++sweep) {
        ASSERT_TRUE(shooting.evaluate_friction());
        ASSERT_TRUE(shooting.converge(1e-10));
      }
      ASSERT_TRUE(shooting.evaluate_friction());
      shooting.finish(statistics, cycles);
      EXPECT_NEAR(together.torques.pinion, alone.torques.pinion, 1e-6 * std::abs(torque));
      // The middles of steps are by other rates: no better than the steps themselves.
      EXPECT_LT(together.figures.distance(alone.figures), 3e-4);
      // By maps from near. Of shafts it hardly depends on the response, of the mesh it does.
      const double expected = alone.map->largest_multiplier();
      const double near = GetParam() == Driveline::kElasticShafts ? 2e-3 : 6e-3;
      EXPECT_NEAR(together.map->largest_multiplier(), expected, near);
      EXPECT_TRUE(together.map->multipliers_are_below(1.01 * expected + near));
      EXPECT_FALSE(together.map->multipliers_are_below(0.99 * expected));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Drivelines, MultipleShootingOn,
                         testing::Values(Driveline::kElasticShafts, Driveline::kConstantTorques),
                         [](const auto& place) {
                           return place.param == Driveline::kElasticShafts ? "ElasticShafts"
                                                                           : "ConstantTorques";
                         });

}  // namespace
}  // namespace tribodyn
