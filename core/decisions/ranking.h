#pragma once

#include <Eigen/Core>
#include <vector>

namespace tribodyn {

/// One figure of several candidates, with its errors by the linear model: each column of effects is
/// the change of the figure when one input rises by its standard uncertainty.
struct UncertainCandidates {
  Eigen::VectorXd values;          ///< in the unit of the figure
  Eigen::VectorXd solver_errors;   ///< bounds of the solver's errors, in the same unit
  Eigen::MatrixXd own_effects;     ///< of inputs whose errors are independent between candidates
  Eigen::MatrixXd shared_effects;  ///< of inputs whose errors all candidates have in common
};

/// How a candidate compares with another one.
struct CandidateComparison {
  double difference;            ///< candidate less the other, in the unit of the figure
  double standard_uncertainty;  ///< of the difference, by the inputs
  double solver_error;          ///< bound of its error by the solver
  /// Probability that the candidate's figure is the higher one, of normal errors and with the
  /// solver's errors as unfavourable as they can be: the difference counts as nearer to zero by
  /// their bound.
  double higher_probability;
};

/// Whether the two-sided interval of a difference that has a confidence holds 0, given the
/// probability that the difference is positive. The same in comparisons and rankings.
bool cannot_be_told_apart(double positive_probability, double confidence);

/// Shared errors cancel as far as their effects are equal.
CandidateComparison compare_candidates(const UncertainCandidates& candidates, Eigen::Index one,
                                       Eigen::Index other);

struct RankedCandidate {
  Eigen::Index index;
  CandidateComparison to_best;
  /// The candidate cannot be told apart from the best one: the interval of the difference that has
  /// the confidence holds 0 (cannot_be_told_apart()). Of the best one itself true.
  bool is_tied;
};

/// Ranks candidates by ascending figure; those of equal figures in their order. Requires values
/// that are finite and 0.5 <= confidence < 1.
std::vector<RankedCandidate> ranked_candidates(const UncertainCandidates& candidates,
                                               double confidence);

}  // namespace tribodyn
