#pragma once

#include <string>

#include "server/convert/violations.h"
#include "tribodyn/v1/lubricants.pb.h"

namespace tribodyn::server {

/// Sets every parameter that is not stated: fitted to the measurements or estimated from the class
/// of the base oil (core/lubricant/characterisation.h), marked `computed`, with its uncertainty and
/// a warning in the provenance. `lubricant` has passed check_message. What cannot be told is a
/// violation.
void complete_parameters(v1::Lubricant& lubricant, const std::string& path, Violations& violations);

/// Unsets what the server had computed, with its provenance, so that it is computed again.
void forget_computed(v1::Lubricant& lubricant);

/// What the parameters amount to and how well they fit the measurements. `lubricant` is complete.
v1::LubricantCharacterisation characterisation(const v1::Lubricant& lubricant);
/// Only the figures that a list shows: viscosities, index, density and grades.
v1::LubricantCharacterisation brief_characterisation(const v1::Lubricant& lubricant);

}  // namespace tribodyn::server
