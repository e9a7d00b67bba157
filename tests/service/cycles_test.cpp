// EvaluateCycle: energies lost over a drive cycle, by a map of points.
#include "server/application/cycles.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/refusal.h"
#include "server/simulation/cycle_evaluation.h"
#include "server/simulation/point_evaluation.h"
#include "tests/service/support.h"
#include "tests/service/uncertain_fluids.h"

namespace tribodyn::server {
namespace {

using testing::HasSubstr;
using testing::Not;

v1::EvaluateCycleRequest nedc_request(const std::vector<std::string>& lubricants) {
  v1::EvaluateCycleRequest out;
  for (const std::string& each : lubricants) out.add_lubricants(each);
  out.set_named_cycle(v1::NAMED_CYCLE_NEDC);
  return out;
}

void add_place(v1::EvaluateCycleRequest& request, double seconds, double speed,
               double degrees = 0) {
  v1::CyclePlace& place = *request.add_places();
  place.set_time_seconds(seconds);
  place.set_speed_kilometres_per_hour(speed);
  place.set_ascent_angle_degrees(degrees);
}

/// Stands, accelerates uphill, cruises, brakes downhill and stands.
v1::EvaluateCycleRequest short_request() {
  v1::EvaluateCycleRequest out = nedc_request({"lubricants/paper-fluid-1"});
  out.clear_named_cycle();
  add_place(out, 0, 0);
  add_place(out, 2, 0, 1);
  add_place(out, 10, 50);
  add_place(out, 15, 50, -2);
  add_place(out, 20, 0);
  add_place(out, 22, 0);
  return out;
}

v1::EvaluateCycleResponse run_cycle(const v1::EvaluateCycleRequest& request,
                                    const ResourceLookup& lookup = seed_lookup()) {
  Violations violations;
  const auto evaluation = read_cycle(request, lookup, violations);
  if (!evaluation) throw std::runtime_error(violations.front().description);
  PreparedGearSets gear_sets;
  return evaluate_cycle(request, *evaluation, gear_sets, [] { return false; });
}

std::string cycle_violations(const v1::EvaluateCycleRequest& request) {
  Violations violations;
  read_cycle(request, seed_lookup(), violations);
  std::string out;
  for (const Violation& each : violations) out += each.field + ": " + each.description + "\n";
  return out;
}

/// 1,200 s of unsteady driving: uphill, so that the drive flanks always carry, or on the level, so
/// that the torque often passes through zero.
v1::EvaluateCycleRequest unsteady_request(double degrees) {
  v1::EvaluateCycleRequest out = nedc_request({"lubricants/paper-fluid-1"});
  out.clear_named_cycle();
  for (int i = 0; i <= 1200; ++i) {
    add_place(out, i, 60 + 45 * std::sin(0.013 * i) + 2 * std::sin(0.9 * i), degrees);
  }
  return out;
}

TEST(EvaluateCycle, OfTheNedcIsThePointByPointIntegration) {
  v1::EvaluateCycleRequest request =
      nedc_request({"lubricants/paper-fluid-1", "lubricants/paper-fluid-2"});
  request.mutable_model_options()->set_preset(v1::ModelOptions::PAPER);
  const v1::EvaluateCycleResponse out = run_cycle(request);
  request.set_point_by_point(true);
  const v1::EvaluateCycleResponse by_piece = run_cycle(request);
  EXPECT_NEAR(out.duration_seconds(), 1180, 1e-9);
  EXPECT_NEAR(out.distance_metres(), 11028, 1);
  EXPECT_NEAR(out.standstill_seconds(), 280, 1e-9);
  ASSERT_EQ(out.lubricants_size(), 2);
  for (int k = 0; k < 2; ++k) {
    const v1::CycleLubricant& lubricant = out.lubricants(k);
    EXPECT_EQ(lubricant.loss_joules(), by_piece.lubricants(k).loss_joules());
    EXPECT_EQ(lubricant.map_error_joules(), 0);
    EXPECT_GT(lubricant.solver_error_joules(), 0);
    EXPECT_LE(lubricant.solver_error_joules(), 1e-3 * lubricant.loss_joules());
    EXPECT_LT(lubricant.points(), 200) << "the urban part is repeated four times, and solved once";
    double sum = 0;
    for (int i = 0; i < out.start_seconds_size(); ++i) {
      sum += lubricant.mesh_loss_power_watts(i) * out.piece_seconds(i);
    }
    EXPECT_NEAR(sum, lubricant.loss_joules(), 1e-9 * sum);
    EXPECT_EQ(lubricant.lubricant_revision(), request.lubricants(k) + "@1");
  }
  // As first obtained in the client, point by point.
  EXPECT_NEAR(out.lubricants(0).loss_joules(), 83'860, 1e-3 * 83'860);
  EXPECT_EQ(out.vehicle_revision(), "vehicles/passenger-car@1");
}

TEST(EvaluateCycle, OfManyPlacesIsWithinItsStatedErrorOfThePointByPointIntegration) {
  v1::EvaluateCycleRequest request = unsteady_request(3);
  const v1::EvaluateCycleResponse by_map = run_cycle(request);
  request.set_point_by_point(true);
  const v1::EvaluateCycleResponse by_piece = run_cycle(request);
  const v1::CycleLubricant& of_map = by_map.lubricants(0);
  const v1::CycleLubricant& of_pieces = by_piece.lubricants(0);
  EXPECT_GT(of_map.map_error_joules(), 0);
  EXPECT_LE(of_map.map_error_joules(), 2e-3 * of_map.loss_joules());
  EXPECT_LT(of_map.points(), 900);
  EXPECT_EQ(of_pieces.map_error_joules(), 0);
  EXPECT_EQ(of_pieces.points(), 1200);
  EXPECT_LE(std::abs(of_map.loss_joules() - of_pieces.loss_joules()), of_map.map_error_joules());
  EXPECT_EQ(by_map.model_version(), by_piece.model_version());
}

TEST(EvaluateCycle, CarriesTheWarningsOfItsPoints) {
  v1::EvaluateCycleRequest request = nedc_request({"lubricants/paper-fluid-1"});
  request.clear_named_cycle();
  for (const double second : {0.0, 10.0, 20.0}) add_place(request, second, 120);
  const v1::CycleLubricant lubricant = run_cycle(request).lubricants(0);
  const bool warns =
      std::any_of(lubricant.warnings().begin(), lubricant.warnings().end(),
                  [](const v1::RangeWarning& each) { return each.code() == "RESPONSES_COEXIST"; });
  EXPECT_TRUE(warns);
}

// Marching every rattle calls back half as often again.
TEST(EvaluateCycle, ThroughZeroTorqueMarchesNoRattle) {
  const v1::EvaluateCycleRequest request = unsteady_request(0);
  Violations violations;
  const auto evaluation = read_cycle(request, seed_lookup(), violations);
  PreparedGearSets gear_sets;
  long calls = 0;
  const v1::EvaluateCycleResponse out =
      evaluate_cycle(request, *evaluation, gear_sets, [&calls] { return ++calls < 0; });
  const v1::CycleLubricant& lubricant = out.lubricants(0);
  EXPECT_LE(lubricant.map_error_joules(), 2e-3 * lubricant.loss_joules());
  EXPECT_LT(calls, 36'000);
  EXPECT_FALSE(std::isnan(lubricant.solver_error_joules()));
}

TEST(EvaluateCycle, EachPieceIsThePointOfItsSpeedAndTorque) {
  v1::EvaluateCycleRequest request = short_request();
  request.set_point_by_point(true);
  request.set_tolerance(1e-6);
  const v1::EvaluateCycleResponse out = run_cycle(request);
  for (int i = 0; i < out.start_seconds_size(); ++i) {
    SCOPED_TRACE(out.start_seconds(i));
    const double speed = out.speed_kilometres_per_hour(i);
    const double power = out.lubricants(0).mesh_loss_power_watts(i);
    if (speed < 0.1) {
      EXPECT_EQ(power, 0);
      EXPECT_EQ(out.wheel_torque_newton_metres(i), 0);
      continue;
    }
    v1::Simulation simulation;
    simulation.set_lubricant("lubricants/paper-fluid-1");
    simulation.mutable_solver_options()->set_tolerance(1e-6);
    auto& snapshot = *simulation.mutable_operating_point()->mutable_drive_cycle_snapshot();
    snapshot.set_speed_kilometres_per_hour(speed);
    snapshot.set_acceleration_metres_per_second_squared(
        out.acceleration_metres_per_second_squared(i));
    snapshot.set_ascent_angle_degrees(out.ascent_angle_degrees(i));
    Violations violations;
    const auto inputs = read_simulation(simulation, seed_lookup(), "", violations);
    const PointStudy point = std::get<PointStudy>(study(*inputs));
    const PointResult alone = solve_operating_point(scene(*inputs), point.condition, point.options);
    EXPECT_NEAR(power, alone.mesh_loss_power, 3e-6 * alone.mesh_loss_power);
    EXPECT_NEAR(out.wheel_torque_newton_metres(i), alone.wheel_torque,
                1e-9 * std::abs(alone.wheel_torque));
  }
}

TEST(EvaluateCycle, PartsStateEnergiesAndTheDifferenceFromTheFirstLubricant) {
  v1::EvaluateCycleRequest request = short_request();
  request.add_lubricants("lubricants/paper-fluid-2");
  const v1::EvaluateCycleResponse out = run_cycle(request);
  double of_flanks = 0;
  for (int i = 0; i < out.parts_size(); ++i) {
    const v1::CyclePart& part = out.parts(i);
    for (const v1::CycleLubricant& lubricant : out.lubricants()) {
      const v1::CyclePartLoss& loss = lubricant.parts(i);
      if (part.kind() == v1::CYCLE_PART_KIND_STANDSTILL) {
        EXPECT_EQ(loss.loss_joules(), 0);
        EXPECT_TRUE(std::isnan(loss.inefficiency_percent()));
        continue;
      }
      if (loss.input_joules() > 0) {
        EXPECT_DOUBLE_EQ(loss.inefficiency_percent(),
                         100 * loss.loss_joules() / loss.input_joules());
        EXPECT_DOUBLE_EQ(loss.loss_share_percent(),
                         100 * loss.loss_joules() / lubricant.loss_joules());
        EXPECT_NEAR(loss.loss_difference_percent(),
                    100 * (loss.loss_joules() / out.lubricants(0).parts(i).loss_joules() - 1),
                    1e-12);
      }
    }
    if (part.kind() == v1::CYCLE_PART_KIND_DRIVE || part.kind() == v1::CYCLE_PART_KIND_COAST) {
      EXPECT_GT(out.lubricants(0).parts(i).loss_joules(), 0);
      of_flanks += out.lubricants(0).parts(i).loss_joules();
    }
  }
  EXPECT_NEAR(of_flanks, out.lubricants(0).loss_joules(), 1e-9 * of_flanks);
  EXPECT_NE(out.lubricants(1).parts(0).loss_difference_percent(), 0);
  EXPECT_EQ(out.lubricants(0).parts(0).loss_difference_percent(), 0);
}

TEST(EvaluateCycle, FollowsTheTemperatureOfTheSumpFromPlaceToPlace) {
  v1::EvaluateCycleRequest request = nedc_request({"lubricants/paper-fluid-1"});
  request.clear_named_cycle();
  add_place(request, 0, 60);
  add_place(request, 30, 60);
  const double cold = run_cycle(request).lubricants(0).loss_joules();
  request.set_sump_temperature_celsius(90);
  const double hot = run_cycle(request).lubricants(0).loss_joules();
  request.mutable_places(0)->set_sump_temperature_celsius(40);
  request.mutable_places(1)->set_sump_temperature_celsius(90);
  const v1::EvaluateCycleResponse out = run_cycle(request);
  EXPECT_NEAR(out.sump_temperature_celsius(0), 40 + 50.0 / 60, 1e-9);
  EXPECT_NEAR(out.sump_temperature_celsius(29), 90 - 50.0 / 60, 1e-9);
  const double warming = out.lubricants(0).loss_joules();
  EXPECT_GT(warming, std::min(cold, hot));
  EXPECT_LT(warming, std::max(cold, hot));
  request.set_point_by_point(true);
  EXPECT_NEAR(run_cycle(request).lubricants(0).loss_joules(), warming,
              out.lubricants(0).map_error_joules());
}

TEST(EvaluateCycle, ALubricantThatTheModelRefusesStandsBesideOthersThatHaveFigures) {
  Fluids fluids;
  v1::Lubricant thick = seed<v1::Lubricant>("lubricants/paper-fluid-1");
  thick.set_vogel_reference_temperature_kelvin(280);
  fluids.add("lubricants/thick", thick);
  fluids.add("lubricants/usual", seed<v1::Lubricant>("lubricants/paper-fluid-1"));
  v1::EvaluateCycleRequest request = short_request();
  for (v1::CyclePlace& place : *request.mutable_places()) {
    place.set_sump_temperature_celsius(place.time_seconds() < 12 ? 40 : -40);  // 253 K at the inlet
  }
  request.clear_lubricants();
  request.add_lubricants("lubricants/thick");
  request.add_lubricants("lubricants/usual");
  const v1::EvaluateCycleResponse out = run_cycle(request, fluids.lookup());
  const v1::CycleLubricant& refused = out.lubricants(0);
  EXPECT_EQ(refused.refusal_reason(), "INVALID_AT_INLET");
  EXPECT_THAT(refused.refusal_message(), HasSubstr("km/h"));
  EXPECT_TRUE(std::isnan(refused.loss_joules()));
  EXPECT_EQ(refused.parts_size(), 0);
  EXPECT_EQ(refused.mesh_loss_power_watts_size(), 0);
  EXPECT_EQ(out.lubricants(1).refusal_reason(), "");
  EXPECT_GT(out.lubricants(1).loss_joules(), 0);
  EXPECT_TRUE(std::isnan(out.lubricants(1).parts(0).loss_difference_percent()));
}

TEST(EvaluateCycle, AVehicleThatStandsLosesNothing) {
  v1::EvaluateCycleRequest request = nedc_request({"lubricants/paper-fluid-1"});
  request.clear_named_cycle();
  add_place(request, 0, 0);
  add_place(request, 60, 0.05);
  const v1::EvaluateCycleResponse out = run_cycle(request);
  EXPECT_NEAR(out.standstill_seconds(), 60, 1e-9);
  EXPECT_EQ(out.lubricants(0).loss_joules(), 0);
  EXPECT_EQ(out.lubricants(0).points(), 0);
  EXPECT_TRUE(std::isnan(out.lubricants(0).inefficiency_percent()));
}

TEST(EvaluateCycle, NamesFieldAndRowOfAllThatIsWrongWithACycle) {
  v1::EvaluateCycleRequest request = short_request();
  request.mutable_places(2)->set_time_seconds(2);
  request.mutable_places(3)->set_time_seconds(1);
  EXPECT_THAT(cycle_violations(request),
              HasSubstr("places[2].time_seconds: time_seconds = 2 s; allowed: above that of the "
                        "place before, 2 s\n"));
  EXPECT_THAT(cycle_violations(request), HasSubstr("places[3].time_seconds: time_seconds = 1 s"));
  request.mutable_places(1)->set_speed_kilometres_per_hour(-3);
  request.mutable_places(4)->set_speed_kilometres_per_hour(
      std::numeric_limits<double>::quiet_NaN());
  request.mutable_places(5)->set_ascent_angle_degrees(60);
  request.mutable_places(0)->set_sump_temperature_celsius(40);
  request.set_map_tolerance(1);
  request.set_lubricants(0, "lubricants/none");
  const std::string all = cycle_violations(request);
  EXPECT_THAT(all,
              HasSubstr("places[1].speed_kilometres_per_hour: speed_kilometres_per_hour = -3"));
  EXPECT_THAT(all, HasSubstr("places[4].speed_kilometres_per_hour: "));
  EXPECT_THAT(all, HasSubstr("places[5].ascent_angle_degrees: "));
  EXPECT_THAT(all, HasSubstr("places[3].sump_temperature_celsius: not set; allowed: as in "
                             "places[0], where it is set"));
  EXPECT_THAT(all, HasSubstr("places[3].time_seconds"));
  EXPECT_THAT(all, HasSubstr("map_tolerance: "));
  EXPECT_THAT(all, HasSubstr("lubricants[0]: "));
  v1::EvaluateCycleRequest sudden = short_request();
  sudden.mutable_places(1)->set_speed_kilometres_per_hour(390);
  EXPECT_THAT(cycle_violations(sudden),
              HasSubstr("places[1].speed_kilometres_per_hour: speed_kilometres_per_hour = 390 km/h "
                        "2 s after 0 km/h is an acceleration of 54.17 m/s2; allowed: -50 to 50"));
}

TEST(EvaluateCycle, RefusesAMapToleranceWhereNoMapIsMade) {
  v1::EvaluateCycleRequest request = short_request();
  request.set_map_tolerance(1e-3);
  EXPECT_EQ(cycle_violations(request), "");
  request.set_point_by_point(true);
  EXPECT_THAT(cycle_violations(request),
              HasSubstr("map_tolerance: map_tolerance = 0.001 has no effect: with point_by_point"));
  request.clear_map_tolerance();
  request.set_tolerance(1e-3);
  EXPECT_EQ(cycle_violations(request), "") << "the error of each point counts for both";
}

TEST(EvaluateCycle, TellsAFewOfManyWrongPlaces) {
  v1::EvaluateCycleRequest request = nedc_request({"lubricants/paper-fluid-1"});
  request.clear_named_cycle();
  for (int i = 0; i < 1000; ++i) add_place(request, 1000 - i, 50);
  const std::string all = cycle_violations(request);
  EXPECT_THAT(all, HasSubstr("places[10].time_seconds"));
  EXPECT_THAT(all, Not(HasSubstr("places[11].time_seconds")));
  EXPECT_THAT(all, HasSubstr("places: 989 more places do not follow their predecessor"));
}

TEST(EvaluateCycle, NeedsOneCycleOfTwoPlacesOrMoreAndOneToEightLubricants) {
  v1::EvaluateCycleRequest request = short_request();
  request.mutable_places()->DeleteSubrange(1, 5);
  EXPECT_THAT(cycle_violations(request), HasSubstr("places: 1 place; allowed: two places or more"));
  request.set_named_cycle(v1::NAMED_CYCLE_NEDC);
  EXPECT_THAT(cycle_violations(request), HasSubstr("places: set together with named_cycle"));
  request.clear_places();
  EXPECT_EQ(cycle_violations(request), "");
  request.clear_named_cycle();
  EXPECT_THAT(cycle_violations(request), HasSubstr("places: not set; allowed: two places"));
  request.set_named_cycle(static_cast<v1::NamedCycle>(9));
  EXPECT_THAT(cycle_violations(request), HasSubstr("named_cycle = 9"));
  request.set_named_cycle(v1::NAMED_CYCLE_NEDC);
  request.clear_lubricants();
  EXPECT_THAT(cycle_violations(request), HasSubstr("lubricants: 0 lubricants; allowed: 1 to 8"));
  for (int i = 0; i < 9; ++i) request.add_lubricants("lubricants/paper-fluid-1");
  EXPECT_THAT(cycle_violations(request), HasSubstr("lubricants: 9 lubricants; allowed: 1 to 8"));
  request = nedc_request({"lubricants/paper-fluid-1", "lubricants/paper-fluid-11"});
  request.set_vehicle("vehicles/none");
  EXPECT_THAT(cycle_violations(request), HasSubstr("lubricants[1]: "));
  EXPECT_THAT(cycle_violations(request), HasSubstr("vehicle: "));
}

TEST(EvaluateCycle, LimitsItsWork) {
  v1::EvaluateCycleRequest request = nedc_request({"lubricants/paper-fluid-1"});
  request.clear_named_cycle();
  add_place(request, 0, 50);
  add_place(request, 20'001, 50);
  EXPECT_THAT(cycle_violations(request), HasSubstr("places: 2 places over 20001 s are more than "
                                                   "20000 pieces of at most 1 s"));
  request.mutable_places(1)->set_time_seconds(15'000);
  EXPECT_EQ(cycle_violations(request), "");
  request.add_lubricants("lubricants/paper-fluid-2");
  EXPECT_EQ(cycle_violations(request), "");
  request.set_point_by_point(true);
  EXPECT_THAT(cycle_violations(request),
              HasSubstr("point_by_point: true; 15000 pieces of 2 lubricants are 30000 points"));
}

TEST(EvaluateCycle, StatesALargerErrorWhereItsPointsEnd) {
  const v1::EvaluateCycleRequest request = unsteady_request(3);
  Violations violations;
  auto evaluation = read_cycle(request, seed_lookup(), violations);
  evaluation->options.most_points = 150;
  PreparedGearSets gear_sets;
  const v1::EvaluateCycleResponse out =
      evaluate_cycle(request, *evaluation, gear_sets, [] { return false; });
  const v1::CycleLubricant& lubricant = out.lubricants(0);
  EXPECT_LE(lubricant.points(), 150);
  EXPECT_GT(lubricant.map_error_joules(), 2e-3 * lubricant.loss_joules());
  EXPECT_NEAR(lubricant.loss_joules(), run_cycle(request).lubricants(0).loss_joules(),
              lubricant.map_error_joules());
}

TEST(EvaluateCycle, StopsWhenItsCallIsOver) {
  const v1::EvaluateCycleRequest request = nedc_request({"lubricants/paper-fluid-1"});
  Violations violations;
  const auto evaluation = read_cycle(request, seed_lookup(), violations);
  PreparedGearSets gear_sets;
  int calls = 0;
  EXPECT_THROW(evaluate_cycle(request, *evaluation, gear_sets, [&calls] { return ++calls > 3; }),
               Cancelled);
  EXPECT_LT(calls, 20);
}

}  // namespace
}  // namespace tribodyn::server
