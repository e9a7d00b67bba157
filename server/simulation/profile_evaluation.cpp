#include "server/simulation/profile_evaluation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include "core/refusal.h"
#include "core/surface/measured_surface.h"
#include "core/surface/roughness_product.h"
#include "core/surface/spectral_moments.h"
#include "server/mapping/from_core.h"
#include "server/resources/imports/read_profiles.h"

namespace tribodyn::server {
namespace {

constexpr int kFewestHeights = 5;  // of spectral_moments()
constexpr int kMostSamplingSteps = 50;

int fewest_heights(const std::vector<ReadProfile>& profiles) {
  std::size_t fewest = profiles.front().heights.size();
  for (const ReadProfile& each : profiles) fewest = std::min(fewest, each.heights.size());
  return static_cast<int>(fewest);
}

/// Returns 1, 2, 3, 4, 6, 8, 12 and so on: two steps an octave.
std::vector<int> usual_steps(int heights) {
  std::vector<int> out{1};
  for (int octave = 2; static_cast<int>(out.size()) < kMostSamplingSteps; octave *= 2) {
    for (const int step : {octave, octave + octave / 2}) {
      if (heights / step < kFewestSampledHeights) return out;
      out.push_back(step);
    }
  }
  return out;
}

/// Adds a violation for each step that no profile can be sampled with, or that does not rise.
void check_steps(const v1::EvaluateProfilesRequest& request, int heights, Violations& violations) {
  for (int i = 0; i < request.sampling_steps_size(); ++i) {
    const int step = request.sampling_steps(i);
    const int most = std::max(1, heights / kFewestHeights);
    const int before = i == 0 ? 0 : request.sampling_steps(i - 1);
    if (step >= 1 && step <= most && step > before) continue;
    violations.add(fmt::format("sampling_steps[{}]", i),
                   step >= 1 && step <= most
                       ? fmt::format("{}; allowed: more than the one before, {}", step, before)
                       : fmt::format("{}; allowed: 1 to {}, so that {} of the {} heights of the "
                                     "shortest profile are left (eq 45)",
                                     step, most, kFewestHeights, heights));
  }
}

void set_moments(const SpectralMoments& moments, v1::ProfileMoments& out) {
  out.set_mean_square_height_square_metres(moments.m0);
  out.set_mean_square_slope(moments.m2);
  out.set_mean_square_curvature_per_square_metre(moments.m4);
}

void add_group(const ProfileGroup& group, v1::EvaluateProfilesResponse& out) {
  v1::ProfileGroup& message = *out.add_groups();
  message.set_member(group.member == FlankMember::kPinion ? v1::FLANK_MEMBER_PINION
                     : group.member == FlankMember::kGear ? v1::FLANK_MEMBER_GEAR
                                                          : v1::FLANK_MEMBER_UNSPECIFIED);
  message.set_direction(group.direction == ProfileDirection::kAxial ? v1::PROFILE_DIRECTION_AXIAL
                        : group.direction == ProfileDirection::kRadial
                            ? v1::PROFILE_DIRECTION_RADIAL
                            : v1::PROFILE_DIRECTION_UNSPECIFIED);
  message.set_profiles(group.profiles);
  set_moments(group.mean, *message.mutable_mean());
  if (group.deviation) set_moments(*group.deviation, *message.mutable_standard_deviation());
}

void set_roughness(const Roughness& roughness, double product, v1::ProfileRoughness& out) {
  out.set_asperity_density_per_square_metre(roughness.asperity_density);
  out.set_asperity_radius_metres(roughness.asperity_radius);
  out.set_composite_rms_height_metres(roughness.composite_rms_height);
  out.set_roughness_product(product);
}

/// Returns the surface at a sampling interval. Throws Refusal if it has none.
v1::SampledSurface sampled_surface(const std::vector<ReadProfile>& profiles, int step,
                                   const AsPublished& as_published) {
  v1::SampledSurface out;
  out.set_sampling_step(step);
  std::vector<MeasuredProfile> sampled;
  for (const ReadProfile& profile : profiles) {
    const double spacing = profile.measurement.spacing_metres();
    MeasuredProfile each = measured_profile(profile.measurement);
    each.moments = sampled_moments(profile.heights, spacing, step, profile.levelling);
    const double waves = wave_length_in_spacings(each.moments, step * spacing);
    if (sampled.empty() || waves < out.wave_length_ratio()) out.set_wave_length_ratio(waves);
    out.set_spacing_metres(out.spacing_metres() +
                           step * spacing / static_cast<double>(profiles.size()));
    sampled.push_back(each);
  }
  const Roughness roughness = roughness_of_profiles(sampled, as_published);
  set_roughness(roughness, roughness_product(roughness), *out.mutable_roughness());
  const auto uncertainty = roughness_uncertainty(sampled, as_published);
  const auto product = roughness_product_uncertainty(sampled, as_published);
  if (uncertainty && product) {
    set_roughness(*uncertainty, *product, *out.mutable_standard_uncertainty());
  }
  return out;
}

void add_profile_warnings(const v1::ProfileRoughness& roughness,
                          v1::EvaluateProfilesResponse& out) {
  const auto add = [&out](const char* code, const std::string& sentence) {
    if (sentence.empty()) return;
    *out.add_warnings() = to_message(RangeWarning{code, sentence});
  };
  add("PROFILE_NOT_RESOLVED", unresolved_text(out.measurements()));
  add("SURFACE_PARTLY_MEASURED", unmeasured_text(out.measurements()));
  add("ROUGHNESS_PRODUCT",
      product_text({.asperity_density = roughness.asperity_density_per_square_metre(),
                    .asperity_radius = roughness.asperity_radius_metres(),
                    .composite_rms_height = roughness.composite_rms_height_metres()}));
}

}  // namespace

std::optional<v1::EvaluateProfilesResponse> evaluate_profiles(
    const v1::EvaluateProfilesRequest& request, const std::function<bool()>& is_over,
    Violations& violations) {
  const std::size_t before = violations.size();
  const std::vector<ReadProfile> profiles = read_profiles(request, violations);
  if (!profiles.empty()) check_steps(request, fewest_heights(profiles), violations);
  if (violations.size() > before) return std::nullopt;
  v1::EvaluateProfilesResponse out;
  std::vector<MeasuredProfile> measured;
  for (const ReadProfile& each : profiles) {
    *out.add_measurements() = each.measurement;
    measured.push_back(measured_profile(each.measurement));
  }
  for (const ProfileGroup& group : profile_groups(measured)) add_group(group, out);
  AsPublished as_published;
  as_published.eq46_square_root_of_sum = request.eq46_square_root_of_sum();
  std::vector<int> steps(request.sampling_steps().begin(), request.sampling_steps().end());
  if (steps.empty()) steps = usual_steps(fewest_heights(profiles));
  try {
    for (const int step : steps) {
      if (is_over()) throw Cancelled();
      *out.add_surfaces() = sampled_surface(profiles, step, as_published);
    }
    const v1::SampledSurface whole = out.surfaces(0).sampling_step() == 1
                                         ? out.surfaces(0)
                                         : sampled_surface(profiles, 1, as_published);
    add_profile_warnings(whole.roughness(), out);
  } catch (const Refusal& refusal) {
    violations.add("profiles", refusal.what());
    return std::nullopt;
  }
  return out;
}

}  // namespace tribodyn::server
