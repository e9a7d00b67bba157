#include "core/uncertainty/shapley.h"

#include <bit>
#include <cstddef>

namespace tribodyn {
namespace {

/// Returns size! (n - size - 1)!/n! for each size below n: the share of the orders of n causes in
/// which the causes before a given one are a given set of that size.
std::vector<double> order_shares(std::size_t n) {
  std::vector<double> out(n, 1 / static_cast<double>(n));
  for (std::size_t size = 1; size < n; ++size) {
    out[size] = out[size - 1] * static_cast<double>(size) / static_cast<double>(n - size);
  }
  return out;
}

std::size_t bit_of(std::size_t cause) { return std::size_t{1} << cause; }

}  // namespace

std::vector<double> shapley_values(std::span<const double> values) {
  const auto causes = static_cast<std::size_t>(std::countr_zero(values.size()));
  const std::vector<double> shares = order_shares(causes);
  std::vector<double> out(causes, 0.0);
  for (std::size_t set = 0; set < values.size(); ++set) {
    const auto size = static_cast<std::size_t>(std::popcount(set));
    for (std::size_t cause = 0; cause < causes; ++cause) {
      if ((set & bit_of(cause)) != 0) continue;
      out[cause] += shares[size] * (values[set | bit_of(cause)] - values[set]);
    }
  }
  return out;
}

std::vector<double> shapley_interactions(std::span<const double> values) {
  const auto causes = static_cast<std::size_t>(std::countr_zero(values.size()));
  const std::vector<double> shares = order_shares(causes - 1);  // the pair counts as one cause
  std::vector<double> out;
  for (std::size_t i = 0; i < causes; ++i) {
    for (std::size_t j = i + 1; j < causes; ++j) {
      const std::size_t first = bit_of(i), second = bit_of(j);
      double sum = 0;
      for (std::size_t set = 0; set < values.size(); ++set) {
        if ((set & (first | second)) != 0) continue;
        sum += shares[static_cast<std::size_t>(std::popcount(set))] *
               (values[set | first | second] - values[set | first] - values[set | second] +
                values[set]);
      }
      out.push_back(sum);
    }
  }
  return out;
}

}  // namespace tribodyn
