#include "server/storage/history/pyramid.h"

#include <algorithm>
#include <limits>

namespace tribodyn::server {
namespace {

struct Pair {
  double least = std::numeric_limits<double>::infinity();
  double largest = -std::numeric_limits<double>::infinity();

  void add(double low, double high) {
    least = std::min(least, low);
    largest = std::max(largest, high);
  }
};

std::int64_t divide_up(std::int64_t a, std::int64_t b) { return (a + b - 1) / b; }

/// Includes entries [first, last) of a level in `out`.
void add_entries(int level, std::int64_t first, std::int64_t last, const ReadLevel& read,
                 Pair& out) {
  if (first >= last) return;
  if (level == 0) {
    for (const double value : read(0, first, last - first)) out.add(value, value);
    return;
  }
  const std::vector<double> entries = read(level, 2 * first, 2 * (last - first));
  for (std::size_t i = 0; i < entries.size(); i += 2) out.add(entries[i], entries[i + 1]);
}

/// Includes rows [start, end) in `out`: whole entries of the level, and at both ends entries of
/// finer levels.
void add_rows(int level, std::int64_t start, std::int64_t end, const ReadLevel& read, Pair& out) {
  if (start >= end) return;
  if (level == 0) return add_entries(0, start, end, read, out);
  const std::int64_t stride = kPyramidStrides[level];
  const std::int64_t first = divide_up(start, stride);
  const std::int64_t last = end / stride;
  if (first >= last) return add_rows(level - 1, start, end, read, out);
  add_rows(level - 1, start, first * stride, read, out);
  add_entries(level, first, last, read, out);
  add_rows(level - 1, last * stride, end, read, out);
}

/// Returns the coarsest level whose entries are not longer than a run and that exists in a column
/// of `total` rows.
int level_for(std::int64_t run, std::int64_t total) {
  int level = 0;
  while (level + 1 < kPyramidLevels && kPyramidStrides[level + 1] <= run &&
         level_size(level + 1, total) > 0) {
    ++level;
  }
  return level;
}

}  // namespace

std::int64_t level_size(int level, std::int64_t rows) {
  if (level == 0) return rows;
  // A level of a single entry would save nothing over the level below.
  const std::int64_t entries = divide_up(rows, kPyramidStrides[level]);
  return entries > 1 ? 2 * entries : 0;
}

std::vector<std::vector<double>> build_pyramid(std::span<const double> column) {
  const auto rows = static_cast<std::int64_t>(column.size());
  std::vector<std::vector<double>> levels;
  for (int level = 1; level < kPyramidLevels && level_size(level, rows) > 0; ++level) {
    std::vector<double> entries;
    entries.reserve(static_cast<std::size_t>(level_size(level, rows)));
    const std::int64_t finer = level == 1 ? 1 : 2;  // doubles in an entry of the level below
    const std::int64_t ratio = kPyramidStrides[level] / kPyramidStrides[level - 1];
    const std::span<const double> below = level == 1 ? column : levels.back();
    const auto size = static_cast<std::int64_t>(below.size());
    for (std::int64_t i = 0; i < size; i += ratio * finer) {
      Pair pair;
      for (std::int64_t k = i; k < std::min(size, i + ratio * finer); k += finer) {
        pair.add(below[k], below[k + finer - 1]);
      }
      entries.push_back(pair.least);
      entries.push_back(pair.largest);
    }
    levels.push_back(std::move(entries));
  }
  return levels;
}

std::int64_t Overview::pairs() const {
  return divide_up(end, rows_per_pair) - start / rows_per_pair;
}

Overview overview(std::int64_t start, std::int64_t end, std::int64_t total,
                  std::int64_t maximum_points) {
  // Leave room for one more run: the ends of the range may cut two runs.
  const std::int64_t least = divide_up(end - start, maximum_points / 2 - 1);
  const std::int64_t stride = kPyramidStrides[level_for(least, total)];
  return {start, end, total, divide_up(least, stride) * stride};
}

std::vector<double> overview_pairs(const Overview& overview, std::int64_t first, std::int64_t count,
                                   const ReadLevel& read) {
  const std::int64_t run = overview.rows_per_pair;
  const int level = level_for(run, overview.total);
  const std::int64_t stride = kPyramidStrides[level];
  const std::int64_t base = overview.start / run;  // number of the first run
  std::vector<double> out;
  out.reserve(static_cast<std::size_t>(2 * count));
  const auto push = [&out](const Pair& pair) {
    out.push_back(pair.least);
    out.push_back(pair.largest);
  };
  std::int64_t k = base + first;
  const std::int64_t last = k + count;
  if (k < last && k * run < overview.start) {
    Pair pair;
    add_rows(level, overview.start, std::min(overview.end, (k + 1) * run), read, pair);
    push(pair);
    ++k;
  }
  // The last entry of a column covers the rows that are left: a range up to there ends in a whole
  // run.
  const bool is_to_the_end = overview.end == overview.total;
  const std::int64_t whole =
      std::min(last, is_to_the_end ? divide_up(overview.end, run) : overview.end / run);
  if (k < whole) {
    const std::int64_t step = level == 0 ? 1 : 2;      // doubles in an entry
    const std::int64_t width = step * (run / stride);  // doubles in a run
    const std::vector<double> entries = read(
        level, k * width, std::min(whole * width, level_size(level, overview.total)) - k * width);
    const auto size = static_cast<std::int64_t>(entries.size());
    for (std::int64_t i = 0; i < size; i += width) {
      Pair pair;
      for (std::int64_t j = i; j < std::min(i + width, size); j += step)
        pair.add(entries[j], entries[j + step - 1]);
      push(pair);
    }
    k = whole;
  }
  for (; k < last; ++k) {
    Pair pair;
    add_rows(level, std::max(overview.start, k * run), std::min(overview.end, (k + 1) * run), read,
             pair);
    push(pair);
  }
  return out;
}

}  // namespace tribodyn::server
