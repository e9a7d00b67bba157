#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "server/application/table_columns.h"
#include "server/contract/violations.h"
#include "server/storage/stored_resource.h"

namespace tribodyn::server {

/// Reads columns of a campaign as it is when the object is made: rows that come later are not
/// computed. Not safe for concurrent access.
class CampaignRows {
 public:
  /// `limits` without the end of a call, as the object outlives that.
  CampaignRows(Store& store, const StoredCampaign& campaign, const CallLimits& limits);

  std::int64_t total() const { return total_; }
  /// Returns rows [start, start + count) of a column.
  std::vector<double> read(const TableColumn& column, std::int64_t start, std::int64_t count);
  /// Makes rows that no tile has at present not computed for good. Without it a row may come
  /// between two calls.
  void freeze();

 private:
  void clear_later_rows(std::int64_t start, double value, std::vector<double>& values) const;

  Store& store_;
  const CallLimits limits_;
  const std::int64_t campaign_;
  const std::int64_t conditions_;
  const std::int64_t total_;
  bool is_frozen_ = false;
  std::vector<RowRange> computed_;  ///< if frozen: runs of rows in tiles, by row
};

/// A condition on the values of a column.
struct RowCondition {
  TableColumn column;
  Restriction::Comparison comparison;
  double value;
};

/// Reads a filter of rows. Adds violations at "filter".
std::vector<RowCondition> read_row_filter(const std::string& filter, TableColumns& columns,
                                          Violations& violations);

/// The rows of a range that satisfy all conditions.
class RowFilter {
 public:
  /// Evaluates the conditions in all rows [start, end). `rows` must be frozen and outlive the
  /// object.
  RowFilter(CampaignRows& rows, std::vector<RowCondition> conditions, std::int64_t start,
            std::int64_t end);

  /// Number of the rows that satisfy all conditions.
  std::int64_t size() const { return size_; }
  /// Returns values [first, first + count) of a column, of these rows alone.
  std::vector<double> read(const TableColumn& column, std::int64_t first, std::int64_t count);

 private:
  /// Rows that are looked at together: 256 kB a column.
  static constexpr std::int64_t kBlock = 32'768;

  std::vector<std::int64_t> rows_of_block(std::size_t block);

  CampaignRows& rows_;
  const std::vector<RowCondition> conditions_;
  const std::int64_t start_;
  const std::int64_t end_;
  std::int64_t size_ = 0;
  std::vector<std::int32_t> counts_;  ///< of rows, by block
  std::size_t block_ = 0;             ///< whose rows `block_rows_` has
  std::vector<std::int64_t> block_rows_;
  bool has_block_ = false;
};

}  // namespace tribodyn::server
