// Studies have the same bits for any prepared gear set and any number of threads; curves of
// independent points.
#include "server/simulation/compute.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <memory>
#include <mutex>
#include <numeric>
#include <random>
#include <set>
#include <thread>

#include "core/refusal.h"
#include "server/mapping/from_core.h"
#include "server/simulation/cost_estimate.h"
#include "server/simulation/input_hash.h"
#include "server/simulation/simulation_inputs.h"
#include "tests/service/support.h"
#include "tests/support/run_length.h"

namespace tribodyn::server {
namespace {

constexpr auto kGoOn = [](double, const StageText&) { return true; };

SimulationInputs inputs_for(const v1::Simulation& simulation) {
  Violations violations;
  auto inputs = read_simulation(simulation, seed_lookup(), "simulation", violations);
  if (!inputs) throw std::runtime_error(violations.front().description);
  return *inputs;
}

/// Returns result and history of a study as bytes.
std::string bits_of(const v1::Simulation& simulation, PreparedGearSets& gear_sets) {
  const SimulationInputs inputs = inputs_for(simulation);
  Computed computed = to_result(inputs, {}, solve(inputs, {}, gear_sets, kGoOn));
  std::string out = computed.result.SerializeAsString();
  for (const StoredColumn& column : computed.history) {
    out.append(reinterpret_cast<const char*>(column.values.data()),
               column.values.size() * sizeof(double));
  }
  return out;
}

std::string bits_alone(const v1::Simulation& simulation) {
  PreparedGearSets none;
  return bits_of(simulation, none);
}

v1::Simulation point_of(const std::string& lubricant, double speed) {
  v1::Simulation out = point_simulation();
  out.set_lubricant(lubricant);
  out.mutable_operating_point()->mutable_cruise()->set_speed_kilometres_per_hour(speed);
  return out;
}

/// Returns scenes of all seeds with points of every kind: models, methods, options, coast,
/// histories.
std::vector<v1::Simulation> scenes() {
  std::vector<v1::Simulation> out;
  for (const char* lubricant :
       {"lubricants/paper-fluid-1", "lubricants/paper-fluid-2", "lubricants/paper-fluid-3"}) {
    for (const double speed : {2.0, 35.0, 72.5, 110.0}) {
      out.push_back(point_of(lubricant, speed));
      out.back().set_sump_temperature_celsius(speed);
      out.push_back(out.back());
      out.back().set_gear_set("gearSets/reference-axle-loaded-error");
    }
    out.push_back(point_of(lubricant, 100));
    out.back().mutable_operating_point()->set_model(v1::POINT_MODEL_QUASI_STATIC);
    out.push_back(point_of(lubricant, 60));
    out.back().mutable_model_options()->set_exact_hertz(true);
    v1::PrescribedTorque* coast = out.emplace_back(point_of(lubricant, 0))
                                      .mutable_operating_point()
                                      ->mutable_prescribed_torque();
    coast->set_pinion_torque_newton_metres(-30);
    coast->set_pinion_speed_radians_per_second(200);
  }
  out.push_back(point_of("lubricants/paper-fluid-1", 90));
  out.back().mutable_operating_point()->mutable_history()->add_columns("mesh_force_newtons");
  out.push_back(point_of("lubricants/paper-fluid-2", 90));
  out.back().mutable_solver_options()->set_tolerance(1e-6);
  if (!kUnderSanitizer) {
    out.push_back(point_of("lubricants/paper-fluid-2", 72.5));
    out.back().mutable_solver_options()->set_method(v1::STEADY_STATE_METHOD_MARCH);
    out.push_back(curve_simulation());
  }
  return out;
}

TEST(PreparedGearSets, GiveTheBitsOfAnUnpreparedOneAfterAnyOtherStudy) {
  const std::vector<v1::Simulation> all = scenes();
  std::vector<std::string> alone;
  for (const v1::Simulation& each : all) alone.push_back(bits_alone(each));
  std::vector<std::size_t> order(all.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::mt19937 random(1);
  PreparedGearSets gear_sets;
  for (int round = 0; round < (kUnderSanitizer ? 1 : 3); ++round) {
    std::shuffle(order.begin(), order.end(), random);
    for (const std::size_t i : order) {
      EXPECT_EQ(bits_of(all[i], gear_sets), alone[i]) << all[i].ShortDebugString();
    }
  }
  EXPECT_EQ(gear_sets.size(), 3U) << "A, B, and A under exact_hertz";
}

TEST(PreparedGearSets, GiveTheSameBitsToManyThreads) {
  std::vector<v1::Simulation> points;
  for (const double speed : {30.0, 50.0, 70.0, 90.0})
    points.push_back(point_of("lubricants/paper-fluid-1", speed));
  std::vector<std::string> alone;
  for (const v1::Simulation& each : points) alone.push_back(bits_alone(each));
  PreparedGearSets gear_sets;
  std::vector<std::thread> threads;
  for (std::size_t thread = 0; thread < 4; ++thread) {
    threads.emplace_back([&, thread] {
      for (std::size_t i = 0; i < 8; ++i) {
        const std::size_t which = (thread + i) % points.size();
        EXPECT_EQ(bits_of(points[which], gear_sets), alone[which]);
      }
    });
  }
  for (std::thread& each : threads) each.join();
  EXPECT_LE(gear_sets.size(), 4U) << "one a thread";
}

const auto kFirst = std::make_shared<const v1::GearSet>();
const auto kSecond = std::make_shared<const v1::GearSet>();

TEST(PreparedGearSets, AreLentToOneStudyAtATime) {
  const SimulationInputs inputs = inputs_for(point_simulation());
  const Scene physical = scene(inputs);
  PreparedGearSets gear_sets;
  const auto first = gear_sets.take(kFirst, physical);
  const auto second = gear_sets.take(kFirst, physical);
  EXPECT_NE(first, second);
  const PreparedGearSet* const returned = second.get();
  gear_sets.give_back(kFirst, physical.options, second);
  EXPECT_EQ(gear_sets.take(kFirst, physical).get(), returned);
}

TEST(PreparedGearSets, DifferByGearSetAndModel) {
  Scene physical = scene(inputs_for(point_simulation()));
  PreparedGearSets gear_sets;
  const auto first = gear_sets.take(kFirst, physical);
  gear_sets.give_back(kFirst, physical.options, first);
  EXPECT_NE(gear_sets.take(kSecond, physical), first);
  physical.options.as_published.eq22_inverted_ratio = true;
  EXPECT_NE(gear_sets.take(kFirst, physical), first);
  physical.options.as_published.eq22_inverted_ratio = false;
  EXPECT_EQ(gear_sets.take(kFirst, physical), first);
}

TEST(PreparedGearSets, KeepRecentlyUsedOnesAndDropLargeOnes) {
  const Scene physical = scene(inputs_for(point_simulation()));
  PreparedGearSets gear_sets;
  std::map<std::size_t, PreparedGearSets::Source> sources;
  const auto source = [&](std::size_t number) {
    auto& out = sources[number];
    if (!out) out = std::make_shared<const v1::GearSet>();
    return out;
  };
  const auto use = [&](std::size_t number) {
    auto taken = gear_sets.take(source(number), physical);
    gear_sets.give_back(source(number), physical.options, taken);
    return taken;
  };
  const auto first = use(1);
  const auto second = use(2);
  for (std::size_t i = 3; i <= PreparedGearSets::kCapacity; ++i) use(i);
  EXPECT_EQ(use(1), first);
  use(PreparedGearSets::kCapacity + 1);
  EXPECT_EQ(gear_sets.size(), PreparedGearSets::kCapacity);
  EXPECT_EQ(use(1), first);
  EXPECT_NE(use(2), second) << "used longest ago";

  const auto large = gear_sets.take(source(1), physical);
  large->grids().with_steps(static_cast<int>(PreparedGearSets::kMaximumSteps) + 1);
  gear_sets.give_back(source(1), physical.options, large);
  EXPECT_NE(gear_sets.take(source(1), physical), large);
}

TEST(PreparedGearSets, AreSharedBySimulationsAndDroppedAfterAnException) {
  std::mutex mutex;
  std::vector<std::shared_ptr<PreparedGearSet>> used;
  StudyFunctions studies = quick_studies();
  studies.solve_operating_point = [&, inner = studies.solve_operating_point](
                                      const Scene& scene, const OperatingCondition& condition,
                                      const PointOptions& options,
                                      const std::shared_ptr<PreparedGearSet>& gear_set) {
    const std::lock_guard lock(mutex);
    used.push_back(gear_set);
    if (condition.vehicle_speed > 30) throw Refusal("TOO_FAST", "too fast");
    return inner(scene, condition, options, gear_set);
  };
  Bench bench(studies, 1);
  for (const double speed : {50.0, 60.0, 120.0, 70.0}) {
    const std::string name = bench.create(point_of("lubricants/paper-fluid-1", speed));
    ASSERT_TRUE(
        bench.reaches(name, speed > 100 ? v1::Simulation::FAILED : v1::Simulation::SUCCEEDED));
  }
  const std::lock_guard lock(mutex);
  ASSERT_EQ(used.size(), 4U);
  EXPECT_EQ(used[1], used[0]);
  EXPECT_EQ(used[2], used[0]);
  EXPECT_NE(used[3], used[0]) << "an exception may leave something half made";
}

v1::Simulation independent_curve(const std::vector<double>& speeds) {
  v1::Simulation out = curve_simulation();
  v1::InefficiencyCurveStudy* curve = out.mutable_inefficiency_curve();
  curve->Clear();
  *curve->mutable_speeds_kilometres_per_hour() = {speeds.begin(), speeds.end()};
  curve->set_independent_points(true);
  return out;
}

v1::SimulationResult result_of(const v1::Simulation& simulation) {
  const SimulationInputs inputs = inputs_for(simulation);
  PreparedGearSets gear_sets;
  return to_result(inputs, {}, solve(inputs, {}, gear_sets, kGoOn)).result;
}

TEST(IndependentPoints, HaveTheBitsOfSinglePointsInEveryModel) {
  // Flanks stay in contact at 60 km/h and separate at 70 and 75; at 2 the quasi-static model is
  // used.
  const std::vector<double> speeds = {2, 60, 70, 75, 110};
  for (const v1::PointModel model :
       {v1::POINT_MODEL_AUTOMATIC, v1::POINT_MODEL_FULL, v1::POINT_MODEL_QUASI_STATIC}) {
    v1::Simulation asked = independent_curve(speeds);
    asked.mutable_inefficiency_curve()->set_model(model);
    const v1::SimulationResult curve = result_of(asked);
    ASSERT_EQ(curve.points_size(), static_cast<int>(speeds.size()));
    EXPECT_TRUE(curve.independent_points());
    EXPECT_EQ(curve.direction(), v1::SWEEP_DIRECTION_UNSPECIFIED);
    for (int i = 0; i < curve.points_size(); ++i) {
      v1::Simulation single = point_of(asked.lubricant(), speeds[static_cast<std::size_t>(i)]);
      single.mutable_operating_point()->set_model(model);
      const v1::CurvePoint point = result_of(single).points(0);
      EXPECT_EQ(curve.points(i).SerializeAsString(), point.SerializeAsString())
          << model << " at " << point.speed_kilometres_per_hour();
      EXPECT_FALSE(curve.points(i).has_branch_end());
    }
  }
}

TEST(IndependentPoints, StartFromTheRequestedState) {
  v1::Simulation asked = independent_curve({69, 75});
  asked.mutable_inefficiency_curve()->set_start(v1::POINT_START_LARGE_VIBRATION);
  const v1::SimulationResult curve = result_of(asked);
  for (const v1::CurvePoint& each : curve.points()) {
    v1::Simulation single = point_of(asked.lubricant(), each.speed_kilometres_per_hour());
    single.mutable_operating_point()->set_start(v1::POINT_START_LARGE_VIBRATION);
    EXPECT_EQ(each.SerializeAsString(), result_of(single).points(0).SerializeAsString());
  }
  EXPECT_TRUE(curve.points(0).result().contact_loss()) << "the quiet branch ends at 71 km/h";
}

TEST(Sensitivities, ComeWithAPointIfAskedForAndCountAsAnotherInput) {
  v1::Simulation request = point_simulation();
  request.mutable_operating_point()->mutable_cruise()->set_speed_kilometres_per_hour(100);
  const auto inputs = [&request] {
    Violations violations;
    return read_simulation(request, seed_lookup(), "", violations).value();
  };
  const std::string plain = input_hash(inputs());
  const double seconds = estimate_cost(inputs()).processor_seconds();
  request.mutable_operating_point()->set_sensitivities(false);
  EXPECT_EQ(input_hash(inputs()), plain);
  request.mutable_operating_point()->set_sensitivities(true);
  EXPECT_NE(input_hash(inputs()), plain);
  EXPECT_GT(estimate_cost(inputs()).processor_seconds(), seconds);
  const PointStudy point = std::get<PointStudy>(study(inputs()));
  const v1::CurvePoint result =
      to_curve_point(solve_operating_point(scene(inputs()), point.condition, point.options));
  EXPECT_EQ(result.result().sensitivities().parameters_size(), 28);
}

TEST(Sensitivities, OfIndependentPointsHaveTheBitsOfThoseOfSinglePoints) {
  const std::vector<double> speeds = {2, 60, 70, 75, 110};
  for (const v1::PointModel model : {v1::POINT_MODEL_AUTOMATIC, v1::POINT_MODEL_QUASI_STATIC}) {
    v1::Simulation asked = independent_curve(speeds);
    asked.mutable_inefficiency_curve()->set_model(model);
    asked.mutable_inefficiency_curve()->set_sensitivities(true);
    const v1::SimulationResult curve = result_of(asked);
    ASSERT_EQ(curve.points_size(), static_cast<int>(speeds.size()));
    for (int i = 0; i < curve.points_size(); ++i) {
      v1::Simulation single = point_of(asked.lubricant(), speeds[static_cast<std::size_t>(i)]);
      single.mutable_operating_point()->set_model(model);
      single.mutable_operating_point()->set_sensitivities(true);
      EXPECT_EQ(curve.points(i).SerializeAsString(),
                result_of(single).points(0).SerializeAsString())
          << model << " at " << speeds[static_cast<std::size_t>(i)];
      const v1::PointResult& point = curve.points(i).result();
      EXPECT_EQ(point.sensitivities().parameters_size(),
                model == v1::POINT_MODEL_QUASI_STATIC ? 0 : 28);
      EXPECT_EQ(point.has_sensitivities(),
                std::ranges::none_of(point.warnings(), [](const v1::RangeWarning& warning) {
                  return warning.code() == "NO_SENSITIVITIES";
                }));
    }
  }
}

TEST(Sensitivities, OfACurveCountAsAnotherInputAndChangeNothingElse) {
  v1::Simulation plain = curve_simulation();
  v1::InefficiencyCurveStudy& study = *plain.mutable_inefficiency_curve();
  study.Clear();
  for (const double speed : {66, 69, 72, 75}) study.add_speeds_kilometres_per_hour(speed);
  v1::Simulation with = plain;
  with.mutable_inefficiency_curve()->set_sensitivities(true);
  v1::Simulation without = plain;
  without.mutable_inefficiency_curve()->set_sensitivities(false);
  EXPECT_EQ(input_hash(inputs_for(without)), input_hash(inputs_for(plain)));
  EXPECT_NE(input_hash(inputs_for(with)), input_hash(inputs_for(plain)));
  EXPECT_GT(estimate_cost(inputs_for(with)).processor_seconds(),
            estimate_cost(inputs_for(plain)).processor_seconds());
  v1::SimulationResult curve = result_of(with);
  int branch_ends = 0;
  for (v1::CurvePoint& each : *curve.mutable_points()) {
    EXPECT_EQ(each.result().sensitivities().figures_size(), 9) << each.speed_kilometres_per_hour();
    branch_ends += each.has_branch_end() ? 1 : 0;
    each.mutable_result()->clear_sensitivities();
  }
  EXPECT_EQ(branch_ends, 1);
  const v1::SimulationResult expected = result_of(plain);
  ASSERT_EQ(curve.points_size(), expected.points_size());
  for (int i = 0; i < curve.points_size(); ++i) {
    EXPECT_EQ(curve.points(i).ShortDebugString(), expected.points(i).ShortDebugString());
  }
}

TEST(IndependentPoints, HaveAnotherInputHashThanAFollowedBranchAndCostLess) {
  v1::Simulation independent = curve_simulation();
  independent.mutable_inefficiency_curve()->set_independent_points(true);
  const SimulationInputs followed = inputs_for(curve_simulation());
  const SimulationInputs alone = inputs_for(independent);
  EXPECT_NE(input_hash(followed), input_hash(alone));
  EXPECT_LT(estimate_cost(alone).processor_seconds(),
            0.5 * estimate_cost(followed).processor_seconds());
}

TEST(IndependentPoints, HaveNoDirection) {
  v1::Simulation asked = independent_curve({60, 70});
  asked.mutable_inefficiency_curve()->set_direction(v1::SWEEP_DIRECTION_DOWN);
  Violations violations;
  EXPECT_FALSE(read_simulation(asked, seed_lookup(), "simulation", violations));
  ASSERT_EQ(violations.size(), 1U);
  EXPECT_EQ(violations[0].field, "simulation.inefficiency_curve.direction");
  EXPECT_EQ(violations[0].description,
            "direction = DOWN together with independent_points; allowed: unset, as a direction is "
            "that in which a branch is followed from point to point");
}

}  // namespace
}  // namespace tribodyn::server
