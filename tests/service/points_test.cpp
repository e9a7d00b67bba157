// EvaluatePoints: columns of figures of candidates at conditions, without a simulation of each.
#include "server/application/points.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "core/refusal.h"
#include "core/study/operating_point.h"
#include "server/contract/resource_names.h"
#include "server/mapping/from_core.h"
#include "server/simulation/point_evaluation.h"
#include "server/simulation/simulation_inputs.h"
#include "tests/service/support.h"
#include "tests/service/uncertain_fluids.h"

namespace tribodyn::server {
namespace {

using testing::HasSubstr;

constexpr double kSpeeds[] = {30, 66, 110};  // in contact, at the resonance, above it

void add_column(v1::EvaluatePointsRequest& request, const std::string& path,
                const std::vector<double>& values) {
  v1::CandidateColumn& column = *request.add_candidate_columns();
  column.set_path(path);
  for (const double value : values) column.add_values(value);
}

/// Three candidates, which differ in a parameter of the lubricant and one of the surface, at three
/// speeds with two sump temperatures.
v1::EvaluatePointsRequest request_of_candidates() {
  v1::EvaluatePointsRequest out;
  out.set_lubricant("lubricants/paper-fluid-1");
  add_column(out, "lubricant.pressure_viscosity_coefficient_per_pascal", {1.2e-8, 1.6e-8, 2e-8});
  add_column(out, "surface.asperity_friction_coefficient", {0.08, 0.1, 0.12});
  for (const double sump : {40.0, 90.0}) {
    for (const double speed : kSpeeds) {
      v1::PointCondition& condition = *out.add_conditions();
      condition.set_speed_kilometres_per_hour(speed);
      condition.set_sump_temperature_celsius(sump);
    }
  }
  return out;
}

v1::EvaluatePointsResponse evaluate(const v1::EvaluatePointsRequest& request) {
  Violations violations;
  const auto evaluation = read_points(request, seed_lookup(), violations);
  if (!evaluation) throw std::runtime_error(violations.front().description);
  PreparedGearSets gear_sets;
  return evaluate_points(*evaluation, gear_sets, [] { return false; });
}

std::string violations_of(const v1::EvaluatePointsRequest& request) {
  Violations violations;
  read_points(request, seed_lookup(), violations);
  std::string out;
  for (const Violation& each : violations) out += each.field + ": " + each.description + "\n";
  return out;
}

/// Returns the point of a candidate at a condition as a simulation finds it, with sensitivities if
/// the request has elasticities.
PointResult simulated(const v1::EvaluatePointsRequest& request, int candidate, int condition) {
  v1::Simulation simulation;
  simulation.set_lubricant(request.lubricant());
  const v1::PointCondition& at = request.conditions(condition);
  simulation.set_sump_temperature_celsius(at.sump_temperature_celsius());
  simulation.mutable_operating_point()->mutable_cruise()->set_speed_kilometres_per_hour(
      at.speed_kilometres_per_hour());
  simulation.mutable_operating_point()->set_sensitivities(!request.elasticity_parameters().empty());
  simulation.mutable_solver_options()->set_tolerance(request.tolerance());
  Violations violations;
  auto inputs = read_simulation(simulation, seed_lookup(), "", violations);
  if (!inputs) throw std::runtime_error(violations.front().description);
  Scene physical = scene(*inputs);
  physical.lubricant.pressure_viscosity_coefficient =
      request.candidate_columns(0).values(candidate);
  physical.boundary.asperity_friction_coefficient = request.candidate_columns(1).values(candidate);
  const PointStudy point = std::get<PointStudy>(study(*inputs));
  return solve_operating_point(physical, point.condition, point.options);
}

TEST(EvaluatePoints, RowsAgreeWithSimulationsOfTheirCandidatesWithinTheEstimatedErrors) {
  const v1::EvaluatePointsRequest request = request_of_candidates();
  const v1::EvaluatePointsResponse out = evaluate(request);
  ASSERT_EQ(out.candidates(), 3);
  ASSERT_EQ(out.conditions(), 6);
  ASSERT_EQ(out.inefficiency_rms_percent_size(), 18);
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 6; ++k) {
      SCOPED_TRACE(testing::Message() << "candidate " << i << " at condition " << k);
      const int row = 6 * i + k;
      const PointResult alone = simulated(request, i, k);
      ASSERT_EQ(out.refusal_numbers(row), 0);
      const double error =
          out.estimated_relative_error(row) + alone.estimated_relative_error.value_or(0);
      EXPECT_LT(error, 3e-3);
      const auto agrees = [&](double screened, double simulated_value) {
        EXPECT_NEAR(screened, simulated_value, error * std::abs(simulated_value));
      };
      agrees(out.inefficiency_rms_percent(row), alone.inefficiency_rms.value());
      agrees(out.inefficiency_energy_mean_percent(row), alone.inefficiency_energy_mean.value());
      agrees(out.mesh_loss_power_watts(row), alone.mesh_loss_power);
      agrees(out.pinion_torque_newton_metres(row), alone.pinion_torque);
      EXPECT_EQ(out.contact_loss(row), alone.contact_loss);
      EXPECT_EQ(out.settled(row), alone.settled);
    }
  }
}

