#pragma once

#include <optional>
#include <string>

#include "core/laws/lubricant.h"

namespace tribodyn {

/// How a number came to be known; the same list as Provenance of the service's contract.
enum class Provenance {
  kPublished,   ///< printed in the paper
  kDerived,     ///< follows from published numbers, checked
  kLiterature,  ///< from another source, named
  kMeasured,
  kFitted,
  kAssumed,     ///< a choice; must be shown as such
  kCalibrated,  ///< assumed, tuned so that a published fact holds
  kUser,        ///< stated in the request
};

/// One parameter as it is known.
struct KnownParameter {
  double value;                                ///< SI
  std::optional<double> standard_uncertainty;  ///< same unit as the value
  Provenance provenance;
  std::string source;
};

/// One of something for each parameter of a Lubricant, by the same names.
template <class T>
struct LubricantParameters {
  T vogel_viscosity_prefactor;
  T vogel_temperature_coefficient;
  T vogel_reference_temperature;
  T pressure_viscosity_coefficient;
  T pressure_viscosity_temperature;
  T relaxation_time;
  T havriliak_negami_alpha;
  T havriliak_negami_beta;
  T rheology_reference_temperature;
  T limiting_shear_stress_at_zero_pressure;
  T limiting_shear_stress_coefficient;
  T thermal_conductivity;
  T density_at_zero_kelvin;
  T density_temperature_slope;
};

/// Throws Refusal PARAMETER_OUT_OF_RANGE naming the first one that is not finite, of impossible
/// sign or far outside what the laws allow.
void check_stated_parameters(const LubricantParameters<std::optional<KnownParameter>>& parameters);

/// Throws Refusal PARAMETER_OUT_OF_RANGE, all violations in one sentence, if a parameter that the
/// lubricant's pressure-viscosity law needs is not finite or of a sign that no fluid has.
void check(const Lubricant& lubricant);

Lubricant values_of(const LubricantParameters<KnownParameter>& parameters);

}  // namespace tribodyn
