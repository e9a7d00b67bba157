#include "server/resources/sheared_lubricant.h"

#include <fmt/format.h>

#include "server/resources/lubricant_parameters.h"
#include "server/resources/provenance.h"

namespace tribodyn::server {
namespace {

constexpr char kPrefactor[] = "vogel_viscosity_prefactor_pascal_seconds";

void scale_viscosities(double ratio, v1::LubricantMeasurements& measured) {
  measured.set_kinematic_viscosity_40_celsius_square_millimetres_per_second(
      ratio * measured.kinematic_viscosity_40_celsius_square_millimetres_per_second());
  measured.set_kinematic_viscosity_100_celsius_square_millimetres_per_second(
      ratio * measured.kinematic_viscosity_100_celsius_square_millimetres_per_second());
  for (v1::BrookfieldViscosity& row : *measured.mutable_brookfield_viscosities()) {
    row.set_dynamic_viscosity_millipascal_seconds(ratio *
                                                  row.dynamic_viscosity_millipascal_seconds());
  }
  for (v1::ViscosityMeasurement& row : *measured.mutable_viscosities()) {
    if (row.has_kinematic_viscosity_square_millimetres_per_second()) {
      row.set_kinematic_viscosity_square_millimetres_per_second(
          ratio * row.kinematic_viscosity_square_millimetres_per_second());
    } else if (row.has_dynamic_viscosity_millipascal_seconds()) {
      row.set_dynamic_viscosity_millipascal_seconds(ratio *
                                                    row.dynamic_viscosity_millipascal_seconds());
    }
  }
}

}  // namespace

std::optional<v1::Lubricant> sheared_lubricant(const v1::Lubricant& lubricant) {
  const double sheared =
      lubricant.measurements()
          .sheared_kinematic_viscosity_100_celsius_square_millimetres_per_second();
  if (!(sheared > 0)) return std::nullopt;
  const double ratio =
      sheared / brief_characterisation(lubricant)
                    .kinematic_viscosity_100_celsius_square_millimetres_per_second();
  v1::Lubricant out = lubricant;
  out.set_condition(v1::Lubricant::SHEARED);
  scale_viscosities(ratio, *out.mutable_measurements());
  const v1::ParameterProvenance* origin = find_provenance(lubricant.provenance(), kPrefactor);
  const bool is_fitted = origin != nullptr && origin->computed();
  if (is_fitted) {  // the fit to the scaled viscosities, from which draws start too
    clear_computed_parameters(out);
    Violations violations;
    complete_parameters(out, "", violations);
    if (!violations.empty()) return std::nullopt;
  } else {
    out.set_vogel_viscosity_prefactor_pascal_seconds(
        ratio * lubricant.vogel_viscosity_prefactor_pascal_seconds());
  }
  for (v1::ParameterProvenance& entry : *out.mutable_provenance()) {
    if (entry.field() != kPrefactor) continue;
    if (!is_fitted) entry.set_standard_uncertainty(ratio * entry.standard_uncertainty());
    entry.set_source(fmt::format(
        "viscosities times {:.4g}: KV100 after the shear test over KV100 before it, assumed at all "
        "temperatures; {}",
        ratio, entry.source()));
  }
  return out;
}

}  // namespace tribodyn::server
