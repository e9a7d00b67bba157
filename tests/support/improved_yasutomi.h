#pragma once

#include <cmath>
#include <numbers>

#include "core/celsius.h"
#include "core/laws/lubricant.h"

namespace tribodyn {

/// The improved Yasutomi law as it is printed: T_g = T_g0 + A_1 ln(1 + A_2 p), F = (1 + b_1 p)^b_2,
/// lg(eta/eta_g) = -C_1 (T - T_g) F/(C_2 + (T - T_g) F). SI units.
struct PrintedYasutomi {
  double glass_temperature;                            ///< T_g0 [K]
  double c1, c2;                                       ///< [-], [K]
  std::array<double, kMostLawParameters> of_pressure;  ///< by ImprovedYasutomiParameter

  double log_viscosity(double pressure, double temperature) const {
    const auto& law = of_pressure;
    const double glass = glass_temperature + law[kGlassTemperatureRise] *
                                                 std::log(1 + law[kGlassPressureFactor] * pressure);
    const double scaled =
        (temperature - glass) *
        std::pow(1 + law[kExpansivityPressureFactor] * pressure, law[kExpansivityExponent]);
    return std::log(law[kGlassViscosity]) - std::numbers::ln10 * c1 * scaled / (c2 + scaled);
  }
};

/// The printed form of a lubricant's law.
inline PrintedYasutomi printed_yasutomi(const Lubricant& oil) {
  const double span = std::log(oil.law_parameters[kGlassViscosity] / oil.vogel_viscosity_prefactor);
  const double c2 = oil.vogel_temperature_coefficient / span;
  return {oil.vogel_reference_temperature + c2, span / std::numbers::ln10, c2, oil.law_parameters};
}

/// Gives a lubricant the law.
inline void set_yasutomi(const PrintedYasutomi& law, Lubricant& oil) {
  oil.vogel_viscosity_prefactor =
      law.of_pressure[kGlassViscosity] * std::pow(10, -law.c1);  // eq 34 at infinite temperature
  oil.vogel_temperature_coefficient = std::numbers::ln10 * law.c1 * law.c2;
  oil.vogel_reference_temperature = law.glass_temperature - law.c2;
  oil.pressure_viscosity_law = PressureViscosityLaw::kImprovedYasutomi;
  oil.law_parameters = law.of_pressure;
}

/// An SAE 80W-90 gear oil (S. Bair, High Pressure Rheology for Quantitative Elastohydrodynamics,
/// 2nd ed., 2019).
inline PrintedYasutomi gear_oil_80w90() {
  return {kZeroCelsius - 71.7, 16.372, 29.99, {1e12, 210.6, 0.455e-9, 7.606e-9, -0.4193}};
}

}  // namespace tribodyn
