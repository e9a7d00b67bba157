#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "server/storage/connection.h"
#include "server/storage/stored_campaign.h"
#include "server/storage/stored_resource.h"

namespace tribodyn::server {

// Rows of campaigns on an open connection, inside the caller's transaction. All throw
// SQLite::Exception.

/// Adds a campaign that is RUNNING, or returns the one that an earlier request with the same
/// request_id added to the same project.
CampaignAdded insert_campaign(Connection& db, const NewCampaign& campaign, Microseconds now);

std::optional<StoredCampaign> query_campaign(Connection& db, std::int64_t id);
std::optional<StoredCampaign> query_numbered_campaign(Connection& db, const std::string& project,
                                                      std::int64_t number);
std::optional<StoredCampaign> query_campaign_of_request(Connection& db, const std::string& project,
                                                        const std::string& request_id);
/// Which campaigns of a project a list has.
struct CampaignQuery {
  std::string project;
  std::vector<Restriction> restrictions;  ///< all must be true
  std::int64_t before = 0;                ///< only numbers below; 0: all
  int limit = 0;
};
/// Returns the campaigns that satisfy the query, the latest first, and the number of those over all
/// pages.
Page<StoredCampaign> query_campaigns(Connection& db, const CampaignQuery& query);
/// Returns the rows of all campaigns that are PAUSED.
std::vector<std::int64_t> query_paused_campaigns(Connection& db);
/// As Store::describe_campaign(); returns false if it changes nothing.
bool describe_campaign(Connection& db, const StoredCampaign& present, const std::string& request,
                       const CampaignLabels& labels,
                       const std::optional<std::string>& candidate_table);
/// Adds candidates. A campaign that has SUCCEEDED is RUNNING again; `lost_attempts`: as in
/// StoredCampaign, from then on.
CandidatesAdded insert_candidates(Connection& db, const NewCandidates& added, Microseconds now,
                                  int lost_attempts);
/// Returns what the request that added candidates under a request_id says of itself: as kind
/// kRepeated or kRequestIdTaken. Returns nullopt if none did.
std::optional<CandidatesAdded::Kind> query_append(Connection& db, std::int64_t id,
                                                  const std::string& request_id,
                                                  const std::string& request_hash);
/// Returns the number of candidates with which a campaign was created.
int query_created_candidates(Connection& db, std::int64_t id);
/// Returns NewCampaign::candidate_table; empty if the campaign does not exist.
std::string query_candidate_table(Connection& db, std::int64_t id);

/// A change of the state of a campaign that has not ended.
struct CampaignChange {
  std::int64_t id = 0;
  CampaignState to = CampaignState::kRunning;
  Microseconds time = 0;
  std::string reason = {};
  std::string message = {};
  std::optional<CampaignState> from = {};     ///< the only state that may change; empty: any
  std::optional<CampaignBudget> budget = {};  ///< its budget from now on; empty: the present one
  int lost_attempts = 0;                      ///< as in StoredCampaign, from now on
};
/// Changes the state. Returns the campaign; nullopt, and changes nothing, if it has ended or is in
/// another state than `from`.
std::optional<StoredCampaign> change_campaign(Connection& db, const CampaignChange& change);

/// Removes a campaign with its tiles. Returns the freed bytes.
std::int64_t remove_campaign(Connection& db, std::int64_t id);

}  // namespace tribodyn::server
