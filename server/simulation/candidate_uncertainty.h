#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "server/contract/violations.h"
#include "server/simulation/campaign_inputs.h"
#include "server/simulation/candidate_figures.h"
#include "server/simulation/prepared_gear_sets.h"

namespace tribodyn::server {

/// Returns true if the parameter errs together with others: by a fit to the same measurements.
bool errs_with_a_law(const google::protobuf::FieldDescriptor& field);

// Of a base only lubricant and surface are used. It has no surface if the specimens of a rig are
// smooth.

/// Returns the value of the base; nullopt if it has none.
std::optional<double> base_value(const google::protobuf::FieldDescriptor& field,
                                 const SimulationInputs& base);
/// Returns the standard uncertainty that the base states of a parameter, path as in
/// CandidateColumn; 0: none, or the parameter errs with a law.
double stated_by_base(const std::string& path, const google::protobuf::FieldDescriptor& field,
                      const SimulationInputs& base);

/// Checks the names and values of stated uncertainties.
void check_uncertainties(const v1::RankCandidatesRequest& request, Violations& violations);

/// Largest number of points that comparisons take: some 2 s of a processor.
inline constexpr std::size_t kMaximumComparisonPoints = 60'000;

/// A figure of candidates under drawn inputs, which are those of ComparePoints where candidates are
/// lubricants.
struct DrawnCandidates {
  int draws = 0;  ///< 0: no input has an uncertainty
  /// By candidate and draw, in the unit of the figure; NaN where the model refuses a draw. Empty of
  /// a candidate of which nobody stated an uncertainty, unless the request or the table states
  /// some.
  std::vector<std::vector<double>> values;
  std::set<std::string> own_inputs, shared_inputs;  ///< that err
};

/// Draws the inputs of candidates, as RankCandidatesRequest describes it.
struct CandidateDraws {
  const v1::RankCandidatesRequest& request;
  std::vector<std::size_t> candidates;
  int column;  ///< of the figure (campaign_columns.h)
  const ConditionAggregate& aggregate;
  /// Those between the best one and this place have no values; the draws of the others do not
  /// depend on it.
  std::size_t first = 0;

  /// Throws Cancelled once `is_over` returns true.
  DrawnCandidates compute(CampaignInputs inputs, PreparedGearSets& gear_sets,
                          const std::function<bool()>& is_over) const;
  /// The number of points that each candidate takes.
  std::size_t points_of_each() const;
};

}  // namespace tribodyn::server
