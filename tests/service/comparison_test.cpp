// ComparePoints: figures with the uncertainty of their inputs, and differences of lubricants.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "core/refusal.h"
#include "core/study/operating_point.h"
#include "core/uncertainty/drawn_value.h"
#include "server/contract/resource_names.h"
#include "server/mapping/to_core.h"
#include "server/resources/lubricant_parameters.h"
#include "server/resources/sheared_lubricant.h"
#include "server/resources/viscosity_fit.h"
#include "server/simulation/contact_inputs.h"
#include "server/simulation/input_hash.h"
#include "server/simulation/point_comparison.h"
#include "tests/service/support.h"
#include "tests/service/uncertain_fluids.h"
#include "tests/support/run_length.h"

namespace tribodyn::server {
namespace {

using testing::HasSubstr;

std::string violations_of(const v1::ComparePointsRequest& request) {
  Violations violations;
  read_comparison(request, seed_lookup(), violations);
  std::string out;
  for (const Violation& each : violations) out += each.field + ": " + each.description + "\n";
  return out;
}

/// The point of a lubricant, computed as a simulation is, with errors of the solver far below the
/// 0.1 % by which the inputs move the extremes of its transmission error.
PointResult simulated(const v1::Lubricant& lubricant, double kilometres_per_hour) {
  Fluids fluids;
  fluids.add("lubricants/truth", lubricant);
  v1::Simulation simulation;
  simulation.set_lubricant("lubricants/truth");
  simulation.mutable_operating_point()->mutable_cruise()->set_speed_kilometres_per_hour(
      kilometres_per_hour);
  simulation.mutable_solver_options()->set_tolerance(1e-5);
  Violations violations;
  const auto inputs = read_simulation(simulation, fluids.lookup(), "", violations);
  const PointStudy point = std::get<PointStudy>(study(*inputs));
  return solve_operating_point(scene(*inputs), point.condition, point.options);
}

double true_inefficiency(const v1::Lubricant& lubricant, double kilometres_per_hour) {
  return simulated(lubricant, kilometres_per_hour).inefficiency_energy_mean.value();
}

TEST(ComparePoints, MovesAFigureByItsOnlyUncertainInputAsARecomputationDoes) {
  Fluids fluids;
  fluids.add("lubricants/a", fluid_with_alpha());
  fluids.add("lubricants/plus",
             fluid_with_alpha(std::exp(std::sqrt(std::log1p(0.05 * 0.05))), 0.05));
  const auto out = compare(request_at({50}, {"lubricants/a", "lubricants/plus"}), fluids);
  const v1::ComparedPoint& a = out.lubricants(0).points(0);
  const v1::UncertainFigure& figure = a.inefficiency_energy_mean_percent();
  const double moved =
      out.lubricants(1).points(0).inefficiency_energy_mean_percent().value() - figure.value();
  ASSERT_EQ(a.shares_size(), 1);
  EXPECT_EQ(a.shares(0).input(), "lubricant.pressure_viscosity_coefficient_per_pascal");
  EXPECT_DOUBLE_EQ(a.shares(0).variance_share(), 1);
  EXPECT_NEAR(a.shares(0).effect(), moved, 0.05 * std::abs(moved));
  EXPECT_NEAR(figure.linear_standard_uncertainty(), std::abs(moved), 0.05 * std::abs(moved));
  EXPECT_NEAR(figure.standard_uncertainty(), std::abs(moved), 0.05 * std::abs(moved));
  EXPECT_NEAR(figure.interval_maximum() - figure.interval_minimum(), 2 * 1.96 * std::abs(moved),
              0.2 * std::abs(moved));
  EXPECT_LT(figure.solver_error(), 2e-3 * figure.value());
}

TEST(ComparePoints, FindsALubricantNeitherBetterNorWorseThanItself) {
  Fluids fluids;
  fluids.add("lubricants/a", fluid_with_alpha());
  const auto out = compare(request_at({50}, {"lubricants/a", "lubricants/a"}), fluids);
  const v1::ComparedDifference& difference = out.lubricants(1).mean_difference();
  EXPECT_EQ(difference.verdict(), v1::ComparedDifference::CANNOT_BE_TOLD_APART);
  EXPECT_EQ(difference.difference_percent().value(), 0);
  EXPECT_EQ(difference.difference_percent().standard_uncertainty(), 0);
  EXPECT_EQ(difference.lower_probability(), 0.5);
}

TEST(ComparePoints, SaysWhichLubricantLosesLessOnlyIfTheInputsBearIt) {
  const auto verdict = [](double factor, double relative_uncertainty) {
    Fluids fluids;
    fluids.add("lubricants/a", fluid_with_alpha(1, relative_uncertainty));
    fluids.add("lubricants/b", fluid_with_alpha(factor, relative_uncertainty));
    const auto out = compare(request_at({50}, {"lubricants/a", "lubricants/b"}), fluids);
    return out.lubricants(1).mean_difference();
  };
  EXPECT_EQ(verdict(0.8, 0.01).verdict(), v1::ComparedDifference::LOWER);
  EXPECT_EQ(verdict(0.8, 0.01).lower_probability(), 1);
  EXPECT_EQ(verdict(1.25, 0.01).verdict(), v1::ComparedDifference::HIGHER);
  EXPECT_EQ(verdict(1.25, 0.01).lower_probability(), 0);
  const v1::ComparedDifference open = verdict(0.95, 0.2);
  EXPECT_EQ(open.verdict(), v1::ComparedDifference::CANNOT_BE_TOLD_APART);
  EXPECT_GT(open.lower_probability(), 0.5);
  EXPECT_LT(open.lower_probability(), 0.7);
}

TEST(ComparePoints, RanksAllLubricantsWhicheverComesFirst) {
  Fluids fluids;
  fluids.add("lubricants/good", fluid_with_alpha(0.8, 0.02));
  fluids.add("lubricants/near", fluid_with_alpha(0.805, 0.02));
  fluids.add("lubricants/bad", fluid_with_alpha(1.2, 0.02));
  const auto out = compare(
      request_at({50, 90}, {"lubricants/bad", "lubricants/near", "lubricants/good"}), fluids);
  const v1::ComparedLubricant &bad = out.lubricants(0), &near = out.lubricants(1),
                              &good = out.lubricants(2);
  EXPECT_FALSE(good.has_mean_difference_from_best());
  EXPECT_EQ(bad.mean_difference_from_best().verdict(), v1::ComparedDifference::HIGHER);
  EXPECT_EQ(near.mean_difference_from_best().verdict(),
            v1::ComparedDifference::CANNOT_BE_TOLD_APART);
  EXPECT_EQ(bad.mean_difference_from_best().difference_percent().value(),
            -good.mean_difference().difference_percent().value());
  EXPECT_EQ(bad.best_probability(), 0);
  EXPECT_GT(good.best_probability(), near.best_probability());
  EXPECT_NEAR(good.best_probability() + near.best_probability(), 1, 1e-12);
  const auto alone = compare(request_at({50}, {"lubricants/good"}), fluids);
  EXPECT_EQ(alone.lubricants(0).best_probability(), 1);
  const auto twice = compare(request_at({50}, {"lubricants/good", "lubricants/good"}), fluids);
  EXPECT_EQ(twice.lubricants(1).best_probability(), 0.5);
}

TEST(ComparePoints, MeasuredValuesAreIndependentAndEstimatesShareTheirErrorAsStated) {
  const auto deviation = [](bool is_estimate, std::optional<double> correlation) {
    Fluids fluids;
    fluids.add("lubricants/a", fluid_with_alpha(1, 0.05, is_estimate));
    fluids.add("lubricants/b", fluid_with_alpha(1, 0.05, is_estimate));
    auto request = request_at({50}, {"lubricants/a", "lubricants/b"});
    if (correlation) request.set_estimate_correlation(*correlation);
    const auto out = compare(request, fluids);
    const v1::UncertainFigure& figure = out.lubricants(1).mean_difference().difference_percent();
    EXPECT_NEAR(figure.linear_standard_uncertainty(), figure.standard_uncertainty(),
                0.1 * figure.linear_standard_uncertainty() + 1e-12);
    return figure.linear_standard_uncertainty();
  };
  const double independent = deviation(false, 1);
  EXPECT_GT(independent, 0);
  EXPECT_NEAR(deviation(true, 0), independent, 1e-9);
  EXPECT_NEAR(deviation(true, std::nullopt), independent * std::sqrt(0.5), 1e-9);
  EXPECT_NEAR(deviation(true, 1), 0, 1e-9);
}

TEST(ComparePoints, ErrorsOfTheSceneAreCommonToAllLubricants) {
  Fluids fluids;
  fluids.add("lubricants/a", fluid_with_alpha(1, 0));
  fluids.add("lubricants/b", fluid_with_alpha(1.02, 0));
  auto request = request_at({50}, {"lubricants/a", "lubricants/b"});
  request.set_inlet_temperature_rise_uncertainty_kelvin(5);
  const auto out = compare(request, fluids);
  const auto& a = out.lubricants(0).points(0).inefficiency_energy_mean_percent();
  const auto& difference = out.lubricants(1).differences(0);
  EXPECT_GT(a.standard_uncertainty(), 0);
  EXPECT_LT(difference.difference_percent().standard_uncertainty(), 0.1 * a.standard_uncertainty());
  EXPECT_EQ(difference.shares(0).lubricant_revision(), "");
  EXPECT_NE(difference.verdict(), v1::ComparedDifference::CANNOT_BE_TOLD_APART);
}

TEST(ComparePoints, TheMeanWeighsItsConditions) {
  Fluids fluids;
  fluids.add("lubricants/a", fluid_with_alpha());
  auto request = request_at({40, 100}, {"lubricants/a"});
  request.add_condition_weights(3);
  request.add_condition_weights(1);
  const auto out = compare(request, fluids);
  const v1::ComparedLubricant& a = out.lubricants(0);
  EXPECT_NEAR(a.mean_inefficiency_percent().value(),
              0.75 * a.points(0).inefficiency_energy_mean_percent().value() +
                  0.25 * a.points(1).inefficiency_energy_mean_percent().value(),
              1e-12);
}

TEST(ComparePoints, StatesTheMeanSpeedOfThePinionAtEachConditionInTheirOrder) {
  Fluids fluids;
  fluids.add("lubricants/a", fluid_with_alpha());
  auto request = request_at({100, 40, 70}, {"lubricants/a"});
  request.mutable_conditions(0)->set_sump_temperature_celsius(90);
  const auto out = compare(request, fluids);
  ASSERT_EQ(out.mean_pinion_speed_radians_per_second_size(), 3);
  for (int k = 0; k < 3; ++k) {
    const double speed = request.conditions(k).speed_kilometres_per_hour();
    EXPECT_NEAR(out.mean_pinion_speed_radians_per_second(k),
                simulated(fluid_with_alpha(), speed).mean_pinion_speed, 1e-9);
  }
}

TEST(ComparePoints, NamesTheInputsThatCountAsExact) {
  const auto out = compare(request_at({50}, {"lubricants/paper-fluid-1"}), {});
  const v1::ComparedLubricant& a = out.lubricants(0);
  EXPECT_THAT(a.inputs_without_uncertainty(),
              testing::Contains("lubricant.relaxation_time_seconds"));
  EXPECT_THAT(a.inputs_without_uncertainty(),
              testing::Not(testing::Contains("lubricant.rheology_reference_temperature_kelvin")));
  EXPECT_THAT(out.inputs_without_uncertainty(), testing::Contains("sump_temperature_celsius"));
  const v1::UncertainFigure& figure = a.points(0).inefficiency_energy_mean_percent();
  EXPECT_EQ(figure.standard_uncertainty(), 0);
  EXPECT_EQ(figure.interval_minimum(), figure.value());
  EXPECT_EQ(a.points(0).shares_size(), 0);
}

TEST(ComparePoints, OfADataSheetNamesThePressureViscosityCoefficientFirst) {
  Fluids fluids;
  fluids.add("lubricants/sheet", data_sheet(103, 15.1));
  const auto out = compare(request_at({60}, {"lubricants/sheet"}), fluids);
  const v1::ComparedPoint& point = out.lubricants(0).points(0);
  EXPECT_EQ(point.shares(0).input(), "lubricant.pressure_viscosity_coefficient_per_pascal");
  EXPECT_GT(point.shares(0).variance_share(), 0.8);
  double sum = 0;
  for (const v1::InputShare& share : point.shares()) sum += share.variance_share();
  EXPECT_NEAR(sum, 1, 1e-12);
  const v1::UncertainFigure& figure = point.inefficiency_energy_mean_percent();
  EXPECT_GT(figure.standard_uncertainty(), 0.2 * figure.value());
  EXPECT_LT(figure.standard_uncertainty(), 0.5 * figure.value());
  EXPECT_EQ(out.lubricants(0).inputs_without_uncertainty_size(), 0);
}

TEST(ComparePoints, ExtremesOfHistoriesAndOfContactsHaveTheUncertaintyOfARecomputation) {
  Fluids fluids;
  fluids.add("lubricants/a", fluid_with_alpha());
  fluids.add("lubricants/plus",
             fluid_with_alpha(std::exp(std::sqrt(std::log1p(0.05 * 0.05))), 0.05));
  auto request = request_at({60}, {"lubricants/a", "lubricants/plus"});
  request.set_draws(39);
  EXPECT_FALSE(compare(request, fluids).lubricants(0).points(0).has_film_ratio_minimum());
  request.set_contact_figures(true);
  const auto out = compare(request, fluids);
  const v1::ComparedPoint &a = out.lubricants(0).points(0), &plus = out.lubricants(1).points(0);
  const auto check = [](const v1::UncertainFigure& figure, const v1::UncertainFigure& moved) {
    const double change = std::abs(moved.value() - figure.value());
    EXPECT_GT(change, 0);
    EXPECT_NEAR(figure.linear_standard_uncertainty(), change, 0.15 * change);
    EXPECT_NEAR(figure.standard_uncertainty(), change, 0.2 * change);
    EXPECT_LT(figure.interval_minimum(), figure.value());
    EXPECT_GT(figure.interval_maximum(), figure.value());
  };
  check(a.film_ratio_minimum(), plus.film_ratio_minimum());
  check(a.contact_temperature_maximum_kelvin(), plus.contact_temperature_maximum_kelvin());
  check(a.mesh_friction_coefficient(), plus.mesh_friction_coefficient());
  check(a.flash_temperature_rise_maximum_kelvin(), plus.flash_temperature_rise_maximum_kelvin());
  check(a.dynamic_transmission_error_maximum_metres(),
        plus.dynamic_transmission_error_maximum_metres());
  EXPECT_TRUE(std::isnan(a.film_ratio_minimum().solver_error())) << "nobody estimates it";
  const auto found = simulated(fluid_with_alpha(), 60);
  EXPECT_NEAR(a.film_ratio_minimum().value(), found.film_ratio.minimum,
              1e-3 * found.film_ratio.minimum);
  EXPECT_NEAR(a.mesh_friction_coefficient().value(), found.friction_coefficient.mean,
              1e-3 * found.friction_coefficient.mean);
  EXPECT_NEAR(a.maximum_pressure_maximum_pascals().value(), found.maximum_pressure.maximum,
              1e-3 * found.maximum_pressure.maximum);
  EXPECT_NEAR(a.dynamic_transmission_error_minimum_metres().value(),
              found.dynamic_transmission_error.minimum,
              2 * a.dynamic_transmission_error_minimum_metres().solver_error());
}

TEST(ContactUncertainty, IsThatOfARecomputationWithTheMovedInput) {
  v1::EvaluateContactRequest request = contact_request();
  const auto stated = fluid_with_alpha();
  EXPECT_EQ(evaluate_contact(request, stated).uncertainties_size(), 0) << "nobody asked for them";
  const auto plus =
      evaluate_contact(request, fluid_with_alpha(std::exp(std::sqrt(std::log1p(0.05 * 0.05))), 0));
  request.set_draws(199);
  const auto out = evaluate_contact(request, stated);
  ASSERT_EQ(out.friction_shares_size(), 1);
  EXPECT_EQ(out.friction_shares(0).input(), "lubricant.pressure_viscosity_coefficient_per_pascal");
  EXPECT_EQ(out.friction_shares(0).variance_share(), 1);
  EXPECT_GT(out.inputs_without_uncertainty_size(), 3);
  int found = 0;
  for (const v1::UncertainContactFigure& each : out.uncertainties()) {
    const auto* field = out.GetDescriptor()->FindFieldByName(each.figure());
    const double value = out.GetReflection()->GetDouble(out, field);
    const double change = std::abs(plus.GetReflection()->GetDouble(plus, field) - value);
    EXPECT_EQ(each.value().value(), value);
    EXPECT_LT(each.value().interval_minimum(), each.value().interval_maximum()) << each.figure();
    if (each.figure() != "friction_coefficient" &&
        each.figure() != "central_film_thickness_metres" &&
        each.figure() != "contact_temperature_kelvin") {
      continue;
    }
    ++found;
    SCOPED_TRACE(each.figure());
    EXPECT_NEAR(each.value().linear_standard_uncertainty(), change, 0.1 * change);
    EXPECT_NEAR(each.value().standard_uncertainty(), change, 0.15 * change);
    EXPECT_LT(each.value().interval_minimum(), value);
    EXPECT_GT(each.value().interval_maximum(), value);
  }
  EXPECT_EQ(found, 3);
  const auto without =
      evaluate_contact(request, exact_seed<v1::Lubricant>("lubricants/paper-fluid-1"));
  EXPECT_EQ(without.uncertainties_size(), 0);
  EXPECT_THAT(without.inputs_without_uncertainty(),
              testing::Contains("lubricant.relaxation_time_seconds"));
}

/// The data sheet of an oil whose viscosity at 100 C the shear test lowers by a tenth.
v1::Lubricant sheared_data_sheet() {
  auto out = data_sheet(103, 15.1);
  out.mutable_measurements()
      ->set_sheared_kinematic_viscosity_100_celsius_square_millimetres_per_second(13.59);
  return out;
}

TEST(ShearedLubricant, HasItsViscositiesTimesTheLossOfTheShearTest) {
  const v1::Lubricant fresh = sheared_data_sheet();
  const auto sheared = sheared_lubricant(fresh);
  ASSERT_TRUE(sheared);
  EXPECT_EQ(sheared->condition(), v1::Lubricant::SHEARED);
  for (const auto kinematic : {&v1::LubricantCharacterisation::
                                   kinematic_viscosity_40_celsius_square_millimetres_per_second,
                               &v1::LubricantCharacterisation::
                                   kinematic_viscosity_100_celsius_square_millimetres_per_second}) {
    EXPECT_NEAR((brief_characterisation(*sheared).*kinematic)(),
                0.9 * (brief_characterisation(fresh).*kinematic)(), 1e-9);
  }
  const auto fit = viscosity_fit(*sheared);
  ASSERT_TRUE(fit) << "draws of its inputs start from the fit";
  EXPECT_NEAR(fit->viscosity_prefactor / sheared->vogel_viscosity_prefactor_pascal_seconds(), 1,
              1e-9);
  auto stated = exact_seed<v1::Lubricant>("lubricants/paper-fluid-1");
  stated.mutable_measurements()
      ->set_sheared_kinematic_viscosity_100_celsius_square_millimetres_per_second(14);
  EXPECT_LT(sheared_lubricant(stated)->vogel_viscosity_prefactor_pascal_seconds(),
            stated.vogel_viscosity_prefactor_pascal_seconds());
  EXPECT_FALSE(sheared_lubricant(data_sheet(103, 15.1))) << "no measurement after the test";
}

TEST(ShearedLubricant, IsComputedWhereItIsAskedForAndRefusedWithoutTheMeasurement) {
  Fluids fluids;
  fluids.add("lubricants/fresh", sheared_data_sheet());
  fluids.add("lubricants/sheared", *sheared_lubricant(sheared_data_sheet()));
  fluids.add("lubricants/unknown", data_sheet(103, 15.1));
  auto request = request_at({60}, {"lubricants/sheared"});
  request.set_draws(19);
  const auto expected = compare(request, fluids).lubricants(0).points(0);
  request = request_at({60}, {"lubricants/fresh"});
  request.set_draws(19);
  const auto fresh = compare(request, fluids).lubricants(0).points(0);
  request.set_sheared_lubricant(true);
  const auto out = compare(request, fluids).lubricants(0).points(0);
  const auto& figure = out.inefficiency_energy_mean_percent();
  EXPECT_NEAR(figure.value(), expected.inefficiency_energy_mean_percent().value(), 1e-6);
  EXPECT_NEAR(figure.standard_uncertainty(),
              expected.inefficiency_energy_mean_percent().standard_uncertainty(), 1e-4);
  EXPECT_GT(std::abs(figure.value() - fresh.inefficiency_energy_mean_percent().value()), 1e-3);
  request.add_lubricants("lubricants/unknown");
  Violations violations;
  EXPECT_FALSE(read_comparison(request, fluids.lookup(), violations));
  ASSERT_EQ(violations.size(), 1U);
  EXPECT_EQ(violations.begin()->field, "sheared_lubricant");
  EXPECT_THAT(violations.begin()->description,
              HasSubstr("lubricants/unknown@1 states no viscosity after the shear test"));
}

TEST(ShearedLubricant, OfASimulationChangesItsHashAndNoOther) {
  Fluids fluids;
  fluids.add("lubricants/oil", sheared_data_sheet());
  v1::Simulation simulation;
  simulation.set_lubricant("lubricants/oil");
  simulation.mutable_operating_point()->mutable_cruise()->set_speed_kilometres_per_hour(60);
  Violations violations;
  const auto fresh = read_simulation(simulation, fluids.lookup(), "", violations);
  simulation.set_sheared_lubricant(true);
  const auto sheared = read_simulation(simulation, fluids.lookup(), "", violations);
  ASSERT_TRUE(fresh && sheared);
  EXPECT_NE(input_hash(*fresh), input_hash(*sheared));
  EXPECT_THAT(canonical_inputs(*fresh), testing::Not(HasSubstr("sheared")));
}

TEST(ComparePoints, EqualRequestsHaveEqualAnswersWhicheverLubricantsComeWithThem) {
  Fluids fluids;
  fluids.add("lubricants/a", fluid_with_alpha());
  fluids.add("lubricants/b", fluid_with_alpha(1.1));
  const auto once = compare(request_at({66}, {"lubricants/a", "lubricants/b"}), fluids);
  const auto again = compare(request_at({66}, {"lubricants/a", "lubricants/b"}), fluids);
  EXPECT_EQ(once.SerializeAsString(), again.SerializeAsString());
  const auto alone = compare(request_at({66}, {"lubricants/a"}), fluids);
  const auto without_rank = [](v1::ComparedLubricant lubricant) {
    lubricant.clear_mean_difference_from_best();
    lubricant.clear_best_probability();
    return lubricant.SerializeAsString();
  };
  EXPECT_EQ(without_rank(alone.lubricants(0)), without_rank(once.lubricants(0)));
}

TEST(ComparePoints, RefusesWhatItCannotCompareAndNamesTheField) {
  EXPECT_THAT(violations_of(request_at({50}, {})), HasSubstr("lubricants: 0 lubricants"));
  EXPECT_THAT(violations_of(request_at({50}, {"lubricants/paper-fluid-1", "lubricants/no"})),
              HasSubstr("lubricants[1]: "));
  EXPECT_THAT(violations_of(request_at({}, {"lubricants/paper-fluid-1"})),
              HasSubstr("conditions: "));
  auto weighed = request_at({50, 60}, {"lubricants/paper-fluid-1"});
  weighed.add_condition_weights(1);
  EXPECT_THAT(violations_of(weighed), HasSubstr("condition_weights: 1 weights of 2 conditions"));
  auto large = request_at(std::vector<double>(100, 50), {"lubricants/paper-fluid-1"});
  EXPECT_THAT(violations_of(large), HasSubstr("20000 points; allowed: at most 10000"));
  auto fast = request_at({5000}, {"lubricants/paper-fluid-1"});
  EXPECT_THAT(violations_of(fast), HasSubstr("conditions[0].speed_kilometres_per_hour: "));
}

TEST(ComparePoints, StopsWhenItsCallIsOver) {
  Violations violations;
  Fluids fluids;
  fluids.add("lubricants/a", fluid_with_alpha());
  const auto comparison =
      read_comparison(request_at({50}, {"lubricants/a"}), fluids.lookup(), violations);
  PreparedGearSets gear_sets;
  int calls = 0;
  EXPECT_THROW(compare_points(*comparison, gear_sets, [&calls] { return ++calls > 3; }), Cancelled);
  EXPECT_LT(calls, 20);
}

/// Speeds of a coverage test [km/h].
struct SpeedRange {
  const char* name;
  double low, high;
};

/// How many intervals hold the truth.
struct Coverage {
  int point = 0, mean = 0, difference = 0, film_ratio = 0, transmission_error = 0,
      friction_coefficient = 0;
};

class IntervalCoverage : public testing::TestWithParam<SpeedRange> {
 protected:
  static int holds(const v1::UncertainFigure& figure, double truth) {
    return figure.interval_minimum() <= truth && truth <= figure.interval_maximum() ? 1 : 0;
  }
  /// Draws true inputs, measures them with errors, and computes the truth as a simulation does.
  void add_case() {
    const MeasuredFluid a = measured_fluid(random_), b = measured_fluid(random_);
    Fluids fluids;
    fluids.add("lubricants/a", a.measured);
    fluids.add("lubricants/b", b.measured);
    // At six speeds most draws are not solved, but follow from those at other speeds.
    std::vector<double> speeds(kSpeeds);
    for (double& each : speeds) each = speed_(random_);
    const auto out = compare(request_at(speeds, {"lubricants/a", "lubricants/b"}), fluids);
    double mean_a = 0, mean_b = 0;
    for (const double each : speeds) {
      mean_a += true_inefficiency(a.truth, each) / kSpeeds;
      mean_b += true_inefficiency(b.truth, each) / kSpeeds;
    }
    const v1::ComparedLubricant& first = out.lubricants(0);
    const PointResult truth = simulated(a.truth, speeds[0]);
    coverage_.point += holds(first.points(0).inefficiency_energy_mean_percent(),
                             truth.inefficiency_energy_mean.value());
    coverage_.mean += holds(first.mean_inefficiency_percent(), mean_a);
    coverage_.difference +=
        holds(out.lubricants(1).mean_difference().difference_percent(), mean_b - mean_a);
    if (!full_run()) return;
    auto request = request_at({speeds[0]}, {"lubricants/a"});
    request.set_contact_figures(true);
    const auto contact = compare(request, fluids).lubricants(0).points(0);
    coverage_.film_ratio += holds(contact.film_ratio_minimum(), truth.film_ratio.minimum);
    coverage_.transmission_error += holds(contact.dynamic_transmission_error_maximum_metres(),
                                          truth.dynamic_transmission_error.maximum);
    coverage_.friction_coefficient +=
        holds(contact.mesh_friction_coefficient(), truth.friction_coefficient.mean);
  }

