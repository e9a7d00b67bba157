// Viscosity under pressure by either law, against closed forms and quadrature.
#include "core/lubricant/pressure_response.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/lubricant/viscosity.h"
#include "core/refusal.h"
#include "tests/support/improved_yasutomi.h"
#include "tests/support/reference_scene.h"

namespace tribodyn {
namespace {

Lubricant roelands_oil() { return reference_lubricant(1); }

Lubricant yasutomi_oil() {
  Lubricant out = roelands_oil();
  set_yasutomi(gear_oil_80w90(), out);
  return out;
}

/// 1/int_0^inf eta(0)/eta(p) dp by the trapezoidal rule in u, p = u^2/(1 - u).
double alpha_by_quadrature(const PressureResponse& response, double temperature) {
  constexpr int kSteps = 20'000;
  double integral = 0;
  for (int i = 1; i < kSteps; ++i) {
    const double u = static_cast<double>(i) / kSteps;
    const double pressure = 1e8 * u * u / (1 - u);
    const double slope = 1e8 * (2 * u - u * u) / ((1 - u) * (1 - u));
    integral += std::exp(-response.log_growth(temperature, pressure)) * slope / kSteps;
  }
  return 1 / integral;
}

TEST(PressureResponse, TheCoefficientIsTheInverseOfTheIntegralOfTheFluidityRatio) {
  for (const Lubricant& oil : {roelands_oil(), yasutomi_oil()}) {
    const PressureResponse response(oil, {});
    for (const double temperature : {303.0, 313.15, 373.0}) {
      const double coefficient = response.coefficient(temperature);
      EXPECT_NEAR(alpha_by_quadrature(response, temperature) / coefficient, 1, 1e-5);
    }
  }
}

TEST(PressureResponse, RoelandsGivesTheMeasuredCoefficientBack) {
  const Lubricant oil = roelands_oil();
  EXPECT_NEAR(PressureResponse(oil, {}).coefficient(oil.pressure_viscosity_temperature) /
                  oil.pressure_viscosity_coefficient,
              1, 1e-12);
}

TEST(PressureResponse, RefusesTemperaturesWhereALawDoesNotHold) {
  const Lubricant oil = roelands_oil();
  const auto reason = [](const Lubricant& of, double temperature) -> std::string {
    try {
      PressureResponse(of, {}).check_at(temperature);
    } catch (const Refusal& refusal) {
      return refusal.reason();
    }
    return "";
  };
  EXPECT_EQ(reason(oil, 313), "");
  EXPECT_EQ(reason(oil, oil.vogel_reference_temperature), "BELOW_VOGEL_TEMPERATURE");
  Lubricant thin = oil;
  thin.vogel_viscosity_prefactor = 1e-6;
  thin.pressure_viscosity_temperature = 220;
  EXPECT_EQ(reason(thin, 1e4), "ROELANDS_FACTOR");
  const Lubricant glassy = yasutomi_oil();
  EXPECT_EQ(reason(glassy, glassy.vogel_reference_temperature + 20), "PARAMETER_OUT_OF_RANGE");
}

}  // namespace
}  // namespace tribodyn
