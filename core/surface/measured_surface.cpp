#include "core/surface/measured_surface.h"

#include <array>
#include <cmath>
#include <iterator>
#include <vector>

#include "core/surface/roughness_product.h"

namespace tribodyn {
namespace {

/// Density, radius, height and their product.
using RoughnessFigures = std::array<double, 4>;

RoughnessFigures roughness_figures(const Roughness& roughness) {
  return {roughness.asperity_density, roughness.asperity_radius, roughness.composite_rms_height,
          roughness_product(roughness)};
}

bool is_of_group(const MeasuredProfile& a, const MeasuredProfile& b) {
  return a.member == b.member && a.direction == b.direction;
}

/// The mean moments of a member and direction; nullopt without profile.
std::optional<SpectralMoments> group_mean(std::span<const MeasuredProfile> profiles,
                                          FlankMember member, ProfileDirection direction) {
  SpectralMoments sum{};
  int count = 0;
  for (const MeasuredProfile& each : profiles) {
    if (each.member != member || each.direction != direction) continue;
    sum.m0 += each.moments.m0;
    sum.m2 += each.moments.m2;
    sum.m4 += each.moments.m4;
    ++count;
  }
  if (count == 0) return std::nullopt;
  return SpectralMoments{sum.m0 / count, sum.m2 / count, sum.m4 / count};
}

/// The isotropic surface of a member; nullopt if it was not measured.
std::optional<SpectralMoments> member_moments(std::span<const MeasuredProfile> profiles,
                                              FlankMember member, const AsPublished& as_published) {
  const auto axial = group_mean(profiles, member, ProfileDirection::kAxial);
  const auto radial = group_mean(profiles, member, ProfileDirection::kRadial);
  if (axial && radial) return equivalent_isotropic_moments(*axial, *radial, as_published);
  if (axial) return axial;
  return radial ? radial : group_mean(profiles, member, ProfileDirection::kAny);
}

/// The standard uncertainties of the figures by the jackknife of roughness_uncertainty().
std::optional<RoughnessFigures> jackknife(std::span<const MeasuredProfile> profiles,
                                          const AsPublished& as_published) {
  RoughnessFigures variances{};
  std::vector<bool> is_done(profiles.size());
  for (std::size_t first = 0; first < profiles.size(); ++first) {
    if (is_done[first]) continue;
    std::vector<RoughnessFigures> without;  // each profile of the group left out at a time
    for (std::size_t left_out = first; left_out < profiles.size(); ++left_out) {
      if (!is_of_group(profiles[left_out], profiles[first])) continue;
      is_done[left_out] = true;
      std::vector<MeasuredProfile> rest(profiles.begin(), profiles.end());
      rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(left_out));
      if (!rest.empty())
        without.push_back(roughness_figures(roughness_of_profiles(rest, as_published)));
    }
    const auto count = static_cast<double>(without.size());
    if (count < 2) return std::nullopt;
    for (std::size_t k = 0; k < variances.size(); ++k) {
      double mean = 0;
      for (const RoughnessFigures& each : without) mean += each[k] / count;
      for (const RoughnessFigures& each : without) {
        const double difference = each[k] - mean;
        variances[k] += (count - 1) / count * difference * difference;
      }
    }
  }
  RoughnessFigures out{};
  for (std::size_t k = 0; k < variances.size(); ++k) out[k] = std::sqrt(variances[k]);
  return out;
}

/// Mean and standard deviation of one moment of the profiles of a group.
void set_moment(const std::vector<SpectralMoments>& all, double SpectralMoments::*moment,
                ProfileGroup& out) {
  const auto count = static_cast<double>(all.size());
  double mean = 0, squares = 0;
  for (const SpectralMoments& each : all) mean += each.*moment / count;
  for (const SpectralMoments& each : all) {
    squares += (each.*moment - mean) * (each.*moment - mean);
  }
  out.mean.*moment = mean;
  if (out.deviation) (*out.deviation).*moment = std::sqrt(squares / (count - 1));
}

}  // namespace

Roughness roughness_of_profiles(std::span<const MeasuredProfile> profiles,
                                const AsPublished& as_published) {
  const auto both = member_moments(profiles, FlankMember::kBoth, as_published);
  const auto pinion = member_moments(profiles, FlankMember::kPinion, as_published);
  const auto gear = member_moments(profiles, FlankMember::kGear, as_published);
  const SpectralMoments one = both ? *both : pinion ? *pinion : *gear;
  return greenwood_tripp_roughness(composite_moments(pinion.value_or(one), gear.value_or(one)));
}

std::optional<Roughness> roughness_uncertainty(std::span<const MeasuredProfile> profiles,
                                               const AsPublished& as_published) {
  const auto figures = jackknife(profiles, as_published);
  if (!figures) return std::nullopt;
  const auto& [density, radius, height, product] = *figures;
  return Roughness{
      .asperity_density = density, .asperity_radius = radius, .composite_rms_height = height};
}

std::optional<double> roughness_product_uncertainty(std::span<const MeasuredProfile> profiles,
                                                    const AsPublished& as_published) {
  const auto figures = jackknife(profiles, as_published);
  if (!figures) return std::nullopt;
  return figures->back();
}

std::vector<ProfileGroup> profile_groups(std::span<const MeasuredProfile> profiles) {
  std::vector<ProfileGroup> out;
  std::vector<bool> is_done(profiles.size());
  for (std::size_t first = 0; first < profiles.size(); ++first) {
    if (is_done[first]) continue;
    std::vector<SpectralMoments> moments;
    for (std::size_t i = first; i < profiles.size(); ++i) {
      if (!is_of_group(profiles[i], profiles[first])) continue;
      is_done[i] = true;
      moments.push_back(profiles[i].moments);
    }
    ProfileGroup& group = out.emplace_back();
    group.member = profiles[first].member;
    group.direction = profiles[first].direction;
    group.profiles = static_cast<int>(moments.size());
    if (moments.size() > 1) group.deviation.emplace();
    for (const auto moment : {&SpectralMoments::m0, &SpectralMoments::m2, &SpectralMoments::m4}) {
      set_moment(moments, moment, group);
    }
  }
  return out;
}

}  // namespace tribodyn
