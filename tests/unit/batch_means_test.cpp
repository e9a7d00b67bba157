// The error of the mean of a series whose values depend on one another, and where its transient
// ends.
#include "core/numerics/batch_means.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "core/numerics/square.h"
#include "core/numerics/students_t.h"

namespace tribodyn {
namespace {

/// A stationary first-order autoregression about 0, of variance 1.
std::vector<double> autoregression(double correlation, std::size_t count, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  std::vector<double> out(count);
  double value = normal(random);
  for (double& each : out) {
    each = value;
    value = correlation * value + std::sqrt(1 - square(correlation)) * normal(random);
  }
  return out;
}

struct Coverage {
  double share;   ///< of the intervals that are given, those that hold the true mean
  double given;   ///< share of the series that have an interval
  double excess;  ///< mean half-width over that of a normal mean whose variance is known
};

Coverage coverage_of(double correlation, std::size_t count, int repetitions) {
  constexpr double kNormal95 = 1.959964;
  const double deviation =
      std::sqrt((1 + correlation) / (1 - correlation) / static_cast<double>(count));
  std::mt19937_64 random(1);
  double given = 0, held = 0, width = 0;
  for (int i = 0; i < repetitions; ++i) {
    const std::vector<double> series = autoregression(correlation, count, random);
    const std::optional<double> half = half_width_of_mean(series, 0.95);
    if (!half) continue;
    double mean = 0;
    for (const double each : series) mean += each / static_cast<double>(count);
    ++given;
    held += std::abs(mean) <= *half ? 1 : 0;
    width += *half;
  }
  return {held / given, given / repetitions, width / given / (kNormal95 * deviation)};
}

// The bounds leave out one of a thousand counts of intervals that hold as often as they say.
TEST(BatchMeans, CoverTheMeanOfAnAutoregressionAsOftenAsTheySay) {
  constexpr int kRepetitions = 2000;
  constexpr std::size_t kCount = 1000;
  const double bound = 3.29 * std::sqrt(0.95 * 0.05 / kRepetitions);
  for (const double correlation : {0.0, 0.3, 0.6, 0.9}) {
    SCOPED_TRACE(correlation);
    const Coverage c = coverage_of(correlation, kCount, kRepetitions);
    EXPECT_NEAR(c.share, 0.95, bound);
    EXPECT_GT(c.given, 0.95);
    EXPECT_LT(c.excess, 1.5);
  }
}

// So few values do not tell how they depend on one another.
TEST(BatchMeans, OfFewIndependentValuesAreWiderThanTheyNeedBe) {
  constexpr int kRepetitions = 2000;
  for (const std::size_t count : {8u, 16u, 32u}) {
    SCOPED_TRACE(count);
    const Coverage c = coverage_of(0, count, kRepetitions);
    EXPECT_GT(c.share, 0.95 - 3.09 * std::sqrt(0.95 * 0.05 / kRepetitions));
    EXPECT_GT(c.excess, 1);
    EXPECT_LT(c.excess, 2);
  }
}

TEST(BatchMeans, AConstantSeriesHasNoError) {
  EXPECT_EQ(half_width_of_mean(std::vector<double>(8, 3.0), 0.95), 0.0);
}

TEST(BatchMeans, FewValuesAndSeriesThatDriftHaveNoInterval) {
  EXPECT_FALSE(half_width_of_mean(std::vector<double>{1, 2, 3}, 0.95));
  std::vector<double> drifting;
  for (int i = 0; i < 40; ++i) drifting.push_back(i + 0.1 * (i % 3));
  EXPECT_FALSE(half_width_of_mean(drifting, 0.95));
}

TEST(BatchMeans, ScaleWithTheSeries) {
  std::mt19937_64 random(2);
  std::vector<double> series = autoregression(0.5, 50, random);
  const double half = half_width_of_mean(series, 0.95).value();
  for (double& each : series) each = 1e6 + 10 * each;
  EXPECT_NEAR(half_width_of_mean(series, 0.95).value(), 10 * half, 1e-6 * half);
}

TEST(InitialTransient, EndsWhereADecayIsLostInTheNoise) {
  constexpr std::size_t kCount = 100;
  constexpr double kDecay = 5, kAmplitude = 20;
  std::mt19937_64 random(3);
  for (int i = 0; i < 200; ++i) {
    std::vector<double> series = autoregression(0, kCount, random);
    for (std::size_t n = 0; n < kCount; ++n) {
      series[n] += kAmplitude * std::exp(-static_cast<double>(n) / kDecay);
    }
    const std::size_t first = initial_transient(series);
    // exp(-8/5) of 20 is three standard deviations.
    EXPECT_GE(first, 8u);
    EXPECT_LE(first, 50u);
  }
}

TEST(InitialTransient, LeavesOutAtMostTheFirstHalf) {
  std::vector<double> drifting;
  for (int i = 0; i < 41; ++i) drifting.push_back(i);
  EXPECT_EQ(initial_transient(drifting), 20u);
  EXPECT_EQ(initial_transient(std::vector<double>{7}), 0u);
  EXPECT_EQ(initial_transient(std::vector<double>{}), 0u);
  EXPECT_EQ(initial_transient(std::vector<double>(9, 1.0)), 0u);
}

// Published tables.
TEST(StudentsT, HasTheTabulatedQuantiles) {
  EXPECT_NEAR(students_t_quantile(2, 0.975), 4.303, 5e-4);
  EXPECT_NEAR(students_t_quantile(10, 0.975), 2.228, 5e-4);
  EXPECT_NEAR(students_t_quantile(1e6, 0.975), 1.960, 5e-4);
}

}  // namespace
}  // namespace tribodyn
