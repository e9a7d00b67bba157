#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace tribodyn::server {

// A pyramid holds minimum and maximum of a column over runs of its rows, so that an overview of
// millions of rows reads only thousands of numbers. Level 0 is the column itself. An entry of level
// L > 0 is the pair (minimum, maximum) over kPyramidStrides[L] rows; the last entry covers the
// remaining rows.

inline constexpr std::array<std::int64_t, 5> kPyramidStrides = {1, 64, 512, 4096, 32768};
inline constexpr int kPyramidLevels = static_cast<int>(kPyramidStrides.size());

/// Returns the number of doubles in a level of a column of `rows` rows.
std::int64_t level_size(int level, std::int64_t rows);

/// Returns level 1 and all coarser levels that have more than one entry.
std::vector<std::vector<double>> build_pyramid(std::span<const double> column);

/// Returns doubles [start, start + count) of a level of one column.
using ReadLevel =
    std::function<std::vector<double>(int level, std::int64_t start, std::int64_t count)>;

/// Division of rows [start, end) of a column of `total` rows into runs. Each run becomes a pair
/// (minimum, maximum). Run k begins at row first_multiple + k rows_per_pair; the range clips the
/// first and the last run.
struct Overview {
  std::int64_t start = 0;
  std::int64_t end = 0;
  std::int64_t total = 0;
  std::int64_t rows_per_pair = 0;
  std::int64_t pairs() const;
};

inline constexpr int kLeastMaximumPoints = 4;

/// Returns an overview of at most `maximum_points` values. Requires kLeastMaximumPoints or more
/// points, and a range of more rows than that.
Overview overview(std::int64_t start, std::int64_t end, std::int64_t total,
                  std::int64_t maximum_points);

/// Returns pairs [first, first + count) of an overview: minimum, maximum, minimum, ... Whole
/// runs are read from one level, and finer levels only where the range cuts a run; a range to the
/// end of the column cuts none there.
std::vector<double> overview_pairs(const Overview& overview, std::int64_t first, std::int64_t count,
                                   const ReadLevel& read);

}  // namespace tribodyn::server
