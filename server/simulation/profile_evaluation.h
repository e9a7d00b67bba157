#pragma once

#include <functional>
#include <optional>

#include "server/contract/violations.h"
#include "tribodyn/v1/profiles.pb.h"

namespace tribodyn::server {

/// Heights of each profile that are left at the longest sampling interval, if the request names no
/// intervals: below some 50 the moments of one profile scatter by a quarter (1/sqrt(n) times their
/// waves of about 4 samples).
inline constexpr int kFewestSampledHeights = 50;

/// Computes the surface of the profiles at every sampling interval. Returns nullopt and adds all
/// violations if the request is invalid. Throws Cancelled soon after `is_over` returns true.
std::optional<v1::EvaluateProfilesResponse> evaluate_profiles(
    const v1::EvaluateProfilesRequest& request, const std::function<bool()>& is_over,
    Violations& violations);

}  // namespace tribodyn::server
