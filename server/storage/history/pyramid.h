#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace tribodyn::server {

// Least and largest values of a column over runs of its rows, so that an overview of millions of
// rows reads thousands of numbers. Level 0 is the column itself; an entry of level L > 0 is the
// pair (least, largest) over kPyramidStrides[L] rows, the last one over what is left.

inline constexpr std::array<std::int64_t, 5> kPyramidStrides = {1, 64, 512, 4096, 32768};
inline constexpr int kPyramidLevels = static_cast<int>(kPyramidStrides.size());

/// Doubles that a level of a column of so many rows has.
std::int64_t level_size(int level, std::int64_t rows);

/// Levels 1 to the last one that is no longer than a pair, in order.
std::vector<std::vector<double>> build_pyramid(std::span<const double> column);

/// Doubles [start, start + count) of a level of one column.
using ReadLevel =
    std::function<std::vector<double>(int level, std::int64_t start, std::int64_t count)>;

/// How rows [start, end) of a column of `total` rows are cut into runs, each of which becomes a
/// pair: run k begins at row first_multiple + k rows_per_pair, but for the ends of the range.
struct Overview {
  std::int64_t start = 0;
  std::int64_t end = 0;
  std::int64_t total = 0;
  std::int64_t rows_per_pair = 0;
  std::int64_t pairs() const;
};

inline constexpr int kLeastMaximumPoints = 4;

/// An overview of at most `maximum_points` values, kLeastMaximumPoints or more, of a range that has
/// more rows.
Overview overview(std::int64_t start, std::int64_t end, std::int64_t total,
                  std::int64_t maximum_points);

/// Pairs [first, first + count) of an overview: least, largest, least, ... Reads of the finest
/// level only what the ends of the range cut.
std::vector<double> overview_pairs(const Overview& overview, std::int64_t first, std::int64_t count,
                                   const ReadLevel& read);

}  // namespace tribodyn::server
