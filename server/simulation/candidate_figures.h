#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "server/contract/violations.h"
#include "tribodyn/v1/campaigns.pb.h"

namespace tribodyn::server {

/// Returns the weights of the conditions of a campaign, with the sum 1: `stated`, or if that is
/// empty those of the campaign. Adds a violation, and returns nothing of use, if their number is
/// not that of the conditions.
std::vector<double> condition_weights(const google::protobuf::RepeatedField<double>& stated,
                                      const v1::Campaign& campaign, Violations& violations);

/// Makes one value of the values of a candidate at all conditions.
class ConditionAggregate {
 public:
  /// `weights`: of the conditions, with the sum 1.
  ConditionAggregate(v1::CandidateFigure::Aggregate kind, std::vector<double> weights);

  std::size_t conditions() const { return weights_.size(); }
  /// Returns NaN if a value is NaN.
  double value(std::span<const double> values) const;
  /// Returns a bound of the error of value(); `errors`: bounds of the errors of the values.
  double error(std::span<const double> errors) const;

 private:
  v1::CandidateFigure::Aggregate kind_;
  std::vector<double> weights_;
};

/// A figure by candidate.
struct CandidateValues {
  std::vector<double> values;         ///< in the unit of the column; NaN: none
  std::vector<double> solver_errors;  ///< bounds, in the same unit; empty: not estimated
};

/// Candidates of a campaign by what becomes of them in a decision.
struct CandidateSelection {
  std::vector<std::size_t> candidates;  ///< that the decision takes, ascending
  int excluded = 0;                     ///< violate a constraint
  int refused = 0;                      ///< lack one of the figures
  int missing = 0;                      ///< have rows that are not computed yet
};

/// `missing`: by candidate, whether one of its rows is not computed. `figures`: everything that the
/// decision reads of the candidates; the last ones are those of the constraints.
CandidateSelection select_candidates(
    const std::vector<bool>& missing, const std::vector<CandidateValues>& figures,
    const google::protobuf::RepeatedPtrField<v1::CandidateConstraint>& constraints);

}  // namespace tribodyn::server
