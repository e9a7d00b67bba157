#pragma once

#include <span>
#include <vector>

namespace tribodyn {

/// What a discrete Fourier transform may cost: samples times the sum of the prime factors of their
/// number. About a second, by a transform of 99,991 samples (a prime) and 2^20 samples.
inline constexpr double kMostTransformProducts = 3e8;

/// Returns samples times the sum of the prime factors of their number, the cost of their transform.
double transform_products(long samples);

/// The spectrum of a signal over orders: multiples of 1/cycles of the frequency of a cycle. The
/// signal is
///
///   z(phase) = mean + sum_{k=1}^{n/2} amplitude_k cos(2 pi k phase/cycles + phase_angle_k)
///
/// at its n samples, phase in cycles from the first one.
struct OrderSpectrum {
  double mean;
  double alternating_mean_square;    ///< mean of (z - mean)^2
  std::vector<double> amplitudes;    ///< of k = 1, 2, ..., from zero to peak
  std::vector<double> phase_angles;  ///< in (-pi, pi] [rad]
};

/// Transforms samples at equal distances of phase over a whole number of cycles, without a window,
/// and keeps the first `lines` amplitudes, at most samples.size()/2. By Parseval
///
///   alternating_mean_square = sum_k amplitude_k^2/2
///
/// over all of them, where an even number of samples counts its last amplitude twice. Requires
/// transform_products() of at most kMostTransformProducts.
OrderSpectrum order_spectrum(std::span<const double> samples, std::size_t lines);

}  // namespace tribodyn
