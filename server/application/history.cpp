#include <fmt/format.h>
#include <google/protobuf/arena.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <memory>
#include <numeric>
#include <optional>

#include "server/application/errors.h"
#include "server/application/simulation_lookup.h"
#include "server/application/streams.h"
#include "server/contract/constraints.h"
#include "server/contract/resource_names.h"
#include "server/mapping/history_columns.h"
#include "server/storage/history/pyramid.h"
#include "server/support/sha256.h"

static_assert(std::endian::native == std::endian::little, "chunks are little-endian");

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

constexpr char kHistoryType[] = "tribodyn.v1.History";

/// What ResourceInfo calls the history of a simulation.
std::string history_name(const std::string& simulation) { return simulation + "/history"; }

/// A place among the open histories, all of which share one budget of memory.
class OpenHistory {
 public:
  explicit OpenHistory(std::shared_ptr<std::atomic<int>> open) : open_(std::move(open)) {
    ++*open_;
  }
  ~OpenHistory() { --*open_; }
  OpenHistory(const OpenHistory&) = delete;
  OpenHistory& operator=(const OpenHistory&) = delete;

  /// Values of a chunk at present: whole blocks, 256 KiB while few read.
  std::int64_t chunk_values() const {
    const std::int64_t share = kOpenHistoryValues / std::max(1, open_->load());
    return std::clamp(share / kHistoryBlock * kHistoryBlock, kHistoryBlock, kChunkValues);
  }

  /// Rows of a run at present whose columns a reader keeps together.
  std::int64_t row_run(std::int64_t columns) const {
    const std::int64_t share = kOpenHistoryValues / std::max(1, open_->load()) / columns;
    const std::int64_t unit = share < kHistoryBlock ? kLeastRun : kHistoryBlock;
    return std::clamp(share / unit * unit, kLeastRun, kChunkValues);
  }

 private:
  static constexpr std::int64_t kLeastRun = 512;  // rows; even, as pairs of an overview are
  std::shared_ptr<std::atomic<int>> open_;
};

/// The schema, then chunks: each column as far as the others before any goes on.
class HistorySource : public MessageSource<v1::ReadHistoryResponse> {
 public:
  HistorySource(Application& application, std::string name, HistoryShape shape, Window window,
                const std::string& input_hash, const v1::SimulationResult& result,
                const CallContext& call)
      : store_(application.store),
        limits_{.cancelled = call.limits.cancelled},
        name_(std::move(name)),
        open_(application.open_histories),
        shape_(std::move(shape)),
        window_(std::move(window)),
        input_warnings_(result.input_warnings()),
        tag_(tag_of(input_hash, result)),
        rows_(window_.end_row - window_.start_row) {
    if (window_.maximum_points == 0 || rows_ <= window_.maximum_points) return;
    overview_ = overview(window_.start_row, window_.end_row, shape_.rows, window_.maximum_points);
    rows_ = 2 * overview_->pairs();
  }

  void set_order(Order order) override { order_ = order; }

  Step next(v1::ReadHistoryResponse& out) override {
    out.Clear();
    if (!told_schema_) {
      told_schema_ = true;
      tell_schema(*out.mutable_schema());
      return Step::kMessage;
    }
    if (next_row_ >= rows_) return Step::kEnd;
    if (column_ == 0 || order_ == Order::kColumns) {
      run_ = std::min(longest_run(), rows_ - next_row_);
    }
    const std::vector<double> values = read(shape_.columns[window_.columns[column_]]);
    v1::HistoryChunk& chunk = *out.mutable_chunk();
    chunk.set_column(static_cast<int>(column_));
    chunk.set_first_row(next_row_);
    chunk.set_values(values.data(), values.size() * sizeof(double));
    if (error_.code() != 0) return Step::kEnd;
    if (order_ == Order::kColumns) {
      next_row_ += run_;
      if (next_row_ == rows_ && ++column_ < window_.columns.size()) next_row_ = 0;
    } else if (++column_ == window_.columns.size()) {
      column_ = 0;
      next_row_ += run_;
    }
    return Step::kMessage;
  }

  std::string tag() const override { return tag_; }
  bool is_short() const override { return rows_ <= kHistoryBlock; }
  google::rpc::Status error() const override { return error_; }

 private:
  std::int64_t longest_run() const {
    if (order_ != Order::kRows) return open_.chunk_values();
    return open_.row_run(static_cast<std::int64_t>(window_.columns.size()));
  }

