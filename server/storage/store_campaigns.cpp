// Store: campaigns, their tiles and their suspects.
#include <SQLiteCpp/Transaction.h>

#include "server/storage/campaign_rows.h"
#include "server/storage/campaign_suspects.h"
#include "server/storage/campaign_tiles.h"
#include "server/storage/life_cycle.h"
#include "server/storage/store_access.h"

namespace tribodyn::server {

CampaignAdded Store::add_campaign(const NewCampaign& campaign, Microseconds now,
                                  const CallLimits& limits) {
  CampaignAdded out;
  write_together(limits, [&](Connection& db) { out = insert_campaign(db, campaign, now); });
  return out;
}

std::optional<StoredCampaign> Store::campaign(std::int64_t id, const CallLimits& limits) {
  return read(limits, [&](Connection& db) { return query_campaign(db, id); });
}

std::optional<StoredCampaign> Store::numbered_campaign(const std::string& project,
                                                       std::int64_t number,
                                                       const CallLimits& limits) {
  return read(limits, [&](Connection& db) { return query_numbered_campaign(db, project, number); });
}

std::optional<StoredCampaign> Store::campaign_of_request(const std::string& project,
                                                         const std::string& request_id,
                                                         const CallLimits& limits) {
  return read(limits,
              [&](Connection& db) { return query_campaign_of_request(db, project, request_id); });
}

Page<StoredCampaign> Store::campaigns(const CampaignQuery& query, const CallLimits& limits) {
  return read(limits, [&](Connection& db) { return query_campaigns(db, query); });
}

std::optional<StoredCampaign> Store::describe_campaign(
    const StoredCampaign& present, const std::string& request, const CampaignLabels& labels,
    const std::optional<std::string>& candidate_table, const CallLimits& limits) {
  std::optional<StoredCampaign> out;
  write_together(limits, [&](Connection& db) {
    out.reset();
    if (server::describe_campaign(db, present, request, labels, candidate_table)) {
      out = query_campaign(db, present.id);
    }
  });
  return out;
}

CandidatesAdded Store::add_candidates(const NewCandidates& added, Microseconds now,
                                      int lost_attempts, const CallLimits& limits) {
  CandidatesAdded out;
  write_together(limits,
                 [&](Connection& db) { out = insert_candidates(db, added, now, lost_attempts); });
  tell_campaign_change();
  return out;
}

std::optional<CandidatesAdded::Kind> Store::append_of_request(std::int64_t id,
                                                              const std::string& request_id,
                                                              const std::string& request_hash,
                                                              const CallLimits& limits) {
  return read(limits,
              [&](Connection& db) { return query_append(db, id, request_id, request_hash); });
}

int Store::created_candidates(std::int64_t id, const CallLimits& limits) {
  return read(limits, [&](Connection& db) { return query_created_candidates(db, id); });
}

std::vector<std::int64_t> Store::resume_campaigns() {
  std::vector<std::int64_t> out;
  write_together({}, [&](Connection& db) { out = server::resume_campaigns(db); });
  return out;
}

std::vector<std::int64_t> Store::paused_campaigns() {
  return read({}, [](Connection& db) { return query_paused_campaigns(db); });
}

std::string Store::candidate_table(std::int64_t id, const CallLimits& limits) {
  return read(limits, [&](Connection& db) { return query_candidate_table(db, id); });
}

std::optional<StoredCampaign> Store::change_campaign(const CampaignChange& change,
                                                     const CallLimits& limits) {
  std::optional<StoredCampaign> out;
  write_together(limits, [&](Connection& db) { out = server::change_campaign(db, change); });
  tell_campaign_change();
  return out;
}

std::optional<StoredCampaign> Store::begin_campaign(std::int64_t id) {
  std::optional<StoredCampaign> out;
  write_together({}, [&](Connection& db) { out = server::begin_campaign(db, id); });
  tell_campaign_change();  // it may pause the campaign
  return out;
}

void Store::release_campaign(std::int64_t id) {
  write_together({}, [&](Connection& db) { server::release_campaign(db, id); });
}

std::vector<CampaignSuspect> Store::campaign_suspects(std::int64_t id) {
  return read({}, [&](Connection& db) { return query_suspects(db, id); });
}

void Store::begin_suspect(std::int64_t id, const RowRange& rows) {
  write_together({}, [&](Connection& db) { server::begin_suspect(db, id, rows); });
}

void Store::end_suspects(std::int64_t id) {
  write_together({}, [&](Connection& db) { server::end_suspects(db, id); });
}

std::optional<StoredCampaign> Store::add_tile(std::int64_t id, const NewTile& tile,
                                              Microseconds now,
                                              const std::function<void()>& between_columns) {
  // Compresses before the transaction, so that other writers do not wait.
  const std::vector<std::string> blobs = compress_tile(tile, between_columns);
  std::optional<StoredCampaign> out;
  write_together({}, [&](Connection& db) { out = insert_tile(db, id, tile, blobs, now); });
  tell_campaign_change();
  return out;
}

void Store::tell_campaign_change() {
  ++campaign_changes_;  // before anybody is notified, so that who looks then finds it
  campaign_observers_.tell();
}

std::optional<CampaignProgress> Store::campaign_progress(std::int64_t id,
                                                         std::int64_t first_missing_row,
                                                         const CallLimits& limits) {
  return read(limits,
              [&](Connection& db) { return query_campaign_progress(db, id, first_missing_row); });
}

std::vector<RowRange> Store::campaign_tiles(std::int64_t id, const CallLimits& limits) {
  return read(limits, [&](Connection& db) { return query_tiles(db, id); });
}

std::vector<CampaignRefusal> Store::campaign_refusals(std::int64_t id, const CallLimits& limits) {
  return read(limits, [&](Connection& db) { return query_refusals(db, id); });
}

bool Store::remove_campaign(std::int64_t id, const CallLimits& limits) {
  const bool is_gone = write(limits, [&](Connection& db) {
    SQLite::Transaction transaction(db, SQLite::TransactionBehavior::IMMEDIATE);
    const auto stored = query_campaign(db, id);
    if (stored && !has_ended(stored->state)) return false;
    server::remove_campaign(db, id);
    transaction.commit();
    return true;
  });
  if (is_gone) tell_campaign_change();
  return is_gone;
}

void Store::read_campaign(std::int64_t id, int column, std::int64_t start, std::span<double> values,
                          const CallLimits& limits) {
  run_read(limits, [&](Connection& db) { query_campaign_column(db, id, column, start, values); });
}

}  // namespace tribodyn::server
