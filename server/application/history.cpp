#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <numeric>
#include <optional>
#include <span>
#include <vector>

#include "server/application/column_source.h"
#include "server/application/errors.h"
#include "server/application/stored_history.h"
#include "server/application/streams.h"
#include "server/contract/constraints.h"
#include "server/contract/parse_fields.h"
#include "server/mapping/history_columns.h"
#include "server/storage/history/pyramid.h"
#include "server/support/sha256.h"

namespace tribodyn::server {
namespace {

constexpr int kLargestMaximumPoints = 1'000'000;
static_assert(kMaximumHistoryRows >= kMaximumHistoryValues);

/// Columns by their place in the shape, and rows of them.
struct Window {
  std::vector<std::size_t> columns;
  std::int64_t start_row = 0;
  std::int64_t end_row = 0;
  std::int64_t maximum_points = 0;  // 0: all
};

/// The rows of a history, or of an overview of it.
class HistorySource final : public ColumnSource<v1::ReadHistoryResponse> {
 public:
  HistorySource(Application& application, std::string name, HistoryShape shape, Window window,
                const std::string& input_hash, const v1::SimulationResult& result,
                const CallContext& call)
      : ColumnSource(application, window.columns.size()),
        store_(application.store),
        limits_{.cancelled = call.limits.cancelled},
        name_(std::move(name)),
        shape_(std::move(shape)),
        window_(std::move(window)),
        input_warnings_(result.input_warnings()),
        origin_(fmt::format("{} {} {}", input_hash, result.model_version(), result.platform())) {
    rows_ = window_.end_row - window_.start_row;
    if (window_.maximum_points == 0 || rows_ <= window_.maximum_points) return;
    overview_ = overview(window_.start_row, window_.end_row, shape_.rows, window_.maximum_points);
    rows_ = 2 * overview_->pairs();
  }

  std::string tag() const override {
    std::string all = fmt::format("{} {} {} {}", origin_, window_.start_row, window_.end_row,
                                  window_.maximum_points);
    for (const std::size_t place : window_.columns) all += ' ' + shape_.names[place];
    return sha256(all);
  }

 private:
  void tell_schema(v1::HistorySchema& out) const override {
    for (const std::size_t place : window_.columns) {
      v1::HistorySchema::Column* column = out.add_columns();
      column->set_name(shape_.names[place]);
      column->set_unit(std::string(history_column_unit(shape_.names[place])));
    }
    out.set_start_row(window_.start_row);
    out.set_row_count(rows_);
    out.set_total_rows(shape_.rows);
    if (overview_) out.set_rows_per_pair(overview_->rows_per_pair);
    *out.mutable_input_warnings() = input_warnings_;
  }

  void read(std::size_t place, std::int64_t first, std::span<double> values) override {
    const std::int64_t column = shape_.columns[window_.columns[place]];
    const auto read_level = [&](int level, std::int64_t start, std::span<double> out) {
      if (!store_.read_history(column, level, start, out, limits_)) {
        error_ = history_evicted(name_);
      }
    };
    if (!overview_) return read_level(0, window_.start_row + first, values);
    const auto level = [&](int which, std::int64_t start, std::int64_t count) {
      std::vector<double> out(static_cast<std::size_t>(count));
      read_level(which, start, out);
      return out;
    };
    const auto count = static_cast<std::int64_t>(values.size());
    std::ranges::copy(overview_pairs(*overview_, first / 2, count / 2, level), values.begin());
  }

  Store& store_;
  const CallLimits limits_;  // the end of the stream is its transport's
  const std::string name_;   // of the simulation
  const HistoryShape shape_;
  const Window window_;
  const google::protobuf::RepeatedPtrField<v1::RangeWarning> input_warnings_;
  const std::string origin_;  // gives the same bits: inputs, model and platform
  std::optional<Overview> overview_;
};

std::optional<Window> window(const v1::ReadHistoryRequest& request, const HistoryShape& shape,
                             Violations& violations) {
  Window out;
  out.columns = history_places(request.columns(), shape, violations);
  if (request.columns().empty()) {
    out.columns.resize(shape.names.size());
    std::iota(out.columns.begin(), out.columns.end(), 0);
  }
  const std::int64_t start = request.start_row();
  if (start < 0 || start > shape.rows) {
    violations.push_back(
        {"start_row", fmt::format("start_row = {}; allowed: 0 to {}", start, shape.rows)});
  }
  if (request.row_count() < 0) {
    violations.push_back(
        {"row_count",
         fmt::format("row_count = {}; allowed: 0 (to the end) or more", request.row_count())});
  }
  if (request.max_points() != 0 && (request.max_points() < kLeastMaximumPoints ||
                                    request.max_points() > kLargestMaximumPoints)) {
    violations.push_back(
        {"max_points",
         fmt::format("max_points = {}; allowed: {} to {}, or 0 (all rows)", request.max_points(),
                     kLeastMaximumPoints, kLargestMaximumPoints)});
  }
  if (!violations.empty()) return std::nullopt;
  out.maximum_points = request.max_points();
  out.start_row = start;
  const std::int64_t left = shape.rows - start;
  out.end_row = start + (request.row_count() == 0 ? left : std::min(left, request.row_count()));
  return out;
}

}  // namespace

StreamOutcome<v1::ReadHistoryResponse> read_history(Application& application,
                                                    const v1::ReadHistoryRequest& request,
                                                    const CallContext& call) {
  using Source = std::shared_ptr<MessageSource<v1::ReadHistoryResponse>>;
  auto found = find_history(application, request.name(), call);
  if (!found.ok()) return found.error();
  auto& [stored, result_bytes, shape] = found.message();
  Violations violations;
  auto rows = window(request, shape, violations);
  if (!rows) return invalid(violations);
  v1::SimulationResult result;
  parse_fields(
      result_bytes,
      {v1::SimulationResult::kInputWarningsFieldNumber,
       v1::SimulationResult::kModelVersionFieldNumber, v1::SimulationResult::kPlatformFieldNumber},
      result);
  return Source(std::make_shared<HistorySource>(application, request.name(), std::move(shape),
                                                std::move(*rows), stored.input_hash, result, call));
}

}  // namespace tribodyn::server