TEST(EvaluatePoints, ARowHasTheSameBitsWhicheverRowsComeWithIt) {
  const v1::EvaluatePointsRequest request = request_of_candidates();
  const v1::EvaluatePointsResponse together = evaluate(request);
  v1::EvaluatePointsRequest alone = request;
  for (v1::CandidateColumn& column : *alone.mutable_candidate_columns()) {
    column.mutable_values()->erase(column.values().begin(), column.values().begin() + 2);
  }
  alone.mutable_conditions()->DeleteSubrange(0, 5);
  const v1::EvaluatePointsResponse last = evaluate(alone);
  ASSERT_EQ(last.inefficiency_rms_percent_size(), 1);
  EXPECT_EQ(last.inefficiency_rms_percent(0), together.inefficiency_rms_percent(17));
  EXPECT_EQ(last.mesh_loss_power_watts(0), together.mesh_loss_power_watts(17));
  EXPECT_EQ(last.dynamic_transmission_error_maximum_metres(0),
            together.dynamic_transmission_error_maximum_metres(17));
}

TEST(EvaluatePoints, WithoutColumnsTheBaseIsTheOnlyCandidate) {
  v1::EvaluatePointsRequest request = request_of_candidates();
  request.clear_candidate_columns();
  const v1::EvaluatePointsResponse out = evaluate(request);
  EXPECT_EQ(out.candidates(), 1);
  EXPECT_EQ(out.model_size(), 6);
  EXPECT_EQ(out.lubricant_revision(), "lubricants/paper-fluid-1@1");
}

TEST(EvaluatePoints, ContactFiguresAgreeWithSimulationsAndChangeNoBitOfTheOthers) {
  v1::EvaluatePointsRequest request = request_of_candidates();
  const v1::EvaluatePointsResponse without = evaluate(request);
  EXPECT_EQ(without.film_ratio_minimum_size(), 0);
  request.set_contact_figures(true);
  const v1::EvaluatePointsResponse out = evaluate(request);
  ASSERT_EQ(out.mean_friction_coefficient_size(), 18);
  for (int row = 0; row < 18; ++row) {
    SCOPED_TRACE(row);
    EXPECT_EQ(out.mesh_loss_power_watts(row), without.mesh_loss_power_watts(row));
    const PointResult alone = simulated(request, row / 6, row % 6);
    const auto agrees = [](double screened, double simulated_value, double error) {
      EXPECT_NEAR(screened, simulated_value, error * std::abs(simulated_value));
    };
    // Means are as exact as losses; extremes lie between the steps of a grid.
    agrees(out.film_ratio_mean(row), alone.film_ratio.mean, 2e-3);
    agrees(out.contact_temperature_mean_kelvin(row), alone.contact_temperature.mean, 2e-4);
    agrees(out.viscous_loss_power_watts(row), alone.viscous_loss_power, 3e-3);
    agrees(out.boundary_loss_power_watts(row), alone.boundary_loss_power, 1e-2);
    agrees(out.mean_friction_coefficient(row), alone.friction_coefficient.mean, 3e-3);
    agrees(out.film_ratio_minimum(row), alone.film_ratio.minimum, 2e-2);
    agrees(out.contact_temperature_maximum_kelvin(row), alone.contact_temperature.maximum, 5e-3);
    agrees(out.maximum_pressure_maximum_pascals(row), alone.maximum_pressure.maximum, 5e-3);
    agrees(out.flash_temperature_rise_maximum_kelvin(row), alone.flash_temperature_rise.maximum,
           2e-2);
    EXPECT_NEAR(out.viscous_loss_power_watts(row) + out.boundary_loss_power_watts(row),
                out.mesh_loss_power_watts(row), 3e-3 * out.mesh_loss_power_watts(row));
    EXPECT_GT(out.mean_friction_coefficient(row), 0.005);
    EXPECT_LT(out.mean_friction_coefficient(row), 0.1);
  }
}

