#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "server/storage/campaign_rows.h"

namespace tribodyn::server {

// Processes that were lost while they computed campaigns, and the suspects: rows at which one may
// have been lost. On an open connection, inside the caller's transaction. All throw
// SQLite::Exception.

/// Returns the rows of all campaigns that are RUNNING, the oldest first. Called once by a process,
/// before begin_campaign(). A suspect that an earlier process had begun is halved; of a single
/// candidate the lost attempt is counted. Either explains the loss of that process, which counts
/// for no campaign then.
std::vector<std::int64_t> resume_campaigns(Connection& db);

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
/// Removes suspects whose rows a tile holds, and shortens one of which it holds the first rows.
void clear_suspects(Connection& db, std::int64_t id, const RowRange& tile);

}  // namespace tribodyn::server
