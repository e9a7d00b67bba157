#include "server/application/row_filter.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "server/application/list_filter.h"
#include "server/contract/constraints.h"
#include "server/simulation/campaign_columns.h"

namespace tribodyn::server {
namespace {

using enum Restriction::Comparison;

constexpr double kNoRowValue = std::numeric_limits<double>::quiet_NaN();

bool satisfies(double value, const RowCondition& condition) {
  switch (condition.comparison) {
    case kNotEqual:
      return value != condition.value;
    case kLess:
      return value < condition.value;
    case kLessOrEqual:
      return value <= condition.value;
    case kGreater:
      return value > condition.value;
    case kGreaterOrEqual:
      return value >= condition.value;
    default:
      return value == condition.value;
  }
}

/// Returns the attribute with texts of this name; null if there is none.
const v1::CandidateAttribute* texts_of(const v1::Campaign& table, const std::string& name) {
  for (const v1::CandidateAttribute& each : table.candidate_attributes()) {
    if (each.name() == name && !each.texts().empty()) return &each;
  }
  return nullptr;
}

/// Returns the condition that a text of each candidate is the value, or another one.
RowCondition text_condition(const v1::CandidateAttribute& attribute,
                            const FilterCondition& condition) {
  RowCondition out{{attribute.name(), TableColumn::Kind::kPerCandidate}, condition.comparison, 1};
  for (const std::string& text : attribute.texts()) {
    out.column.values.push_back(text == condition.value ? 1 : 0);
  }
  return out;
}

}  // namespace

CampaignRows::CampaignRows(Store& store, const StoredCampaign& campaign, const CallLimits& limits)
    : store_(store),
      limits_(limits),
      campaign_(campaign.id),
      conditions_(campaign.conditions),
      total_(campaign.points()) {}

void CampaignRows::freeze() {
  is_frozen_ = true;
  for (const RowRange& tile : store_.campaign_tiles(campaign_, limits_)) {
    if (!computed_.empty() && computed_.back().first + computed_.back().count == tile.first) {
      computed_.back().count += tile.count;
    } else {
      computed_.push_back(tile);
    }
  }
}

/// Sets the values of rows that no tile had when the object was frozen.
void CampaignRows::clear_later_rows(std::int64_t start, double value,
                                    std::vector<double>& values) const {
  const std::int64_t end = start + static_cast<std::int64_t>(values.size());
  const auto at = [&](std::int64_t row) { return values.begin() + (row - start); };
  auto run = std::upper_bound(
      computed_.begin(), computed_.end(), start,
      [](std::int64_t row, const RowRange& each) { return row < each.first + each.count; });
  std::int64_t next = start;
  for (; run != computed_.end() && run->first < end; ++run) {
    if (run->first > next) std::fill(at(next), at(run->first), value);
    next = std::min(end, run->first + run->count);
  }
  std::fill(at(next), values.end(), value);
}

std::vector<double> CampaignRows::read(const TableColumn& column, std::int64_t start,
                                       std::int64_t count) {
  std::vector<double> out(static_cast<std::size_t>(count), kNoRowValue);
  if (column.kind == TableColumn::Kind::kStored) {
    const double none = column.number == 0 ? kNotComputed : kNoRowValue;
    std::fill(out.begin(), out.end(), none);
    store_.read_campaign(campaign_, column.number, start, out, limits_);
    if (is_frozen_) clear_later_rows(start, none, out);
    return out;
  }
  for (std::int64_t i = 0; i < count; ++i) {
    const std::int64_t candidate = (start + i) / conditions_;
    const std::int64_t condition = (start + i) % conditions_;
    double& value = out[static_cast<std::size_t>(i)];
    switch (column.kind) {
      case TableColumn::Kind::kCandidate:
        value = static_cast<double>(candidate);
        break;
      case TableColumn::Kind::kCondition:
        value = static_cast<double>(condition);
        break;
      case TableColumn::Kind::kRow:
        value = static_cast<double>(start + i);
        break;
      case TableColumn::Kind::kPerCandidate:
        value = column.values[static_cast<std::size_t>(candidate)];
        break;
      default:
        value = column.values[static_cast<std::size_t>(condition)];
    }
  }
  return out;
}

std::vector<RowCondition> read_row_filter(const std::string& filter, TableColumns& columns,
                                          Violations& violations) {
  std::vector<RowCondition> out;
  const auto complain = [&violations](std::string text) {
    violations.add("filter", std::move(text));
  };
  for (const FilterCondition& each :
       split_filter(filter, "refusal_number = 0 AND film_ratio_minimum < 1", violations)) {
    const bool is_equality = each.comparison == kEqual || each.comparison == kNotEqual;
    if (const auto* texts = texts_of(columns.table(), each.field)) {
      if (is_equality) {
        out.push_back(text_condition(*texts, each));
      } else {
        complain(each.field + ": allowed: = or !=, as its values are texts");
      }
      continue;
    }
    auto column = columns.find(each.field);
    const std::optional<double> value = filter_number(each.value);
    if (!column) {
      std::vector<std::string> known = columns.names();
      for (const auto& attribute : columns.table().candidate_attributes()) {
        if (!attribute.texts().empty()) known.push_back(attribute.name());
      }
      complain(fmt::format("\"{}\" is no column here{}", plain_excerpt(each.field),
                           meant_text(each.field, known)));
    } else if (each.comparison == kContains) {
      complain(fmt::format("{}: allowed: = != < <= > >=", each.field));
    } else if (!value) {
      complain(fmt::format("{} = \"{}\"; allowed: a finite number", each.field,
                           plain_excerpt(each.value)));
    } else {
      out.push_back({std::move(*column), each.comparison, *value});
    }
  }
  return out;
}

RowFilter::RowFilter(CampaignRows& rows, std::vector<RowCondition> conditions, std::int64_t start,
                     std::int64_t end)
    : rows_(rows), conditions_(std::move(conditions)), start_(start), end_(end) {
  const std::int64_t blocks = (end_ - start_ + kBlock - 1) / kBlock;
  for (std::int64_t i = 0; i < blocks; ++i) {
    counts_.push_back(static_cast<std::int32_t>(rows_of_block(static_cast<std::size_t>(i)).size()));
    size_ += counts_.back();
  }
}

/// Returns the rows of a block that satisfy all conditions.
std::vector<std::int64_t> RowFilter::rows_of_block(std::size_t block) {
  const std::int64_t first = start_ + static_cast<std::int64_t>(block) * kBlock;
  const std::int64_t count = std::min(kBlock, end_ - first);
  std::vector<bool> is_left(static_cast<std::size_t>(count), true);
  for (const RowCondition& condition : conditions_) {
    const std::vector<double> values = rows_.read(condition.column, first, count);
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (!satisfies(values[i], condition)) is_left[i] = false;
    }
  }
  std::vector<std::int64_t> out;
  for (std::int64_t i = 0; i < count; ++i) {
    if (is_left[static_cast<std::size_t>(i)]) out.push_back(first + i);
  }
  return out;
}

std::vector<double> RowFilter::read(const TableColumn& column, std::int64_t first,
                                    std::int64_t count) {
  std::vector<double> out;
  out.reserve(static_cast<std::size_t>(count));
  std::int64_t before = 0;  // rows of the filter in the blocks before
  for (std::size_t block = 0; block < counts_.size() && before < first + count; ++block) {
    const std::int64_t size = counts_[block];
    const std::int64_t from = std::max(first, before), to = std::min(first + count, before + size);
    if (from < to) {
      if (!has_block_ || block_ != block) {
        block_rows_ = rows_of_block(block);
        block_ = block;
        has_block_ = true;
      }
      const auto begin = block_rows_.begin() + (from - before);
      const auto end = block_rows_.begin() + (to - before);
      const std::int64_t row = *begin, last = *(end - 1);
      const std::vector<double> values = rows_.read(column, row, last - row + 1);
      for (auto at = begin; at != end; ++at) {
        out.push_back(values[static_cast<std::size_t>(*at - row)]);
      }
    }
    before += size;
  }
  return out;
}

}  // namespace tribodyn::server
