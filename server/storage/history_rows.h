#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "server/storage/connection.h"
#include "server/storage/stored_simulation.h"

namespace tribodyn::server {

/// Number of doubles in a block: 64 KiB.
inline constexpr std::int64_t kHistoryBlock = 8192;

/// Largest number of rows that a request may ask for (kMaximumHistoryValues of constraints.h, in
/// one column). A database with more is damaged.
inline constexpr std::int64_t kMaximumHistoryRows = 20'000'000;

/// Columns and rows of a stored history.
struct HistoryShape {
  std::vector<std::string> names;
  std::vector<std::int64_t> columns;  ///< ids in history_columns, one for each name
  std::int64_t rows = 0;              ///< rows of each column
};

/// A simulation and, if it has succeeded, its result and the columns of its history.
struct StoredHistory {
  StoredSimulation simulation;
  std::string result = {};  ///< as Store::result
  HistoryShape shape = {};
};

/// Compresses a column and its pyramid. Uses no database.
CompressedColumn compress(const StoredColumn& column);

// The functions below work on an open connection inside the caller's transaction. All throw
// SQLite::Exception; those that read values throw StoreError kDataLoss if a block differs from its
// checksum.

void insert_history_column(Connection& db, std::int64_t result, std::int64_t position,
                           const CompressedColumn& column);

/// Returns the columns and rows of the history of a result.
HistoryShape query_history_shape(Connection& db, std::int64_t result);
/// Returns the columns and rows of the history of a simulation; none if it has no result.
HistoryShape query_history_shape_of(Connection& db, std::int64_t simulation);

/// Like Store::read_history.
bool query_history(Connection& db, std::int64_t column, int level, std::int64_t start,
                   std::span<double> values);

/// Returns true if a column has exactly these values, bit for bit.
bool holds_column(Connection& db, std::int64_t column, const std::vector<double>& values);

/// Returns true if no block of a column is missing or damaged, and its pyramid follows from its
/// values.
bool is_whole_column(Connection& db, std::int64_t column);

}  // namespace tribodyn::server