TEST(EvaluatePoints, ElasticitiesAreTheExponentsOfSmallChanges) {
  v1::EvaluatePointsRequest request = request_of_candidates();
  request.clear_candidate_columns();
  request.clear_conditions();
  request.add_conditions()->set_speed_kilometres_per_hour(30);
  request.add_elasticity_figures("inefficiency_energy_mean_percent");
  request.add_elasticity_figures("film_ratio_mean");
  request.add_elasticity_parameters("lubricant.pressure_viscosity_coefficient_per_pascal");
  request.add_elasticity_parameters("surface.asperity_friction_coefficient");
  const v1::EvaluatePointsResponse at = evaluate(request);
  ASSERT_EQ(at.elasticities_size(), 4);
  EXPECT_EQ(at.elasticities_one_sided_size(), 1);
  EXPECT_EQ(at.model(0), v1::POINT_MODEL_FULL);
  EXPECT_EQ(at.elasticities(2).figure(), "film_ratio_mean");
  EXPECT_EQ(at.elasticities(3).parameter(), "surface.asperity_friction_coefficient");
  constexpr double kStep = 1e-3;
  for (int i = 0; i < 4; ++i) {
    SCOPED_TRACE(at.elasticities(i).figure() + " by " + at.elasticities(i).parameter());
    v1::EvaluatePointsRequest moved = request;
    const std::string& path = at.elasticities(i).parameter();
    const double usual =
        path.starts_with("surface")
            ? seed<v1::Surface>("surfaces/run-in").asperity_friction_coefficient()
            : seed<v1::Lubricant>(request.lubricant()).pressure_viscosity_coefficient_per_pascal();
    add_column(moved, path, {usual * std::exp(-kStep), usual * std::exp(kStep)});
    moved.set_contact_figures(true);
    const v1::EvaluatePointsResponse beside = evaluate(moved);
    const auto& values =
        i < 2 ? beside.inefficiency_energy_mean_percent() : beside.film_ratio_mean();
    const double difference = std::log(values[1] / values[0]) / (2 * kStep);
    EXPECT_NEAR(at.elasticities(i).values(0), difference, 2e-3);
  }
}

TEST(EvaluatePoints, EveryParameterOfACandidateHasElasticities) {
  v1::EvaluatePointsRequest request = request_of_candidates();
  request.clear_candidate_columns();
  request.mutable_conditions()->DeleteSubrange(1, 5);
  for (const std::string& each : candidate_parameter_names()) {
    request.add_elasticity_parameters(each);
  }
  const v1::EvaluatePointsResponse out = evaluate(request);
  ASSERT_EQ(out.elasticities_size(), request.elasticity_parameters_size());
  for (const v1::ElasticityColumn& each : out.elasticities()) {
    const bool is_not_used = each.parameter().find("improved_yasutomi") != std::string::npos ||
                             each.parameter() == "lubricant.asperity_friction_coefficient" ||
                             each.parameter() == "lubricant.tribofilm_shear_strength_pascals";
    EXPECT_TRUE(std::isfinite(each.values(0))) << each.parameter();
    EXPECT_EQ(each.values(0) == 0, is_not_used) << each.parameter();
  }
}

/// Figures and parameters of elasticities, with their names in the sensitivities of a point.
constexpr std::pair<const char*, const char*> kDifferentiatedFigures[] = {
    {"inefficiency_rms_percent", "inefficiency_rms_percent"},
    {"inefficiency_energy_mean_percent", "inefficiency_energy_mean_percent"},
    {"mesh_loss_power_watts", "mesh_loss_power_watts"},
    {"mesh_loss_torque_newton_metres", "mesh_loss_torque_newton_metres"},
    {"pinion_friction_torque_mean_newton_metres", "pinion_friction_torque_newton_metres.mean"},
    {"film_ratio_mean", "film_ratio.mean"},
    {"contact_temperature_mean_kelvin", "contact_temperature_kelvin.mean"},
    {"dynamic_transmission_error_minimum_metres", "dynamic_transmission_error_metres.minimum"},
    {"dynamic_transmission_error_maximum_metres", "dynamic_transmission_error_metres.maximum"}};
