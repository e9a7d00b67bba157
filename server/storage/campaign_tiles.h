#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "server/storage/campaign_rows.h"

namespace tribodyn::server {

// Tiles of campaigns on an open connection, inside the caller's transaction. All throw
// SQLite::Exception; query_campaign_column() also throws StoreError kDataLoss.

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

}  // namespace tribodyn::server
