#pragma once

#include <array>

#include "core/laws/shear_law.h"
#include "core/numerics/instruction_set.h"

namespace tribodyn {

inline constexpr int kRatioTerms = 24;
/// A number for each point in L or power of it, padded to a whole number of vectors.
using RatioLanes = std::array<double, 32>;
/// [j][i]: the j-th point in s or power of it, the i-th in L.
using RatioSquare = std::array<RatioLanes, kRatioTerms>;

/// What the integrals R(L, s) of ContactBlockTables have in common: from each Chebyshev point in s
/// to the next there is a Gauss-Legendre rule. Lengths and weights are shares of the greatest s.
struct RatioRule {
  static constexpr int kNodes = 8;
  RatioLanes end;  ///< the points, rising
  std::array<double, kRatioTerms * kNodes> node, weight;
  RatioSquare to_coefficients;  ///< as in Chebyshev
  RatioSquare transposed;
};

/// Coefficients of T_j in s and T_i in L, from R at the points of s in [0, maximum_log_pressure]
/// and at the Chebyshev points `factor` of L. R is good to 1e-13 while ln eta grows by less than 5
/// from one point to the next.
void ratio_coefficients(InstructionSet instruction_set, const RatioRule& rule,
                        const RatioLanes& factor, double maximum_log_pressure,
                        const ShearLaw<double>& law, RatioSquare& coefficients);

}  // namespace tribodyn