  static constexpr int kSpeeds = 6;
  std::mt19937_64 random_{19};
  std::uniform_real_distribution<double> speed_{GetParam().low, GetParam().high};
  Coverage coverage_;
};

/// In the full run 1000 cases each: a point, the mean of a curve, a difference, and extremes.
TEST_P(IntervalCoverage, IsNinetyFivePercent) {
  const int cases = full_run() ? 1000 : kUnderSanitizer ? 2 : 40;
  for (int i = 0; i < cases; ++i) add_case();
  // A true coverage of 95 % gives less than these in one run of a thousand.
  const double least = full_run() ? 0.93 : 0.825, most = full_run() ? 0.97 : 1;
  std::vector<std::pair<const char*, int>> counts = {
      {"point", coverage_.point}, {"mean", coverage_.mean}, {"difference", coverage_.difference}};
  if (full_run()) {
    counts.insert(counts.end(), {{"film_ratio", coverage_.film_ratio},
                                 {"transmission_error", coverage_.transmission_error},
                                 {"friction_coefficient", coverage_.friction_coefficient}});
  }
  for (const auto& [name, count] : counts) {
    SCOPED_TRACE(name);
    const double coverage = static_cast<double>(count) / cases;
    RecordProperty(name, std::to_string(coverage));
    if (kUnderSanitizer) continue;
    EXPECT_GE(coverage, least);
    EXPECT_LE(coverage, most);
  }
}

INSTANTIATE_TEST_SUITE_P(Speeds, IntervalCoverage,
                         testing::Values(SpeedRange{"All", 25, 130},
                                         SpeedRange{"VibroImpact", 66, 80}),
                         [](const auto& range) { return range.param.name; });

}  // namespace
}  // namespace tribodyn::server
