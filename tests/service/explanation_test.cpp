// ExplainPoints: the difference of two lubricants, attributed to groups of their parameters.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/refusal.h"
#include "core/study/operating_point.h"
#include "server/mapping/to_core.h"
#include "server/simulation/point_explanation.h"
#include "tests/service/support.h"
#include "tests/service/uncertain_fluids.h"

namespace tribodyn::server {
namespace {

using testing::HasSubstr;

constexpr char kOneFluid[] = "lubricants/paper-fluid-1";
constexpr char kOtherFluid[] = "lubricants/paper-fluid-2";

v1::ExplainPointsRequest explanation_of(const std::string& a, const std::string& b,
                                        const std::vector<double>& speeds = {50, 100}) {
  v1::ExplainPointsRequest out;
  out.set_lubricant(a);
  out.set_other_lubricant(b);
  for (const double speed : speeds) {
    out.add_conditions()->set_speed_kilometres_per_hour(speed);
  }
  out.set_draws(19);
  return out;
}

v1::ExplainPointsResponse explain(const v1::ExplainPointsRequest& request,
                                  const Fluids& fluids = {}) {
  Violations violations;
  const auto explanation = read_explanation(request, fluids.lookup(), violations);
  if (!explanation) throw std::runtime_error(violations.begin()->description);
  PreparedGearSets gear_sets;
  return explain_points(*explanation, gear_sets, [] { return false; });
}

std::string explanation_violations(const v1::ExplainPointsRequest& request) {
  Violations violations;
  read_explanation(request, seed_lookup(), violations);
  std::string out;
  for (const Violation& each : violations) out += each.field + ": " + each.description + "\n";
  return out;
}

const v1::Attribution& share(const v1::DifferenceExplanation& explanation,
                             v1::ParameterGroup group) {
  const v1::DifferenceCause& cause = explanation.causes(static_cast<int>(group) - 1);
  EXPECT_EQ(cause.group(), group);
  return cause.inefficiency_percent();
}

double sum_of_shares(const v1::DifferenceExplanation& explanation) {
  double out = 0;
  for (const v1::DifferenceCause& cause : explanation.causes()) {
    out += cause.inefficiency_percent().shapley_value().value();
  }
  return out;
}

/// The inefficiency of a point that is computed as a simulation is.
double recomputed_inefficiency(const v1::Lubricant& lubricant, double kilometres_per_hour) {
  Fluids fluids;
  fluids.add("lubricants/swapped", lubricant);
  v1::Simulation simulation;
  simulation.set_lubricant("lubricants/swapped");
  simulation.mutable_solver_options()->set_tolerance(1e-5);
  simulation.mutable_operating_point()->mutable_cruise()->set_speed_kilometres_per_hour(
      kilometres_per_hour);
  Violations violations;
  const auto inputs = read_simulation(simulation, fluids.lookup(), "", violations);
  const PointStudy point = std::get<PointStudy>(study(*inputs));
  return solve_operating_point(scene(*inputs), point.condition, point.options)
      .inefficiency_energy_mean.value();
}

/// Lubricants that differ in four groups, two of which neither viscosity nor pressure sets.
Fluids different_fluids() {
  auto b = exact_seed<v1::Lubricant>(kOtherFluid);
  b.set_relaxation_time_seconds(3 * b.relaxation_time_seconds());
  b.set_limiting_shear_stress_coefficient(0.8 * b.limiting_shear_stress_coefficient());
  Fluids out;
  out.add("lubricants/b", b);
  return out;
}

TEST(ExplainPoints, SharesSumToTheDifferenceAtEachConditionAndInTheMean) {
  auto request = explanation_of(kOneFluid, "lubricants/b");
  request.add_condition_weights(3);
  request.add_condition_weights(1);
  const auto out = explain(request, different_fluids());
  ASSERT_EQ(out.points_size(), 2);
  for (const auto* each : {&out.points(0), &out.points(1), &out.mean()}) {
    ASSERT_EQ(each->causes_size(), 6);
    const double difference = each->inefficiency_difference_percent().value();
    EXPECT_NEAR(sum_of_shares(*each), difference, 1e-12);
    EXPECT_EQ(difference,
              each->other_inefficiency_percent().value() - each->inefficiency_percent().value());
    double watts = 0;
    for (const v1::DifferenceCause& cause : each->causes()) {
      watts += cause.mesh_loss_power_watts().shapley_value().value();
    }
    EXPECT_NEAR(watts, each->mesh_loss_power_difference_watts().value(), 1e-9);
  }
  const auto viscosity = [](const v1::DifferenceExplanation& each) {
    return share(each, v1::PARAMETER_GROUP_VISCOSITY).shapley_value().value();
  };
  EXPECT_NEAR(viscosity(out.mean()),
              0.75 * viscosity(out.points(0)) + 0.25 * viscosity(out.points(1)), 1e-12);
}

TEST(ExplainPoints, EqualGroupsHaveNoShareAtAll) {
  const auto out = explain(explanation_of(kOneFluid, kOtherFluid));
  for (const v1::DifferenceCause& cause : out.mean().causes()) {
    const bool differs = cause.group() == v1::PARAMETER_GROUP_VISCOSITY ||
                         cause.group() == v1::PARAMETER_GROUP_PRESSURE_RESPONSE;
    SCOPED_TRACE(v1::ParameterGroup_Name(cause.group()));
    EXPECT_EQ(cause.is_equal(), !differs);
    if (differs) continue;
    EXPECT_EQ(cause.inefficiency_percent().shapley_value().value(), 0);
    EXPECT_EQ(cause.inefficiency_percent().shapley_value().solver_error(), 0);
    EXPECT_EQ(cause.inefficiency_percent().last_effect(), 0);
  }
  EXPECT_EQ(out.draws(), 0) << "nothing is uncertain";
}

TEST(ExplainPoints, AnExchangedGroupHasTheEffectOfANewSimulation) {
  const Fluids fluids = different_fluids();
  const auto b = [&] {
    v1::Lubricant out;
    out.ParseFromString(fluids.lookup().find({"lubricants/b", 0})->body);
    return out;
  }();
  auto first = exact_seed<v1::Lubricant>(kOneFluid);
  auto swapped = first;
  swapped.set_pressure_viscosity_coefficient_per_pascal(
      b.pressure_viscosity_coefficient_per_pascal());
  swapped.set_pressure_viscosity_temperature_kelvin(b.pressure_viscosity_temperature_kelvin());
  auto last = b;
  last.set_relaxation_time_seconds(first.relaxation_time_seconds());
  for (const double speed : {50.0, 75.0}) {  // without and with contact loss
    SCOPED_TRACE(speed);
    const auto out = explain(explanation_of(kOneFluid, "lubricants/b", {speed}), fluids);
    const v1::DifferenceExplanation& point = out.points(0);
    const double before = recomputed_inefficiency(first, speed);
    const double error =
        share(point, v1::PARAMETER_GROUP_PRESSURE_RESPONSE).shapley_value().solver_error();
    EXPECT_LT(error, 1e-3);
    EXPECT_NEAR(share(point, v1::PARAMETER_GROUP_PRESSURE_RESPONSE).first_effect(),
                recomputed_inefficiency(swapped, speed) - before, error);
    const double after = recomputed_inefficiency(b, speed);
    EXPECT_NEAR(share(point, v1::PARAMETER_GROUP_SHEAR_THINNING).last_effect(),
                after - recomputed_inefficiency(last, speed), error);
    EXPECT_NEAR(sum_of_shares(point), after - before, error);
  }
}

TEST(ExplainPoints, AnotherSurfaceIsTheShareOfTheBoundaryFilm) {
  auto request = explanation_of(kOneFluid, kOneFluid, {30});
  request.set_other_surface("surfaces/film");
  auto film = exact_seed<v1::Surface>("surfaces/run-in");
  film.set_tribofilm_shear_strength_pascals(2 * film.tribofilm_shear_strength_pascals());
  film.set_asperity_friction_coefficient(1.5 * film.asperity_friction_coefficient());
  Fluids fluids;
  fluids.add("surfaces/film", film);
  const auto out = explain(request, fluids);
  const double difference = out.mean().inefficiency_difference_percent().value();
  EXPECT_GT(difference, 0.01);
  EXPECT_NEAR(share(out.mean(), v1::PARAMETER_GROUP_BOUNDARY_FILM).shapley_value().value(),
              difference, 1e-12);
}

TEST(ExplainPoints, ALubricantDiffersFromItselfAfterTheShearTestByItsViscosity) {
  auto oil = exact_seed<v1::Lubricant>(kOneFluid);
  oil.mutable_measurements()
      ->set_sheared_kinematic_viscosity_100_celsius_square_millimetres_per_second(14);
  Fluids fluids;
  fluids.add("lubricants/oil", oil);
  auto request = explanation_of("lubricants/oil", "lubricants/oil", {60});
  request.set_other_sheared_lubricant(true);
  const v1::DifferenceExplanation mean = explain(request, fluids).mean();
  EXPECT_GT(std::abs(mean.inefficiency_difference_percent().value()), 1e-3);
  EXPECT_NEAR(share(mean, v1::PARAMETER_GROUP_VISCOSITY).shapley_value().value(),
              mean.inefficiency_difference_percent().value(), 1e-12);
  request = explanation_of(kOneFluid, kOneFluid, {60});
  request.set_other_sheared_lubricant(true);
  EXPECT_THAT(explanation_violations(request), testing::StartsWith("other_sheared_lubricant: "));
}

v1::Lubricant with_uncertain_shear(const char* name) {
  auto out = exact_seed<v1::Lubricant>(name);
  set_uncertainty(out, "relaxation_time_seconds", 0.5 * out.relaxation_time_seconds());
  return out;
}

TEST(ExplainPoints, AnUncertainGroupThatIsEqualHasAShareOfZeroWithAnUncertainty) {
  Fluids fluids;
  fluids.add("lubricants/a", with_uncertain_shear(kOneFluid));
  fluids.add("lubricants/b", with_uncertain_shear(kOtherFluid));
  auto request = explanation_of("lubricants/a", "lubricants/b", {60});
  request.set_draws(39);
  const auto out = explain(request, fluids);
  EXPECT_EQ(out.draws(), 39);
  const auto& shear = share(out.mean(), v1::PARAMETER_GROUP_SHEAR_THINNING).shapley_value();
  EXPECT_EQ(shear.value(), 0);
  EXPECT_GT(shear.standard_uncertainty(), 0.005);
  EXPECT_LT(shear.interval_minimum(), 0);
  EXPECT_GT(shear.interval_maximum(), 0);
  const auto& viscosity = share(out.mean(), v1::PARAMETER_GROUP_VISCOSITY).shapley_value();
  EXPECT_LT(viscosity.standard_uncertainty(), shear.standard_uncertainty());
}

TEST(ExplainPoints, ErrorsThatBothShareDoNotReachTheShares) {
  Fluids fluids;
  fluids.add("lubricants/a", with_uncertain_shear(kOneFluid));
  auto request = explanation_of("lubricants/a", "lubricants/a", {60});
  request.set_inlet_temperature_rise_uncertainty_kelvin(5);
  const v1::DifferenceExplanation mean = explain(request, fluids).mean();
  EXPECT_GT(mean.inefficiency_percent().standard_uncertainty(), 0);
  EXPECT_EQ(mean.inefficiency_difference_percent().standard_uncertainty(), 0);
}

TEST(ExplainPoints, WithoutAStatedUncertaintyOfBothOilsHasNoIntervals) {
  Fluids fluids;
  fluids.add("lubricants/a", with_uncertain_shear(kOneFluid));
  for (const char* first : {"lubricants/a", kOneFluid}) {
    const auto mean = explain(explanation_of(first, kOtherFluid, {60}), fluids).mean();
    EXPECT_NE(mean.inefficiency_difference_percent().value(), 0);
    EXPECT_TRUE(std::isnan(mean.inefficiency_difference_percent().interval_minimum()));
    EXPECT_TRUE(std::isnan(
        share(mean, v1::PARAMETER_GROUP_PRESSURE_RESPONSE).shapley_value().standard_uncertainty()));
  }
}

TEST(ExplainPoints, RefuseAnOilBelowItsPourPointWhicheverComesFirst) {
  v1::Lubricant thick = exact_seed<v1::Lubricant>(kOtherFluid);
  thick.set_pour_point_celsius(-5);
  Fluids fluids;
  fluids.add("lubricants/thick", thick);
  for (const bool is_first : {true, false}) {
    auto request = explanation_of(is_first ? "lubricants/thick" : kOneFluid,
                                  is_first ? kOneFluid : "lubricants/thick", {60});
    request.mutable_conditions(0)->set_sump_temperature_celsius(-10);
    EXPECT_EQ(explain(request, fluids).mean().refusal_reason(), "BELOW_POUR_POINT");
  }
}

TEST(ExplainPoints, EqualRequestsHaveEqualAnswers) {
  Fluids fluids;
  fluids.add("lubricants/a", fluid_with_alpha());
  const auto request = explanation_of("lubricants/a", kOtherFluid, {66});
  EXPECT_EQ(explain(request, fluids).SerializeAsString(),
            explain(request, fluids).SerializeAsString());
}

TEST(ExplainPoints, RefusesWhatItCannotExplainAndNamesTheField) {
  EXPECT_THAT(explanation_violations(explanation_of(kOneFluid, "lubricants/no")),
              HasSubstr("other_lubricant: "));
  EXPECT_THAT(explanation_violations(explanation_of("lubricants/no", kOneFluid)),
              testing::StartsWith("lubricant: "));
  EXPECT_THAT(explanation_violations(explanation_of(kOneFluid, kOtherFluid, {})),
              HasSubstr("conditions: "));
  auto request = explanation_of(kOneFluid, kOtherFluid);
  request.add_condition_weights(1);
  EXPECT_THAT(explanation_violations(request),
              HasSubstr("condition_weights: 1 weights of 2 conditions"));
  EXPECT_THAT(
      explanation_violations(explanation_of(kOneFluid, kOtherFluid, std::vector<double>(51, 50))),
      HasSubstr("64 combinations at 51 conditions with 19 draws are 65280 points; allowed: at most "
                "64000"));
  request = explanation_of(kOneFluid, kOtherFluid);
  request.set_other_surface("surfaces/no");
  EXPECT_THAT(explanation_violations(request), testing::StartsWith("other_surface: "));
}

TEST(ExplainPoints, SaysWhyACombinationIsRefused) {
  // The viscosity of b is infinite at 40 C, where the coefficient of the other one is stated.
  auto b = exact_seed<v1::Lubricant>(kOtherFluid);
  b.set_vogel_reference_temperature_kelvin(313.15);
  b.set_vogel_temperature_coefficient_kelvin(100);
  b.set_pressure_viscosity_temperature_kelvin(373.15);
  Fluids fluids;
  fluids.add("lubricants/b", b);
  auto request = explanation_of(kOneFluid, "lubricants/b", {50});
  request.mutable_conditions(0)->set_sump_temperature_celsius(90);
  const auto out = explain(request, fluids);
  EXPECT_NE(out.points(0).refusal_reason(), "");
  EXPECT_NE(out.points(0).refusal_message(), "");
  EXPECT_EQ(out.mean().refusal_reason(), out.points(0).refusal_reason());
  EXPECT_EQ(out.points(0).causes_size(), 0);
}

/// The question of the paper: which property of the viscosity modifiers makes the difference?
TEST(ExplainPoints, TheFluidsOfThePaperDifferByTheirPressureResponse) {
  auto request = explanation_of(kOneFluid, kOtherFluid, {20, 40, 60, 80, 100, 120, 140});
  request.mutable_model_options()->set_preset(v1::ModelOptions::PAPER);
  const v1::DifferenceExplanation second = explain(request).mean();
  EXPECT_NEAR(second.inefficiency_difference_percent().value(), 0.234, 0.001);
  EXPECT_NEAR(share(second, v1::PARAMETER_GROUP_PRESSURE_RESPONSE).shapley_value().value(), 0.347,
              0.001);
  EXPECT_NEAR(share(second, v1::PARAMETER_GROUP_VISCOSITY).shapley_value().value(), -0.113, 0.001);
  EXPECT_EQ(share(second, v1::PARAMETER_GROUP_SHEAR_THINNING).shapley_value().value(), 0)
      << "one set for all three fluids, by assumption";
}

TEST(ExplainPoints, StopsWhenItsCallIsOver) {
  Violations violations;
  const auto explanation =
      read_explanation(explanation_of(kOneFluid, kOtherFluid), seed_lookup(), violations);
  PreparedGearSets gear_sets;
  int calls = 0;
  EXPECT_THROW(explain_points(*explanation, gear_sets, [&calls] { return ++calls > 3; }),
               Cancelled);
  EXPECT_LT(calls, 20);
}

}  // namespace
}  // namespace tribodyn::server
