#pragma once

#include <string>
#include <vector>

#include "server/contract/violations.h"
#include "tribodyn/v1/lubricants.pb.h"
#include "tribodyn/v1/results.pb.h"

namespace tribodyn::server {

/// Adds a violation for alpha* and for its temperature if the client states them beside a
/// pressure-viscosity law that determines them.
void check_law_of_pressure(const v1::Lubricant& lubricant, const std::string& path,
                           Violations& violations);

/// Sets every unset parameter. A value is fitted to the measurements or estimated from the class of
/// the base oil (core/lubricant/characterisation.h), and its provenance is marked `computed` with
/// an uncertainty and a warning. Requires that `lubricant` passed check_message. Adds a violation
/// for a parameter that cannot be computed and for a measurement with a gross error
/// (core/lubricant/gross_errors.h).
void complete_parameters(v1::Lubricant& lubricant, const std::string& path, Violations& violations);

/// Returns the field of Lubricant, nested messages apart, that holds this number; null if none
/// does.
const google::protobuf::FieldDescriptor* lubricant_parameter(const std::string& name);

/// Clears computed parameters and their provenance, so that complete_parameters computes them
/// again.
void clear_computed_parameters(v1::Lubricant& lubricant);

/// Returns figures that follow from the parameters (viscosities, grades), residuals of the
/// measurements, and warnings. Requires a complete lubricant.
v1::LubricantCharacterisation characterisation(const v1::Lubricant& lubricant);
/// Returns the warnings of the characterisation that concern every result, with one warning for all
/// estimated parameters together. Requires a complete lubricant.
std::vector<v1::RangeWarning> fluid_warnings(const v1::Lubricant& lubricant);
/// Returns only the figures for lists: viscosities, index, density and grades.
v1::LubricantCharacterisation brief_characterisation(const v1::Lubricant& lubricant);

}  // namespace tribodyn::server
