// Growth of viscosity with pressure by laws other than eq 31.
// Templates on their number type, compiled per instruction set too: see core/laws/laws.h.
//
// One law more: its value of PressureViscosityLaw and the names of its parameters in
// core/laws/lubricant.h; its formula, the bounds below and a case in each of the four
// functions at the end of this file. All others take the law from those functions.
#if defined(TRIBODYN_CORE_LAWS_PRESSURE_GROWTH_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRIBODYN_CORE_LAWS_PRESSURE_GROWTH_INL_H_
#undef TRIBODYN_CORE_LAWS_PRESSURE_GROWTH_INL_H_
#else
#define TRIBODYN_CORE_LAWS_PRESSURE_GROWTH_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/laws/shear_law.h"
#include "core/numerics/real-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tribodyn {
namespace HWY_NAMESPACE {

/// C_2 [K] of the improved Yasutomi law: A_1/ln(eta_g/eta_ref), A_1 and eta_ref of eq 34.
template <class Parameter>
HWY_INLINE Parameter improved_yasutomi_width(const LubricantOf<Parameter>& oil,
                                             Parameter log_prefactor) {
  return oil.vogel_temperature_coefficient /
         (logarithm(oil.law_parameters[kGlassViscosity]) - log_prefactor);
}

/// ln eta(p, T) - ln eta_0(T) of the improved Yasutomi law (S. Bair, C. Mary, N. Bouscharain and
/// P. Vergne, Proc. IMechE J: J. Engineering Tribology 227 (2013) 1056-1060),
///   T_g = T_g(0) + A_1 ln(1 + A_2 p),  F = (1 + b_1 p)^b_2,
///   lg(eta/eta_g) = -C_1 (T - T_g) F/(C_2 + (T - T_g) F),
/// of the temperature T [K] and the pressure p [Pa] >= 0. At p = 0 the law is eq 34 with
/// T_0 = T_g(0) - C_2, A_1 = ln(10) C_1 C_2 and ln eta_ref = ln eta_g - ln(10) C_1, so that the
/// parameters of eq 34 stand for T_g(0), C_1 and C_2. The law holds above the glass transition:
/// where T < T_g the viscosity stays eta_g.
template <class Parameter, class Real>
HWY_INLINE Real improved_yasutomi_growth(const GrowthLaw<Parameter>& law, Real temperature,
                                         Real pressure) {
  const auto& parameter = law.parameters;
  const Real rise =
      parameter[kGlassTemperatureRise] * logarithm(parameter[kGlassPressureFactor] * pressure + 1);
  const Real factor = exponential(parameter[kExpansivityExponent] *
                                  logarithm(parameter[kExpansivityPressureFactor] * pressure + 1));
  const Real above_vogel = temperature - parameter[kVogelReference];
  const Real above_glass = greatest(above_vogel - parameter[kGlassWidth] - rise, 0);
  return parameter[kVogelCoefficient] / (above_glass * factor + parameter[kGlassWidth]) -
         parameter[kVogelCoefficient] / above_vogel;
}

/// A sufficient condition for pressure_growth_falls(). Above the glass transition the slope is
/// A_V (1/(T - T_0)^2 - F/D^2), D = C_2 + (T - T_g) F, and D <= F (T - T_0) + (1 - F) C_2: negative
/// if T - T_0 > C_2 (1 + F^-1/2), which holds at the lower pressures if at the highest.
HWY_INLINE bool improved_yasutomi_growth_falls(const GrowthLaw<double>& law, double temperature,
                                               double pressure) {
  const auto& parameter = law.parameters;
  const double per_root = std::pow(1 + parameter[kExpansivityPressureFactor] * pressure,
                                   -0.5 * parameter[kExpansivityExponent]);
  const double glass_rise =
      parameter[kGlassTemperatureRise] * std::log1p(parameter[kGlassPressureFactor] * pressure);
  const double above_vogel = temperature - parameter[kVogelReference];
  const double width = parameter[kGlassWidth];
  return above_vogel > width + glass_rise && above_vogel > width * (1 + per_root);
}

/// The law of a lubricant, from ln eta_ref of eq 34 too.
template <class Parameter>
HWY_INLINE GrowthLaw<Parameter> growth_law(const LubricantOf<Parameter>& oil,
                                           Parameter log_prefactor) {
  GrowthLaw<Parameter> out{oil.pressure_viscosity_law, {}};
  std::copy(oil.law_parameters.begin(), oil.law_parameters.end(), out.parameters.begin());
  out.parameters[kVogelCoefficient] = oil.vogel_temperature_coefficient;
  out.parameters[kVogelReference] = oil.vogel_reference_temperature;
  switch (oil.pressure_viscosity_law) {
    case PressureViscosityLaw::kRoelands:
      break;
    case PressureViscosityLaw::kImprovedYasutomi:
      out.parameters[kGlassWidth] = improved_yasutomi_width(oil, log_prefactor);
      break;
  }
  return out;
}

/// A law with derivatives by its parameters: the variables of Number from number 1 on, as far as
/// Number has them. Number 0 is for the temperature.
template <class Number, class Parameter>
HWY_INLINE GrowthLaw<Number> by_its_parameters(const GrowthLaw<Parameter>& law) {
  GrowthLaw<Number> out{law.law, {}};
  for (int k = 0; k < kGrowthParameters; ++k) {
    const double value = value_of(law.parameters[k]);
    out.parameters[k] = 1 + k < Number::kVariables ? Number::variable(value, 1 + k) : Number(value);
  }
  return out;
}

/// ln eta(p, T) - ln eta_0(T) of the temperature T [K] and the pressure p [Pa] >= 0; 0 by eq 31,
/// which has functions of its own in core/laws/viscosity-inl.h.
template <class Parameter, class Real>
HWY_INLINE Real pressure_growth(const GrowthLaw<Parameter>& law, Real temperature, Real pressure) {
  switch (law.law) {
    case PressureViscosityLaw::kRoelands:
      break;
    case PressureViscosityLaw::kImprovedYasutomi:
      return improved_yasutomi_growth(law, temperature, pressure);
  }
  return Real(0.0);
}

/// Returns true only if pressure_growth() falls with temperature at every pressure up to `pressure`
/// and every temperature from `temperature` on; false where that is not proved.
HWY_INLINE bool pressure_growth_falls(const GrowthLaw<double>& law, double temperature,
                                      double pressure) {
  switch (law.law) {
    case PressureViscosityLaw::kRoelands:
      return true;  // L of eq 31 falls with temperature
    case PressureViscosityLaw::kImprovedYasutomi:
      return improved_yasutomi_growth_falls(law, temperature, pressure);
  }
  return false;
}

/// ln of the upper bound of the viscosity [Pa s], such as eta_g; infinite if the law has no bound.
HWY_INLINE double log_greatest_viscosity(const LubricantOf<double>& oil) {
  switch (oil.pressure_viscosity_law) {
    case PressureViscosityLaw::kRoelands:
      break;
    case PressureViscosityLaw::kImprovedYasutomi:
      return std::log(oil.law_parameters[kGlassViscosity]);
  }
  return std::numeric_limits<double>::infinity();
}

}  // namespace HWY_NAMESPACE
}  // namespace tribodyn
HWY_AFTER_NAMESPACE();

#endif  // TRIBODYN_CORE_LAWS_PRESSURE_GROWTH_INL_H_
