#include "server/storage/campaign_suspects.h"

#include <string>

#include "server/storage/life_cycle.h"

namespace tribodyn::server {
namespace {

/// A suspect that a lost process had begun.
struct LostSuspect {
  std::int64_t campaign = 0;
  RowRange rows;
  std::int64_t conditions = 1;
  int lost_attempts = 0;
};

std::vector<LostSuspect> query_lost_suspects(Connection& db) {
  Prepared query(db,
                 "SELECT s.campaign, s.first_row, s.rows, c.conditions, s.lost_attempts "
                 "FROM campaign_suspects s JOIN campaigns c ON c.id = s.campaign "
                 "WHERE s.is_begun = 1");
  std::vector<LostSuspect> out;
  while (query.executeStep()) {
    out.push_back({query.getColumn(0).getInt64(),
                   {query.getColumn(1).getInt64(), query.getColumn(2).getInt64()},
                   query.getColumn(3).getInt64(),
                   query.getColumn(4).getInt()});
  }
  return out;
}

/// Halves a suspect of several candidates.
void halve(Connection& db, const LostSuspect& suspect) {
  const std::int64_t first = suspect.rows.count / suspect.conditions / 2 * suspect.conditions;
  execute(db,
          "UPDATE campaign_suspects SET rows = ?3, is_begun = 0 WHERE campaign = ?1 AND "
          "first_row = ?2",
          suspect.campaign, suspect.rows.first, first);
  execute(db, "INSERT INTO campaign_suspects VALUES (?, ?, ?, 0, 0)", suspect.campaign,
          suspect.rows.first + first, suspect.rows.count - first);
}

/// Counts the lost attempt of a suspect of one candidate.
void count_attempt(Connection& db, const LostSuspect& suspect) {
  execute(db,
          "UPDATE campaign_suspects SET lost_attempts = lost_attempts + 1, is_begun = 0 "
          "WHERE campaign = ? AND first_row = ?",
          suspect.campaign, suspect.rows.first);
  if (suspect.lost_attempts + 1 != kMaximumLostAttempts) return;
  execute(db, "UPDATE campaigns SET lost_candidates = lost_candidates + 1 WHERE id = ?",
          suspect.campaign);
}

}  // namespace

std::vector<std::int64_t> resume_campaigns(Connection& db) {
  const std::vector<LostSuspect> lost = query_lost_suspects(db);
  for (const LostSuspect& each : lost) {
    each.rows.count > each.conditions ? halve(db, each) : count_attempt(db, each);
  }
  if (!lost.empty()) {
    // That explains the loss of the process: it says nothing of the other campaigns.
    db.exec(
        "UPDATE campaigns SET lost_attempts = lost_attempts - 1 WHERE state <= 2 AND "
        "lost_attempts > 0");
  }
  Prepared query(db, "SELECT id FROM campaigns WHERE state = 1 ORDER BY id");
  std::vector<std::int64_t> out;
  while (query.executeStep()) out.push_back(query.getColumn(0).getInt64());
  return out;
}

std::optional<StoredCampaign> begin_campaign(Connection& db, std::int64_t id) {
  Prepared update(db,
                  "UPDATE campaigns SET lost_attempts = lost_attempts + 1 "
                  "WHERE id = ? AND state <= 2 RETURNING lost_attempts, lost_candidates",
                  id);
  if (!update.executeStep()) return std::nullopt;
  const int attempts = update.getColumn(0).getInt(), candidates = update.getColumn(1).getInt();
  update.executeStep();  // to its end: only then is it done
  CampaignChange pause{.id = id,
                       .to = CampaignState::kPaused,
                       .reason = "WORKER_LOST",
                       .from = CampaignState::kRunning};
  if (candidates > kMaximumLostCandidates) {
    pause.message = "the server ended whenever it computed one of " + std::to_string(candidates) +
                    " candidates; resume the campaign to go on with the others";
    change_campaign(db, pause);
  } else if (attempts > kMaximumLostAttempts) {
    pause.message = "the server ended " + std::to_string(kMaximumLostAttempts) +
                    " times while it computed this campaign; resume it to go on";
    change_campaign(db, pause);
  }
  return query_campaign(db, id);
}

void release_campaign(Connection& db, std::int64_t id) {
  execute(db, "UPDATE campaigns SET lost_attempts = 0 WHERE id = ? AND state <= 2", id);
  end_suspects(db, id);
}

std::vector<CampaignSuspect> query_suspects(Connection& db, std::int64_t id) {
  Prepared query(db,
                 "SELECT first_row, rows, lost_attempts FROM campaign_suspects WHERE campaign = ? "
                 "ORDER BY first_row",
                 id);
  std::vector<CampaignSuspect> out;
  while (query.executeStep()) {
    out.push_back({{query.getColumn(0).getInt64(), query.getColumn(1).getInt64()},
                   query.getColumn(2).getInt()});
  }
  return out;
}

void begin_suspect(Connection& db, std::int64_t id, const RowRange& rows) {
  execute(db,
          "INSERT INTO campaign_suspects SELECT id, ?2, ?3, 1, 0 FROM campaigns "
          "WHERE id = ?1 AND state <= 2 "
          "ON CONFLICT (campaign, first_row) DO UPDATE SET is_begun = 1",
          id, rows.first, rows.count);
}

void end_suspects(Connection& db, std::int64_t id) {
  execute(db, "UPDATE campaign_suspects SET is_begun = 0 WHERE campaign = ? AND is_begun = 1", id);
}

void clear_suspects(Connection& db, std::int64_t id, const RowRange& tile) {
  execute(db,
          "DELETE FROM campaign_suspects WHERE campaign = ?1 AND first_row >= ?2 AND "
          "first_row + rows <= ?3",
          id, tile.first, tile.first + tile.count);
  execute(db,
          "UPDATE campaign_suspects SET rows = first_row + rows - ?3, first_row = ?3, "
          "is_begun = 0 WHERE campaign = ?1 AND first_row = ?2",
          id, tile.first, tile.first + tile.count);
}

}  // namespace tribodyn::server
