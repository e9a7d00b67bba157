#include "core/contact/asperity_functions.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "tests/support/reference_data.h"

namespace tribodyn {
namespace {

double asperity_function_2(double film_ratio) { return asperity_functions(film_ratio).f2; }
double asperity_function_5_2(double film_ratio) { return asperity_functions(film_ratio).f5_2; }
AsperityFunctions asperity_functions_as_published(double film_ratio) {
  return {laws::f2_as_published(film_ratio), laws::f5_2_as_published(film_ratio)};
}

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kLastNormal = 37.2;  // F_n is a normal number up to here

double relative_error(double value, long double exact) {
  return static_cast<double>(std::abs((static_cast<long double>(value) - exact) / exact));
}

// An independent method: with t = u^2 the integrand of F_n is entire, and Gauss-Legendre panels in
// extended precision are exact to it.
struct LongRule {
  static constexpr int kPoints = 20;
  std::array<long double, kPoints> node{};
  std::array<long double, kPoints> weight{};
  LongRule() {
    for (int i = 0; i < kPoints; ++i) {
      long double x = std::cos(std::numbers::pi_v<long double> * (i + 0.75L) / (kPoints + 0.5L));
      long double slope = 0;
      for (int iteration = 0; iteration < 50; ++iteration) {
        long double previous = 1, value = x;
        for (int n = 2; n <= kPoints; ++n) {
          const long double next = ((2 * n - 1) * x * value - (n - 1) * previous) / n;
          previous = value;
          value = next;
        }
        slope = kPoints * (x * value - previous) / (x * x - 1);
        x -= value / slope;
      }
      node[i] = x;
      weight[i] = 2 / ((1 - x * x) * slope * slope);
    }
  }
};

long double quadrature(long double order, long double film_ratio) {
  static const LongRule rule;
  constexpr int kPanels = 16;
  const long double last_t = std::sqrt(film_ratio * film_ratio + 2 * 60) - film_ratio;
  const long double half = std::sqrt(last_t) / kPanels / 2;
  long double sum = 0;
  for (int panel = 0; panel < kPanels; ++panel) {
    for (int i = 0; i < LongRule::kPoints; ++i) {
      const long double u = (2 * panel + 1 + rule.node[i]) * half;
      const long double t = u * u;
      sum += rule.weight[i] * half * 2 * std::pow(u, 2 * order + 1) *
             std::exp(-t * (t / 2 + film_ratio));
    }
  }
  return sum * std::exp(-film_ratio * film_ratio / 2) /
         std::sqrt(2 * std::numbers::pi_v<long double>);
}

TEST(AsperityFunctions, MatchPublishedValues) {
  const nlohmann::json checks =
      load_reference("published_checks.json").at("asperity_functions_exact");
  const double tolerance = checks.at("relative_tolerance");
  for (std::size_t i = 0; i < checks.at("lambda").size(); ++i) {
    const AsperityFunctions f = asperity_functions(checks.at("lambda")[i]);
    const double f2 = checks.at("F_2")[i];
    const double f5_2 = checks.at("F_5_2")[i];
    EXPECT_NEAR(f.f2, f2, tolerance * f2);
    EXPECT_NEAR(f.f5_2, f5_2, tolerance * f5_2);
  }
}

TEST(AsperityFunctions, MatchIndependentQuadrature) {
  std::mt19937_64 random(20240229);
  std::uniform_real_distribution<double> everywhere(0, kLastNormal);
  std::uniform_real_distribution<double> mixed_lubrication(0, 4);
  for (int i = 0; i < 400; ++i) {
    const double l = i % 2 == 0 ? everywhere(random) : mixed_lubrication(random);
    EXPECT_LT(relative_error(asperity_function_2(l), quadrature(2.0L, l)), 3e-15) << l;
    EXPECT_LT(relative_error(asperity_function_5_2(l), quadrature(2.5L, l)), 3e-15) << l;
  }
}

TEST(AsperityFunctions, MatchIndependentQuadratureBelowTheMeanPlane) {
  for (double l = -40; l < 0; l += 0.0973) {
    EXPECT_LT(relative_error(asperity_function_2(l), quadrature(2.0L, l)), 3e-15) << l;
    EXPECT_LT(relative_error(asperity_function_5_2(l), quadrature(2.5L, l)), 3e-15) << l;
  }
}

TEST(AsperityFunctions, GiveBackTheSeparationUnderTheirLoad) {
  for (double l = -50; l < 1.1; l += 0.137) {
    EXPECT_NEAR(separation_under_load(asperity_function_5_2(l), 1.2), l, 1e-13 * (1 + std::abs(l)));
  }
}

TEST(AsperityFunctions, MatchClosedFormsAtZeroFilm) {
  // F_n(0) = 2^((n-1)/2) Gamma((n+1)/2)/sqrt(2 pi)
  EXPECT_NEAR(asperity_function_2(0), 0.5, 1e-15);
  EXPECT_NEAR(asperity_function_5_2(0),
              std::pow(2, 0.75) * std::tgamma(1.75) / std::sqrt(2 * std::numbers::pi), 2e-15);
}

TEST(AsperityFunctions, MatchTheClosedFormOfF2WhereItDoesNotCancel) {
  for (double film_ratio = 0; film_ratio <= 3; film_ratio += 0.01) {
    const long double l = film_ratio;
    const long double tail = 0.5L * std::erfc(l / std::numbers::sqrt2_v<long double>);
    const long double density =
        std::exp(-l * l / 2) / std::sqrt(2 * std::numbers::pi_v<long double>);
    const long double closed = (1 + l * l) * tail - l * density;
    EXPECT_LT(relative_error(asperity_function_2(film_ratio), closed), 3e-15) << film_ratio;
  }
}

TEST(AsperityFunctions, MatchTheAsymptoticSeriesAtThickFilms) {
  // F_n(l) ~ exp(-l^2/2)/sqrt(2 pi) sum_j (-1/2)^j Gamma(n+2j+1)/(j! l^(n+2j+1))
  for (double l = 15; l < kLastNormal; l += 0.37) {
    for (const double n : {2.0, 2.5}) {
      const long double x = l;
      long double term = std::tgamma(n + 1.0L) / std::pow(x, n + 1.0L);
      long double sum = 0;
      for (int j = 0; j < 15; ++j) {
        sum += term;
        term *= -(n + 2 * j + 1) * (n + 2 * j + 2) / (2 * (j + 1) * x * x);
      }
      sum *= std::exp(-x * x / 2) / std::sqrt(2 * std::numbers::pi_v<long double>);
      const double value = n == 2 ? asperity_function_2(l) : asperity_function_5_2(l);
      EXPECT_LT(relative_error(value, sum), 1e-11) << "F_" << n << "(" << l << ")";
    }
  }
}

// F_n' = -n F_(n-1) and F_(n+1) + l F_n = n F_(n-1) together: F_n'' + l F_n' - n F_n = 0.
TEST(AsperityFunctions, SatisfyTheirDifferentialEquation) {
  constexpr double kStep = 1.0 / 32;
  const auto residual = [](auto function, double n, double l) {
    // central differences of eighth order
    const std::array<double, 5> first{0, 4.0 / 5, -1.0 / 5, 4.0 / 105, -1.0 / 280};
    const std::array<double, 5> second{-205.0 / 72, 8.0 / 5, -1.0 / 5, 8.0 / 315, -1.0 / 560};
    double slope = 0;
    double curvature = second[0] * function(l);
    for (int j = 1; j < 5; ++j) {
      const double ahead = function(l + j * kStep);
      const double behind = function(l - j * kStep);
      slope += first[j] * (ahead - behind);
      curvature += second[j] * (ahead + behind);
    }
    return (curvature / (kStep * kStep) + l * slope / kStep) / (n * function(l)) - 1;
  };
  for (double l = 0.2; l < 8; l += 0.0713) {
    EXPECT_NEAR(residual(asperity_function_2, 2, l), 0, 3e-7 * (1 + l)) << l;
    EXPECT_NEAR(residual(asperity_function_5_2, 2.5, l), 0, 3e-7 * (1 + l)) << l;
  }
}

TEST(AsperityFunctions, HaveTheGaussianTailAsCurvatureOfF2) {
  // F_2'' = 2 F_0 = erfc(l/sqrt 2)
  constexpr double kStep = 1e-3;
  for (double l = 0.05; l < 5; l += 0.05) {
    const double curvature = (asperity_function_2(l + kStep) - 2 * asperity_function_2(l) +
                              asperity_function_2(l - kStep)) /
                             (kStep * kStep);
    const double tail = std::erfc(l / std::numbers::sqrt2);
    EXPECT_NEAR(curvature, tail, 1e-5 * tail + 1e-9) << l;
  }
}

TEST(AsperityFunctions, AreContinuousWherePiecesJoin) {
  for (int k = 0; k < 148; ++k) {
    const double join = (k + 0.5) / 4;
    const AsperityFunctions left = asperity_functions(std::nextafter(join, 0.0));
    const AsperityFunctions right = asperity_functions(join);
    // one step of the argument itself changes F_n by about l ulp(l)
    const double tolerance = 5e-15 + join * join * 2.3e-16;
    EXPECT_NEAR(left.f2 / right.f2, 1, tolerance) << join;
    EXPECT_NEAR(left.f5_2 / right.f5_2, 1, tolerance) << join;
  }
}

TEST(AsperityFunctions, FallMonotonicallyToZeroAtThickFilms) {
  double last_2 = kInfinity;
  double last_5_2 = kInfinity;
  for (double l = 0; l < 39.5; l += 1.0 / 64) {
    const AsperityFunctions f = asperity_functions(l);
    EXPECT_GE(f.f2, 0);
    EXPECT_GE(f.f5_2, 0);
    EXPECT_TRUE(l < kLastNormal ? f.f2 < last_2 : f.f2 <= last_2) << l;
    EXPECT_TRUE(l < kLastNormal ? f.f5_2 < last_5_2 : f.f5_2 <= last_5_2) << l;
    last_2 = f.f2;
    last_5_2 = f.f5_2;
  }
  for (const double l : {38.75, 40.0, 1e5, 1e300, kInfinity}) {
    EXPECT_EQ(asperity_function_2(l), 0) << l;
    EXPECT_EQ(asperity_function_5_2(l), 0) << l;
    EXPECT_EQ(asperity_functions(l).f2, 0) << l;
    EXPECT_EQ(asperity_functions(l).f5_2, 0) << l;
  }
}

TEST(AsperityFunctions, AreNotANumberOfWhatIsNone) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(std::isnan(asperity_function_2(nan)));
  EXPECT_TRUE(std::isnan(asperity_function_5_2(nan)));
  EXPECT_EQ(asperity_function_2(-0.0), asperity_function_2(0.0));
}

TEST(AsperityFunctions, HaveTheSlopesOfTheIntegrals) {
  for (double l = 0; l < 12; l += 0.0431) {
    const auto f = asperity_functions_and_slopes(l);
    EXPECT_EQ(f.f2.value, asperity_functions(l).f2) << l;
    EXPECT_EQ(f.f5_2.value, asperity_functions(l).f5_2) << l;
    EXPECT_LT(relative_error(f.f2.slope[0] / -2, quadrature(1.0L, l)), 1e-12) << l;
    EXPECT_LT(relative_error(f.f5_2.slope[0] / -2.5, quadrature(1.5L, l)), 1e-12) << l;
  }
}

TEST(AsperityFunctionsAsPublished, AreThePrintedPolynomials) {
  const AsperityFunctions zero = asperity_functions_as_published(0);
  EXPECT_EQ(zero.f5_2, 0.6167);
  EXPECT_EQ(zero.f2, 0.5003);
  const AsperityFunctions one = asperity_functions_as_published(1);
  EXPECT_NEAR(one.f5_2, -0.0046 + 0.0574 - 0.2958 + 0.7844 - 1.0776 + 0.6167, 1e-15);
  EXPECT_NEAR(one.f2, -0.0018 + 0.0281 - 0.1728 + 0.5258 - 0.8043 + 0.5003, 1e-15);
  const AsperityFunctions ten = asperity_functions_as_published(10);
  EXPECT_NEAR(ten.f5_2, -460 + 574 - 295.8 + 78.44 - 10.776 + 0.6167, 1e-10);
  EXPECT_NEAR(ten.f2, -180 + 281 - 172.8 + 52.58 - 8.043 + 0.5003, 1e-10);
}

TEST(AsperityFunctionsAsPublished, AreCloseForThinFilmsAndNegativeForThickOnes) {
  for (double l = 0; l < 1.4; l += 0.01) {
    EXPECT_NEAR(asperity_functions_as_published(l).f2 / asperity_function_2(l), 1, 0.02) << l;
    EXPECT_NEAR(asperity_functions_as_published(l).f5_2 / asperity_function_5_2(l), 1, 0.02) << l;
  }
  EXPECT_GT(asperity_functions_as_published(2.223).f5_2, 0);
  EXPECT_LT(asperity_functions_as_published(2.225).f5_2, 0);
  EXPECT_GT(asperity_functions_as_published(2.293).f2, 0);
  EXPECT_LT(asperity_functions_as_published(2.295).f2, 0);
  const AsperityFunctions printed = asperity_functions_as_published(2);
  const AsperityFunctions exact = asperity_functions(2);
  EXPECT_NEAR(std::abs(printed.f5_2 / exact.f5_2 - 1), 0.28, 0.01);
  EXPECT_NEAR(std::abs(printed.f2 / exact.f2 - 1), 0.22, 0.01);
}

}  // namespace
}  // namespace tribodyn