constexpr std::pair<const char*, const char*> kDifferentiatedParameters[] = {
    {"lubricant.vogel_viscosity_prefactor_pascal_seconds", "lubricant.vogel_viscosity_prefactor"},
    {"lubricant.vogel_temperature_coefficient_kelvin", "lubricant.vogel_temperature_coefficient"},
    {"lubricant.vogel_reference_temperature_kelvin", "lubricant.vogel_reference_temperature"},
    {"lubricant.pressure_viscosity_coefficient_per_pascal",
     "lubricant.pressure_viscosity_coefficient"},
    {"lubricant.pressure_viscosity_temperature_kelvin", "lubricant.pressure_viscosity_temperature"},
    {"lubricant.relaxation_time_seconds", "lubricant.relaxation_time"},
    {"lubricant.havriliak_negami_alpha", "lubricant.havriliak_negami_alpha"},
    {"lubricant.havriliak_negami_beta", "lubricant.havriliak_negami_beta"},
    {"lubricant.rheology_reference_temperature_kelvin", "lubricant.rheology_reference_temperature"},
    {"lubricant.limiting_shear_stress_at_zero_pressure_pascals",
     "lubricant.limiting_shear_stress_at_zero_pressure"},
    {"lubricant.limiting_shear_stress_coefficient", "lubricant.limiting_shear_stress_coefficient"},
    {"lubricant.thermal_conductivity_watts_per_metre_kelvin", "lubricant.thermal_conductivity"},
    {"lubricant.density_at_zero_kelvin_kilograms_per_cubic_metre",
     "lubricant.density_at_zero_kelvin"},
    {"lubricant.density_slope_kilograms_per_cubic_metre_kelvin",
     "lubricant.density_temperature_slope"},
    {"surface.asperity_density_per_square_metre", "roughness.asperity_density"},
    {"surface.asperity_radius_metres", "roughness.asperity_radius"},
    {"surface.composite_rms_height_metres", "roughness.composite_rms_height"},
    {"surface.tribofilm_shear_strength_pascals", "boundary.tribofilm_shear_strength"},
    {"surface.asperity_friction_coefficient", "boundary.asperity_friction_coefficient"},
    {"gear_set.youngs_modulus_pascals", "solid.youngs_modulus"},
    {"gear_set.poissons_ratio", "solid.poissons_ratio"},
    {"gear_set.solid_thermal_conductivity_watts_per_metre_kelvin", "solid.thermal_conductivity"},
    {"gear_set.solid_density_kilograms_per_cubic_metre", "solid.density"},
    {"gear_set.solid_specific_heat_capacity_joules_per_kilogram_kelvin",
     "solid.specific_heat_capacity"},
    {"sump_temperature_celsius", "sump_temperature"},
    {"inlet_temperature_rise_kelvin", "inlet_temperature_rise"},
    {"speed_kilometres_per_hour", "vehicle_speed"},
    {"wheel_torque_newton_metres", "wheel_torque"}};

TEST(EvaluatePoints, ElasticitiesOfEveryFigureByEveryParameterAreThoseOfThePoint) {
  constexpr std::size_t kFigures = std::size(kDifferentiatedFigures);
  constexpr std::size_t kParameters = std::size(kDifferentiatedParameters);
  v1::EvaluatePointsRequest request = request_of_candidates();
  request.set_tolerance(1e-6);
  for (const auto& [name, of_point] : kDifferentiatedFigures) request.add_elasticity_figures(name);
  for (const auto& [name, of_point] : kDifferentiatedParameters) {
    request.add_elasticity_parameters(name);
  }
  const v1::EvaluatePointsResponse out = evaluate(request);
  ASSERT_EQ(static_cast<std::size_t>(out.elasticities_size()), kFigures * kParameters);
  for (const int row : {0, 8, 16}) {
    const v1::PointSensitivities alone =
        to_message(simulated(request, row / 6, row % 6), 0).sensitivities();
    ASSERT_EQ(static_cast<std::size_t>(alone.figures_size()), kFigures);
    ASSERT_EQ(static_cast<std::size_t>(alone.parameters_size()), kParameters);
    for (int f = 0; f < alone.figures_size(); ++f) {
      for (const v1::ParameterSensitivity& parameter : alone.parameters()) {
        const auto named = [](const std::string& name) {
          return [&name](const auto& each) { return each.second == name; };
        };
        const auto figure = std::ranges::find_if(kDifferentiatedFigures, named(alone.figures(f)));
        const auto by =
            std::ranges::find_if(kDifferentiatedParameters, named(parameter.parameter()));
        const auto place =
            (figure - kDifferentiatedFigures) * kParameters + (by - kDifferentiatedParameters);
        const v1::ElasticityColumn& screened = out.elasticities(static_cast<int>(place));
        ASSERT_EQ(screened.figure(), figure->first);
        ASSERT_EQ(screened.parameter(), by->first);
        EXPECT_NEAR(screened.values(row), parameter.elasticities(f),
                    1e-9 * std::abs(parameter.elasticities(f)))
            << screened.figure() << " by " << screened.parameter() << " in row " << row;
      }
    }
  }
}

