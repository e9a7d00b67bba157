// Order spectra: known cosines come back, Parseval's identity holds, and so does the definition.
#include "core/study/order_spectrum.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

namespace tribodyn {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;

std::vector<double> ragged_signal(std::size_t samples) {
  std::vector<double> out;
  for (std::size_t i = 0; i < samples; ++i) {
    const double phase = static_cast<double>(i) / static_cast<double>(samples);
    out.push_back(3 + std::abs(std::sin(7.3 * phase)) - 0.2 * static_cast<double>(i % 5));
  }
  return out;
}

TEST(OrderSpectrum, CosinesComeBackWithAmplitudeAndPhase) {
  constexpr int kCycles = 2, kSamplesPerCycle = 96;
  std::vector<double> z;
  for (int i = 0; i < kCycles * kSamplesPerCycle; ++i) {
    const double phase = static_cast<double>(i) / kSamplesPerCycle;
    z.push_back(5 + 2 * std::cos(kTurn * phase + 0.3) + 0.25 * std::cos(kTurn * 2.5 * phase - 3));
  }
  const OrderSpectrum spectrum = order_spectrum(z, 1000);
  ASSERT_EQ(spectrum.amplitudes.size(), z.size() / 2);
  EXPECT_NEAR(spectrum.mean, 5, 1e-14);
  for (std::size_t k = 1; k <= spectrum.amplitudes.size(); ++k) {  // order k/2
    const double wanted = k == 2 ? 2 : k == 5 ? 0.25 : 0;
    EXPECT_NEAR(spectrum.amplitudes[k - 1], wanted, 1e-14) << k;
  }
  EXPECT_NEAR(spectrum.phase_angles[1], 0.3, 1e-13);
  EXPECT_NEAR(spectrum.phase_angles[4], -3, 1e-13);
}

TEST(OrderSpectrum, HalvesOfSquaredAmplitudesSumToTheMeanSquare) {
  for (const std::size_t samples : {2U, 3U, 97U, 192U, 360U, 1155U}) {
    SCOPED_TRACE(samples);
    const OrderSpectrum spectrum = order_spectrum(ragged_signal(samples), samples);
    double sum = 0;
    for (std::size_t k = 1; k <= spectrum.amplitudes.size(); ++k) {
      const double share = 2 * k == samples ? 1 : 0.5;
      sum += share * spectrum.amplitudes[k - 1] * spectrum.amplitudes[k - 1];
    }
    EXPECT_NEAR(sum, spectrum.alternating_mean_square, 1e-13);
  }
}

TEST(OrderSpectrum, IsTheDiscreteFourierTransform) {
  const std::vector<double> z = ragged_signal(45);
  const OrderSpectrum spectrum = order_spectrum(z, 10);
  ASSERT_EQ(spectrum.amplitudes.size(), 10U);
  for (std::size_t k = 1; k <= 10; ++k) {
    std::complex<double> sum;
    for (std::size_t i = 0; i < z.size(); ++i) {
      sum += z[i] * std::polar(1.0, -kTurn * static_cast<double>(k * i) / 45);
    }
    EXPECT_NEAR(spectrum.amplitudes[k - 1], std::abs(sum) * 2 / 45, 1e-13);
    EXPECT_NEAR(std::remainder(spectrum.phase_angles[k - 1] - std::arg(sum), kTurn), 0, 1e-11);
  }
}

TEST(OrderSpectrum, AConstantHasNoAmplitude) {
  const OrderSpectrum spectrum = order_spectrum(std::vector<double>(48, 7.5), 24);
  EXPECT_EQ(spectrum.mean, 7.5);
  EXPECT_EQ(spectrum.alternating_mean_square, 0);
  for (const double each : spectrum.amplitudes) EXPECT_EQ(each, 0);
}

TEST(OrderSpectrum, TheCostGrowsWithThePrimeFactors) {
  EXPECT_EQ(transform_products(192), 192 * (6 * 2 + 3));
  EXPECT_EQ(transform_products(97), 97 * 97);
  EXPECT_LT(transform_products(1 << 20), kMostTransformProducts);
  EXPECT_GT(transform_products(99'991), kMostTransformProducts);
}

}  // namespace
}  // namespace tribodyn
