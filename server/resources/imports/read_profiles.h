#pragma once

#include <google/protobuf/repeated_field.h>

#include <string>
#include <vector>

#include "core/surface/measured_surface.h"
#include "core/surface/spectral_moments.h"
#include "server/contract/violations.h"
#include "tribodyn/v1/profiles.pb.h"
#include "tribodyn/v1/surfaces.pb.h"

namespace tribodyn::server {

inline constexpr int kMaximumProfiles = 24;  ///< two members, two directions, six repeats

/// A profile of a request.
struct ReadProfile {
  v1::SurfaceMeasurement measurement;  ///< its moments at its own spacing
  std::vector<double> heights;         ///< levelled and filtered [m]
  Levelling levelling = Levelling::kLeastSquaresLine;
};

/// Checks the profiles of a request and returns those that are usable: levelled, then filtered,
/// with their moments (eq 45). Violations name the profile, the row (line of its text) and the
/// column.
std::vector<ReadProfile> read_profiles(const v1::ImportSurfaceProfilesRequest& request,
                                       Violations& violations);
std::vector<ReadProfile> read_profiles(const v1::EvaluateProfilesRequest& request,
                                       Violations& violations);

MeasuredProfile measured_profile(const v1::SurfaceMeasurement& measurement);

using Measurements = google::protobuf::RepeatedPtrField<v1::SurfaceMeasurement>;

/// Returns a sentence for each profile whose sampling is too coarse for its waves.
std::string unresolved_text(const Measurements& measurements);
/// Returns a sentence if no steel surface has this product of Greenwood and Tripp's parameters.
std::string product_text(const Roughness& roughness);
/// Returns the flanks and directions without a profile.
std::string unmeasured_text(const Measurements& measurements);

/// Returns the allowed headers of a profile.
std::vector<std::string> profile_headers();

}  // namespace tribodyn::server
