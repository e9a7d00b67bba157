#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "server/storage/connection.h"
#include "server/storage/stored_campaign.h"
#include "server/storage/stored_resource.h"

namespace tribodyn::server {

// Rows of campaigns on an open connection, inside the caller's transaction. All throw
// SQLite::Exception; query_campaign_column() also throws StoreError kDataLoss.

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
/// Replaces the request of a campaign, and its labels. Returns false, and changes nothing, if the
/// request is no longer `before`.
bool relabel_campaign(Connection& db, std::int64_t id, const std::string& before,
                      const std::string& request, const CampaignLabels& labels);
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
/// Returns the rows of all campaigns that are RUNNING, the oldest first. Called once by a process,
/// before begin_campaign(). A suspect that an earlier process had begun is halved; of a single
/// candidate the lost attempt is counted. Either explains the loss of that process, which counts
/// for no campaign then.
std::vector<std::int64_t> resume_campaigns(Connection& db);
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

/// Counts the beginning of the campaign's computation by a process. Pauses the campaign with
/// WORKER_LOST if the attempts of kMaximumLostAttempts processes were lost without a suspect, or
/// more than kMaximumLostCandidates candidates have had so many. Returns the campaign; nullopt if
/// it does not exist or has ended.
std::optional<StoredCampaign> begin_campaign(Connection& db, std::int64_t id);
inline constexpr int kMaximumLostCandidates = 10;
/// Forgives the attempts that were counted: the process ends in good order.
void release_campaign(Connection& db, std::int64_t id);

/// Returns the suspects of a campaign in the order of their rows.
std::vector<CampaignSuspect> query_suspects(Connection& db, std::int64_t id);
/// Notes that a process computes rows, which are a suspect from now on until a tile holds them.
/// Changes nothing if the campaign does not exist or has ended.
void begin_suspect(Connection& db, std::int64_t id, const RowRange& rows);
/// Notes that no process computes suspects of the campaign.
void end_suspects(Connection& db, std::int64_t id);

/// Blobs of a tile: one for each column. Calls `between_columns`, if there is one, before each.
std::vector<std::string> compress_tile(const NewTile& tile,
                                       const std::function<void()>& between_columns);
/// Adds a tile, and changes the campaign to SUCCEEDED if no row is missing, or to PAUSED with
/// BUDGET_SPENT if its budget is. Returns the campaign; nullopt, and changes nothing, if the
/// campaign does not exist or has ended, or holds one of the rows.
std::optional<StoredCampaign> insert_tile(Connection& db, std::int64_t id, const NewTile& tile,
                                          const std::vector<std::string>& blobs, Microseconds now);

/// Returns how far a campaign is; nullopt if it does not exist. `first_missing_row`: of an earlier
/// call, or 0; the tiles before it are not read again.
std::optional<CampaignProgress> query_campaign_progress(Connection& db, std::int64_t id,
                                                        std::int64_t first_missing_row);
/// Returns the rows of all tiles, in their order.
std::vector<RowRange> query_tiles(Connection& db, std::int64_t id);
std::vector<CampaignRefusal> query_refusals(Connection& db, std::int64_t id);
/// Reads rows [start, start + values.size()) of a column. Rows without a tile keep their values.
void query_campaign_column(Connection& db, std::int64_t id, int column, std::int64_t start,
                           std::span<double> values);
/// Returns false if a tile lacks one of the columns 0 to `columns` - 1, or one is damaged.
bool is_whole_tile(Connection& db, std::int64_t id, const RowRange& tile, int columns);

/// Removes a campaign with its tiles. Returns the freed bytes.
std::int64_t remove_campaign(Connection& db, std::int64_t id);

}  // namespace tribodyn::server
