#pragma once

#include <optional>
#include <string>
#include <vector>

#include "server/contract/resource_names.h"
#include "server/contract/violations.h"
#include "tribodyn/v1/results.pb.h"
#include "tribodyn/v1/surfaces.pb.h"

namespace tribodyn::server {

/// The surface that measured profiles mean, accepted (accept_resource.h): moments of each profile
/// (eq 45), repeats of a direction averaged, two directions of a member made isotropic (eq 46),
/// members added (eq 47), Greenwood-Tripp parameters (eq 48). A member that was not measured is
/// taken to be like the other one and a single direction to be isotropic, with a warning in the
/// provenance. Violations name the profile, the row (line of its text) and the column.
std::optional<v1::Surface> import_surface(const v1::ImportSurfaceProfilesRequest& request,
                                          const std::string& name, const ResourceLookup& lookup,
                                          Violations& violations);

/// What to know of a surface made of profiles before relying on a result; nothing for one whose
/// parameters were stated.
std::vector<v1::RangeWarning> surface_warnings(const v1::Surface& surface);

/// Headers that a profile may have.
std::vector<std::string> profile_headers();

inline constexpr int kMaximumProfiles = 24;  ///< two members, two directions, six repeats

}  // namespace tribodyn::server
