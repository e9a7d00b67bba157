#include "server/storage/campaign_rows.h"

#include <string_view>

#include "server/storage/checksum.h"
#include "server/storage/life_cycle.h"
#include "server/storage/list_conditions.h"
#include "server/storage/resource_rows.h"

namespace tribodyn::server {
namespace {

constexpr char kSelectCampaigns[] =
    "SELECT id, project, number, state, stop_reason, stop_message, create_time, end_time, request, "
    "request_id, request_hash, input_hash, model_version, platform, principal, candidates, "
    "conditions, points_done, points_refused, lost_attempts, budget_seconds, budget_points, "
    "processor_seconds, cost_seconds, stored_bytes, "
    "(SELECT name || '@' || revision FROM revision_names WHERE revision_id = lubricant), "
    "(SELECT name || '@' || revision FROM revision_names WHERE revision_id = gear_set), "
    "(SELECT name || '@' || revision FROM revision_names WHERE revision_id = surface), "
    "(SELECT name || '@' || revision FROM revision_names WHERE revision_id = vehicle), "
    "request_checksum FROM campaigns ";

/// Returns the relative name of a revision; empty if it is not of this collection: no column is
/// NULL, and one without a resource has the lubricant.
std::string own_revision(const std::string& full, std::string_view collection) {
  std::string name = relative_name(full);
  const bool is_own = name.starts_with(collection) && name[collection.size()] == '/';
  return is_own ? name : std::string();
}

StoredCampaign stored_campaign(const SQLite::Statement& query) {
  StoredCampaign out;
  int at = 0;
  const auto next = [&] { return query.getColumn(at++); };
  out.id = next().getInt64();
  out.project = next().getString();
  out.number = next().getInt64();
  out.state = static_cast<CampaignState>(next().getInt());
  out.stop_reason = next().getString();
  out.stop_message = next().getString();
  out.create_time = next().getInt64();
  if (const SQLite::Column end = next(); !end.isNull()) out.end_time = end.getInt64();
  out.request = next().getString();
  out.request_id = next().getString();
  out.request_hash = next().getString();
  out.input_hash = next().getString();
  out.model_version = next().getString();
  out.platform = next().getString();
  out.principal = next().getString();
  out.candidates = next().getInt();
  out.conditions = next().getInt();
  out.points_done = next().getInt64();
  out.points_refused = next().getInt64();
  out.lost_attempts = next().getInt();
  out.budget.processor_seconds = next().getDouble();
  out.budget.points = next().getInt64();
  out.processor_seconds = next().getDouble();
  out.cost_seconds = next().getDouble();
  out.stored_bytes = next().getInt64();
  out.revisions.lubricant = relative_name(next().getString());
  out.revisions.gear_set = own_revision(next().getString(), kGearSets);
  out.revisions.surface = own_revision(next().getString(), kSurfaces);
  out.revisions.vehicle = own_revision(next().getString(), kVehicles);
  require_undamaged(out.request, next().getInt64(), "the stored request of ", name_of(out));
  return out;
}

std::int64_t next_campaign_number(Connection& db, const std::string& project) {
  const auto number =
      Prepared(db,
               "UPDATE projects SET last_campaign = last_campaign + 1 WHERE name = ? "
               "RETURNING last_campaign",
               project)
          .returned();
  if (!number) throw SQLite::Exception("no such project");
  return *number;
}

void insert_campaign_labels(Connection& db, std::int64_t id, const CampaignLabels& labels) {
  for (const auto& [key, value] : labels) {
    execute(db, "INSERT INTO campaign_labels VALUES (?, ?, ?)", key, value, id);
  }
}

void insert_lubricants(Connection& db, std::int64_t id, const std::string& project,
                       const std::vector<std::string>& revisions) {
  Prepared insert(db,
                  "INSERT INTO campaign_lubricants VALUES (?, (SELECT revision_id FROM "
                  "revision_names WHERE name = ? AND revision = ?)) ON CONFLICT DO NOTHING");
  for (const std::string& each : revisions) {
    const RevisionRow row = revision_row(project, each);
    insert.run(id, row.name, row.number);
  }
}

}  // namespace

CampaignAdded insert_campaign(Connection& db, const NewCampaign& campaign, Microseconds now) {
  if (!campaign.request_id.empty()) {
    if (auto stored = query_campaign_of_request(db, campaign.project, campaign.request_id)) {
      const bool is_same = stored->request_hash == campaign.request_hash;
      return {is_same ? CampaignAdded::Kind::kRepeated : CampaignAdded::Kind::kRequestIdTaken,
              std::move(*stored)};
    }
  }
  std::vector<RevisionRow> revisions;
  for (const std::string* revision : campaign.revisions.all()) {
    revisions.push_back(revision_row(campaign.project,
                                     revision->empty() ? campaign.revisions.lubricant : *revision));
  }
  execute(db,
          "INSERT INTO campaigns (project, number, state, create_time, request_id, request_hash, "
          "input_hash, model_version, platform, client, principal, candidates, conditions, "
          "cost_seconds, budget_seconds, budget_points, stored_bytes, request, request_checksum, "
          "candidate_table, table_checksum, lubricant, gear_set, surface, vehicle) "
          "VALUES (?, ?, 1, ?, nullif(?, ''), ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, "
          "(SELECT revision_id FROM revision_names WHERE name = ? AND revision = ?), "
          "(SELECT revision_id FROM revision_names WHERE name = ? AND revision = ?), "
          "(SELECT revision_id FROM revision_names WHERE name = ? AND revision = ?), "
          "(SELECT revision_id FROM revision_names WHERE name = ? AND revision = ?))",
          campaign.project, next_campaign_number(db, campaign.project), now, campaign.request_id,
          campaign.request_hash, campaign.input_hash, campaign.model_version, campaign.platform,
          campaign.client, campaign.principal, campaign.candidates, campaign.conditions,
          campaign.cost_seconds, campaign.budget.processor_seconds, campaign.budget.points,
          static_cast<std::int64_t>(campaign.request.size() + campaign.candidate_table.size()),
          Blob{campaign.request}, checksum(campaign.request), Blob{campaign.candidate_table},
          checksum(campaign.candidate_table), revisions[0].name, revisions[0].number,
          revisions[1].name, revisions[1].number, revisions[2].name, revisions[2].number,
          revisions[3].name, revisions[3].number);
  const std::int64_t id = db.getLastInsertRowid();
  insert_campaign_labels(db, id, campaign.labels);
  insert_lubricants(db, id, campaign.project, campaign.candidate_lubricants);
  return {CampaignAdded::Kind::kAdded, *query_campaign(db, id)};
}

std::optional<StoredCampaign> query_campaign(Connection& db, std::int64_t id) {
  Prepared query(db, std::string(kSelectCampaigns) + "WHERE id = ?", id);
  return query.first(stored_campaign);
}

std::optional<StoredCampaign> query_numbered_campaign(Connection& db, const std::string& project,
                                                      std::int64_t number) {
  Prepared query(db, std::string(kSelectCampaigns) + "WHERE project = ? AND number = ?", project,
                 number);
  return query.first(stored_campaign);
}

std::optional<StoredCampaign> query_campaign_of_request(Connection& db, const std::string& project,
                                                        const std::string& request_id) {
  Prepared query(db, std::string(kSelectCampaigns) + "WHERE project = ? AND request_id = ?",
                 project, request_id);
  return query.first(stored_campaign);
}

Page<StoredCampaign> query_campaigns(Connection& db, const CampaignQuery& wanted) {
  const Condition all = list_condition(db, "campaigns", wanted.project, wanted.restrictions);
  SQLite::Statement query(db, std::string(kSelectCampaigns) + "WHERE " + all.sql +
                                  " AND (? = 0 OR number < ?) ORDER BY number DESC LIMIT ?");
  std::vector<PropertyValue> values = all.values;
  const std::int64_t before = wanted.before;
  for (const std::int64_t each : {before, before, std::int64_t{wanted.limit + 1}}) {
    values.emplace_back(each);
  }
  bind_values(query, values);
  Page<StoredCampaign> out;
  while (query.executeStep()) out.rows.push_back(stored_campaign(query));
  out.more = out.rows.size() > static_cast<std::size_t>(wanted.limit);
  if (out.more) out.rows.pop_back();
  SQLite::Statement count(db, "SELECT count(*) FROM campaigns WHERE " + all.sql);
  bind_values(count, all.values);
  count.executeStep();
  out.total = count.getColumn(0).getInt64();
  return out;
}

std::vector<std::int64_t> query_paused_campaigns(Connection& db) {
  Prepared query(db, "SELECT id FROM campaigns WHERE state = ?", CampaignState::kPaused);
  std::vector<std::int64_t> out;
  while (query.executeStep()) out.push_back(query.getColumn(0).getInt64());
  return out;
}

bool describe_campaign(Connection& db, const StoredCampaign& present, const std::string& request,
                       const CampaignLabels& labels,
                       const std::optional<std::string>& candidate_table) {
  const int changed = execute(
      db,
      "UPDATE campaigns SET stored_bytes = stored_bytes + length(?1) - length(request), "
      "request = ?1, request_checksum = ?5 WHERE id = ?2 AND request = ?3 AND candidates = ?4",
      Blob{request}, present.id, Blob{present.request}, present.candidates, checksum(request));
  if (changed == 0) return false;
  if (candidate_table) {
    execute(db,
            "UPDATE campaigns SET "
            "stored_bytes = stored_bytes + length(?1) - length(candidate_table), "
            "candidate_table = ?1, table_checksum = ?3 WHERE id = ?2",
            Blob{*candidate_table}, present.id, checksum(*candidate_table));
  }
  execute(db, "DELETE FROM campaign_labels WHERE campaign = ?", present.id);
  insert_campaign_labels(db, present.id, labels);
  return true;
}

std::optional<CandidatesAdded::Kind> query_append(Connection& db, std::int64_t id,
                                                  const std::string& request_id,
                                                  const std::string& request_hash) {
  if (request_id.empty()) return std::nullopt;
  Prepared query(db,
                 "SELECT request_hash FROM campaign_appends WHERE campaign = ? AND request_id = ?",
                 id, request_id);
  if (!query.executeStep()) return std::nullopt;
  return query.getColumn(0).getString() == request_hash ? CandidatesAdded::Kind::kRepeated
                                                        : CandidatesAdded::Kind::kRequestIdTaken;
}

int query_created_candidates(Connection& db, std::int64_t id) {
  Prepared query(db,
                 "SELECT coalesce((SELECT min(first_candidate) FROM campaign_appends WHERE "
                 "campaign = ?1), (SELECT candidates FROM campaigns WHERE id = ?1), 0)",
                 id);
  query.executeStep();
  return query.getColumn(0).getInt();
}

CandidatesAdded insert_candidates(Connection& db, const NewCandidates& added, Microseconds now,
                                  int lost_attempts) {
  using enum CandidatesAdded::Kind;
  if (const auto earlier = query_append(db, added.campaign, added.request_id, added.request_hash)) {
    return {*earlier, query_campaign(db, added.campaign)};
  }
  Prepared update(
      db,
      "UPDATE campaigns SET candidates = ?2, candidate_table = ?3, table_checksum = ?8, "
      "input_hash = ?4, "
      "cost_seconds = cost_seconds + ?5, "
      "stored_bytes = stored_bytes + length(?3) - length(candidate_table), "
      "lost_attempts = CASE state WHEN 3 THEN ?7 ELSE lost_attempts END, "
      "end_time = NULL, state = CASE state WHEN 3 THEN 1 ELSE state END "
      "WHERE id = ?1 AND state <= 3 AND candidates = ?6 RETURNING project",
      added.campaign, added.candidates, Blob{added.candidate_table}, added.input_hash,
      added.cost_seconds, added.candidates_before, lost_attempts, checksum(added.candidate_table));
  if (!update.executeStep()) return {kChanged, query_campaign(db, added.campaign)};
  const std::string project = update.getColumn(0).getString();
  update.executeStep();  // to its end: only then is it done
  execute(db, "INSERT INTO campaign_appends VALUES (?, ?, nullif(?, ''), ?, ?)", added.campaign,
          added.candidates_before, added.request_id, added.request_hash, now);
  insert_lubricants(db, added.campaign, project, added.candidate_lubricants);
  return {kAdded, query_campaign(db, added.campaign)};
}

std::string query_candidate_table(Connection& db, std::int64_t id) {
  Prepared query(db,
                 "SELECT candidate_table, table_checksum, project, number FROM campaigns "
                 "WHERE id = ?",
                 id);
  if (!query.executeStep()) return {};
  std::string out = query.getColumn(0).getString();
  require_undamaged(out, query.getColumn(1).getInt64(), "the stored candidates of ",
                    campaign_name(query.getColumn(2).getString(), query.getColumn(3).getInt64()));
  return out;
}

std::optional<StoredCampaign> change_campaign(Connection& db, const CampaignChange& change) {
  std::optional<double> seconds;
  std::optional<std::int64_t> points;
  if (change.budget) {
    seconds = change.budget->processor_seconds;
    points = change.budget->points;
  }
  const int changed =
      execute(db,
              "UPDATE campaigns SET state = ?2, stop_reason = ?3, stop_message = ?4, "
              "end_time = CASE WHEN ?2 >= 3 THEN ?5 END, "
              "budget_seconds = coalesce(?6, budget_seconds), "
              "budget_points = coalesce(?7, budget_points), lost_attempts = ?9, "
              "lost_candidates = 0 "
              "WHERE id = ?1 AND state <= 2 AND state = coalesce(?8, state)",
              change.id, change.to, change.reason, change.message, change.time, seconds, points,
              change.from, change.lost_attempts);
  if (changed == 0) return std::nullopt;
  if (has_ended(change.to)) {
    execute(db, "DELETE FROM campaign_suspects WHERE campaign = ?", change.id);
  }
  return query_campaign(db, change.id);
}

std::int64_t remove_campaign(Connection& db, std::int64_t id) {
  Prepared remove(db, "DELETE FROM campaigns WHERE id = ? RETURNING stored_bytes", id);
  return remove.returned().value_or(0);
}

}  // namespace tribodyn::server
