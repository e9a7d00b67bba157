#include "core/decisions/ranking.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace tribodyn {
namespace {

/// Returns the variance of the difference of two candidates by inputs whose errors they share, or
/// whose errors are independent between them. `effects`: standard uncertainty of an input times its
/// effect, by candidate and input; none: 0.
double variance(const Eigen::MatrixXd& effects, Eigen::Index one, Eigen::Index other, bool shared) {
  if (effects.cols() == 0) return 0;  // Eigen has no row of it: its data are null
  if (shared) return (effects.row(one) - effects.row(other)).squaredNorm();
  return effects.row(one).squaredNorm() + effects.row(other).squaredNorm();
}

}  // namespace

bool cannot_be_told_apart(double positive_probability, double confidence) {
  return std::abs(2 * positive_probability - 1) < confidence;
}

CandidateComparison compare_candidates(const UncertainCandidates& candidates, Eigen::Index one,
                                       Eigen::Index other) {
  CandidateComparison out{};
  out.difference = candidates.values(one) - candidates.values(other);
  out.higher_probability = 0.5;
  if (one == other) return out;
  out.standard_uncertainty = std::sqrt(variance(candidates.own_effects, one, other, false) +
                                       variance(candidates.shared_effects, one, other, true));
  out.solver_error = candidates.solver_errors(one) + candidates.solver_errors(other);
  const double certain =
      std::copysign(std::max(0.0, std::abs(out.difference) - out.solver_error), out.difference);
  if (out.standard_uncertainty > 0) {
    out.higher_probability =
        0.5 * std::erfc(-certain / (out.standard_uncertainty * std::numbers::sqrt2));
  } else if (certain != 0) {
    out.higher_probability = certain > 0 ? 1 : 0;
  }
  return out;
}

std::vector<RankedCandidate> ranked_candidates(const UncertainCandidates& candidates,
                                               double confidence) {
  std::vector<Eigen::Index> order(static_cast<std::size_t>(candidates.values.size()));
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](Eigen::Index a, Eigen::Index b) {
    return candidates.values(a) < candidates.values(b);
  });
  std::vector<RankedCandidate> out;
  for (const Eigen::Index index : order) {
    const CandidateComparison to_best = compare_candidates(candidates, index, order.front());
    out.push_back({index, to_best, cannot_be_told_apart(to_best.higher_probability, confidence)});
  }
  return out;
}

}  // namespace tribodyn
