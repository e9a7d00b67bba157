// Tests of stored histories: compression is lossless, and overviews contain every extreme.
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "server/storage/history/column_codec.h"
#include "server/storage/history/pyramid.h"

namespace tribodyn::server {
namespace {

std::vector<double> wave(std::int64_t rows) {
  std::vector<double> out;
  for (std::int64_t i = 0; i < rows; ++i) {
    out.push_back(std::sin(0.001 * static_cast<double>(i)) + 1e-3 * static_cast<double>(i % 977));
  }
  return out;
}

RC_GTEST_PROP(ColumnCodec, IsLossless, (const std::vector<std::uint64_t>& bits)) {
  std::vector<double> values(bits.size());
  if (!bits.empty()) std::memcpy(values.data(), bits.data(), 8 * bits.size());
  std::vector<double> back(values.size());
  decompress_column(compress_column(values), back);
  // Computed outside the macro, which evaluates both sides.
  const bool is_same =
      values.empty() || std::memcmp(values.data(), back.data(), 8 * values.size()) == 0;
  RC_ASSERT(is_same);
}

TEST(ColumnCodec, CompressesSmoothColumns) {
  std::vector<double> time;
  for (int i = 0; i < 8192; ++i) time.push_back(1e-6 * i);
  EXPECT_LT(compress_column(time).size(), 8192U * 8 * 8 / 10);
  EXPECT_LT(compress_column(std::vector<double>(8192, 350.0)).size(), 200U);
}

TEST(ColumnCodec, DetectsDamage) {
  const std::vector<double> values = wave(100);
  std::string bytes = compress_column(values);
  std::vector<double> back(99);
  EXPECT_THROW(decompress_column(bytes, back), std::runtime_error);
  back.resize(100);
  bytes.resize(bytes.size() / 2);
  EXPECT_THROW(decompress_column(bytes, back), std::runtime_error);
}

RC_GTEST_PROP(Pyramid, AnOverviewMissesNoExtremeAndKeepsItsSize, ()) {
  const auto rows = *rc::gen::inRange<std::int64_t>(1, 300'000);
  const auto start = *rc::gen::inRange<std::int64_t>(0, rows);
  const auto end = *rc::gen::inRange<std::int64_t>(start + 1, rows + 1);
  const auto points = *rc::gen::inRange<std::int64_t>(kLeastMaximumPoints, 5000);
  const std::vector<double> column = wave(rows);
  std::vector<std::vector<double>> levels = build_pyramid(column);
  levels.insert(levels.begin(), column);
  for (std::size_t i = 0; i < levels.size(); ++i) {
    RC_ASSERT(static_cast<std::int64_t>(levels[i].size()) == level_size(static_cast<int>(i), rows));
  }
  std::int64_t numbers_read = 0;
  const ReadLevel read = [&](int level, std::int64_t first, std::int64_t count) {
    numbers_read += count;
    const auto begin = levels.at(level).begin() + first;
    return std::vector<double>(begin, begin + count);
  };
  const Overview over = overview(start, end, rows, points);
  RC_ASSERT(2 * over.pairs() <= points);
  const std::int64_t half = over.pairs() / 2;
  std::vector<double> pairs = overview_pairs(over, 0, half, read);
  const std::vector<double> rest = overview_pairs(over, half, over.pairs() - half, read);
  pairs.insert(pairs.end(), rest.begin(), rest.end());
  RC_ASSERT(static_cast<std::int64_t>(pairs.size()) == 2 * over.pairs());
  RC_ASSERT(numbers_read < 32 * points + 4000);
  for (std::int64_t k = 0; k < over.pairs(); ++k) {
    const std::int64_t run = (start / over.rows_per_pair + k) * over.rows_per_pair;
    const auto first = column.begin() + std::max(start, run);
    const auto last = column.begin() + std::min(end, run + over.rows_per_pair);
    RC_ASSERT(pairs[2 * k] == *std::min_element(first, last));
    RC_ASSERT(pairs[2 * k + 1] == *std::max_element(first, last));
  }
}

RC_GTEST_PROP(Pyramid, AnOverviewToTheEndOfAColumnReadsOneLevelOnce, ()) {
  const auto rows = *rc::gen::inRange<std::int64_t>(10, 300'000);
  const auto points = *rc::gen::inRange<std::int64_t>(kLeastMaximumPoints, std::min(rows, 5000L));
  const std::vector<double> column = wave(rows);
  std::vector<std::vector<double>> levels = build_pyramid(column);
  levels.insert(levels.begin(), column);
  int reads = 0;
  const ReadLevel read = [&](int level, std::int64_t first, std::int64_t count) {
    ++reads;
    const auto begin = levels.at(level).begin() + first;
    return std::vector<double>(begin, begin + count);
  };
  const Overview over = overview(0, rows, rows, points);
  const std::vector<double> pairs = overview_pairs(over, 0, over.pairs(), read);
  RC_ASSERT(reads == 1);
  RC_ASSERT(static_cast<std::int64_t>(pairs.size()) == 2 * over.pairs());
  const auto last = column.begin() + (over.pairs() - 1) * over.rows_per_pair;
  RC_ASSERT(pairs[pairs.size() - 2] == *std::min_element(last, column.end()));
  RC_ASSERT(pairs.back() == *std::max_element(last, column.end()));
}

}  // namespace
}  // namespace tribodyn::server
