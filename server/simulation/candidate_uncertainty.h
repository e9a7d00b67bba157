#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/decisions/ranking.h"
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

/// A parameter with a standard uncertainty.
struct UncertainParameter {
  std::string path;  ///< as in CandidateColumn
  const google::protobuf::FieldDescriptor* field;
  bool is_shared;                     ///< all candidates have its error in common
  std::vector<double> uncertainties;  ///< by candidate of the campaign, in the unit of the field
};

/// Returns the uncertain parameters, as RankCandidatesRequest describes them.
std::vector<UncertainParameter> uncertain_parameters(const v1::RankCandidatesRequest& request,
                                                     const CampaignInputs& inputs);

/// Largest number of points that comparisons take. They take some 2 s of a processor.
inline constexpr std::size_t kMaximumComparisonPoints = 20'000;

/// Computes the effects of parameters on a figure: half its change from one standard uncertainty
/// below the value to one above.
struct EffectsStudy {
  std::vector<UncertainParameter> parameters;
  std::vector<std::size_t> candidates;
  int column;  ///< of the figure (campaign_columns.h)
  const ConditionAggregate& aggregate;

  /// Returns the effects by candidate, in the order of `candidates`, then by parameter; NaN where
  /// the model refuses one of the two. Throws Cancelled once `is_over` returns true.
  std::vector<std::vector<double>> compute(CampaignInputs inputs, PreparedGearSets& gear_sets,
                                           const std::function<bool()>& is_over) const;
};

}  // namespace tribodyn::server
