#include "server/storage/campaign_tiles.h"

#include <algorithm>
#include <cstddef>
#include <stdexcept>

#include "server/storage/campaign_suspects.h"
#include "server/storage/checksum.h"
#include "server/storage/history/column_codec.h"
#include "server/storage/store_error.h"

namespace tribodyn::server {
namespace {

/// Decompresses the blob of a tile. Throws StoreError kDataLoss if it is damaged.
void decompress_blob(const SQLite::Column& data, std::int64_t expected, std::span<double> values) {
  const std::string_view bytes = bytes_of(data);
  const StoreError damaged(StoreError::Kind::kDataLoss, "a tile of a stored campaign is damaged");
  if (checksum(bytes) != expected) throw damaged;
  try {
    decompress_column(bytes, values);
  } catch (const std::runtime_error&) {
    throw damaged;
  }
}

/// Returns true if a tile has one of the rows.
bool overlaps(Connection& db, std::int64_t id, const RowRange& rows) {
  Prepared query(db,
                 "SELECT 1 FROM campaign_tiles WHERE campaign = ?1 AND first_row < ?2 AND "
                 "first_row + rows > ?3",
                 id, rows.first + rows.count, rows.first);
  return query.executeStep();
}

void insert_blobs(Connection& db, std::int64_t id, const NewTile& tile,
                  const std::vector<std::string>& blobs) {
  execute(db, "INSERT INTO campaign_tiles VALUES (?, ?, ?)", id, tile.rows.first, tile.rows.count);
  Prepared blob(db, "INSERT INTO campaign_blobs VALUES (?, ?, ?, ?, ?)");
  for (std::size_t i = 0; i < blobs.size(); ++i) {
    blob.run(id, static_cast<int>(i), tile.rows.first, checksum(blobs[i]), Blob{blobs[i]});
  }
  for (const CampaignRefusal& each : tile.refusals) {
    execute(db, "INSERT INTO campaign_refusals VALUES (?, ?, ?, ?) ON CONFLICT DO NOTHING", id,
            each.number, each.reason, each.message);
  }
}

}  // namespace

std::vector<std::string> compress_tile(const NewTile& tile,
                                       const std::function<void()>& between_columns) {
  std::vector<std::string> out;
  out.reserve(tile.columns.size());
  for (const std::vector<double>& each : tile.columns) {
    if (between_columns) between_columns();
    out.push_back(compress_column(each));
  }
  return out;
}

std::optional<StoredCampaign> insert_tile(Connection& db, std::int64_t id, const NewTile& tile,
                                          const std::vector<std::string>& blobs, Microseconds now) {
  if (overlaps(db, id, tile.rows)) return std::nullopt;
  std::size_t bytes = 0;
  for (const std::string& each : blobs) bytes += each.size();
  const int changed =
      execute(db,
              "UPDATE campaigns SET points_done = points_done + ?2, "
              "points_refused = points_refused + ?3, "
              "processor_seconds = processor_seconds + ?4, stored_bytes = stored_bytes + ?5, "
              "lost_attempts = CASE WHEN ?6 THEN 0 ELSE lost_attempts END "
              "WHERE id = ?1 AND state <= 2",
              id, tile.rows.count, tile.refused_points, tile.processor_seconds,
              static_cast<std::int64_t>(bytes), tile.proves_health);
  if (changed == 0) return std::nullopt;
  insert_blobs(db, id, tile, blobs);
  clear_suspects(db, id, tile.rows);
  std::optional<StoredCampaign> stored = query_campaign(db, id);
  const CampaignBudget& budget = stored->budget;
  if (stored->points_done == stored->points()) {
    return change_campaign(db, {.id = id, .to = CampaignState::kSucceeded, .time = now});
  }
  const bool is_spent =
      (budget.points > 0 && stored->points_done >= budget.points) ||
      (budget.processor_seconds > 0 && stored->processor_seconds >= budget.processor_seconds);
  if (!is_spent || stored->state != CampaignState::kRunning) return stored;
  return change_campaign(db, {.id = id,
                              .to = CampaignState::kPaused,
                              .reason = "BUDGET_SPENT",
                              .message = "the budget is spent; resume it with a larger one"});
}

std::optional<CampaignProgress> query_campaign_progress(Connection& db, std::int64_t id,
                                                        std::int64_t first_missing_row) {
  Prepared query(db,
                 "SELECT state, stop_reason, stop_message, candidates * conditions, points_done, "
                 "points_refused, processor_seconds FROM campaigns WHERE id = ?",
                 id);
  if (!query.executeStep()) return std::nullopt;
  CampaignProgress out{.state = static_cast<CampaignState>(query.getColumn(0).getInt()),
                       .stop_reason = query.getColumn(1).getString(),
                       .stop_message = query.getColumn(2).getString(),
                       .points = query.getColumn(3).getInt64(),
                       .points_done = query.getColumn(4).getInt64(),
                       .points_refused = query.getColumn(5).getInt64(),
                       .first_missing_row = first_missing_row,
                       .processor_seconds = query.getColumn(6).getDouble()};
  Prepared tiles(db,
                 "SELECT first_row, rows FROM campaign_tiles WHERE campaign = ? AND "
                 "first_row >= ? ORDER BY first_row",
                 id, first_missing_row);
  while (tiles.executeStep() && tiles.getColumn(0).getInt64() == out.first_missing_row) {
    out.first_missing_row += tiles.getColumn(1).getInt64();
  }
  return out;
}

std::vector<RowRange> query_tiles(Connection& db, std::int64_t id) {
  Prepared query(
      db, "SELECT first_row, rows FROM campaign_tiles WHERE campaign = ? ORDER BY first_row", id);
  std::vector<RowRange> out;
  while (query.executeStep()) {
    out.push_back({query.getColumn(0).getInt64(), query.getColumn(1).getInt64()});
  }
  return out;
}

std::vector<CampaignRefusal> query_refusals(Connection& db, std::int64_t id) {
  Prepared query(db,
                 "SELECT number, reason, message FROM campaign_refusals WHERE campaign = ? "
                 "ORDER BY number",
                 id);
  std::vector<CampaignRefusal> out;
  while (query.executeStep()) {
    out.push_back({query.getColumn(0).getInt(), query.getColumn(1).getString(),
                   query.getColumn(2).getString()});
  }
  return out;
}

void query_campaign_column(Connection& db, std::int64_t id, int column, std::int64_t start,
                           std::span<double> values) {
  const std::int64_t end = start + static_cast<std::int64_t>(values.size());
  Prepared query(db,
                 "SELECT b.first_row, t.rows, b.checksum, b.data FROM campaign_blobs b "
                 "JOIN campaign_tiles t ON t.campaign = b.campaign AND t.first_row = b.first_row "
                 "WHERE b.campaign = ?1 AND b.number = ?2 AND b.first_row > ?3 AND "
                 "b.first_row < ?4 ORDER BY b.first_row",
                 id, column, start - kMaximumTileRows, end);
  std::vector<double> part;
  while (query.executeStep()) {
    const std::int64_t first = query.getColumn(0).getInt64();
    const std::int64_t last = first + query.getColumn(1).getInt64();
    if (last <= start) continue;
    if (first >= start && last <= end) {
      decompress_blob(query.getColumn(3), query.getColumn(2).getInt64(),
                      values.subspan(static_cast<std::size_t>(first - start),
                                     static_cast<std::size_t>(last - first)));
      continue;
    }
    part.resize(static_cast<std::size_t>(last - first));
    decompress_blob(query.getColumn(3), query.getColumn(2).getInt64(), part);
    const std::int64_t from = std::max(first, start), to = std::min(last, end);
    std::copy(part.begin() + (from - first), part.begin() + (to - first),
              values.begin() + (from - start));
  }
}

bool is_whole_tile(Connection& db, std::int64_t id, const RowRange& tile, int columns) try {
  if (tile.count < 1 || tile.count > kMaximumTileRows) return false;
  Prepared query(db,
                 "SELECT number, checksum, data FROM campaign_blobs WHERE campaign = ? AND "
                 "first_row = ? ORDER BY number",
                 id, tile.first);
  std::vector<double> values(static_cast<std::size_t>(tile.count));
  int found = 0;
  for (; query.executeStep(); ++found) {
    if (query.getColumn(0).getInt() != found) return false;
    decompress_blob(query.getColumn(2), query.getColumn(1).getInt64(), values);
  }
  return found == columns;
} catch (const StoreError&) {
  return false;
}

}  // namespace tribodyn::server
