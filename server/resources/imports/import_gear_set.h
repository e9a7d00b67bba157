#pragma once

#include <optional>
#include <string>
#include <vector>

#include "server/contract/resource_names.h"
#include "server/contract/violations.h"
#include "tribodyn/v1/gear_sets.pb.h"

namespace tribodyn::server {

/// The gear set that an import means, with its tables read, checked and accepted
/// (accept_resource.h); `name` is the name it is to have. Columns and forms: gear_sets.proto.
/// Violations name row (line of the text) and column.
///
/// Friction arms that are not given follow from the velocities, r_fr,p = -(V . A_p)/|V| and
/// r_fr,g = (V . A_g)/|V| with V = A_p - A_g N_p/N_g; velocities of the contact point that are not
/// given are 0, with a warning in the provenance of flank_slots. R_g0 within 1e-6 of R_p0 N_g/N_p
/// is set to that, with a warning in the provenance of series: tables rarely print enough digits.
std::optional<v1::GearSet> import_gear_set(const v1::ImportGearSetRequest& request,
                                           const std::string& name, const ResourceLookup& lookup,
                                           Violations& violations);

/// Headers that each text may have.
std::vector<std::string> tooth_contact_headers();
std::vector<std::string> series_headers();

}  // namespace tribodyn::server
