#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "server/contract/resource_names.h"
#include "server/contract/violations.h"
#include "server/simulation/point_evaluation.h"
#include "server/simulation/rig_evaluation.h"
#include "tribodyn/v1/campaigns.pb.h"

namespace tribodyn::server {

/// Largest number of conditions of a campaign: a tile holds whole candidates.
inline constexpr int kMaximumCampaignConditions = 2000;

/// What a campaign of a rig computes for each candidate.
struct RigPoints {
  /// Conditions with the same temperature. A rig is prepared once for each candidate and group.
  struct Group {
    double supply_temperature_celsius;
    std::vector<std::pair<int, RigCondition>> conditions;  ///< with their position
  };

  RigEvaluation rig;  ///< of the base
  std::vector<Group> groups;
};

/// Returns the number of conditions of a campaign, of the axle or of a rig.
int condition_count(const v1::Campaign& campaign);

/// Returns true for a rig whose specimens have no roughness.
bool has_smooth_specimens(const v1::Campaign& campaign);

/// Returns why a parameter of candidates, path as in CandidateColumn, has no effect on a rig; empty
/// if it may have one, or without a rig.
std::string no_effect_text(const v1::Campaign& campaign, const std::string& path);

/// Returns the conditions of the rig of a campaign, those of a grid in the order of nested loops.
std::vector<v1::RigCondition> rig_conditions(const v1::Campaign& campaign);

/// Checks a campaign with a rig and finds its resources. `columns` has the columns of its
/// candidates and nothing else. Returns nullopt and adds all violations if the campaign is invalid
/// or has more than `most` points. Otherwise sets candidates, conditions and columns of `points`,
/// and of its base the lubricant, the surface, which is null for smooth specimens, and the names of
/// their revisions.
std::optional<RigPoints> read_rig_points(const v1::Campaign& campaign,
                                         const v1::EvaluatePointsRequest& columns,
                                         const ResourceLookup& lookup, int most,
                                         Violations& violations, PointEvaluation& points);

/// Returns the canonical text of all values that a row of the base can depend on, as
/// canonical_inputs().
std::string canonical_rig(const v1::Campaign& campaign, const RigPoints& points);

}  // namespace tribodyn::server
