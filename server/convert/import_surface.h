#pragma once

#include <optional>
#include <string>
#include <vector>

#include "server/convert/resource_names.h"
#include "server/convert/violations.h"
#include "tribodyn/v1/surfaces.pb.h"

namespace tribodyn::server {

/// The surface that measured profiles mean, accepted (accept_resource.h): moments of each profile
/// (eq 45), two directions of a member made isotropic (eq 46), members added (eq 47),
/// Greenwood-Tripp parameters (eq 48). A member that was not measured is taken to be like the other
/// one and a single direction to be isotropic, with a warning in the provenance.
/// Violations name the profile, the row (line of its text) and the column.
std::optional<v1::Surface> import_surface(const v1::ImportSurfaceProfilesRequest& request,
                                          const std::string& name, const ResourceLookup& lookup,
                                          Violations& violations);

/// Headers that a profile may have.
std::vector<std::string> profile_headers();

inline constexpr int kMaximumProfiles = 4;  ///< two members, two directions

}  // namespace tribodyn::server
