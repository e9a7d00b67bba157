#include "core/uncertainty/normal_draws.h"

#include <cmath>
#include <numbers>
#include <utility>

#include "core/numerics/bracketed_root.h"

namespace tribodyn {
namespace {

/// SplitMix64: G. L. Steele, D. Lea and C. H. Flood, OOPSLA 2014, 453-472. The standard library's
/// distributions and std::shuffle differ from platform to platform.
class SplitMix {
 public:
  explicit SplitMix(std::uint64_t seed) : state_(seed) {}
  std::uint64_t next() {
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15U);
    z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9U;
    z = (z ^ (z >> 27U)) * 0x94d049bb133111ebU;
    return z ^ (z >> 31U);
  }

 private:
  std::uint64_t state_;
};

}  // namespace

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
