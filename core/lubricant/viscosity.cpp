#include "core/lubricant/viscosity.h"

#include <cmath>
#include <string>

#include "core/laws/laws.h"
#include "core/number_text.h"
#include "core/numerics/bracketed_root.h"
#include "core/refusal.h"

namespace tribodyn {

double ambient_viscosity(const Lubricant& lubricant, double temperature) {
  return std::exp(log_ambient_viscosity(lubricant, temperature));
}

double log_viscosity_under_pressure(double log_ambient_viscosity, double factor, double index,
                                    double pressure) {
  return laws::log_under_pressure(
      log_ambient_viscosity, factor,
      std::expm1(index * std::log1p(laws::kRoelandsPressureCoefficient * pressure)));
}

double index_from_reciprocal_asymptotic(double factor, double coefficient) {
  constexpr double kLow = 0.05, kHigh = 3;
  const auto excess = [&](double index) {
    using Number = laws::Dual<double, 1>;
    const Number at =
        laws::roelands_reciprocal_asymptotic(Number(factor), Number::variable(index, 0));
    return ValueAndSlope{at.value / coefficient - 1, at.slope[0] / coefficient};
  };
  if (factor > 0 && coefficient > 0) {
    const double start = laws::houpert_index(factor, coefficient);
    const double index = safeguarded_newton(excess, kLow, kHigh, start, true, 1e-9);
    if (std::abs(excess(index).value) < 1e-9) return index;
  }
  throw Refusal("PRESSURE_VISCOSITY_INDEX",
                "no Roelands index Z in [0.05, 3] gives a pressure-viscosity coefficient of " +
                    std::to_string(coefficient * 1e9) +
                    " 1/GPa back by eq 33 (ln eta_0 + 9.67 = " + std::to_string(factor) + ")");
}

void check_above_vogel(const Lubricant& lubricant, double temperature, const char* what) {
  const double vogel = lubricant.vogel_reference_temperature;
  if (temperature > vogel) return;
  throw Refusal("BELOW_VOGEL_TEMPERATURE", std::string(what) + " of " + celsius_text(temperature) +
                                               " is not above the Vogel reference temperature of " +
                                               celsius_text(vogel) +
                                               ": eq 34 has no viscosity there");
}

void check_ambient_viscosity(const Lubricant& lubricant, double temperature, const char* what) {
  const double viscosity = ambient_viscosity(lubricant, temperature);
  if (viscosity <= kGreatestAmbientViscosity && std::isnormal(viscosity)) return;
  const double vogel = lubricant.vogel_reference_temperature;
  throw Refusal("VISCOSITY_OUT_OF_RANGE",
                "eq 34 (Vogel) gives " + number_text(viscosity, 3) + " Pa s at " + what + " of " +
                    celsius_text(temperature) + ", allowed: positive and at most " +
                    number_text(kGreatestAmbientViscosity) +
                    " Pa s, beyond which no oil flows; check the reference temperature T_0 of " +
                    celsius_text(vogel) + ", which is " + number_text(temperature - vogel, 3) +
                    " K below, the coefficient A_1 of " +
                    number_text(lubricant.vogel_temperature_coefficient) +
                    " K and the unit of the prefactor of " +
                    number_text(lubricant.vogel_viscosity_prefactor) + " Pa s");
}

void check_pressure_growth(const Lubricant& lubricant, double temperature,
                           const AsPublished& as_published) {
  if (lubricant.pressure_viscosity_law != PressureViscosityLaw::kRoelands) {
    check_greatest_viscosity(lubricant, temperature);
  } else if (!(roelands_factor(log_ambient_viscosity(lubricant, temperature), as_published) > 0)) {
    throw Refusal("ROELANDS_FACTOR",
                  "ln eta_0 + 9.67 of eq 31 is not positive: the fluid is too thin for the law");
  }
}

void check_greatest_viscosity(const Lubricant& lubricant, double temperature) {
  constexpr double kLeastLogGrowth = 16;
  const double greatest = laws::log_greatest_viscosity(lubricant);
  if (greatest - log_ambient_viscosity(lubricant, temperature) >= kLeastLogGrowth) return;
  throw Refusal("PARAMETER_OUT_OF_RANGE",
                "the pressure-viscosity law is too near its glass transition: the viscosity of " +
                    number_text(ambient_viscosity(lubricant, temperature)) + " Pa s at " +
                    celsius_text(temperature) +
                    " must be at least e^16 times below the greatest one, " +
                    number_text(std::exp(greatest)) + " Pa s");
}

}  // namespace tribodyn
