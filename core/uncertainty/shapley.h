#pragma once

#include <span>
#include <vector>

namespace tribodyn {

// How much each of n causes adds to a value that was computed for every set of them. `values` has
// 2^n elements: that of a set of causes is at the index whose bit i is 1 if cause i is in the set.
// Requires 2 <= n <= 20.

/// Shapley values: for each cause what it adds to the value, averaged over all orders in which the
/// causes come. Their sum is the value of all causes less that of none.
/// Source: L. S. Shapley, in Contributions to the Theory of Games II (1953) 307-317.
std::vector<double> shapley_values(std::span<const double> values);

/// Shapley interaction indices of the pairs (0, 1), (0, 2), ..., (1, 2), ...: what two causes add
/// together beyond what each adds alone, averaged likewise. All are zero if the value is a sum of
/// functions of one cause each.
/// Source: M. Grabisch and M. Roubens, International Journal of Game Theory 28 (1999) 547-565.
std::vector<double> shapley_interactions(std::span<const double> values);

}  // namespace tribodyn