TEST(EvaluatePoints, PointsThatLoseContactHaveElasticities) {
  v1::EvaluatePointsRequest request = request_of_candidates();
  request.clear_candidate_columns();
  request.clear_conditions();
  for (const double speed : {40.0, 72.0, 76.0, 80.0}) {
    request.add_conditions()->set_speed_kilometres_per_hour(speed);
  }
  request.add_elasticity_parameters("lubricant.relaxation_time_seconds");
  const v1::EvaluatePointsResponse out = evaluate(request);
  int lost = 0;
  for (int k = 0; k < 4; ++k) {
    lost += out.contact_loss(k) ? 1 : 0;
    EXPECT_TRUE(std::isfinite(out.elasticities(0).values(k))) << k;
    EXPECT_GT(out.mesh_loss_power_watts(k), 0);
  }
  EXPECT_GT(lost, 0);
}

TEST(EvaluatePoints, ColumnsThatTheBoundaryFrictionOfTheOilOverridesAreRefused) {
  const auto violations_with = [](const v1::Lubricant& oil, const char* path) {
    Fluids fluids;
    fluids.add("lubricants/oil", oil);
    v1::EvaluatePointsRequest request = request_of_candidates();
    request.set_lubricant("lubricants/oil");
    request.mutable_candidate_columns(1)->set_path(path);
    Violations violations;
    read_points(request, fluids.lookup(), violations);
    return violations;
  };
  const auto plain = seed<v1::Lubricant>("lubricants/paper-fluid-1");
  v1::Lubricant with_number = plain, with_table = plain;
  with_number.set_asperity_friction_coefficient(0.1);
  for (const double celsius : {40.0, 100.0}) {
    v1::BoundaryFrictionAtTemperature& each = *with_table.add_asperity_friction_by_temperature();
    each.set_temperature_celsius(celsius);
    each.set_asperity_friction_coefficient(0.1);
  }
  const char *of_surface = "surface.asperity_friction_coefficient",
             *of_oil = "lubricant.asperity_friction_coefficient";
  EXPECT_TRUE(violations_with(plain, of_surface).empty());
  EXPECT_TRUE(violations_with(plain, of_oil).empty());
  EXPECT_TRUE(violations_with(with_number, of_oil).empty());
  for (const auto& [oil, path] :
       {std::pair(with_number, of_surface), std::pair(with_table, of_surface),
        std::pair(with_table, of_oil)}) {
    const Violations found = violations_with(oil, path);
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found.front().field, "candidate_columns[1].path");
  }
}

TEST(EvaluatePoints, ElasticitiesThatDoNotExistAreRefusedByName) {
  v1::EvaluatePointsRequest request = request_of_candidates();
  request.add_elasticity_figures("film_ratio_minimum");
  EXPECT_THAT(violations_of(request),
              testing::AllOf(HasSubstr("elasticity_figures[0]: \"film_ratio_minimum\" is no figure "
                                       "that is differentiated"),
                             HasSubstr("elasticity_parameters: not set; allowed: at least one")));
  request.set_elasticity_figures(0, "film_ratio_mean");
  request.add_elasticity_parameters("lubricant.relaxation_time_second");
  request.add_elasticity_parameters("lubricant.relaxation_time_seconds");
  request.add_elasticity_parameters("lubricant.relaxation_time_seconds");
  EXPECT_THAT(violations_of(request),
              testing::AllOf(HasSubstr("did you mean \"lubricant.relaxation_time_seconds\"?"),
                             HasSubstr("elasticity_parameters[2]: "
                                       "\"lubricant.relaxation_time_seconds\" is listed twice")));
}

