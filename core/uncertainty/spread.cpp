#include "core/uncertainty/spread.h"

#include <algorithm>
#include <cmath>

#include "core/numerics/square.h"

namespace tribodyn {
namespace {

double quantile_of_sorted(const std::vector<double>& sorted, double probability) {
  const double last = static_cast<double>(sorted.size() - 1);
  const double place =
      std::clamp(probability * static_cast<double>(sorted.size()) - 0.5, 0.0, last);
  const double below = std::floor(place);
  const auto at = static_cast<std::size_t>(below);
  if (at + 1 >= sorted.size()) return sorted.back();
  return sorted[at] + (place - below) * (sorted[at + 1] - sorted[at]);
}

}  // namespace

Spread spread_of(std::vector<double> draws, double coverage) {
  const auto count = static_cast<double>(draws.size());
  double mean = 0;
  for (const double each : draws) mean += each / count;
  double squares = 0;
  for (const double each : draws) squares += square(each - mean);
  std::sort(draws.begin(), draws.end());
  if (draws.front() == draws.back()) squares = 0;  // else the rounding of their mean
  const double outside = 0.5 * (1 - coverage);
  return {std::sqrt(squares / (count - 1)), quantile_of_sorted(draws, outside),
          quantile_of_sorted(draws, 1 - outside)};
}

double share_below_zero(std::span<const double> draws) {
  double below = 0;
  for (const double each : draws) below += each < 0 ? 1 : (each == 0 ? 0.5 : 0);
  return below / static_cast<double>(draws.size());
}

}  // namespace tribodyn
