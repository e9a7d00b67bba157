#pragma once

#include <optional>
#include <string>

#include "server/contract/resource_names.h"
#include "server/contract/violations.h"
#include "server/simulation/campaign_candidates.h"
#include "server/simulation/campaign_rig.h"
#include "server/simulation/point_evaluation.h"
#include "server/storage/stored_campaign.h"
#include "tribodyn/v1/campaigns.pb.h"

namespace tribodyn::server {

/// Largest number of rows of a campaign: 1 GB of figures, and an hour of one processor.
inline constexpr int kMaximumCampaignPoints = 20'000'000;

/// Inputs of a campaign.
struct CampaignInputs {
  v1::Campaign requested;  ///< what the client set, without candidates
  v1::Campaign table;      ///< columns, attributes and lubricants of candidates, and nothing else
  PointEvaluation points;  ///< with `rig` only what read_rig_points() sets
  std::optional<RigPoints> rig;
  std::size_t columns = 0;  ///< number of the columns that the store keeps
  std::string input_hash;   ///< SHA-256, 64 hex digits
};

/// Checks the request, finds its resources and fills in defaults. Returns nullopt and adds all
/// violations if the request is invalid; their paths start with `path`. `search` is needed for
/// lubricant_filter.
std::optional<CampaignInputs> read_campaign(v1::Campaign request, const ResourceLookup& lookup,
                                            const std::string& path, Violations& violations,
                                            const LubricantSearch& search = {});

/// A campaign with further candidates.
struct AppendedCandidates {
  CampaignInputs all;
  double cost_seconds = 0;                        ///< of the further candidates
  std::vector<std::string> candidate_lubricants;  ///< those that are further candidates
};

/// Checks a request for further candidates of a stored campaign. Returns nullopt and adds all
/// violations if it is invalid.
std::optional<AppendedCandidates> read_appended(const StoredCampaign& stored,
                                                const std::string& table,
                                                const v1::AppendCandidatesRequest& request,
                                                const ResourceLookup& lookup,
                                                const ResourceLookup& accepted,
                                                Violations& violations);

/// Reads a stored campaign again, without its hash. Throws Refusal if it cannot be read or this
/// server's model refuses it.
CampaignInputs stored_campaign_inputs(const StoredCampaign& stored, const std::string& table,
                                      const ResourceLookup& lookup);

/// Checks weights of conditions and attributes of candidates, which decide no figure, of a campaign
/// with so many candidates.
void check_descriptions(const v1::Campaign& requested, const v1::Campaign& table, int candidates,
                        const std::string& path, Violations& violations);

/// Estimates what all points take: right within a factor of a few.
v1::CostEstimate estimate_cost(const CampaignInputs& inputs);

}  // namespace tribodyn::server
