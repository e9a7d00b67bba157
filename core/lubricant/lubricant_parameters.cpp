#include "core/lubricant/lubricant_parameters.h"

#include <cmath>

#include "core/number_text.h"
#include "core/refusal.h"

namespace tribodyn {
namespace {

using Stated = LubricantParameters<std::optional<KnownParameter>>;
struct NamedMember {
  const char* name;
  std::optional<KnownParameter> Stated::*stated;
  KnownParameter LubricantParameters<KnownParameter>::*known;
  double Lubricant::*value;
  double least;  // allowed range of a stated value; strict where it is 0 and `positive`
  double most;
  bool positive;
};

using Known = LubricantParameters<KnownParameter>;
constexpr NamedMember kMembers[] = {
    {"vogel_viscosity_prefactor", &Stated::vogel_viscosity_prefactor,
     &Known::vogel_viscosity_prefactor, &Lubricant::vogel_viscosity_prefactor, 0, 1e3, true},
    {"vogel_temperature_coefficient", &Stated::vogel_temperature_coefficient,
     &Known::vogel_temperature_coefficient, &Lubricant::vogel_temperature_coefficient, 0, 1e5,
     true},
    {"vogel_reference_temperature", &Stated::vogel_reference_temperature,
     &Known::vogel_reference_temperature, &Lubricant::vogel_reference_temperature, 0, 400, false},
    {"pressure_viscosity_coefficient", &Stated::pressure_viscosity_coefficient,
     &Known::pressure_viscosity_coefficient, &Lubricant::pressure_viscosity_coefficient, 0, 1e-6,
     true},
    {"pressure_viscosity_temperature", &Stated::pressure_viscosity_temperature,
     &Known::pressure_viscosity_temperature, &Lubricant::pressure_viscosity_temperature, 150, 600,
     true},
    {"relaxation_time", &Stated::relaxation_time, &Known::relaxation_time,
     &Lubricant::relaxation_time, 0, 10, false},
    {"havriliak_negami_alpha", &Stated::havriliak_negami_alpha, &Known::havriliak_negami_alpha,
     &Lubricant::havriliak_negami_alpha, 0, 5, true},
    {"havriliak_negami_beta", &Stated::havriliak_negami_beta, &Known::havriliak_negami_beta,
     &Lubricant::havriliak_negami_beta, 0, 5, false},
    {"rheology_reference_temperature", &Stated::rheology_reference_temperature,
     &Known::rheology_reference_temperature, &Lubricant::rheology_reference_temperature, 150, 600,
     true},
    {"limiting_shear_stress_at_zero_pressure", &Stated::limiting_shear_stress_at_zero_pressure,
     &Known::limiting_shear_stress_at_zero_pressure,
     &Lubricant::limiting_shear_stress_at_zero_pressure, 0, 1e10, false},
    {"limiting_shear_stress_coefficient", &Stated::limiting_shear_stress_coefficient,
     &Known::limiting_shear_stress_coefficient, &Lubricant::limiting_shear_stress_coefficient, 0,
     10, false},
    {"thermal_conductivity", &Stated::thermal_conductivity, &Known::thermal_conductivity,
     &Lubricant::thermal_conductivity, 0, 100, true},
    {"density_at_zero_kelvin", &Stated::density_at_zero_kelvin, &Known::density_at_zero_kelvin,
     &Lubricant::density_at_zero_kelvin, 0, 1e5, true},
    {"density_temperature_slope", &Stated::density_temperature_slope,
     &Known::density_temperature_slope, &Lubricant::density_temperature_slope, -100, 100, false},
};

}  // namespace

void check_stated_parameters(const LubricantParameters<std::optional<KnownParameter>>& parameters) {
  for (const NamedMember& member : kMembers) {
    const std::optional<KnownParameter>& stated = parameters.*member.stated;
    if (!stated) continue;
    const double value = stated->value;
    const bool allowed =
        value >= member.least && value <= member.most && !(member.positive && value <= 0);
    const double uncertainty = stated->standard_uncertainty.value_or(0);
    if (allowed && uncertainty >= 0 && std::isfinite(uncertainty)) continue;
    throw Refusal("PARAMETER_OUT_OF_RANGE",
                  std::string("stated.") + member.name + " of " + number_text(value) +
                      (allowed ? " has a standard uncertainty that is not finite and positive."
                               : " is outside " + number_text(member.least) + " to " +
                                     number_text(member.most) + " (SI units)."));
  }
}

Lubricant values_of(const LubricantParameters<KnownParameter>& parameters) {
  Lubricant lubricant{};
  for (const NamedMember& member : kMembers) {
    lubricant.*member.value = (parameters.*member.known).value;
  }
  return lubricant;
}

}  // namespace tribodyn
