#pragma once

#include <array>

#include "core/numerics/instruction_set.h"

namespace tribodyn {

inline constexpr int kRatioPoints = 28;
/// One number for each L, padded to a whole number of vectors.
using RatioLanes = std::array<double, 32>;

/// How R(L, s) of ContactBlockTables follows from its integrand, for every L alike: by quadrature
/// from each of the rising points s = ln(1 + c p) to the next.
struct RatioInterval {
  static constexpr int kNodes = 8;
  double growth;                      ///< (1 + c p)^Z - 1 at its end
  double per_square;                  ///< 2/(c p)^2 there
  std::array<double, kNodes> weight;  ///< c^2 p dp/ds times that of the rule
  std::array<double, kNodes> less;    ///< growth at the node less that at the end, <= 0
};
using RatioRule = std::array<RatioInterval, kRatioPoints>;

/// `values[j]` has R at the end of interval j for every L. To 1e-13 while L times the growth in an
/// interval stays below 5.
void integrate_ratios(InstructionSet instruction_set, const RatioRule& rule,
                      const RatioLanes& factor, std::array<RatioLanes, kRatioPoints>& values);

}  // namespace tribodyn
