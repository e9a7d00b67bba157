#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace tribodyn {

/// Indices of the points that no other point beats: no other has both values at most as large and
/// one of them smaller. By ascending first value, equal points in their order. A point with a NaN
/// is never in the front. Requires as many second values as first ones. O(n log n).
std::vector<std::size_t> pareto_front(std::span<const double> first,
                                      std::span<const double> second);

}  // namespace tribodyn