  /// Equal inputs give the same bits on the same platform and with the same model.
  std::string tag_of(const std::string& input_hash, const v1::SimulationResult& result) const {
    std::string all =
        fmt::format("{} {} {} {} {} {}", input_hash, result.model_version(), result.platform(),
                    window_.start_row, window_.end_row, window_.maximum_points);
    for (const std::size_t place : window_.columns) all += ' ' + shape_.names[place];
    return sha256(all);
  }

  void tell_schema(v1::HistorySchema& out) const {
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

  /// The present run of a column.
  std::vector<double> read(std::int64_t column) {
    const auto level = [&](int which, std::int64_t start, std::int64_t count) {
      std::vector<double> values(static_cast<std::size_t>(count));
      if (!store_.read_history(column, which, start, values, limits_)) {
        error_ = not_found(kHistoryType, history_name(name_),
                           "the history of " + name_ + " has been evicted",
                           v1::ERROR_REASON_HISTORY_EVICTED);
      }
      return values;
    };
    if (!overview_) return level(0, window_.start_row + next_row_, run_);
    return overview_pairs(*overview_, next_row_ / 2, run_ / 2, level);
  }

  Store& store_;
  const CallLimits limits_;  // the end of the stream is its transport's
  const std::string name_;   // of the simulation
  const OpenHistory open_;
  const HistoryShape shape_;
  const Window window_;
  const google::protobuf::RepeatedPtrField<v1::RangeWarning> input_warnings_;
  const std::string tag_;
  std::int64_t rows_;  // to come in all
  std::optional<Overview> overview_;
  bool told_schema_ = false;
  std::int64_t next_row_ = 0;
  std::int64_t run_ = 0;  // rows of the present chunks
  std::size_t column_ = 0;
  Order order_ = Order::kChunks;
  google::rpc::Status error_;
};

/// Places of the stored names that a request means: "flank_load_newtons" stands for its three
/// flanks.
std::vector<std::size_t> expand(const std::string& asked, const std::vector<std::string>& stored) {
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < stored.size(); ++i) {
    if (stored[i] == asked || stored[i].starts_with(asked + "_flank_")) out.push_back(i);
  }
  return out;
}

std::optional<Window> window(const v1::ReadHistoryRequest& request, const HistoryShape& shape,
                             Violations& violations) {
  Window out;
  const int asked = std::min(request.columns_size(), kMaximumHistoryColumns);
  for (int i = 0; i < asked; ++i) {
    const std::vector<std::size_t> meant = expand(request.columns(i), shape.names);
    if (meant.empty()) {
      violations.push_back(
          {fmt::format("columns[{}]", i),
           fmt::format("no such column here{}", meant_text(request.columns(i), shape.names))});
    }
    for (const std::size_t place : meant) {
      if (std::find(out.columns.begin(), out.columns.end(), place) == out.columns.end()) {
        out.columns.push_back(place);
      }
    }
  }
  if (request.columns_size() > kMaximumHistoryColumns) {
    violations.push_back({"columns", fmt::format("{} columns; allowed: at most {}",
                                                 request.columns_size(), kMaximumHistoryColumns)});
  }
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
  const auto found = find_simulation(application, request.name(), call);
  if (!found.ok()) return found.error();
  const StoredSimulation& stored = found.message();
  if (stored.state != StoredState::kSucceeded) {
    return not_possible(
        v1::ERROR_REASON_NO_RESULT_YET, "tribodyn.v1.Simulation", request.name(),
        request.name() + " has not succeeded, so it has no history",
        {{"state", v1::Simulation::State_Name(static_cast<v1::Simulation::State>(stored.state))}});
  }
  HistoryShape shape = application.store.history_shape(stored.id, call.limits);
  if (shape.names.empty()) {
    return not_found(kHistoryType, history_name(request.name()),
                     request.name() + " was run without history", v1::ERROR_REASON_NO_HISTORY);
  }
  Violations violations;
  auto rows = window(request, shape, violations);
  if (!rows) return invalid(violations);
  google::protobuf::Arena arena;  // a result has hundreds of parts
  auto& result = *google::protobuf::Arena::CreateMessage<v1::SimulationResult>(&arena);
  result.ParseFromString(application.store.result(stored.id, call.limits).value_or(""));
  return Source(std::make_shared<HistorySource>(application, request.name(), std::move(shape),
                                                std::move(*rows), stored.input_hash, result, call));
}

}  // namespace tribodyn::server
