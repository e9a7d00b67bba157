#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <optional>

#include "server/application/campaigns.h"
#include "server/application/column_source.h"
#include "server/application/errors.h"
#include "server/application/table_columns.h"
#include "server/contract/constraints.h"
#include "server/mapping/history_columns.h"
#include "server/simulation/campaign_columns.h"

namespace tribodyn::server {
namespace {

constexpr double kNoValue = std::numeric_limits<double>::quiet_NaN();

/// Rows of some columns.
struct TableWindow {
  std::vector<TableColumn> columns;
  std::int64_t start_row = 0;
  std::int64_t end_row = 0;
};

class CampaignSource final : public ColumnSource<v1::ReadCampaignResponse> {
 public:
  CampaignSource(Application& application, const StoredCampaign& stored, TableWindow window,
                 const CallContext& call)
      : ColumnSource(application, window.columns.size()),
        store_(application.store),
        limits_{.cancelled = call.limits.cancelled},
        campaign_(stored.id),
        conditions_(stored.conditions),
        total_rows_(stored.points()),
        window_(std::move(window)) {
    rows_ = window_.end_row - window_.start_row;
  }

 private:
  void tell_schema(v1::HistorySchema& out) const override {
    for (const TableColumn& each : window_.columns) {
      v1::HistorySchema::Column* column = out.add_columns();
      column->set_name(each.name);
      // The end of an elasticity's name is the unit of its parameter.
      if (!each.name.starts_with("elasticity.")) {
        column->set_unit(std::string(history_column_unit(each.name)));
      }
    }
    out.set_start_row(window_.start_row);
    out.set_row_count(rows_);
    out.set_total_rows(total_rows_);
  }

  std::vector<double> read(std::size_t place, std::int64_t first, std::int64_t count) override {
    const TableColumn& column = window_.columns[place];
    std::vector<double> out(static_cast<std::size_t>(count), kNoValue);
    const std::int64_t start = window_.start_row + first;
    if (column.kind == TableColumn::Kind::kStored) {
      if (column.number == 0) std::fill(out.begin(), out.end(), kNotComputed);
      store_.read_campaign(campaign_, column.number, start, out, limits_);
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
        case TableColumn::Kind::kPerCandidate:
          value = column.values[static_cast<std::size_t>(candidate)];
          break;
        default:
          value = column.values[static_cast<std::size_t>(condition)];
      }
    }
    return out;
  }

  Store& store_;
  const CallLimits limits_;  // the end of the stream is its transport's
  const std::int64_t campaign_;
  const std::int64_t conditions_;
  const std::int64_t total_rows_;
  const TableWindow window_;
};

std::optional<TableWindow> table_window(Application& application, const StoredCampaign& stored,
                                        const v1::ReadCampaignRequest& request,
                                        const CallContext& call, Violations& violations) {
  TableWindow out;
  TableColumns columns(application, stored, call);
  for (int i = 0; i < request.columns_size(); ++i) {
    const std::string& name = request.columns(i);
    const bool is_repeated =
        std::any_of(out.columns.begin(), out.columns.end(),
                    [&](const TableColumn& each) { return each.name == name; });
    if (is_repeated) continue;
    auto found = columns.find(name);
    if (!found) {
      violations.push_back(
          {fmt::format("columns[{}]", i),
           fmt::format("no such column here{}", meant_text(name, columns.names()))});
      continue;
    }
    out.columns.push_back(std::move(*found));
  }
  if (request.columns().empty()) out.columns = columns.figures();
  const std::int64_t rows = stored.points();
  if (request.start_row() < 0 || request.start_row() > rows) {
    violations.push_back(
        {"start_row", fmt::format("start_row = {}; allowed: 0 to {}", request.start_row(), rows)});
  }
  if (request.row_count() < 0) {
    violations.push_back(
        {"row_count",
         fmt::format("row_count = {}; allowed: 0 (to the end) or more", request.row_count())});
  }
  if (!violations.empty()) return std::nullopt;
  out.start_row = request.start_row();
  const std::int64_t left = rows - out.start_row;
  out.end_row =
      out.start_row + (request.row_count() == 0 ? left : std::min(left, request.row_count()));
  return out;
}

}  // namespace

StreamOutcome<v1::ReadCampaignResponse> read_campaign(Application& application,
                                                      const v1::ReadCampaignRequest& request,
                                                      const CallContext& call) {
  using Source = std::shared_ptr<MessageSource<v1::ReadCampaignResponse>>;
  const auto found = find_campaign(application, request.name(), call);
  if (!found.ok()) return found.error();
  Violations violations;
  auto window = table_window(application, found.message(), request, call, violations);
  if (!window) return invalid(violations);
  return Source(
      std::make_shared<CampaignSource>(application, found.message(), std::move(*window), call));
}

}  // namespace tribodyn::server
