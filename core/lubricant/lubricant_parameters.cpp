#include "core/lubricant/lubricant_parameters.h"

#include <cmath>

#include "core/number_text.h"
#include "core/parameter_check.h"
#include "core/refusal.h"

namespace tribodyn {
namespace {

using Stated = LubricantParameters<std::optional<KnownParameter>>;
struct NamedMember {
  const char* name;
  std::optional<KnownParameter> Stated::*stated;
  KnownParameter LubricantParameters<KnownParameter>::*known;
  double Lubricant::*value;
  const char* unit;
  Bound bound;
  double least, most;  // plausible range of a stated value
};

using Known = LubricantParameters<KnownParameter>;
constexpr NamedMember kMembers[] = {
    {"vogel_viscosity_prefactor", &Stated::vogel_viscosity_prefactor,
     &Known::vogel_viscosity_prefactor, &Lubricant::vogel_viscosity_prefactor, "Pa s",
     Bound::kPositive, 0, 1e3},
    {"vogel_temperature_coefficient", &Stated::vogel_temperature_coefficient,
     &Known::vogel_temperature_coefficient, &Lubricant::vogel_temperature_coefficient, "K",
     Bound::kPositive, 0, 1e5},
    {"vogel_reference_temperature", &Stated::vogel_reference_temperature,
     &Known::vogel_reference_temperature, &Lubricant::vogel_reference_temperature, "K",
     Bound::kNotNegative, 0, 400},
    {"pressure_viscosity_coefficient", &Stated::pressure_viscosity_coefficient,
     &Known::pressure_viscosity_coefficient, &Lubricant::pressure_viscosity_coefficient, "1/Pa",
     Bound::kPositive, 0, 1e-6},
    {"pressure_viscosity_temperature", &Stated::pressure_viscosity_temperature,
     &Known::pressure_viscosity_temperature, &Lubricant::pressure_viscosity_temperature, "K",
     Bound::kPositive, 150, 600},
    {"relaxation_time", &Stated::relaxation_time, &Known::relaxation_time,
     &Lubricant::relaxation_time, "s", Bound::kNotNegative, 0, 10},
    {"havriliak_negami_alpha", &Stated::havriliak_negami_alpha, &Known::havriliak_negami_alpha,
     &Lubricant::havriliak_negami_alpha, "1", Bound::kPositive, 0, 5},
    {"havriliak_negami_beta", &Stated::havriliak_negami_beta, &Known::havriliak_negami_beta,
     &Lubricant::havriliak_negami_beta, "1", Bound::kNotNegative, 0, 5},
    {"rheology_reference_temperature", &Stated::rheology_reference_temperature,
     &Known::rheology_reference_temperature, &Lubricant::rheology_reference_temperature, "K",
     Bound::kPositive, 150, 600},
    {"limiting_shear_stress_at_zero_pressure", &Stated::limiting_shear_stress_at_zero_pressure,
     &Known::limiting_shear_stress_at_zero_pressure,
     &Lubricant::limiting_shear_stress_at_zero_pressure, "Pa", Bound::kNotNegative, 0, 1e10},
    {"limiting_shear_stress_coefficient", &Stated::limiting_shear_stress_coefficient,
     &Known::limiting_shear_stress_coefficient, &Lubricant::limiting_shear_stress_coefficient, "1",
     Bound::kNotNegative, 0, 10},
    {"thermal_conductivity", &Stated::thermal_conductivity, &Known::thermal_conductivity,
     &Lubricant::thermal_conductivity, "W/(m K)", Bound::kPositive, 0, 100},
    {"density_at_zero_kelvin", &Stated::density_at_zero_kelvin, &Known::density_at_zero_kelvin,
     &Lubricant::density_at_zero_kelvin, "kg/m3", Bound::kPositive, 0, 1e5},
    {"density_temperature_slope", &Stated::density_temperature_slope,
     &Known::density_temperature_slope, &Lubricant::density_temperature_slope, "kg/(m3 K)",
     Bound::kFinite, -100, 100},
};

}  // namespace

void check_stated_parameters(const LubricantParameters<std::optional<KnownParameter>>& parameters) {
  for (const NamedMember& member : kMembers) {
    const std::optional<KnownParameter>& stated = parameters.*member.stated;
    if (!stated) continue;
    const double value = stated->value;
    const bool allowed = value >= member.least && value <= member.most &&
                         !(member.bound == Bound::kPositive && value <= 0);
    const double uncertainty = stated->standard_uncertainty.value_or(0);
    if (allowed && uncertainty >= 0 && std::isfinite(uncertainty)) continue;
    throw Refusal("PARAMETER_OUT_OF_RANGE",
                  std::string("stated.") + member.name + " of " + number_text(value) +
                      (allowed ? " has a standard uncertainty that is not finite and positive."
                               : " is outside " + number_text(member.least) + " to " +
                                     number_text(member.most) + " (SI units)."));
  }
}

void check(const Lubricant& oil) {
  ParameterCheck check;
  const bool roelands = oil.pressure_viscosity_law == PressureViscosityLaw::kRoelands;
  for (const NamedMember& member : kMembers) {
    const bool of_roelands = member.value == &Lubricant::pressure_viscosity_coefficient ||
                             member.value == &Lubricant::pressure_viscosity_temperature;
    if (of_roelands && !roelands) continue;
    check.expect(member.name, oil.*member.value, member.unit, member.bound);
  }
  for (const LawDescription& law : kLawDescriptions) {
    if (law.law != oil.pressure_viscosity_law) continue;
    for (int k = 0; k < kMostLawParameters && law.parameters[k].name != nullptr; ++k) {
      const LawParameter& parameter = law.parameters[k];
      check.expect(parameter.name, oil.law_parameters[k], parameter.unit, parameter.bound);
    }
  }
  check.conclude();
}

Lubricant values_of(const LubricantParameters<KnownParameter>& parameters) {
  Lubricant lubricant{};
  for (const NamedMember& member : kMembers) {
    lubricant.*member.value = (parameters.*member.known).value;
  }
  return lubricant;
}

}  // namespace tribodyn
