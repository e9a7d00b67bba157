#include "core/study/order_spectrum.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numeric>
#include <unsupported/Eigen/FFT>

namespace tribodyn {

double transform_products(long samples) {
  double factors = 0;
  long left = samples;
  for (long factor = 2; factor * factor <= left; ++factor) {
    for (; left % factor == 0; left /= factor) factors += static_cast<double>(factor);
  }
  if (left > 1) factors += static_cast<double>(left);
  return static_cast<double>(samples) * factors;
}

OrderSpectrum order_spectrum(std::span<const double> samples, std::size_t lines) {
  const auto count = static_cast<double>(samples.size());
  OrderSpectrum out{};
  out.mean = std::accumulate(samples.begin(), samples.end(), 0.0) / count;
  std::vector<double> alternating(samples.begin(), samples.end());
  for (double& each : alternating) {
    each -= out.mean;
    out.alternating_mean_square += each * each / count;
  }
  std::vector<std::complex<double>> transform;
  Eigen::FFT<double> fourier;
  fourier.fwd(transform, alternating);
  for (std::size_t k = 1; k <= std::min(lines, samples.size() / 2); ++k) {
    const double sides = 2 * k == samples.size() ? 1 : 2;  // half the samples: its own mirror image
    out.amplitudes.push_back(sides * std::abs(transform[k]) / count);
    out.phase_angles.push_back(std::arg(transform[k]));
  }
  return out;
}

}  // namespace tribodyn
