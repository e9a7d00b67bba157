#pragma once

#include <optional>
#include <string>
#include <vector>

#include "server/contract/resource_names.h"
#include "server/contract/violations.h"
#include "tribodyn/v1/results.pb.h"
#include "tribodyn/v1/surfaces.pb.h"

namespace tribodyn::server {

/// Computes a surface from measured profiles and returns it accepted (accept_resource.h) with the
/// name `name`. Steps: moments of each profile (eq 45), mean of the repeats of a direction,
/// isotropic surface of two directions of a member (eq 46), sum of both members (eq 47),
/// Greenwood-Tripp parameters (eq 48), with the standard uncertainties that the spread of the
/// repeats makes. If only one member was measured, the other is assumed to be
/// equal; if only one direction was measured, the surface is assumed to be isotropic; both with a
/// warning in the provenance. Violations name the profile, the row (line of its text) and the
/// column. Returns nullopt if there is a violation.
std::optional<v1::Surface> import_surface(const v1::ImportSurfaceProfilesRequest& request,
                                          const std::string& name, const ResourceLookup& lookup,
                                          Violations& violations);

/// Returns warnings about the profiles of a surface; none if the client set its parameters.
std::vector<v1::RangeWarning> surface_warnings(const v1::Surface& surface);

}  // namespace tribodyn::server
