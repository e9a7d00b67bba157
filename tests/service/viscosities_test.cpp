// EvaluateViscosity: the laws of a lubricant over temperature and pressure.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "core/lubricant/comparison.h"
#include "core/lubricant/pressure_response.h"
#include "core/refusal.h"
#include "server/mapping/to_core.h"
#include "server/simulation/viscosity_evaluation.h"
#include "tests/service/support.h"

namespace tribodyn::server {
namespace {

using testing::HasSubstr;

v1::EvaluateViscosityRequest viscosity_request() {
  v1::EvaluateViscosityRequest out;
  out.set_lubricant("lubricants/paper-fluid-1");
  for (const double celsius : {40.0, 70.0, 100.0}) out.add_temperatures_celsius(celsius);
  for (const double pressure : {0.0, 1e9}) out.add_pressures_pascals(pressure);
  return out;
}

v1::EvaluateViscosityResponse run_viscosity(const v1::EvaluateViscosityRequest& request) {
  Violations violations;
  const auto evaluation = read_viscosity(request, seed_lookup(), violations);
  if (!evaluation) throw std::runtime_error(violations.front().description);
  return evaluate_viscosity(request, *evaluation, [] { return false; });
}

TEST(EvaluateViscosity, FiguresAreThoseByWhichLubricantsAreCompared) {
  const v1::EvaluateViscosityResponse out = run_viscosity(viscosity_request());
  const LubricantFigures figures =
      lubricant_figures(to_core(seed<v1::Lubricant>("lubricants/paper-fluid-1")), {});
  ASSERT_EQ(out.ambient_dynamic_viscosity_pascal_seconds_size(), 3);
  ASSERT_EQ(out.dynamic_viscosity_pascal_seconds_size(), 6);
  for (int i = 0; i < 3; ++i) {
    const auto& at = figures.at[static_cast<std::size_t>(i)];
    EXPECT_NEAR(out.ambient_dynamic_viscosity_pascal_seconds(i) / at.viscosity, 1, 1e-14);
    EXPECT_NEAR(
        out.pressure_viscosity_coefficient_per_pascal(i) / at.pressure_viscosity_coefficient, 1,
        1e-14);
    EXPECT_EQ(out.dynamic_viscosity_pascal_seconds(2 * i),
              out.ambient_dynamic_viscosity_pascal_seconds(i));
    EXPECT_NEAR(out.dynamic_viscosity_pascal_seconds(2 * i + 1) / at.viscosity_at_gigapascal, 1,
                1e-14);
  }
  EXPECT_NEAR(out.ambient_kinematic_viscosity_square_millimetres_per_second(0) /
                  (1e6 * figures.kinematic_viscosity_40),
              1, 1e-14);
  EXPECT_NEAR(out.ambient_density_kilograms_per_cubic_metre(0), 1016.1 - 0.6323 * 313.15, 1e-9);
  EXPECT_EQ(out.lubricant_revision(), "lubricants/paper-fluid-1@1");
}

TEST(EvaluateViscosity, ATemperatureAtWhichALawDoesNotHoldIsRefusedBesideOthers) {
  v1::EvaluateViscosityRequest request = viscosity_request();
  auto& oil = *request.mutable_lubricant_parameters();
  oil = seed<v1::Lubricant>("lubricants/paper-fluid-1");
  oil.set_vogel_reference_temperature_kelvin(230);
  request.set_temperatures_celsius(1, -60);
  const v1::EvaluateViscosityResponse out = run_viscosity(request);
  EXPECT_EQ(out.refusal_numbers(0), 0);
  EXPECT_EQ(out.refusal_numbers(1), 1);
  EXPECT_EQ(out.refusals(0).reason(), "BELOW_VOGEL_TEMPERATURE");
  EXPECT_TRUE(std::isnan(out.dynamic_viscosity_pascal_seconds(2)));
  EXPECT_TRUE(std::isnan(out.ambient_density_kilograms_per_cubic_metre(1)));
  EXPECT_TRUE(std::isfinite(out.dynamic_viscosity_pascal_seconds(4)));
  EXPECT_EQ(out.lubricant_revision(), "");
}

TEST(EvaluateViscosity, FollowsTheIndexOfTheRequest) {
  v1::EvaluateViscosityRequest request = viscosity_request();
  const double usual = run_viscosity(request).pressure_viscosity_coefficient_per_pascal(0);
  request.mutable_model_options()->set_pressure_viscosity_index(
      v1::ModelOptions::PRESSURE_VISCOSITY_INDEX_HOUPERT);
  EXPECT_NEAR(usual, 1.609e-8, 1e-20);
  EXPECT_NE(run_viscosity(request).dynamic_viscosity_pascal_seconds(1),
            run_viscosity(viscosity_request()).dynamic_viscosity_pascal_seconds(1));
}

TEST(EvaluateViscosity, NamesAllThatIsWrong) {
  const auto wrong = [](const v1::EvaluateViscosityRequest& request) {
    Violations violations;
    read_viscosity(request, seed_lookup(), violations);
    std::string out;
    for (const Violation& each : violations) out += each.field + ": " + each.description + "\n";
    return out;
  };
  const std::string empty = wrong({});
  EXPECT_THAT(empty, HasSubstr("temperatures_celsius: not set; allowed: at least one"));
  EXPECT_THAT(empty, HasSubstr("fluid: not set; allowed: lubricant or lubricant_parameters"));
  v1::EvaluateViscosityRequest request = viscosity_request();
  request.set_lubricant("lubricants/paper-fluid-11");
  while (request.temperatures_celsius_size() < 1000) request.add_temperatures_celsius(50);
  while (request.pressures_pascals_size() < 101) request.add_pressures_pascals(1e9);
  EXPECT_THAT(wrong(request), HasSubstr("1000 temperatures x 101 pressures; allowed: at most "
                                        "100000 combinations"));
  EXPECT_THAT(wrong(request), HasSubstr("did you mean \"lubricants/paper-fluid-1\"?"));
}

TEST(EvaluateViscosity, StopsWhenItsCallIsOver) {
  Violations violations;
  const auto request = viscosity_request();
  const auto evaluation = read_viscosity(request, seed_lookup(), violations);
  EXPECT_THROW(evaluate_viscosity(request, *evaluation, [] { return true; }), Cancelled);
}

}  // namespace
}  // namespace tribodyn::server
