#include "core/decisions/pareto_front.h"

#include <algorithm>
#include <cmath>

namespace tribodyn {

std::vector<std::size_t> pareto_front(std::span<const double> first,
                                      std::span<const double> second) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < first.size(); ++i) {
    if (!std::isnan(first[i]) && !std::isnan(second[i])) order.push_back(i);
  }
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return first[a] != first[b] ? first[a] < first[b] : second[a] < second[b];
  });
  std::vector<std::size_t> out;
  for (const std::size_t i : order) {
    // All earlier points have a first value at most as large, so that the last one of the front has
    // the least second value so far.
    const bool is_equal =
        !out.empty() && first[out.back()] == first[i] && second[out.back()] == second[i];
    if (out.empty() || second[i] < second[out.back()] || is_equal) out.push_back(i);
  }
  return out;
}

}  // namespace tribodyn
