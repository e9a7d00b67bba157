#include "core/uncertainty/normal_draws.h"

#include <cmath>
#include <numbers>
#include <utility>

#include "core/numerics/bracketed_root.h"
#include "core/uncertainty/split_mix.h"

namespace tribodyn {
double normal_quantile(double probability) {
  // Beyond +-38 standard deviations the probability is no longer a double.
  const auto excess = [probability](double x) {
    return 0.5 * std::erfc(-x / std::numbers::sqrt2) - probability;
  };
  return bracketed_root(excess, -38.0, 38.0);
}

NormalDraws::NormalDraws(int draws, int variables, std::uint64_t seed) : draws_(draws) {
  const auto count = static_cast<std::size_t>(draws);
  std::vector<double> quantiles(count);
  for (std::size_t i = 0; i < count; ++i) {
    quantiles[i] = normal_quantile((static_cast<double>(i) + 0.5) / draws);
  }
  values_.reserve(count * static_cast<std::size_t>(variables));
  for (int variable = 0; variable < variables; ++variable) {
    SplitMix random(seed + 0x5851f42d4c957f2dU * static_cast<std::uint64_t>(variable + 1));
    std::vector<double> column = quantiles;
    for (std::size_t i = count; i > 1; --i) {
      std::swap(column[i - 1], column[random.next() % i]);  // Fisher and Yates
    }
    values_.insert(values_.end(), column.begin(), column.end());
  }
}

}  // namespace tribodyn
