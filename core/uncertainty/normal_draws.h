#pragma once

#include <cstdint>
#include <vector>

namespace tribodyn {

/// Draws of independent standard normal variables by Latin hypercube sampling: each variable takes
/// each of the n quantiles at (i + 1/2)/n once, in random order. Means of functions that are nearly
/// additive in the variables, and their quantiles, scatter much less than those of plain draws.
/// Source: M. D. McKay, R. J. Beckman and W. J. Conover, Technometrics 21 (1979) 239-245.
class NormalDraws {
 public:
  /// Requires draws >= 1. Equal arguments give equal draws, and the draws of a variable do not
  /// depend on the number of the others.
  NormalDraws(int draws, int variables, std::uint64_t seed);

  int draws() const { return draws_; }
  double at(int draw, int variable) const {
    return values_[static_cast<std::size_t>(variable) * static_cast<std::size_t>(draws_) +
                   static_cast<std::size_t>(draw)];
  }

 private:
  int draws_;
  std::vector<double> values_;  // by variable, then by draw
};

/// Quantile of the standard normal distribution [-]. Requires 0 < probability < 1.
double normal_quantile(double probability);

}  // namespace tribodyn
