#pragma once

#include <optional>
#include <string>
#include <vector>

#include "server/contract/resource_names.h"
#include "server/contract/violations.h"
#include "tribodyn/v1/gear_sets.pb.h"

namespace tribodyn::server {

/// Reads the tables of an import request and returns the accepted gear set (accept_resource.h) with
/// the name `name`. gear_sets.proto documents columns and forms. Violations name row (line of the
/// text) and column. Returns nullopt if there is a violation.
///
/// Missing friction arms are computed from the velocities: r_fr,p = -(V . A_p)/|V| and r_fr,g = (V
/// . A_g)/|V| with V = A_p - A_g N_p/N_g. Missing velocities of the contact point are 0, with a
/// warning in the provenance of flank_slots. R_g0 within 1e-6 of R_p0 N_g/N_p is set to that value,
/// with a warning in the provenance of series: tables rarely print enough digits.
std::optional<v1::GearSet> import_gear_set(const v1::ImportGearSetRequest& request,
                                           const std::string& name, const ResourceLookup& lookup,
                                           Violations& violations);

/// Return the allowed headers of each table.
std::vector<std::string> tooth_contact_headers();
std::vector<std::string> series_headers();

}  // namespace tribodyn::server
