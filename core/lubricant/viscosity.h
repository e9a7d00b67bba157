#pragma once

#include "core/laws/laws.h"
#include "core/laws/lubricant.h"
#include "core/model_options.h"
#include "core/numerics/gauss_legendre.h"

namespace tribodyn {

// Real is double, or a dual number for the derivatives.

/// ln eta_0(T), eq 34 (Vogel 1921), and its derivative by T [1/K]. eta in Pa s, temperature in K.
/// Valid for temperature > T_0,ref; +inf or meaningless at or below it: callers check.
template <class Real>
laws::WithSlope<Real> log_ambient_viscosity_and_slope(const LubricantOf<Real>& oil,
                                                      const Real& temperature) {
  return laws::log_vogel_viscosity(laws::logarithm(oil.vogel_viscosity_prefactor),
                                   oil.vogel_temperature_coefficient,
                                   oil.vogel_reference_temperature, temperature);
}
template <class Real>
Real log_ambient_viscosity(const LubricantOf<Real>& oil, const Real& temperature) {
  return log_ambient_viscosity_and_slope(oil, temperature).value;
}

/// eta_0(T) [Pa s], eq 34.
double ambient_viscosity(const Lubricant& lubricant, double temperature);

/// rho(T) [kg/m3], eq 26: linear in temperature [K]. Negative beyond intercept/|slope|.
template <class Real>
Real density(const LubricantOf<Real>& oil, const Real& temperature) {
  return laws::linear_density(oil.density_at_zero_kelvin, oil.density_temperature_slope,
                              temperature);
}

/// The factor of eqs 31 and 32 that multiplies Z: ln eta_0 + 9.67 (Roelands 1966), or, as printed,
/// ln(eta_0 + 9.67). Argument: ln of eta_0 in Pa s.
template <class Real>
Real roelands_factor(const Real& log_ambient_viscosity, const AsPublished& as_published) {
  return as_published.eq31_32_logarithm ? laws::roelands_factor_as_published(log_ambient_viscosity)
                                        : laws::roelands_factor(log_ambient_viscosity);
}

/// ln eta(p) [Pa s] of eq 31 from ln eta_0, the factor above, Z and the pressure [Pa] >= 0.
double log_viscosity_under_pressure(double log_ambient_viscosity, double factor, double index,
                                    double pressure);

/// Z such that eq 33 gives alpha* back at the factor L (bracketed root, to machine precision).
/// Throws Refusal PRESSURE_VISCOSITY_INDEX when no Z in [0.05, 3] does or L is not positive.
double index_from_reciprocal_asymptotic(double factor, double coefficient);

/// Throws Refusal BELOW_VOGEL_TEMPERATURE if a temperature [K] is not above T_0,ref. `what`: such
/// as "an inlet temperature".
void check_above_vogel(const Lubricant& lubricant, double temperature, const char* what);

/// The greatest ambient viscosity of a contact's oil [Pa s]: a thousand times that at which gear
/// oils stop flowing (some 1e3 Pa s at the pour point of ASTM D97), where eq 12 would extrapolate
/// to films of centimetres. Under pressure the viscosity may be any.
inline constexpr double kGreatestAmbientViscosity = 1e6;

/// Throws Refusal VISCOSITY_OUT_OF_RANGE if eq 34 gives more than kGreatestAmbientViscosity at a
/// temperature [K] above T_0,ref, or less than the least normal number. `what`: as above.
void check_ambient_viscosity(const Lubricant& lubricant, double temperature, const char* what);

/// Throws Refusal ROELANDS_FACTOR or PARAMETER_OUT_OF_RANGE (check_greatest_viscosity) if the
/// pressure-viscosity law does not hold at a temperature [K] above T_0,ref.
void check_pressure_growth(const Lubricant& lubricant, double temperature,
                           const AsPublished& as_published);

/// Throws Refusal PARAMETER_OUT_OF_RANGE if the viscosity at a temperature [K] is less than e^16
/// times below the greatest one of its law, such as that of the glass transition: the growth with
/// pressure then ends before alpha* has four digits.
void check_greatest_viscosity(const Lubricant& lubricant, double temperature);

/// alpha* [1/Pa], the inverse of int_0^inf eta(0)/eta(p) dp, of a law other than eq 31 at a
/// temperature [K] that check_greatest_viscosity accepts. By Gauss's rule of 16 points over
/// panels in which the integrand falls by at most 4 e-folds, until it has fallen by 40 or the
/// pressure has reached the end of the growth; what lies beyond is left out, where the integrand is
/// below e^-16. Relative error of the rest below 1e-9.
template <class Real>
Real reciprocal_asymptotic_of_growth(const GrowthLaw<Real>& law, const Real& temperature) {
  constexpr int kNodes = 16;
  constexpr double kLogGrowthPerPanel = 4, kMostLogGrowth = 40, kSmallPressure = 1e6;
  const auto& rule = gauss_legendre<kNodes>();
  const auto growth = [&](double pressure) {
    return laws::pressure_growth(law, temperature, Real(pressure));
  };
  const double panel = kLogGrowthPerPanel * kSmallPressure / laws::value_of(growth(kSmallPressure));
  Real integral = 0.0;
  double log_growth = 0;
  for (double from = 0; log_growth < kMostLogGrowth; from += panel) {
    for (int n = 0; n < kNodes; ++n) {
      integral = integral +
                 panel * rule.weight(n) * laws::exponential(-growth(from + panel * rule.node(n)));
    }
    const double before = log_growth;
    log_growth = laws::value_of(growth(from + panel));
    if (!(log_growth > before + 1e-3)) break;
  }
  return 1 / integral;
}

/// The same with derivatives: first by the kGrowthArguments arguments of the growth, then by the
/// chain rule.
template <int kCount>
laws::Dual<double, kCount> reciprocal_asymptotic_of_growth(
    const GrowthLaw<laws::Dual<double, kCount>>& law,
    const laws::Dual<double, kCount>& temperature) {
  using Number = laws::Dual<double, kGrowthArguments>;
  const Number by_arguments = reciprocal_asymptotic_of_growth<Number>(
      laws::by_its_parameters<Number>(law), Number::variable(temperature.value, 0));
  auto out = laws::chained(by_arguments.value, by_arguments.slope[0], temperature);
  for (int k = 0; k < kGrowthParameters; ++k) {
    out = out + laws::chained(0.0, by_arguments.slope[1 + k], law.parameters[k]);
  }
  return out;
}

}  // namespace tribodyn
