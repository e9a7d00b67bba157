#include "core/lubricant/viscosity.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/numerics/bracketed_root.h"
#include "core/refusal.h"

namespace tribodyn {

double log_ambient_viscosity(const Lubricant& lubricant, double temperature) {
  return std::log(lubricant.vogel_viscosity_prefactor) +
         lubricant.vogel_temperature_coefficient /
             (temperature - lubricant.vogel_reference_temperature);
}

double ambient_viscosity(const Lubricant& lubricant, double temperature) {
  return std::exp(log_ambient_viscosity(lubricant, temperature));
}

double density(const Lubricant& lubricant, double temperature) {
  return lubricant.density_at_zero_kelvin + lubricant.density_temperature_slope * temperature;
}

double roelands_factor(double log_ambient_viscosity, const AsPublished& as_published) {
  return as_published.eq31_32_logarithm
             ? std::log(std::exp(log_ambient_viscosity) + kRoelandsLogViscosity)
             : log_ambient_viscosity + kRoelandsLogViscosity;
}

double log_viscosity_under_pressure(double log_ambient_viscosity, double factor, double index,
                                    double pressure) {
  return log_ambient_viscosity +
         factor * std::expm1(index * std::log1p(kRoelandsPressureCoefficient * pressure));
}

namespace {

/// e^L L^(1-s) Gamma(s, L) and its derivative by s, of the upper incomplete gamma function.
/// For s in (0, 1] by Legendre's continued fraction, whose denominators are all positive there;
/// then upwards by Gamma(s + 1, L) = s Gamma(s, L) + L^s e^-L, in which all terms are. The error of
/// n terms falls as exp(-4 sqrt(n L)): 4 + 85/L of them leave 1e-14.
ValueAndSlope scaled_incomplete_gamma(double l, double s) {
  const int steps = std::max(0, static_cast<int>(std::ceil(s)) - 1);
  double order = s - steps;
  constexpr double kLeast = 0.01;  // bounds the work
  const int terms = 4 + static_cast<int>(85 / std::max(l, kLeast));
  double denominator = l + 2 * terms + 1 - order, slope = -1;
  for (int k = terms; k > 0; --k) {
    const double quotient = k * (k - order) / denominator;
    slope = (k + quotient * slope) / denominator - 1;
    denominator = l + 2 * k - 1 - order - quotient;
  }
  ValueAndSlope out{l / denominator, -l * slope / (denominator * denominator)};
  for (int k = 0; k < steps; ++k, ++order) {
    out = {1 + order / l * out.value, (out.value + order * out.slope) / l};
  }
  return out;
}

/// Eq 33 at one L, in closed form: alpha* = Z c e^-L L^(1/Z)/Gamma(1/Z, L) [1/Pa], and its
/// derivative by Z.
ValueAndSlope reciprocal_asymptotic(double factor, double index) {
  const ValueAndSlope integral = scaled_incomplete_gamma(factor, 1 / index);
  const double coefficient = index * kRoelandsPressureCoefficient * factor / integral.value;
  return {coefficient,
          coefficient * (1 / index + integral.slope / (integral.value * index * index))};
}

}  // namespace

double reciprocal_asymptotic_coefficient(double factor, double index) {
  return reciprocal_asymptotic(factor, index).value;
}

double index_from_reciprocal_asymptotic(double factor, double coefficient) {
  constexpr double kLow = 0.05, kHigh = 3;
  const auto excess = [&](double index) {
    const ValueAndSlope at = reciprocal_asymptotic(factor, index);
    return ValueAndSlope{at.value / coefficient - 1, at.slope / coefficient};
  };
  if (factor > 0 && coefficient > 0) {
    const double start = index_from_houpert(factor, coefficient);
    const double index = safeguarded_newton(excess, kLow, kHigh, start, true, 1e-9);
    if (std::abs(excess(index).value) < 1e-9) return index;
  }
  throw Refusal("PRESSURE_VISCOSITY_INDEX",
                "no Roelands index Z in [0.05, 3] gives a pressure-viscosity coefficient of " +
                    std::to_string(coefficient * 1e9) +
                    " 1/GPa back by eq 33 (ln eta_0 + 9.67 = " + std::to_string(factor) + ")");
}

double index_from_houpert(double factor, double coefficient) {
  return coefficient / (kRoelandsPressureCoefficient * factor);
}

}  // namespace tribodyn
