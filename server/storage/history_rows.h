#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "server/storage/connection.h"
#include "server/storage/stored_simulation.h"

namespace tribodyn::server {

/// Doubles of a block: 64 KiB.
inline constexpr std::int64_t kHistoryBlock = 8192;

/// Rows of the longest history that a request may ask for (kMaximumHistoryValues of constraints.h,
/// in one column). A database that states more is damaged.
inline constexpr std::int64_t kMaximumHistoryRows = 20'000'000;

/// What a stored history consists of.
struct HistoryShape {
  std::vector<std::string> names;
  std::vector<std::int64_t> columns;  ///< rows of history_columns, one a name
  std::int64_t rows = 0;              ///< of each column
};

/// With its pyramid. Needs no database.
CompressedColumn compress(const StoredColumn& column);

// On an open connection, inside the caller's transaction. All throw SQLite::Exception; those that
// read values throw StoreError kDataLoss if a block is not what was written.

void insert_history_column(Connection& db, std::int64_t result, std::int64_t position,
                           const CompressedColumn& column);

HistoryShape query_history_shape(Connection& db, std::int64_t result);

/// As Store::read_history.
bool query_history(Connection& db, std::int64_t column, int level, std::int64_t start,
                   std::span<double> values);

/// Whether a column holds these values, bit for bit.
bool holds_column(Connection& db, std::int64_t column, const std::vector<double>& values);

/// Whether every block of a column is there and is what was written, and its pyramid is its own.
bool is_whole_column(Connection& db, std::int64_t column);

}  // namespace tribodyn::server
