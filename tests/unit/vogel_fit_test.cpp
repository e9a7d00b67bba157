#include "core/lubricant/vogel_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "tests/support/reference_scene.h"
#include "tests/support/refusal_reason.h"

namespace tribodyn {
namespace {

struct Law {
  double prefactor, coefficient, reference;
  double operator()(double temperature) const {
    return prefactor * std::exp(coefficient / (temperature - reference));
  }
};
constexpr Law kOil{1.55e-4, 944.8, 159};

std::vector<ViscosityPoint> table(const Law& law, const std::vector<double>& celsius,
                                  double uncertainty = 0) {
  std::vector<ViscosityPoint> points;
  for (const double c : celsius) points.push_back({c + 273.15, law(c + 273.15), uncertainty});
  return points;
}

std::string reason(const std::vector<ViscosityPoint>& points) {
  return refusal_of([&] { fit_vogel(points); });
}

TEST(VogelFit, RecoversTheLawThatMadeTheTable) {
  for (const int fluid : {1, 2, 3}) {
    const Lubricant lubricant = reference_lubricant(fluid);
    const Law law{lubricant.vogel_viscosity_prefactor, lubricant.vogel_temperature_coefficient,
                  lubricant.vogel_reference_temperature};
    for (const std::vector<double>& celsius :
         {std::vector<double>{40, 70, 100}, {100, -10, 140, 40, 10, 70}, {-40, 40, 100}}) {
      const VogelFit fit = fit_vogel(table(law, celsius));
      EXPECT_FALSE(fit.reference_temperature_assumed);
      EXPECT_NEAR(fit.viscosity_prefactor / law.prefactor, 1, 1e-9);
      EXPECT_NEAR(fit.temperature_coefficient / law.coefficient, 1, 1e-9);
      EXPECT_NEAR(fit.reference_temperature / law.reference, 1, 1e-9);
      EXPECT_LT(fit.root_mean_square_residual, 1e-12);
      EXPECT_EQ(fit.degrees_of_freedom, static_cast<int>(celsius.size()) - 3);
    }
  }
}

TEST(VogelFit, RecoversRandomLaws) {
  std::mt19937 random(34);
  std::uniform_real_distribution<double> lg_eta(-4.6, -3.6), coefficient(500, 1600),
      reference(90, 180);
  for (int i = 0; i < 500; ++i) {
    const Law law{std::pow(10, lg_eta(random)), coefficient(random), reference(random)};
    const VogelFit fit = fit_vogel(table(law, {-10, 20, 40, 60, 80, 100, 120}, 0.01));
    EXPECT_NEAR(fit.viscosity_prefactor / law.prefactor, 1, 1e-9);
    EXPECT_NEAR(fit.temperature_coefficient / law.coefficient, 1, 1e-9);
    EXPECT_NEAR(fit.reference_temperature / law.reference, 1, 1e-9);
  }
}

TEST(VogelFit, IsIndependentOfRowOrder) {
  std::vector<ViscosityPoint> points = table(kOil, {-20, 0, 40, 70, 100, 130});
  std::mt19937 random(7);
  std::normal_distribution<double> noise(0, 0.02);
  for (ViscosityPoint& point : points) point.viscosity *= std::exp(noise(random));
  const VogelFit fit = fit_vogel(points);
  std::shuffle(points.begin(), points.end(), random);
  const VogelFit shuffled = fit_vogel(points);
  EXPECT_NEAR(shuffled.reference_temperature, fit.reference_temperature, 1e-8);
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_NEAR(shuffled.residuals[i],
                std::log(points[i].viscosity) - log_viscosity(fit, points[i].temperature), 1e-10);
  }
}

TEST(VogelFit, MinimisesItsSquares) {
  std::vector<ViscosityPoint> points = table(kOil, {-20, 0, 20, 40, 70, 100, 130});
  std::mt19937 random(11);
  std::normal_distribution<double> noise(0, 0.03);
  for (int trial = 0; trial < 50; ++trial) {
    std::vector<ViscosityPoint> noisy = points;
    for (ViscosityPoint& point : noisy) point.viscosity *= std::exp(noise(random));
    const VogelFit fit = fit_vogel(noisy);
    const auto squares = [&](double a, double b, double c) {
      double sum = 0;
      for (const ViscosityPoint& p : noisy) {
        sum += std::pow(std::log(p.viscosity) - a - b / (p.temperature - c), 2);
      }
      return sum;
    };
    const double a = std::log(fit.viscosity_prefactor), b = fit.temperature_coefficient,
                 c = fit.reference_temperature;
    const double least = squares(a, b, c);
    EXPECT_NEAR(least / 7, std::pow(fit.root_mean_square_residual, 2), 1e-12);
    for (const double s : {-1e-3, 1e-3}) {
      EXPECT_GT(squares(a + s, b, c), least);
      EXPECT_GT(squares(a, b * (1 + s), c), least);
      EXPECT_GT(squares(a, b, c + 100 * s), least);
    }
  }
}

// Share of trials in which the law lies within two standard uncertainties of the fit.
struct Coverage {
  double prefactor = 0, coefficient = 0, reference = 0, viscosity = 0;
};

Coverage coverage(const std::vector<double>& celsius, double noise_level, bool stated, int trials) {
  std::mt19937 random(20260101);
  std::normal_distribution<double> noise(0, noise_level);
  const std::vector<ViscosityPoint> exact = table(kOil, celsius, stated ? noise_level : 0);
  Coverage share;
  for (int trial = 0; trial < trials; ++trial) {
    std::vector<ViscosityPoint> points = exact;
    for (ViscosityPoint& point : points) point.viscosity *= std::exp(noise(random));
    const VogelFit fit = fit_vogel(points);
    const auto within = [&](double error, double variance) {
      return error * error <= 4 * variance ? 1.0 / trials : 0;
    };
    share.prefactor +=
        within(std::log(fit.viscosity_prefactor / kOil.prefactor), fit.covariance(0, 0));
    share.coefficient +=
        within(fit.temperature_coefficient - kOil.coefficient, fit.covariance(1, 1));
    share.reference += within(fit.reference_temperature - kOil.reference, fit.covariance(2, 2));
    share.viscosity += within(log_viscosity(fit, 353.15) - std::log(kOil(353.15)),
                              std::pow(relative_viscosity_uncertainty(fit, 353.15), 2));
  }
  return share;
}

TEST(VogelFit, UncertaintiesCoverTheTruth) {
  // Stated noise, widened by chi-square where that exceeds 1: a little more than 95.4 %.
  const Coverage stated =
      coverage({-30, -10, 10, 25, 40, 55, 70, 85, 100, 120, 140}, 0.01, true, 4000);
  // Estimated from 12 - 3 = 9 degrees of freedom: Student's t within 2 is 92.3 %.
  const Coverage estimated =
      coverage({-30, -10, 10, 25, 40, 55, 70, 85, 100, 115, 130, 140}, 0.01, false, 4000);
  for (const double share :
       {stated.prefactor, stated.coefficient, stated.reference, stated.viscosity}) {
    EXPECT_GT(share, 0.95);
    EXPECT_LT(share, 0.98);
  }
  for (const double share :
       {estimated.prefactor, estimated.coefficient, estimated.reference, estimated.viscosity}) {
    EXPECT_NEAR(share, 0.923, 0.015);
  }
}

TEST(VogelFit, HeedsWeights) {
  std::vector<ViscosityPoint> points = table(kOil, {-40, -20, 0, 40, 70, 100, 130}, 0.005);
  points[0].viscosity *= 1.5;
  points[0].relative_standard_uncertainty = 0.5;
  const VogelFit fit = fit_vogel(points);
  EXPECT_NEAR(fit.reference_temperature, kOil.reference, 0.2);
  EXPECT_NEAR(fit.residuals[0], std::log(1.5), 0.01);
}

TEST(VogelFit, AssumesAReferenceTemperatureWhereTheTableHoldsNone) {
  // two temperatures: T_0 is the typical one, both met, and its uncertainty reaches A_1
  const VogelFit two = fit_vogel(table(kOil, {40, 100}));
  EXPECT_TRUE(two.reference_temperature_assumed);
  EXPECT_EQ(two.reference_temperature, kTypicalVogelReferenceTemperature);
  EXPECT_NEAR(std::sqrt(two.covariance(2, 2)), kTypicalVogelReferenceTemperatureUncertainty, 1e-6);
  EXPECT_NEAR(log_viscosity(two, 313.15), std::log(kOil(313.15)), 1e-12);
  EXPECT_NEAR(log_viscosity(two, 373.15), std::log(kOil(373.15)), 1e-12);
  EXPECT_NEAR(relative_viscosity_uncertainty(two, 313.15), kTypicalViscosityUncertainty, 1e-6);
  EXPECT_GT(relative_viscosity_uncertainty(two, 253.15), 0.1);
  EXPECT_EQ(two.degrees_of_freedom, 0);
  // the law itself lies within the uncertainty stated for it
  EXPECT_NEAR(log_viscosity(two, 253.15), std::log(kOil(253.15)),
              2 * relative_viscosity_uncertainty(two, 253.15));
  // three temperatures that hardly differ say nothing of T_0
  EXPECT_TRUE(fit_vogel(table(kOil, {40, 41, 42}, 0.01)).reference_temperature_assumed);
  // a straight line in T (no curvature at all) would want T_0 far below zero
  const VogelFit straight = fit_vogel(std::vector<ViscosityPoint>{
      {300, std::exp(-1.0), 0}, {340, std::exp(-2.0), 0}, {380, std::exp(-3.0), 0}});
  EXPECT_TRUE(straight.reference_temperature_assumed);
}

TEST(VogelFitAt, KeepsTheReferenceTemperature) {
  const VogelFit fit = fit_vogel_at(table(kOil, {40, 100}), 140, 10);
  EXPECT_EQ(fit.reference_temperature, 140);
  EXPECT_NEAR(std::sqrt(fit.covariance(2, 2)), 10, 1e-6);
  EXPECT_NEAR(log_viscosity(fit, 313.15), std::log(kOil(313.15)), 1e-12);
  EXPECT_EQ(refusal_reason([] {
              fit_vogel_at(table(kOil, {-60, 100}), 210, 10);
            }),
            "VISCOSITY_TABLE_NOT_VOGEL");
}

TEST(VogelFit, RefusesNonsense) {
  const auto with = [](std::size_t row, double temperature, double viscosity, double u = 0) {
    std::vector<ViscosityPoint> points = table(kOil, {0, 40, 70, 100});
    points[row] = {temperature, viscosity, u};
    return reason(points);
  };
  EXPECT_EQ(reason({}).substr(0, 25), "VISCOSITY_TABLE_TOO_SHORT");
  EXPECT_EQ(reason(table(kOil, {40})).substr(0, 25), "VISCOSITY_TABLE_TOO_SHORT");
  EXPECT_EQ(reason(table(kOil, {40, 40, 40.2})).substr(0, 25), "VISCOSITY_TABLE_TOO_SHORT");
  for (const double bad : {0.0, -1.0, (double)NAN, (double)INFINITY, 1e9}) {
    const std::string text = with(2, 343.15, bad);
    EXPECT_EQ(text.substr(0, 28), "VISCOSITY_TABLE_OUT_OF_RANGE");
    EXPECT_NE(text.find("row 3"), std::string::npos);
  }
  EXPECT_EQ(with(1, 40, 0.07).substr(0, 28), "VISCOSITY_TABLE_OUT_OF_RANGE");  // Celsius
  EXPECT_EQ(with(1, NAN, 0.07).substr(0, 28), "VISCOSITY_TABLE_OUT_OF_RANGE");
  EXPECT_EQ(with(1, 313.15, 0.07, -0.1).substr(0, 28), "VISCOSITY_TABLE_OUT_OF_RANGE");
  EXPECT_EQ(with(1, 313.15, 0.07, NAN).substr(0, 28), "VISCOSITY_TABLE_OUT_OF_RANGE");
  const std::string rises = with(3, 373.15, 0.5);
  EXPECT_EQ(rises.substr(0, 28), "VISCOSITY_TABLE_NOT_MONOTONE");
  EXPECT_NE(rises.find("row 4"), std::string::npos);
  // replicates that contradict each other
  EXPECT_EQ(with(1, 343.15, 0.07).substr(0, 28), "VISCOSITY_TABLE_NOT_MONOTONE");
  // a rise inside the noise is accepted
  std::vector<ViscosityPoint> flat = table(kOil, {0, 40, 41, 100}, 0.05);
  std::swap(flat[1].viscosity, flat[2].viscosity);
  EXPECT_EQ(reason(flat), "none");
  // gelled at the coldest row: a wall that no T_0 below it follows
  const std::string gelled = reason({{233.15, 1e6, 0},
                                     {253.15, 1, 0},
                                     {313.15, 0.07, 0},
                                     {343.15, 0.026, 0},
                                     {373.15, 0.0128, 0}});
  EXPECT_EQ(gelled.substr(0, 25), "VISCOSITY_TABLE_NOT_VOGEL");
  EXPECT_NE(gelled.find("row 1"), std::string::npos);
}

TEST(VogelFit, AnswersInFiniteNumbersOrRefuses) {
  // any table gives finite numbers or a named refusal
  std::mt19937 random(99);
  std::uniform_real_distribution<double> temperature(195, 630), lg(-5.2, 7.2), kind(0, 1);
  std::uniform_int_distribution<int> rows(0, 8);
  int fitted = 0;
  for (int trial = 0; trial < 20000; ++trial) {
    std::vector<ViscosityPoint> points;
    const bool tame = kind(random) < 0.7;
    const Law law{std::pow(10, -4.5 + kind(random)), 300 + 2500 * kind(random),
                  40 + 180 * kind(random)};
    for (int i = rows(random); i > 0; --i) {
      const double t = temperature(random);
      points.push_back({t, tame ? law(t) * (1 + 0.1 * kind(random)) : std::pow(10, lg(random)),
                        kind(random) < 0.3 ? 0.1 * kind(random) : 0});
    }
    try {
      const VogelFit fit = fit_vogel(points);
      ++fitted;
      EXPECT_TRUE(std::isfinite(fit.viscosity_prefactor) && fit.viscosity_prefactor > 0);
      EXPECT_TRUE(fit.temperature_coefficient > 0 && std::isfinite(fit.temperature_coefficient));
      EXPECT_TRUE(fit.covariance.allFinite() && std::isfinite(fit.condition_number));
      EXPECT_TRUE((fit.covariance.diagonal().array() >= 0).all());
      for (const double residual : fit.residuals) EXPECT_TRUE(std::isfinite(residual));
      for (const ViscosityPoint& p : points) EXPECT_LT(fit.reference_temperature, p.temperature);
    } catch (const Refusal& refusal) {
      EXPECT_EQ(refusal.reason().substr(0, 16), "VISCOSITY_TABLE_");
    }
  }
  EXPECT_GT(fitted, 3000);
}

}  // namespace
}  // namespace tribodyn
