#include "core/decisions/design.h"

#include <boost/random/sobol.hpp>
#include <cmath>
#include <utility>

#include "core/uncertainty/split_mix.h"

namespace tribodyn {
namespace {

/// Seed of one factor: factors have streams of their own, so that another number of factors changes
/// none.
std::uint64_t seed_of_factor(std::uint64_t seed, int factor) {
  return seed + 0x5851f42d4c957f2dU * static_cast<std::uint64_t>(factor + 1);
}

/// Calls `use(point, factor, word)` for the words of the sequence; 2^64 is 1.
template <class Use>
void for_each_sobol_word(int count, int factors, const Use& use) {
  boost::random::sobol sequence(static_cast<std::size_t>(factors));
  for (int point = 0; point < count; ++point) {
    for (int factor = 0; factor < factors; ++factor) {
      // Boost's sequence leaves the origin out.
      use(point, factor, point == 0 ? std::uint64_t{0} : static_cast<std::uint64_t>(sequence()));
    }
  }
}

/// The middle of that one of 2^52 equal parts of [0, 1] in which the word lies: neither 0 nor 1.
double share_of(std::uint64_t word) {
  return std::ldexp(static_cast<double>(word >> 12U) + 0.5, -52);
}

}  // namespace

Eigen::MatrixXd grid_design(const std::vector<int>& levels) {
  Eigen::Index rows = 1;
  for (const int count : levels) rows *= count;
  Eigen::MatrixXd out(rows, static_cast<Eigen::Index>(levels.size()));
  Eigen::Index repeats = 1;  // of each level: the combinations of the factors after it
  for (Eigen::Index k = out.cols() - 1; k >= 0; --k) {
    const int count = levels[static_cast<std::size_t>(k)];
    for (Eigen::Index i = 0; i < rows; ++i) {
      const auto level = static_cast<double>(i / repeats % count);
      out(i, k) = count == 1 ? 0.5 : level / (count - 1);
    }
    repeats *= count;
  }
  return out;
}

Eigen::MatrixXd latin_hypercube_design(int count, int factors, std::uint64_t seed) {
  Eigen::MatrixXd out(count, factors);
  for (int k = 0; k < factors; ++k) {
    SplitMix random(seed_of_factor(seed, k));
    for (int i = 0; i < count; ++i) {
      // 32 bits: then the sum is exact, and no rounding leaves the part.
      const double place = std::ldexp(static_cast<double>(random.next() >> 32U) + 0.5, -32);
      out(i, k) = (i + place) / count;
    }
    for (int i = count; i > 1; --i) {  // Fisher and Yates
      const auto other = static_cast<Eigen::Index>(random.next() % static_cast<std::uint64_t>(i));
      std::swap(out(i - 1, k), out(other, k));
    }
  }
  return out;
}

Eigen::MatrixXd sobol_design(int count, int factors, std::uint64_t seed) {
  std::vector<std::uint64_t> shifts;
  for (int k = 0; k < factors; ++k) shifts.push_back(SplitMix(seed_of_factor(seed, k)).next());
  Eigen::MatrixXd out(count, factors);
  for_each_sobol_word(count, factors, [&](int point, int factor, std::uint64_t word) {
    out(point, factor) = share_of(word ^ shifts[static_cast<std::size_t>(factor)]);
  });
  return out;
}

Eigen::MatrixXd sobol_points(int count, int factors) {
  Eigen::MatrixXd out(count, factors);
  for_each_sobol_word(count, factors, [&out](int point, int factor, std::uint64_t word) {
    out(point, factor) = std::ldexp(static_cast<double>(word), -64);
  });
  return out;
}

double value_in_range(const FactorRange& range, double share) {
  if (range.is_logarithmic) return range.least * std::pow(range.most / range.least, share);
  return range.least + share * (range.most - range.least);
}

}  // namespace tribodyn
