#pragma once

#include <string>
#include <vector>

#include "server/contract/violations.h"
#include "tribodyn/v1/lubricants.pb.h"
#include "tribodyn/v1/results.pb.h"

namespace tribodyn::server {

/// Sets every parameter that is not stated: fitted to the measurements or estimated from the class
/// of the base oil (core/lubricant/characterisation.h), marked `computed`, with its uncertainty and
/// a warning in the provenance. `lubricant` has passed check_message. What cannot be told is a
/// violation, and so is a measurement that cannot be right (core/lubricant/gross_errors.h).
void complete_parameters(v1::Lubricant& lubricant, const std::string& path, Violations& violations);

/// Unsets what the server had computed, with its provenance, so that it is computed again.
void forget_computed(v1::Lubricant& lubricant);

/// What the parameters amount to and how well they fit the measurements. `lubricant` is complete.
v1::LubricantCharacterisation characterisation(const v1::Lubricant& lubricant);
/// What to know of the fluid before relying on a result: its characterisation's warnings, one for
/// all estimated parameters together. `lubricant` is complete.
std::vector<v1::RangeWarning> fluid_warnings(const v1::Lubricant& lubricant);
/// Only the figures that a list shows: viscosities, index, density and grades.
v1::LubricantCharacterisation brief_characterisation(const v1::Lubricant& lubricant);

}  // namespace tribodyn::server
