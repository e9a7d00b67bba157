#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/model_options.h"
#include "core/surface/spectral_moments.h"
#include "core/surface/surface.h"

namespace tribodyn {

enum class FlankMember { kBoth, kPinion, kGear };
enum class ProfileDirection { kAny, kAxial, kRadial };

/// A measured profile of a flank: at the heel, in the middle, at the toe, or a repeat.
struct MeasuredProfile {
  FlankMember member;  ///< kBoth: both flanks are taken to be like it; then in all profiles
  ProfileDirection direction;
  SpectralMoments moments;
};

/// Returns the surface of all profiles: the moments of the profiles of one member and direction are
/// averaged, two directions of a member make an isotropic surface (eq 46), the members' moments add
/// up (eq 47; a member without profile is taken to be like the other), and eq 48 gives the
/// parameters. Requires at least one profile. Throws Refusal SURFACE_WITHOUT_ROUGHNESS as
/// greenwood_tripp_roughness() does.
Roughness roughness_of_profiles(std::span<const MeasuredProfile> profiles,
                                const AsPublished& as_published);

/// Returns the standard uncertainties of roughness_of_profiles() that the spread between profiles
/// of one member and direction makes, by the jackknife: with n profiles in a group, and one of them
/// left out at a time,
///
///   u^2 = sum over groups of (n - 1)/n sum_i (y_(i) - mean of y_(i))^2.
///
/// It holds for means over the flank, and keeps the correlation of the moments of a profile.
/// Returns nullopt if a member and direction has a single profile, which has no spread.
/// Source: B. Efron and C. Stein, Ann. Statist. 9 (1981) 586-596.
std::optional<Roughness> roughness_uncertainty(std::span<const MeasuredProfile> profiles,
                                               const AsPublished& as_published);

/// Returns the standard uncertainty of roughness_product(), likewise: the parameters of a surface
/// are correlated.
std::optional<double> roughness_product_uncertainty(std::span<const MeasuredProfile> profiles,
                                                    const AsPublished& as_published);

/// The profiles of one member and direction.
struct ProfileGroup {
  FlankMember member;
  ProfileDirection direction;
  int profiles;
  SpectralMoments mean;
  std::optional<SpectralMoments> deviation;  ///< standard, of single profiles; absent for one
};

/// Returns the groups in the order of their first profiles.
std::vector<ProfileGroup> profile_groups(std::span<const MeasuredProfile> profiles);

}  // namespace tribodyn
