#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace tribodyn {

// Designs of experiments: a row is a candidate, a column a factor, each number a share of the
// factor's range, 0 to 1. Equal arguments give equal numbers on every machine.

/// Version of the designs. The numbers of one version never change.
inline constexpr int kDesignVersion = 1;

/// Largest number of factors of sobol_design().
inline constexpr int kMostSobolFactors = 200;

/// Every combination of levels that divide each range equally, the last factor fastest. A factor of
/// one level is at 0.5. Requires levels of at least 1.
Eigen::MatrixXd grid_design(const std::vector<int>& levels);

/// Latin hypercube sampling: each factor has one value in each of `count` equal parts of its range,
/// at a random place there, in random order. Requires count >= 1 and factors >= 1.
/// Source: M. D. McKay, R. J. Beckman and W. J. Conover, Technometrics 21 (1979) 239-245.
Eigen::MatrixXd latin_hypercube_design(int count, int factors, std::uint64_t seed);

/// The first points of Sobol's sequence with the directions of S. Joe and F. Y. Kuo, SIAM J. Sci.
/// Comput. 30 (2008) 2635-2654, from the origin on. The bits of each factor are exchanged with
/// those of one random number: a digital shift, which keeps that 2^m points have one value in each
/// of 2^m equal parts. Counts that are powers of 2 fill the ranges best. Requires count >= 1 and 1
/// <= factors <= kMostSobolFactors. Numbers lie between 0 and 1 and are neither.
Eigen::MatrixXd sobol_design(int count, int factors, std::uint64_t seed);

/// The same points without the shift, as published.
Eigen::MatrixXd sobol_points(int count, int factors);

/// Range of a factor.
struct FactorRange {
  double least, most;           ///< in the unit of the factor
  bool is_logarithmic = false;  ///< equal shares are equal ratios; requires least > 0
};

/// The value at a share of the range, in the unit of the factor.
double value_in_range(const FactorRange& range, double share);

}  // namespace tribodyn
