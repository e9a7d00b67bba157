#pragma once

#include <span>
#include <vector>

namespace tribodyn {

/// Which waves of a profile are kept, by cut-off wave lengths [m]; 0: no filter.
struct ProfileBand {
  double shortest = 0;  ///< lambda_s: shorter waves are noise of the instrument
  double longest = 0;   ///< lambda_c: longer waves are waviness and form
};

/// Products of samples and weights that a filter may take: half a second.
inline constexpr double kMostFilterProducts = 5e8;

/// The profile within a band, by the Gaussian filter of ISO 16610-21: the mean line of cut-off L is
/// the profile weighted with
///
///   s(x) = exp(-pi (x/(a L))^2)/(a L),   a = sqrt(ln 2/pi) = 0.4697,
///
/// which passes half of the amplitude of a wave of length L. The mean line of lambda_s replaces the
/// profile, then that of lambda_c is taken off. Weights end at x = L, where s is 1e-6 of its
/// maximum. Half a cut-off at each end, where weights would lack heights, is left out (ISO 3274).
///
/// heights [m] at equal spacing [m] > 0.
/// Throws Refusal PROFILE_FILTER where a cut-off is below two spacings, lambda_s is not below
/// lambda_c, the profile is too short (fewer than five heights are left), or the products of
/// samples and weights are more than kMostFilterProducts.
std::vector<double> filtered_profile(std::span<const double> heights, double spacing,
                                     const ProfileBand& band);

}  // namespace tribodyn