// A candidate that solidifies at the inlet says nothing about the others.
TEST(EvaluatePoints, ARefusedRowHasItsReasonAndNoFigures) {
  v1::EvaluatePointsRequest request = request_of_candidates();
  request.clear_candidate_columns();
  add_column(request, "lubricant.vogel_reference_temperature_kelvin", {150, 350, 151});
  const v1::EvaluatePointsResponse out = evaluate(request);
  for (int row = 0; row < 18; ++row) {
    const bool refused = row / 6 == 1;
    EXPECT_EQ(out.refusal_numbers(row) > 0, refused) << row;
    EXPECT_EQ(std::isnan(out.inefficiency_rms_percent(row)), refused) << row;
  }
  for (int row = 6; row < 9; ++row) {  // 350 K is above the inlet of 40 C + 20 K
    const v1::PointRefusal& refusal = out.refusals(out.refusal_numbers(row) - 1);
    EXPECT_EQ(refusal.reason(), "INVALID_AT_INLET");
    EXPECT_THAT(refusal.message(), HasSubstr("350"));
  }
}

TEST(EvaluatePoints, AllViolationsNameTheFieldAsStated) {
  v1::EvaluatePointsRequest request = request_of_candidates();
  request.mutable_candidate_columns(0)->set_path("lubricant.relaxation_time_second");
  request.mutable_candidate_columns(1)->set_values(2, 11);
  add_column(request, "lubricant.havriliak_negami_alpha", {0.5});
  request.mutable_conditions(3)->set_speed_kilometres_per_hour(-5);
  const std::string all = violations_of(request);
  EXPECT_THAT(all, HasSubstr("candidate_columns[0].path: \"lubricant.relaxation_time_second\" is "
                             "no parameter of a lubricant or surface that the model uses; did you "
                             "mean \"lubricant.relaxation_time_seconds\"?"));
  EXPECT_THAT(all, HasSubstr("candidate_columns[1].values[2]: asperity_friction_coefficient = 11; "
                             "allowed: 0 to 2"));
  EXPECT_THAT(all, HasSubstr("candidate_columns[2].values: 1 values; allowed: one for each"));
  EXPECT_THAT(all, HasSubstr("conditions[3].speed_kilometres_per_hour: "
                             "speed_kilometres_per_hour = -5 km/h; allowed: 0.1 to 400 km/h"));
}

TEST(EvaluatePoints, MorePointsThanAllowedAreRefused) {
  v1::EvaluatePointsRequest request = request_of_candidates();
  request.clear_candidate_columns();
  add_column(request, "lubricant.havriliak_negami_beta", std::vector<double>(334, 0.5));
  EXPECT_THAT(violations_of(request),
              HasSubstr("conditions: 334 candidates at 6 conditions are 2004 points; allowed: at "
                        "most 2000"));
  request.clear_conditions();
  EXPECT_THAT(violations_of(request), HasSubstr("conditions: not set"));
}

TEST(EvaluatePoints, TheBasesAreThoseOfTheStore) {
  Bench bench;
  Application application = bench.application();
  v1::EvaluatePointsRequest request = request_of_candidates();
  const auto out = evaluate_points(application, request);
  ASSERT_TRUE(out.ok());
  EXPECT_EQ(out.message().inefficiency_rms_percent(4),
            evaluate(request).inefficiency_rms_percent(4));
  v1::EvaluatePointsRequest many = request_of_candidates();
  many.clear_candidate_columns();
  add_column(many, "lubricant.havriliak_negami_beta", std::vector<double>(84, 0.5));
  many.add_elasticity_parameters("lubricant.havriliak_negami_beta");
  EXPECT_THAT(complaints(evaluate_points(application, many).error()),
              HasSubstr("84 candidates at 6 conditions are 504 points; allowed: at most 500 with "
                        "elasticities in one request"));
  request.set_surface("surfaces/run-im");
  EXPECT_THAT(complaints(evaluate_points(application, request).error()),
              HasSubstr("did you mean \"surfaces/run-in\"?"));
}

TEST(EvaluatePoints, WorkEndsSoonAfterTheClientHasCancelled) {
  Violations violations;
  const auto evaluation = read_points(request_of_candidates(), seed_lookup(), violations);
  ASSERT_TRUE(evaluation);
  PreparedGearSets gear_sets;
  int looks = 0;
  EXPECT_THROW(evaluate_points(*evaluation, gear_sets, [&] { return ++looks > 5; }), Cancelled);
  EXPECT_LE(looks, 6);
}

}  // namespace
}  // namespace tribodyn::server
