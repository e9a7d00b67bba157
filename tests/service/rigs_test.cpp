// EvaluateRig: columns of figures of a ball on a disc, without anything stored.
#include "server/application/rigs.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "core/refusal.h"
#include "server/mapping/to_core.h"
#include "server/simulation/rig_evaluation.h"
#include "tests/service/support.h"

namespace tribodyn::server {
namespace {

using testing::HasSubstr;

v1::RigCondition& add_rig_condition(v1::EvaluateRigRequest& request, double load, double percent,
                                    double celsius = 40) {
  v1::RigCondition& out = *request.add_conditions();
  out.set_load_newtons(load);
  out.set_entrainment_speed_metres_per_second(2);
  out.set_slide_roll_ratio_percent(percent);
  out.set_supply_temperature_celsius(celsius);
  return out;
}

v1::RigBody glass() {
  v1::RigBody out;
  out.set_youngs_modulus_pascals(75e9);
  out.set_poissons_ratio(0.22);
  out.set_thermal_conductivity_watts_per_metre_kelvin(1.1);
  out.set_density_kilograms_per_cubic_metre(2500);
  out.set_specific_heat_capacity_joules_per_kilogram_kelvin(840);
  return out;
}

v1::EvaluateRigRequest rig_request() {
  v1::EvaluateRigRequest out;
  out.set_lubricant("lubricants/paper-fluid-1");
  out.set_radius_x_metres(0.0127);
  for (const double percent : {-10.0, 0.0, 10.0, 50.0}) add_rig_condition(out, 38, percent);
  return out;
}

v1::EvaluateRigResponse run_rig(const v1::EvaluateRigRequest& request) {
  Violations violations;
  const auto evaluation = read_rig(request, seed_lookup(), violations);
  if (!evaluation) throw std::runtime_error(violations.front().description);
  return evaluate_rig(request, *evaluation, [] { return false; });
}

std::string rig_violations(const v1::EvaluateRigRequest& request) {
  Violations violations;
  read_rig(request, seed_lookup(), violations);
  std::string out;
  for (const Violation& each : violations) out += each.field + ": " + each.description + "\n";
  return out;
}

TEST(EvaluateRig, RowsAreThoseOfTheCore) {
  v1::EvaluateRigRequest request = rig_request();
  request.set_surface("surfaces/run-in");
  request.set_composite_rms_height_metres(2e-8);
  request.set_radius_y_metres(0.05);
  *request.mutable_body_2() = glass();
  add_rig_condition(request, 20, 5, 80);
  const v1::EvaluateRigResponse out = run_rig(request);
  RigScene scene{to_core(seed<v1::Lubricant>("lubricants/paper-fluid-1")),
                 {{210e9, 0.3, 46, 7850, 470}, {75e9, 0.22, 1.1, 2500, 840}},
                 {0.0127, 0.05},
                 {2.5e9 * 4e-7 / 2e-8, 4e-5, 2e-8},
                 {2e6, 0.17},
                 recommended_model()};
  scene.options.hertz_solution = HertzSolution::kExact;
  ASSERT_EQ(out.traction_coefficient_size(), 5);
  for (int i = 0; i < 5; ++i) {
    const v1::RigCondition& at = request.conditions(i);
    const RigPoint point = Rig(scene, at.supply_temperature_celsius() + kZeroCelsius)
                               .at({at.load_newtons(), 2, 0.01 * at.slide_roll_ratio_percent()});
    EXPECT_EQ(out.refusal_numbers(i), 0);
    EXPECT_EQ(out.traction_coefficient(i), point.traction_coefficient);
    EXPECT_EQ(out.central_film_thickness_metres(i), point.central_film_thickness);
    EXPECT_EQ(out.minimum_film_thickness_metres(i), point.minimum_film_thickness);
    EXPECT_EQ(out.film_ratio(i), point.film_ratio);
    EXPECT_EQ(out.mean_pressure_pascals(i), point.mean_pressure);
    EXPECT_EQ(out.contact_temperature_kelvin(i), point.contact_temperature);
    EXPECT_EQ(out.boundary_friction_share(i), point.boundary_friction_share);
    EXPECT_EQ(out.limiting_stress_area_share(i), point.limiting_stress_area_share);
  }
  EXPECT_EQ(out.lubricant_revision(), "lubricants/paper-fluid-1@1");
  EXPECT_EQ(out.surface_revision(), "surfaces/run-in@1");
  EXPECT_FALSE(out.model_version().empty());
}

TEST(EvaluateRig, SpecimensWithoutSurfaceAreSmooth) {
  const v1::EvaluateRigResponse out = run_rig(rig_request());
  EXPECT_TRUE(std::isnan(out.film_ratio(2)));
  EXPECT_EQ(out.boundary_friction_share(2), 0);
  EXPECT_EQ(out.traction_coefficient(1), 0);
  EXPECT_LT(out.traction_coefficient(0), 0);
  EXPECT_EQ(out.surface_revision(), "");
}

TEST(EvaluateRig, AFilmOnGlassIsThinnedByTheFactorOfGupta) {
  v1::EvaluateRigRequest request = rig_request();
  request.clear_conditions();
  *request.mutable_body_2() = glass();
  for (const double speed : {1.0, 2.0, 3.0}) {
    for (const double percent : {0.0, 50.0}) {
      add_rig_condition(request, 20, percent).set_entrainment_speed_metres_per_second(speed);
    }
  }
  const v1::EvaluateRigResponse heated = run_rig(request);
  request.mutable_model_options()->set_preset(v1::ModelOptions::PAPER);
  const v1::EvaluateRigResponse isothermal = run_rig(request);
  const auto oil = seed<v1::Lubricant>("lubricants/paper-fluid-1");
  const double over_vogel = 40 + kZeroCelsius - oil.vogel_reference_temperature_kelvin();
  const double slope = oil.vogel_temperature_coefficient_kelvin() / over_vogel;
  const double viscosity = oil.vogel_viscosity_prefactor_pascal_seconds() * std::exp(slope);
  const double modulus = 2 / ((1 - 0.3 * 0.3) / 210e9 + (1 - 0.22 * 0.22) / 75e9);
  for (int i = 0; i < request.conditions_size(); ++i) {
    const v1::RigCondition& at = request.conditions(i);
    const double speed = at.entrainment_speed_metres_per_second();
    const double loading = slope / over_vogel * viscosity * speed * speed /
                           oil.thermal_conductivity_watts_per_metre_kelvin();
    const double slide = 0.01 * at.slide_roll_ratio_percent();
    const double pressure = 1.5 * heated.mean_pressure_pascals(i) / modulus;
    const double factor =
        (1 - 13.2 * pressure * std::pow(loading, 0.42)) /
        (1 + 0.213 * (1 + 2.23 * std::pow(slide, 0.83)) * std::pow(loading, 0.64));
    EXPECT_LT(factor, 0.98);
    EXPECT_NEAR(heated.central_film_thickness_metres(i) /
                    isothermal.central_film_thickness_metres(i) / factor,
                1, 1e-9);
  }
}

TEST(EvaluateRig, ARefusedConditionIsARefusedRowBesideOthers) {
  v1::EvaluateRigRequest request = rig_request();
  v1::Lubricant thick = seed<v1::Lubricant>("lubricants/paper-fluid-1");
  Violations violations;
  auto evaluation = read_rig(request, seed_lookup(), violations);
  thick.set_vogel_reference_temperature_kelvin(230);
  evaluation->lubricant = std::make_shared<v1::Lubricant>(thick);
  evaluation->scene.lubricant = to_core(thick);
  add_rig_condition(request, 38, 10, -50);  // below 230 K
  add_rig_condition(request, 38, 20, -50);
  add_rig_condition(request, 38, 10, -20);  // not liquid yet
  const v1::EvaluateRigResponse out = evaluate_rig(request, *evaluation, [] { return false; });
  EXPECT_EQ(out.refusal_numbers(2), 0);
  EXPECT_TRUE(std::isfinite(out.traction_coefficient(2)));
  EXPECT_EQ(out.refusal_numbers(4), 1);
  EXPECT_EQ(out.refusal_numbers(5), 1);
  EXPECT_TRUE(std::isnan(out.traction_coefficient(5)));
  EXPECT_EQ(out.refusal_numbers(6), 2);
  ASSERT_EQ(out.refusals_size(), 2);
  EXPECT_EQ(out.refusals(0).reason(), "INVALID_AT_INLET");
  EXPECT_EQ(out.refusals(1).reason(), "VISCOSITY_OUT_OF_RANGE");
}

v1::EvaluateRigRequest grid_request() {
  v1::EvaluateRigRequest out = rig_request();
  out.clear_conditions();
  v1::RigGrid& grid = *out.mutable_grid();
  for (const double celsius : {40.0, 90.0}) grid.add_supply_temperatures_celsius(celsius);
  for (const double load : {20.0, 38.0, 154.0}) grid.add_loads_newtons(load);
  grid.add_entrainment_speeds_metres_per_second(2);
  for (const double percent : {0.0, 10.0}) grid.add_slide_roll_ratios_percent(percent);
  return out;
}

TEST(EvaluateRig, AGridIsTheListOfItsCombinationsInTheOrderOfNestedLoops) {
  v1::EvaluateRigRequest listed = rig_request();
  listed.clear_conditions();
  for (const double celsius : {40.0, 90.0}) {
    for (const double load : {20.0, 38.0, 154.0}) {
      for (const double percent : {0.0, 10.0}) add_rig_condition(listed, load, percent, celsius);
    }
  }
  EXPECT_EQ(run_rig(grid_request()).SerializeAsString(), run_rig(listed).SerializeAsString());
}

TEST(EvaluateRig, AMeanPressureOfAGridIsThatOfTheContact) {
  v1::EvaluateRigRequest request = grid_request();
  request.set_radius_y_metres(0.05);
  request.mutable_grid()->clear_loads_newtons();
  request.mutable_grid()->add_mean_pressures_pascals(6e8);
  request.mutable_grid()->add_mean_pressures_pascals(9e8);
  const v1::EvaluateRigResponse out = run_rig(request);
  ASSERT_EQ(out.mean_pressure_pascals_size(), 8);
  for (int i = 0; i < 8; ++i) {
    const double wanted = i / 2 % 2 == 0 ? 6e8 : 9e8;
    EXPECT_NEAR(out.mean_pressure_pascals(i) / wanted, 1, 1e-12);  // smooth: W is W_EHL
  }
  EXPECT_NEAR(out.load_newtons(2) / out.load_newtons(0), 1.5 * 1.5 * 1.5, 1e-12);
}

TEST(EvaluateRig, NamesAllThatIsWrongWithAGrid) {
  v1::EvaluateRigRequest request = grid_request();
  request.mutable_grid()->add_mean_pressures_pascals(1e9);
  request.mutable_grid()->clear_slide_roll_ratios_percent();
  add_rig_condition(request, 38, 10);
  const std::string wrong = rig_violations(request);
  EXPECT_THAT(wrong, HasSubstr("grid.loads_newtons: set together with mean_pressures_pascals; "
                               "allowed: either loads or mean pressures"));
  EXPECT_THAT(wrong, HasSubstr("grid.slide_roll_ratios_percent: not set; allowed: at least one"));
  EXPECT_THAT(wrong, HasSubstr("conditions: set together with grid; allowed: one of the two"));

  request = grid_request();
  request.mutable_grid()->clear_loads_newtons();
  EXPECT_THAT(rig_violations(request), HasSubstr("nor are mean_pressures_pascals"));
  request.mutable_grid()->add_mean_pressures_pascals(9e10);
  EXPECT_THAT(rig_violations(request),
              HasSubstr("grid.mean_pressures_pascals[0]: 90000000000 Pa needs a load of"));

  request = grid_request();
  while (request.grid().slide_roll_ratios_percent_size() < 1000) {
    request.mutable_grid()->add_slide_roll_ratios_percent(1);
  }
  EXPECT_THAT(rig_violations(request), HasSubstr("grid: 6000 combinations; allowed: at most 5000"));
}

TEST(EvaluateRig, NamesAllThatIsWrong) {
  v1::EvaluateRigRequest request;
  request.set_lubricant("lubricants/paper-fluid-11");
  request.set_composite_rms_height_metres(1e-8);
  const std::string wrong = rig_violations(request);
  EXPECT_THAT(wrong,
              HasSubstr("radius_x_metres: radius_x_metres = 0 m; allowed: 1e-05 to 10000 m"));
  EXPECT_THAT(wrong, HasSubstr("conditions: not set; allowed: at least one"));
  EXPECT_THAT(wrong, HasSubstr("did you mean \"lubricants/paper-fluid-1\"?"));
  EXPECT_THAT(wrong, HasSubstr("composite_rms_height_metres: set without a surface"));
}

TEST(EvaluateRig, ChecksTheLastOfManyConditions) {
  v1::EvaluateRigRequest request = rig_request();
  while (request.conditions_size() < 5000) add_rig_condition(request, 38, 1);
  request.mutable_conditions(4999)->set_load_newtons(-1);
  EXPECT_THAT(rig_violations(request), HasSubstr("conditions[4999].load_newtons"));
}

TEST(EvaluateRig, TellsTheRowsInWhichALawLeavesItsRange) {
  v1::EvaluateRigRequest request = rig_request();
  request.clear_conditions();
  for (const double load : {5.0, 38.0, 60.0, 20.0}) add_rig_condition(request, load, 10, 60);
  add_rig_condition(request, 38, 10, 10);
  request.set_surface("surfaces/run-in");
  request.set_composite_rms_height_metres(1e-6);  // no full film
  request.mutable_model_options()->set_preset(v1::ModelOptions::PAPER);
  const v1::EvaluateRigResponse out = run_rig(request);
  std::map<std::string, const v1::PointWarning*> by_code;
  for (const v1::PointWarning& each : out.range_warnings()) {
    EXPECT_TRUE(by_code.emplace(each.code(), &each).second) << "one for each law";
  }
  std::vector<int> outside;
  double furthest = 1, pressure_there = 0;
  for (int i = 0; i < 5; ++i) {
    const double pressure = out.maximum_pressure_pascals(i);
    const double excess = std::max(0.85e9 / pressure, pressure / 1.35e9);
    if (excess > 1) outside.push_back(i);
    if (excess > furthest) {
      furthest = excess;
      pressure_there = pressure;
    }
  }
  ASSERT_FALSE(outside.empty());
  ASSERT_LT(outside.size(), 5U);
  ASSERT_NE(by_code["PRESSURE"], nullptr);
  EXPECT_THAT(by_code["PRESSURE"]->rows(), testing::ElementsAreArray(outside));
  EXPECT_THAT(by_code["PRESSURE"]->message(),
              HasSubstr(fmt::format("{:.3g} GPa", 1e-9 * pressure_there)));
  ASSERT_NE(by_code["INLET_HEATING_LEFT_OUT"], nullptr);
  EXPECT_THAT(by_code["INLET_HEATING_LEFT_OUT"]->rows(), testing::Contains(4));
  EXPECT_EQ(by_code["INLET_HEATING_LEFT_OUT"]->level(), v1::WARNING_LEVEL_WITHHOLDS_VERDICT);
  ASSERT_NE(by_code["FILM_RATIO"], nullptr);
  for (const int row : by_code["FILM_RATIO"]->rows()) EXPECT_LT(out.film_ratio(row), 0.5);
  EXPECT_EQ(by_code["ISOTHERMAL"], nullptr);
}

TEST(EvaluateRig, SmoothSpecimensHaveNoWarningOfAsperities) {
  v1::EvaluateRigRequest request = rig_request();
  request.mutable_model_options()->set_isothermal(true);
  const v1::EvaluateRigResponse out = run_rig(request);
  std::set<std::string> codes;
  for (const v1::PointWarning& each : out.range_warnings()) codes.insert(each.code());
  EXPECT_FALSE(codes.contains("FILM_RATIO"));
  EXPECT_FALSE(codes.contains("ROUGHNESS_PRODUCT"));
  EXPECT_TRUE(codes.contains("ISOTHERMAL"));
}

TEST(EvaluateRig, StopsWhenItsCallIsOver) {
  const v1::EvaluateRigRequest request = rig_request();
  Violations violations;
  const auto evaluation = read_rig(request, seed_lookup(), violations);
  EXPECT_THROW(evaluate_rig(request, *evaluation, [] { return true; }), Cancelled);
}

}  // namespace
}  // namespace tribodyn::server
