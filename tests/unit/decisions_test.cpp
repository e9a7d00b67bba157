// Tests of designs, rankings, Pareto fronts and main effects against closed forms and identities.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "core/decisions/design.h"
#include "core/decisions/factor_effects.h"
#include "core/decisions/main_effects.h"
#include "core/decisions/pareto_front.h"
#include "core/decisions/ranking.h"
#include "core/uncertainty/normal_draws.h"
#include "core/uncertainty/split_mix.h"

namespace tribodyn {
namespace {

/// Whether each column has one value in each of as many equal parts of [0, 1] as there are rows.
testing::AssertionResult has_one_value_in_each_part(const Eigen::MatrixXd& design) {
  const auto rows = static_cast<double>(design.rows());
  for (Eigen::Index k = 0; k < design.cols(); ++k) {
    std::set<int> parts;
    for (Eigen::Index i = 0; i < design.rows(); ++i) {
      parts.insert(static_cast<int>(std::floor(design(i, k) * rows)));
    }
    if (static_cast<double>(parts.size()) != rows || *parts.begin() != 0 ||
        *parts.rbegin() != static_cast<int>(rows) - 1) {
      return testing::AssertionFailure() << "column " << k << " has values in " << parts.size();
    }
  }
  return testing::AssertionSuccess();
}

TEST(Design, GridHasEveryCombinationOnce) {
  const Eigen::MatrixXd design = grid_design({2, 1, 3});
  Eigen::MatrixXd expected(6, 3);
  expected << 0, 0.5, 0, 0, 0.5, 0.5, 0, 0.5, 1, 1, 0.5, 0, 1, 0.5, 0.5, 1, 0.5, 1;
  EXPECT_EQ(design, expected);
}

TEST(Design, LatinHypercubeHasOneValueInEachPart) {
  for (const int count : {1, 2, 7, 1000}) {
    const Eigen::MatrixXd design = latin_hypercube_design(count, 9, 3);
    EXPECT_TRUE(has_one_value_in_each_part(design)) << count;
    EXPECT_GT(design.minCoeff(), 0);
    EXPECT_LT(design.maxCoeff(), 1);
  }
  EXPECT_EQ(latin_hypercube_design(20, 3, 4), latin_hypercube_design(20, 5, 4).leftCols(3));
  EXPECT_NE(latin_hypercube_design(20, 3, 4), latin_hypercube_design(20, 3, 5));
}

TEST(Design, SobolBeginsWithThePublishedPoints) {
  // Joe and Kuo, new-joe-kuo-6.21201: the first ten points of three dimensions.
  Eigen::MatrixXd published(10, 3);
  published << 0, 0, 0, 0.5, 0.5, 0.5, 0.75, 0.25, 0.25, 0.25, 0.75, 0.75, 0.375, 0.375, 0.625,
      0.875, 0.875, 0.125, 0.625, 0.125, 0.875, 0.125, 0.625, 0.375, 0.1875, 0.3125, 0.9375, 0.6875,
      0.8125, 0.4375;
  EXPECT_EQ(sobol_points(10, 3), published);
}

TEST(Design, SobolWithAShiftHasOneValueInEachPart) {
  for (const int count : {1, 2, 64, 1024}) {
    const Eigen::MatrixXd design = sobol_design(count, kMostSobolFactors, 7);
    EXPECT_TRUE(has_one_value_in_each_part(design)) << count;
    EXPECT_GT(design.minCoeff(), 0);
    EXPECT_LT(design.maxCoeff(), 1);
  }
  // In pairs of the first dimensions also one point in each of 16 boxes of 4 by 4.
  const Eigen::MatrixXd design = sobol_design(16, 2, 11);
  std::set<int> boxes;
  for (int i = 0; i < 16; ++i) {
    boxes.insert(4 * static_cast<int>(4 * design(i, 0)) + static_cast<int>(4 * design(i, 1)));
  }
  EXPECT_EQ(boxes.size(), 16U);
  EXPECT_EQ(sobol_design(32, 2, 1).topRows(16), sobol_design(16, 2, 1));
}

TEST(Design, NumbersOfAVersionNeverChange) {
  ASSERT_EQ(kDesignVersion, 1);
  EXPECT_EQ(latin_hypercube_design(3, 2, 1)(0, 0), 0.47082782509581494);
  EXPECT_EQ(latin_hypercube_design(3, 2, 1)(2, 1), 0.1675191615941003);
  EXPECT_EQ(sobol_design(3, 2, 1)(0, 0), 0.15769885864331246);
  EXPECT_EQ(sobol_design(3, 2, 1)(2, 1), 0.75255748489080554);
}

TEST(Design, RangesAreLinearOrLogarithmic) {
  EXPECT_DOUBLE_EQ(value_in_range({2, 6, false}, 0.25), 3);
  EXPECT_DOUBLE_EQ(value_in_range({1e-8, 1e-4, true}, 0.25), 1e-7);
}

TEST(ParetoFront, IsWhatABruteForceSearchFinds) {
  SplitMix random(5);
  for (int round = 0; round < 50; ++round) {
    std::vector<double> first, second;
    for (int i = 0; i < 60; ++i) {  // few distinct values: many ties
      first.push_back(static_cast<double>(random.next() % 12));
      second.push_back(static_cast<double>(random.next() % 12));
    }
    first[7] = std::numeric_limits<double>::quiet_NaN();
    second[8] = std::numeric_limits<double>::quiet_NaN();
    std::set<std::size_t> expected;
    for (std::size_t i = 0; i < first.size(); ++i) {
      bool is_beaten = std::isnan(first[i]) || std::isnan(second[i]);
      for (std::size_t j = 0; j < first.size(); ++j) {
        is_beaten = is_beaten || (first[j] <= first[i] && second[j] <= second[i] &&
                                  (first[j] < first[i] || second[j] < second[i]));
      }
      if (!is_beaten) expected.insert(i);
    }
    const std::vector<std::size_t> front = pareto_front(first, second);
    EXPECT_EQ(std::set<std::size_t>(front.begin(), front.end()), expected);
    EXPECT_EQ(front.size(), expected.size());
    EXPECT_TRUE(std::is_sorted(front.begin(), front.end(),
                               [&](std::size_t a, std::size_t b) { return first[a] < first[b]; }));
  }
  EXPECT_TRUE(pareto_front({}, {}).empty());
}

UncertainCandidates two_candidates() {
  UncertainCandidates out;
  out.values = Eigen::Vector2d(1.0, 1.5);
  out.solver_errors = Eigen::Vector2d::Zero();
  out.own_effects = Eigen::MatrixXd::Zero(2, 0);
  out.shared_effects = Eigen::MatrixXd::Zero(2, 0);
  return out;
}

TEST(Ranking, ProbabilityIsThatOfTheNormalDistribution) {
  UncertainCandidates candidates = two_candidates();
  candidates.own_effects = Eigen::Vector2d(0.3, -0.4);  // together 0.5
  const CandidateComparison comparison = compare_candidates(candidates, 1, 0);
  EXPECT_DOUBLE_EQ(comparison.difference, 0.5);
  EXPECT_DOUBLE_EQ(comparison.standard_uncertainty, 0.5);
  EXPECT_NEAR(comparison.higher_probability, 0.8413447460685429, 1e-15);  // one deviation
  EXPECT_NEAR(compare_candidates(candidates, 0, 1).higher_probability, 1 - 0.8413447460685429,
              1e-15);
}

TEST(Ranking, SharedErrorsCancelInADifference) {
  UncertainCandidates candidates = two_candidates();
  candidates.shared_effects = Eigen::Vector2d(2.0, 2.0);
  EXPECT_EQ(compare_candidates(candidates, 1, 0).standard_uncertainty, 0);
  EXPECT_EQ(compare_candidates(candidates, 1, 0).higher_probability, 1);
  candidates.own_effects = candidates.shared_effects;
  EXPECT_DOUBLE_EQ(compare_candidates(candidates, 1, 0).standard_uncertainty, std::sqrt(8));
}

TEST(Ranking, SolversErrorMakesADifferenceLessCertain) {
  UncertainCandidates candidates = two_candidates();
  candidates.solver_errors = Eigen::Vector2d(0.2, 0.3);
  EXPECT_EQ(compare_candidates(candidates, 1, 0).higher_probability, 0.5);
  candidates.own_effects = Eigen::Vector2d(0.1, 0);
  candidates.solver_errors = Eigen::Vector2d(0.2, 0.2);
  EXPECT_NEAR(compare_candidates(candidates, 1, 0).higher_probability, 0.8413447460685429, 1e-12);
}

TEST(Ranking, TiesAreThoseBelowTheConfidence) {
  UncertainCandidates candidates;
  candidates.values = Eigen::Vector4d(1.3, 1.0, 1.1, 9.0);
  candidates.solver_errors = Eigen::Vector4d::Zero();
  candidates.own_effects = 0.1 * Eigen::MatrixXd::Identity(4, 4);
  candidates.shared_effects = Eigen::Vector4d(5, 5, 5, 5);
  const std::vector<RankedCandidate> ranking = ranked_candidates(candidates, 0.95);
  ASSERT_EQ(ranking.size(), 4U);
  EXPECT_EQ(ranking[0].index, 1);
  EXPECT_TRUE(ranking[0].is_tied);
  EXPECT_EQ(ranking[1].index, 2);
  EXPECT_TRUE(ranking[1].is_tied);  // 0.1 of 0.141: 76 %
  EXPECT_EQ(ranking[2].index, 0);
  EXPECT_FALSE(ranking[2].is_tied);  // 0.3 of 0.141: 98.3 %
  EXPECT_TRUE(ranked_candidates(candidates, 0.99)[2].is_tied);
}

TEST(MainEffects, OfALinearModelAreItsCoefficients) {
  const Eigen::MatrixXd columns = latin_hypercube_design(30, 3, 2);
  const Eigen::VectorXd response =
      (2.0 + 3 * columns.col(0).array() - 1e-6 * columns.col(2).array()).matrix();
  const auto found = main_effects(columns, response, 0.95);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->effects[0]->effect, 3, 1e-12);
  EXPECT_NEAR(found->effects[1]->effect, 0, 1e-12);
  EXPECT_NEAR(found->effects[2]->effect, -1e-6, 1e-12);
  EXPECT_NEAR(found->explained_share, 1, 1e-12);
  EXPECT_EQ(found->degrees_of_freedom, 26);
}

TEST(MainEffects, OfOneColumnHaveTheIntervalOfAStraightLine) {
  // Draper and Smith: the slope's variance is s^2 / S_xx.
  Eigen::MatrixXd x(5, 1);
  x << 1, 2, 3, 4, 5;
  Eigen::VectorXd y(5);
  y << 2.1, 3.9, 6.2, 7.8, 10.1;
  const auto found = main_effects(x, y, 0.95);
  ASSERT_TRUE(found);
  const double slope = 19.9 / 10, intercept = 6.02 - 3 * slope;
  double squares = 0;
  for (int i = 0; i < 5; ++i) squares += std::pow(y(i) - intercept - slope * x(i, 0), 2);
  const double error = std::sqrt(squares / 3 / 10);
  EXPECT_NEAR(found->effects[0]->effect, slope, 1e-12);
  EXPECT_NEAR(found->effects[0]->standard_error, error, 1e-12);
  EXPECT_NEAR(found->effects[0]->high - slope, 3.182446305284263 * error,
              1e-10);  // t of 3 at 97.5 %
}

TEST(MainEffects, IntervalsHoldTheTruthAsOftenAsTheyClaim) {
  const int rounds = 400, rows = 12;
  const NormalDraws noise(rounds, rows, 6);
  const Eigen::MatrixXd columns = latin_hypercube_design(rows, 2, 8);
  int held = 0;
  for (int round = 0; round < rounds; ++round) {
    Eigen::VectorXd response = columns.col(0);
    for (int i = 0; i < rows; ++i) response(i) += 0.5 * noise.at(round, i);
    const auto found = main_effects(columns, response, 0.9);
    held += found->effects[0]->low <= 1 && 1 <= found->effects[0]->high ? 1 : 0;
  }
  EXPECT_NEAR(held, 0.9 * rounds, 3 * std::sqrt(rounds * 0.09));  // three deviations of the count
}

TEST(MainEffects, LeaveOutColumnsThatFollowFromOthers) {
  Eigen::MatrixXd columns(8, 4);
  columns.leftCols(2) = sobol_points(8, 2);
  columns.col(2).setConstant(0.3);
  columns.col(3) = 4 * columns.col(0) - 1e-3 * columns.col(1);
  const auto found = main_effects(columns, columns.col(1), 0.95);
  ASSERT_TRUE(found);
  EXPECT_TRUE(found->effects[1]);
  EXPECT_FALSE(found->effects[2]);
  EXPECT_FALSE(found->effects[3]);
  EXPECT_FALSE(main_effects(columns.topRows(3), columns.col(1).head(3), 0.95));
}

TEST(MainEffects, DoNotDependOnTheUnitOfAColumn) {
  const Eigen::MatrixXd columns = latin_hypercube_design(20, 2, 1);
  const Eigen::VectorXd response =
      (columns.col(0).array().square() + columns.col(1).array()).matrix();
  Eigen::MatrixXd scaled = columns;
  scaled.col(0) = (1e-9 * columns.col(0).array() + 5e-9).matrix();
  const auto plain = main_effects(columns, response, 0.95);
  const auto other = main_effects(scaled, response, 0.95);
  EXPECT_NEAR(1e-9 * other->effects[0]->effect, plain->effects[0]->effect, 1e-12);
  EXPECT_NEAR(1e-9 * other->effects[0]->low, plain->effects[0]->low, 1e-12);
}

TEST(FactorEffects, OfWordsAreDifferencesFromTheMostFrequentOne) {
  const std::vector<std::string> words = {"b", "a", "a", "c", "a", "b", "c", "a"};
  const std::vector<double> numbers = {1, 3, 2, 5, 4, 1.5, 2.5, 3};
  std::vector<double> response;
  for (std::size_t i = 0; i < words.size(); ++i) {
    response.push_back(7 + 0.5 * numbers[i] + (words[i] == "b" ? 4 : words[i] == "c" ? -1 : 0));
  }
  const auto found = factor_effects({{{}, words}, {numbers, {}}}, response, 0.95);
  ASSERT_TRUE(found);
  ASSERT_EQ(found->effects.size(), 3U);
  EXPECT_EQ(found->effects[0].factor, 0U);
  EXPECT_EQ(found->effects[0].from, 1U);  // "a"
  EXPECT_EQ(found->effects[0].to, 0U);    // "b"
  EXPECT_NEAR(found->effects[0].effect, 4, 1e-12);
  EXPECT_EQ(found->effects[1].factor, 1U);
  EXPECT_EQ(found->effects[1].from, 0U);
  EXPECT_EQ(found->effects[1].to, 3U);
  EXPECT_NEAR(found->effects[1].effect, 0.5 * (5 - 1), 1e-12);
  EXPECT_NEAR(found->effects[2].effect, -1, 1e-12);
  EXPECT_EQ(found->degrees_of_freedom, 4);
  EXPECT_TRUE(found->left_out.empty());
}

TEST(FactorEffects, LeaveOutFactorsWithTheReason) {
  std::vector<double> response, numbers, doubled;
  std::vector<std::string> same, different;
  for (int i = 0; i < 20; ++i) {
    response.push_back(std::sin(i));
    numbers.push_back(i);
    doubled.push_back(2.0 * i + 1);
    same.emplace_back("x");
    different.push_back(std::to_string(i % 13));
  }
  const auto found =
      factor_effects({{{}, same}, {numbers, {}}, {{}, different}, {doubled, {}}}, response, 0.95);
  ASSERT_TRUE(found);
  ASSERT_EQ(found->effects.size(), 1U);
  EXPECT_EQ(found->effects[0].factor, 1U);
  using Reason = std::pair<std::size_t, NoEffect>;
  EXPECT_EQ(found->left_out, (std::vector<Reason>{{0, NoEffect::kConstant},
                                                  {2, NoEffect::kTooManyWords},
                                                  {3, NoEffect::kFollowsFromOthers}}));
  EXPECT_FALSE(factor_effects({{{1, 2}, {}}}, {1, 2}, 0.95)) << "no degree of freedom";
}

}  // namespace
}  // namespace tribodyn
