#include "server/storage/history_rows.h"

#include <algorithm>
#include <cstring>
#include <stdexcept>
#include <string_view>

#include "server/storage/checksum.h"
#include "server/storage/history/column_codec.h"
#include "server/storage/history/pyramid.h"
#include "server/storage/store_error.h"

namespace tribodyn::server {
namespace {

std::vector<std::string> compressed_blocks(std::span<const double> values) {
  std::vector<std::string> out;
  for (std::size_t i = 0; i < values.size(); i += kHistoryBlock) {
    out.push_back(compress_column(
        values.subspan(i, std::min<std::size_t>(kHistoryBlock, values.size() - i))));
  }
  return out;
}

/// Decompresses a block. Requires a row of data and checksum. Throws StoreError kDataLoss if the
/// block differs from its checksum or has another number of values.
void decompress(SQLite::Statement& block, std::span<double> values) {
  const std::string_view bytes = bytes_of(block.getColumn(0));
  const StoreError damaged(StoreError::Kind::kDataLoss, "a block of a stored history is damaged");
  if (checksum(bytes) != block.getColumn(1).getInt64()) throw damaged;
  try {
    decompress_column(bytes, values);
  } catch (const std::runtime_error&) {
    throw damaged;
  }
}

bool is_equal(std::span<const double> one, std::span<const double> other) {
  return one.size() == other.size() &&
         (one.empty() || std::memcmp(one.data(), other.data(), one.size_bytes()) == 0);
}

constexpr char kRowsOfColumn[] = "SELECT rows FROM history_columns WHERE id = ?";

std::int64_t rows_of(Connection& db, std::int64_t column) {
  Prepared query(db, kRowsOfColumn, column);
  return query.executeStep() ? query.getColumn(0).getInt64() : -1;
}

std::int64_t blocks_of(Connection& db, std::int64_t column) {
  Prepared query(db, "SELECT count(*) FROM history_blocks WHERE history_column = ? AND level = 0",
                 column);
  return query.value().getInt64();
}

HistoryShape history_shape(Prepared& query) {
  HistoryShape shape;
  while (query.executeStep()) {
    shape.columns.push_back(query.getColumn(0).getInt64());
    shape.names.push_back(query.getColumn(1).getString());
    shape.rows = query.getColumn(2).getInt64();
  }
  return shape;
}

}  // namespace

CompressedColumn compress(const StoredColumn& column) {
  CompressedColumn out{column.name, static_cast<std::int64_t>(column.values.size()), {}};
  out.levels.push_back(compressed_blocks(column.values));
  for (const std::vector<double>& level : build_pyramid(column.values)) {
    out.levels.push_back(compressed_blocks(level));
  }
  return out;
}

void insert_history_column(Connection& db, std::int64_t result, std::int64_t position,
                           const CompressedColumn& column) {
  execute(db, "INSERT INTO history_columns (result, position, name, rows) VALUES (?, ?, ?, ?)",
          result, position, column.name, column.rows);
  const std::int64_t row = db.getLastInsertRowid();
  Prepared block(db, "INSERT INTO history_blocks VALUES (?, ?, ?, ?, ?)");
  for (std::size_t level = 0; level < column.levels.size(); ++level) {
    for (std::size_t number = 0; number < column.levels[level].size(); ++number) {
      const std::string& data = column.levels[level][number];
      block.run(row, static_cast<std::int64_t>(level), static_cast<std::int64_t>(number),
                checksum(data), Blob{data});
    }
  }
}

HistoryShape query_history_shape(Connection& db, std::int64_t result) {
  Prepared query(
      db, "SELECT id, name, rows FROM history_columns WHERE result = ? ORDER BY position", result);
  return history_shape(query);
}

HistoryShape query_history_shape_of(Connection& db, std::int64_t simulation) {
  Prepared query(db,
                 "SELECT id, name, rows FROM history_columns "
                 "WHERE result = (SELECT result FROM simulations WHERE id = ?) ORDER BY position",
                 simulation);
  return history_shape(query);
}

bool query_history(Connection& db, std::int64_t column, int level, std::int64_t start,
                   std::span<double> values) {
  const auto count = static_cast<std::int64_t>(values.size());
  if (count == 0) return true;
  // Open until the function ends: while one statement is open, SQLite does not lock the database
  // again for the next.
  Prepared rows(db, kRowsOfColumn, column);
  if (!rows.executeStep()) return false;
  const std::int64_t size = level_size(level, rows.getColumn(0).getInt64());
  if (start + count > size) return false;
  Prepared query(db,
                 "SELECT data, checksum FROM history_blocks WHERE history_column = ? AND level = ? "
                 "AND number BETWEEN ? AND ? ORDER BY number",
                 column, level, start / kHistoryBlock, (start + count - 1) / kHistoryBlock);
  std::vector<double> part;
  std::int64_t here = start / kHistoryBlock * kHistoryBlock;
  for (; here < start + count && query.executeStep(); here += kHistoryBlock) {
    const std::int64_t length = std::min(kHistoryBlock, size - here);
    const std::int64_t first = std::max(start, here);
    const std::int64_t last = std::min(start + count, here + length);
    if (last - first == length) {
      decompress(query, values.subspan(first - start, length));
      continue;
    }
    part.resize(static_cast<std::size_t>(length));
    decompress(query, part);
    std::copy(part.begin() + (first - here), part.begin() + (last - here),
              values.begin() + (first - start));
  }
  return here >= start + count;
}

bool holds_column(Connection& db, std::int64_t column, const std::vector<double>& values) {
  if (rows_of(db, column) != static_cast<std::int64_t>(values.size())) return false;
  std::vector<double> stored(values.size());
  return query_history(db, column, 0, 0, stored) && is_equal(stored, values);
}

bool is_whole_column(Connection& db, std::int64_t column) try {
  const std::int64_t rows = rows_of(db, column);
  if (rows < 0 || rows > kMaximumHistoryRows) return false;
  if (blocks_of(db, column) != (rows + kHistoryBlock - 1) / kHistoryBlock) return false;
  std::vector<double> values(static_cast<std::size_t>(rows));
  if (!query_history(db, column, 0, 0, values)) return false;
  const std::vector<std::vector<double>> levels = build_pyramid(values);
  for (std::size_t i = 0; i < levels.size(); ++i) {
    std::vector<double> stored(levels[i].size());
    if (!query_history(db, column, static_cast<int>(i) + 1, 0, stored) ||
        !is_equal(stored, levels[i])) {
      return false;
    }
  }
  return true;
} catch (const StoreError&) {
  return false;
}

}  // namespace tribodyn::server
