#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <span>

#include "server/application/campaigns.h"
#include "server/application/column_source.h"
#include "server/application/errors.h"
#include "server/application/row_filter.h"
#include "server/application/table_columns.h"
#include "server/contract/constraints.h"
#include "server/mapping/history_columns.h"
#include "server/simulation/campaign_columns.h"
#include "server/simulation/point_evaluation.h"

namespace tribodyn::server {
namespace {

/// Rows of some columns.
struct TableWindow {
  std::vector<TableColumn> columns;
  std::int64_t start_row = 0;
  std::int64_t end_row = 0;
  std::vector<RowCondition> conditions;  ///< of the rows; empty: all
};

std::string_view unit_of(const std::string& column) {
  if (column.starts_with("elasticity.")) return "";
  const auto* parameter = find_candidate_parameter(column);
  return parameter != nullptr ? find_constraint(*parameter)->unit : history_column_unit(column);
}

class CampaignSource final : public ColumnSource<v1::ReadCampaignResponse> {
 public:
  CampaignSource(Application& application, const StoredCampaign& stored, TableWindow window,
                 const CallContext& call)
      : ColumnSource(application, window.columns.size()),
        campaign_rows_(application.store, stored,
                       {.cancelled = call.limits.cancelled}),  // the end of the stream is its
                                                               // transport's
        window_(std::move(window)) {
    rows_ = window_.end_row - window_.start_row;
    if (window_.conditions.empty()) return;
    campaign_rows_.freeze();
    filter_.emplace(campaign_rows_, std::move(window_.conditions), window_.start_row,
                    window_.end_row);
    rows_ = filter_->size();
  }

 private:
  void tell_schema(v1::HistorySchema& out) const override {
    for (const TableColumn& each : window_.columns) {
      v1::HistorySchema::Column* column = out.add_columns();
      column->set_name(each.name);
      column->set_unit(std::string(unit_of(each.name)));
    }
    out.set_start_row(window_.start_row);
    out.set_row_count(rows_);
    out.set_total_rows(campaign_rows_.total());
  }

  void read(std::size_t place, std::int64_t first, std::span<double> values) override {
    const TableColumn& column = window_.columns[place];
    const auto count = static_cast<std::int64_t>(values.size());
    std::ranges::copy(filter_ ? filter_->read(column, first, count)
                              : campaign_rows_.read(column, window_.start_row + first, count),
                      values.begin());
  }

  CampaignRows campaign_rows_;
  TableWindow window_;
  std::optional<RowFilter> filter_;
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
  out.conditions = read_row_filter(request.filter(), columns, violations);
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
