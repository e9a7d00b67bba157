#include "core/contact/contact_block_tables.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/contact/asperity_functions.h"
#include "core/contact/ratio_integrals.h"
#include "core/numerics/gauss_legendre.h"

namespace tribodyn {
namespace {

/// Chebyshev points cos(pi (i + 1/2)/n), from 1 down, and the matrix that takes values there to
/// coefficients of T_0 ... T_{n-1}.
template <int N>
struct Chebyshev {
  Eigen::Array<double, N, 1> point;
  Eigen::Matrix<double, N, N> to_coefficients;
  Eigen::Matrix<double, N, N> to_powers;  ///< column m: coefficients of T_m in powers of x

  Chebyshev() {
    for (int i = 0; i < N; ++i) {
      const double angle = std::numbers::pi * (i + 0.5) / N;
      point(i) = std::cos(angle);
      for (int m = 0; m < N; ++m) {
        to_coefficients(m, i) = (m == 0 ? 1.0 : 2.0) / N * std::cos(m * angle);
      }
    }
    to_powers.setZero();
    to_powers(0, 0) = 1;
    to_powers(1, 1) = 1;
    for (int m = 2; m < N; ++m) {
      for (int j = 0; j < N; ++j) {
        to_powers(j, m) = (j > 0 ? 2 * to_powers(j - 1, m - 1) : 0) - to_powers(j, m - 2);
      }
    }
  }
};

template <int N>
const Chebyshev<N>& chebyshev() {
  static const Chebyshev<N> rule;
  return rule;
}

constexpr int kTerms = kRatioPoints;
using Square = Eigen::Matrix<double, kTerms, kTerms>;

RatioRule ratio_rule(const Eigen::Array<double, kTerms, 1>& depth, double index) {
  constexpr int kNodes = RatioInterval::kNodes;
  const auto& rule = gauss_legendre<kNodes>();
  RatioRule out;
  double before = 0;
  for (int j = 0; j < kTerms; ++j) {
    const double end = depth(kTerms - 1 - j);  // it rises
    const double scaled_pressure = std::expm1(end);
    RatioInterval& interval = out[j];
    interval.growth = std::expm1(index * end);
    interval.per_square = 2 / (scaled_pressure * scaled_pressure);
    for (int n = 0; n < kNodes; ++n) {
      const double s = before + (end - before) * rule.node(n);
      const double q = std::expm1(s);
      interval.weight[n] = (end - before) * rule.weight(n) * q * (q + 1);
      interval.less[n] = std::expm1(index * s) - interval.growth;
    }
    before = end;
  }
  return out;
}

/// R at the Chebyshev points of L (rows) and s (columns).
Square ratio_values(InstructionSet instruction_set, const Eigen::Array<double, kTerms, 1>& factor,
                    const Eigen::Array<double, kTerms, 1>& depth, double index) {
  RatioLanes lanes{};
  std::copy_n(factor.data(), kTerms, lanes.begin());
  std::array<RatioLanes, kTerms> rising;
  integrate_ratios(instruction_set, ratio_rule(depth, index), lanes, rising);
  Square values;
  for (int j = 0; j < kTerms; ++j) {
    values.col(j) =
        Eigen::Map<const Eigen::Matrix<double, kTerms, 1>>(rising[kTerms - 1 - j].data());
  }
  return values;
}

/// Drops what adds up to less than the tolerance, then changes to powers.
BivariatePolynomial truncated(const Square& coefficients, double tolerance) {
  const auto& rule = chebyshev<kTerms>();
  Square kept = Square::Zero();
  const double small = tolerance / 20;
  int rows = 1, columns = 1;
  std::array<int, kTerms> length{};
  for (int i = 0; i < kTerms; ++i) {
    for (int j = 0; j < kTerms; ++j) {
      if (std::abs(coefficients(i, j)) > small) length[i] = j + 1;
    }
    if (length[i] > 0) rows = i + 1;
    columns = std::max(columns, length[i]);
    for (int j = 0; j < length[i]; ++j) kept(i, j) = coefficients(i, j);
  }
  using Small = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kTerms, kTerms>;
  const Small along = kept.topLeftCorner(rows, columns)
                          .lazyProduct(rule.to_powers.topLeftCorner(columns, columns).transpose());
  const Small powers = rule.to_powers.topLeftCorner(rows, rows).lazyProduct(along);
  BivariatePolynomial out;
  int longest = 1;
  for (int i = rows - 1; i >= 0; --i) length[i] = longest = std::max(longest, length[i]);
  for (int i = rows - 1; i >= 0; --i) {
    out.row_length.push_back(length[i]);
    for (int j = length[i] - 1; j >= 0; --j) out.coefficients.push_back(powers(i, j));
  }
  return out;
}

}  // namespace

bool tabulate_ratio(InstructionSet instruction_set, double least_factor, double greatest_factor,
                    ContactBlockTables& tables) {
  const auto& rule = chebyshev<kTerms>();
  const double centre = 0.5 * (least_factor + greatest_factor);
  const double half = std::max(0.5 * (greatest_factor - least_factor), 1e-3);
  tables.factor_scale = 1 / half;
  tables.factor_offset = -centre / half;
  // 3 GPa, or a viscosity 32 e-folds above ambient.
  constexpr double kDeepest = 2.79, kMostFolds = 32;
  double deepest =
      std::min(kDeepest, std::log1p(kMostFolds / std::max(greatest_factor, 1e-3)) / tables.index);
  for (int attempt = 0; attempt < 8; ++attempt, deepest *= 0.85) {
    const Square values = ratio_values(instruction_set, centre + half * rule.point,
                                       0.5 * deepest * (1 + rule.point), tables.index);
    const Square coefficients = rule.to_coefficients * values * rule.to_coefficients.transpose();
    const double tail = std::max(coefficients.bottomRows<2>().cwiseAbs().maxCoeff(),
                                 coefficients.rightCols<2>().cwiseAbs().maxCoeff());
    if (!(tail < 2e-13)) continue;
    tables.deepest = deepest;
    tables.deepest_pressure = std::expm1(deepest);
    tables.depth_scale = 2 / deepest;
    tables.depth_offset = -1;
    tables.ratio = truncated(coefficients, 2e-11);
    tables.coarse_ratio = truncated(coefficients, 1.5e-5);
    return true;
  }
  return false;
}

void tabulate_asperities(ContactBlockTables& tables) {
  struct Fits {
    double scale, offset;
    std::array<double, kAsperityTerms> f2, f5_2;
  };
  static const Fits fits = [] {
    constexpr int kPoints = 40;
    const auto& rule = chebyshev<kPoints>();
    const double most = 1 / kAsperityShift, least = 1 / (kAsperityEnd + kAsperityShift);
    Eigen::Matrix<double, kPoints, 1> f2, f5_2;
    for (int i = 0; i < kPoints; ++i) {
      const double v = least + (most - least) * 0.5 * (1 + rule.point(i));
      const double ratio = std::max(0.0, 1 / v - kAsperityShift);
      const double scale = std::exp(0.5 * ratio * ratio) / (v * v * v);
      const AsperityFunctions f = asperity_functions(ratio);
      f2(i) = scale * f.f2;
      f5_2(i) = scale * f.f5_2 / std::sqrt(v);
    }
    const auto powers = [&](const Eigen::Matrix<double, kPoints, 1>& values) {
      Eigen::Matrix<double, kPoints, 1> coefficients = rule.to_coefficients * values;
      coefficients.tail<kPoints - kAsperityTerms>().setZero();
      const Eigen::Matrix<double, kPoints, 1> in_powers = rule.to_powers * coefficients;
      std::array<double, kAsperityTerms> out;
      for (int j = 0; j < kAsperityTerms; ++j) out[j] = in_powers(kAsperityTerms - 1 - j);
      return out;
    };
    Fits out;
    out.scale = 2 / (most - least);
    out.offset = -(most + least) / (most - least);
    out.f2 = powers(f2);
    out.f5_2 = powers(f5_2);
    return out;
  }();
  tables.asperity_scale = fits.scale;
  tables.asperity_offset = fits.offset;
  tables.f2 = fits.f2;
  tables.f5_2 = fits.f5_2;
}

}  // namespace tribodyn
