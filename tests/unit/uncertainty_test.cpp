// Draws of inputs, and what draws of a figure say of it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/celsius.h"
#include "core/uncertainty/column_fit.h"
#include "core/uncertainty/drawn_value.h"
#include "core/uncertainty/input_draw.h"
#include "core/uncertainty/normal_draws.h"
#include "core/uncertainty/shapley.h"
#include "core/uncertainty/spread.h"

namespace tribodyn {
namespace {

TEST(NormalQuantile, AgreesWithTables) {
  EXPECT_NEAR(normal_quantile(0.975), 1.959963984540054, 1e-13);
  EXPECT_NEAR(normal_quantile(0.5), 0, 1e-13);
  EXPECT_NEAR(normal_quantile(0.001), -3.090232306167813, 1e-12);
}

TEST(NormalDraws, TakeEveryQuantileOnceInAnotherOrderForEachVariable) {
  const NormalDraws draws(199, 3, 1);
  std::vector<std::vector<double>> columns(3);
  for (int v = 0; v < 3; ++v) {
    for (int n = 0; n < 199; ++n) columns[static_cast<std::size_t>(v)].push_back(draws.at(n, v));
  }
  EXPECT_NE(columns[0], columns[1]);
  for (auto& column : columns) {
    std::sort(column.begin(), column.end());
    for (std::size_t i = 0; i < column.size(); ++i) {
      EXPECT_EQ(column[i], normal_quantile((static_cast<double>(i) + 0.5) / 199));
    }
  }
}

TEST(NormalDraws, OfAVariableDoNotDependOnTheNumberOfTheOthers) {
  const NormalDraws few(50, 1, 7), many(50, 9, 7);
  for (int n = 0; n < 50; ++n) EXPECT_EQ(few.at(n, 0), many.at(n, 0));
}

TEST(NormalDraws, OfDifferentVariablesAreAlmostUncorrelated) {
  constexpr int kVariables = 20, kDraws = 199;
  const NormalDraws draws(kDraws, kVariables, 1);
  double largest = 0;
  for (int a = 0; a < kVariables; ++a) {
    for (int b = 0; b < a; ++b) {
      double product = 0;
      for (int n = 0; n < kDraws; ++n) product += draws.at(n, a) * draws.at(n, b) / kDraws;
      largest = std::max(largest, std::abs(product));
    }
  }
  EXPECT_LT(largest, 4 / std::sqrt(kDraws));  // 190 pairs: four standard deviations
}

/// Numbers between -1 and 1.
Eigen::MatrixXd random_numbers(int rows, int columns) {
  const NormalDraws draws(rows, columns, 5);
  Eigen::MatrixXd out(rows, columns);
  for (int i = 0; i < rows; ++i) {
    for (int j = 0; j < columns; ++j) out(i, j) = std::tanh(draws.at(i, j));
  }
  return out;
}

TEST(ColumnFit, FindsTheWeightsOfACombination) {
  const Eigen::MatrixXd base = random_numbers(12, 3) * Eigen::Vector3d(1, 1e6, 1e-6).asDiagonal();
  const Eigen::Vector3d weights(0.5, -2e-6, 1e6);
  const ColumnFit fit = ColumnBase(base).fit(base * weights);
  for (int j = 0; j < 3; ++j) EXPECT_NEAR(fit.weights(j) / weights(j), 1, 1e-4);
  EXPECT_LT(fit.left_out_errors.norm(), 1e-3);
}

TEST(ColumnFit, ErrorsOfLeftOutRowsAreThoseOfFitsWithoutThem) {
  const Eigen::MatrixXd numbers = random_numbers(12, 4);
  const Eigen::MatrixXd base = numbers.leftCols(3);
  const Eigen::VectorXd column = numbers.col(3);
  const ColumnFit fit = ColumnBase(base).fit(column);
  for (int left_out = 0; left_out < 12; ++left_out) {
    Eigen::MatrixXd other_rows(11, 3);
    Eigen::VectorXd other_numbers(11);
    for (int i = 0, row = 0; i < 12; ++i) {
      if (i == left_out) continue;
      other_rows.row(row) = base.row(i);
      other_numbers(row++) = column(i);
    }
    const ColumnFit without = ColumnBase(other_rows).fit(other_numbers);
    EXPECT_NEAR(fit.left_out_errors(left_out),
                column(left_out) - base.row(left_out).dot(without.weights), 1e-4);
  }
}

TEST(ColumnFit, HasWeightsForMoreColumnsThanRowsAndForColumnsOfZeros) {
  Eigen::MatrixXd base = random_numbers(6, 9);
  base.col(4).setZero();
  const ColumnFit fit = ColumnBase(base).fit(base.col(0));
  EXPECT_LT(fit.weights.cwiseAbs().maxCoeff(), 2);
  EXPECT_EQ(fit.weights(4), 0);
  EXPECT_NEAR((base * fit.weights - base.col(0)).norm(), 0, 1e-3);
  EXPECT_EQ(ColumnBase(base).fit(Eigen::VectorXd::Zero(6)).left_out_errors.norm(), 0);
}

TEST(Spread, OfNormalDrawsIsThatOfTheNormalDistribution) {
  const NormalDraws draws(199, 1, 1);
  std::vector<double> figures;
  for (int n = 0; n < 199; ++n) figures.push_back(10 + 2 * draws.at(n, 0));
  const Spread spread = spread_of(figures);
  EXPECT_NEAR(spread.standard_deviation, 2, 0.02);
  EXPECT_NEAR(spread.low, 10 - 1.96 * 2, 0.01);
  EXPECT_NEAR(spread.high, 10 + 1.96 * 2, 0.01);
}

TEST(Spread, OfEqualDrawsIsNothing) {
  const Spread spread = spread_of({3, 3, 3});
  EXPECT_EQ(spread.standard_deviation, 0);
  EXPECT_EQ(spread.low, 3);
  EXPECT_EQ(spread.high, 3);
  // The mean of these is not the number itself.
  EXPECT_EQ(spread_of(std::vector<double>(199, 0.1)).standard_deviation, 0);
}

TEST(Spread, SharesBelowZeroCountZerosHalf) {
  const std::vector<double> draws = {-1, 0, 0, 2};
  EXPECT_EQ(share_below_zero(draws), 0.5);
}

TEST(ShapleyValues, AreThoseOfTheGloveGame) {
  // Causes 0 and 1 have a left glove each, cause 2 a right one; a pair is worth 1.
  const std::vector<double> values = {0, 0, 0, 0, 0, 1, 1, 1};
  const std::vector<double> shapley = shapley_values(values);
  ASSERT_EQ(shapley.size(), 3U);
  EXPECT_NEAR(shapley[0], 1.0 / 6, 1e-15);
  EXPECT_NEAR(shapley[1], 1.0 / 6, 1e-15);
  EXPECT_NEAR(shapley[2], 4.0 / 6, 1e-15);
}

TEST(ShapleyValues, SumToTheDifferenceAndSplitAProductEvenly) {
  // Six causes add 1, 2, 4 ... and causes 1 and 4 another 10 together.
  std::vector<double> values(64);
  for (std::size_t set = 0; set < values.size(); ++set) {
    values[set] = static_cast<double>(set) + ((set & 0b10010U) == 0b10010U ? 10 : 0);
  }
  const std::vector<double> shapley = shapley_values(values);
  const std::vector<double> expected = {1, 2 + 5, 4, 8, 16 + 5, 32};
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_NEAR(shapley[i], expected[i], 1e-12);
  const std::vector<double> interactions = shapley_interactions(values);
  ASSERT_EQ(interactions.size(), 15U);
  std::size_t pair = 0;
  for (int i = 0; i < 6; ++i) {
    for (int j = i + 1; j < 6; ++j, ++pair) {
      EXPECT_NEAR(interactions[pair], i == 1 && j == 4 ? 10 : 0, 1e-12) << i << " and " << j;
    }
  }
}

TEST(DrawnValue, IsLogNormalAboutAPositiveValueAndNormalAboutAnother) {
  EXPECT_EQ(drawn_value(5, 1, 0), 5);
  EXPECT_EQ(drawn_value(5, 0, 3), 5);
  EXPECT_NEAR(drawn_value(5, 0.05, 1), 5.05, 1e-3);
  EXPECT_NEAR(drawn_value(5, 4, 1) * drawn_value(5, 4, -1), 25, 1e-12);
  EXPECT_GT(drawn_value(5, 1e300, -30), 0);
  EXPECT_DOUBLE_EQ(drawn_value(-0.6, 0.1, 2), -0.4);
}

/// Kinematic viscosities of 103 and 15.1 mm2/s at about 870 and 830 kg/m3, 0.5 % each; T_0 within
/// 15 K.
VogelFit fit_of_two() {
  const std::vector<ViscosityPoint> points = {{kFortyCelsius, 0.0877, 0.005},
                                              {kHundredCelsius, 0.01245, 0.005}};
  return fit_vogel_at(points, 170, 15);
}

double viscosity_of(const VogelDraw& draw, double temperature) {
  return draw.viscosity_prefactor *
         std::exp(draw.temperature_coefficient / (temperature - draw.reference_temperature));
}

TEST(DrawnVogel, IsTheFitWithoutDeviation) {
  const VogelFit fit = fit_of_two();
  const VogelDraw draw = drawn_vogel(fit, {0, 0, 0});
  EXPECT_NEAR(draw.viscosity_prefactor, fit.viscosity_prefactor, 1e-10 * fit.viscosity_prefactor);
  EXPECT_NEAR(draw.temperature_coefficient, fit.temperature_coefficient, 1e-8);
  EXPECT_EQ(draw.reference_temperature, fit.reference_temperature);
}

TEST(DrawnVogel, KeepsMeasuredViscositiesWithinTheirUncertaintyHoweverFarT0Moves) {
  const VogelFit fit = fit_of_two();
  const NormalDraws draws(199, 3, 5);
  std::vector<double> cold, measured, reference;
  for (int n = 0; n < 199; ++n) {
    const VogelDraw draw = drawn_vogel(fit, {draws.at(n, 0), draws.at(n, 1), draws.at(n, 2)});
    measured.push_back(std::log(viscosity_of(draw, kFortyCelsius)));
    cold.push_back(std::log(viscosity_of(draw, kZeroCelsius - 10)));
    reference.push_back(draw.reference_temperature);
  }
  EXPECT_NEAR(spread_of(measured).standard_deviation, 0.005, 5e-4);
  EXPECT_NEAR(spread_of(reference).standard_deviation, 15, 1.5);
  const double linear = relative_viscosity_uncertainty(fit, kZeroCelsius - 10);
  EXPECT_NEAR(spread_of(cold).standard_deviation, linear, 0.25 * linear);
}

TEST(DrawnDensity, TurnsAboutTheDensityThatWasMeasured) {
  const DensityDraw law{1050, -0.64};
  constexpr double kPivot = 288.15;
  const DensityDraw turned = drawn_density(law, kPivot * 0.03, 0.03, kPivot, {2, 5});
  EXPECT_NEAR(turned.density_at_zero_kelvin + kPivot * turned.slope,
              law.density_at_zero_kelvin + kPivot * law.slope, 1e-6);
  EXPECT_NEAR(turned.slope, -0.58, 1e-12);
  const DensityDraw own = drawn_density(law, std::hypot(kPivot * 0.03, 26.0), 0.03, kPivot, {0, 1});
  EXPECT_NEAR(own.density_at_zero_kelvin, 1076, 1e-9);
}

}  // namespace
}  // namespace tribodyn
