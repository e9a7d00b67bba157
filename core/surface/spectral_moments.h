#pragma once

#include <span>
#include <vector>

#include "core/model_options.h"
#include "core/surface/surface.h"

namespace tribodyn {

/// Spectral moments of a rough profile or surface, eq 45.
struct SpectralMoments {
  double m0;  ///< mean square height [m2]; its root is Rq
  double m2;  ///< mean square slope [-]
  double m4;  ///< mean square curvature [1/m2]
};

/// What is taken off a measured profile before its moments are formed.
enum class Levelling {
  kMean,              ///< the mean height (eq 45 assumes a centred profile)
  kLeastSquaresLine,  ///< the least-squares line: also removes the tilt of the specimen
};

/// The profile without its mean height or its least-squares line.
std::vector<double> levelled_profile(std::span<const double> heights, Levelling levelling);

/// Eq 45 from a profile sampled at equal spacing:
///
///   m0 = mean z^2,   m2 = mean (dz/dx)^2,   m4 = mean (d2z/dx2)^2.
///
/// m0 is averaged over all samples. Slope (z[i+1] - z[i-1])/(2 dx) and curvature
/// (z[i+1] - 2 z[i] + z[i-1])/dx^2 are central differences, averaged over the interior samples;
/// both have an error of second order in dx: for a wave of length L they give m2 (sin q/q)^2 and m4
/// (sin(q/2)/(q/2))^4, q = 2 pi dx/L. m2 and m4 of a real surface depend on the sampling interval
/// (they have no limit for a fractal profile): keep it, and the filter, with the result.
///
/// heights [m]: at least 5, all finite; spacing dx [m] > 0.
/// Throws Refusal PROFILE_UNUSABLE, naming everything that is wrong.
/// Source: J. I. McCool, Wear 107 (1986) 37-60.
SpectralMoments spectral_moments(std::span<const double> heights, double spacing,
                                 Levelling levelling = Levelling::kMean);

/// spectral_moments() of every `step`-th height, averaged over the `step` first heights from which
/// they may be taken. Shows how m2 and m4 move with the sampling interval. Throws Refusal
/// PROFILE_UNUSABLE as spectral_moments() does, also if fewer than five heights are left.
SpectralMoments sampled_moments(std::span<const double> heights, double spacing, int step,
                                Levelling levelling);

/// Length of the waves that make up slopes and curvatures of a profile sampled at `spacing` [m], in
/// spacings: 2 pi/q of the wave whose m2 and m4, as spectral_moments() forms them, are in the
/// profile's ratio, tan(q/2) = dx sqrt(m4/m2)/2. White noise has 3.
double wave_length_in_spacings(const SpectralMoments& moments, double spacing);

/// A profile of shorter waves is noise of the instrument, or was not filtered: its asperities are
/// those of the sampling. ISO 3274 samples five times or more in the cut-off wave length lambda_s;
/// even white noise has waves of 5.3 spacings after that filter, and 3 without one.
inline constexpr double kLeastSpacingsPerWave = 4;

/// What profiles of machined and polished surfaces have, with some reserve (assumed): rms heights
/// [m] of optical discs to those of castings, and rms slopes up to those that a stylus can follow.
/// Beyond them a unit is wrong.
inline constexpr double kLeastRmsHeight = 1e-9, kMostRmsHeight = 1e-4;
inline constexpr double kLeastRmsSlope = 5e-4, kMostRmsSlope = 2;

/// Eq 46, the isotropic surface equivalent to an anisotropic one measured along the axial and the
/// radial direction: m0 is the arithmetic mean, m2 and m4 are the geometric means sqrt(m_a m_r).
/// The paper prints sqrt(m_a + m_r), which has the wrong dimension for m4 and gives sqrt(2 m)
/// instead of m for an isotropic surface (as_published.eq46_square_root_of_sum).
/// Source: R. S. Sayles and T. R. Thomas, Appl. Energy 2 (1976) 249-267.
SpectralMoments equivalent_isotropic_moments(const SpectralMoments& axial,
                                             const SpectralMoments& radial,
                                             const AsPublished& as_published);

/// Eq 47: the moments of two uncorrelated surfaces in contact add up.
SpectralMoments composite_moments(const SpectralMoments& pinion, const SpectralMoments& gear);

/// Eq 48, the Greenwood-Tripp parameters of an isotropic Gaussian surface:
///
///   eta_G = m4/(6 pi sqrt(3) m2),   beta_G = 0.375 sqrt(pi/m4),   sigma_G = sqrt(m0).
///
/// Throws Refusal SURFACE_WITHOUT_ROUGHNESS when a moment is not positive and finite: a perfectly
/// smooth surface has no asperities to describe.
/// Sources: M. S. Longuet-Higgins, Phil. Trans. R. Soc. A 249 (1957) 321-387; A. W. Bush, R. D.
/// Gibson, T. R. Thomas, Wear 35 (1975) 87-111.
Roughness greenwood_tripp_roughness(const SpectralMoments& composite);

}  // namespace tribodyn
