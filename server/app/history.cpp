#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <optional>

#include "server/app/guard.h"
#include "server/app/simulation_lookup.h"
#include "server/app/streams.h"
#include "server/convert/constraints.h"
#include "server/convert/resource_names.h"

namespace tribodyn::server {
namespace {

/// Rows still to send.
struct Window {
  std::int64_t id = 0;
  std::vector<std::string> columns;
  std::int64_t next_row = 0;
  std::int64_t end_row = 0;
  std::int64_t total_rows = 0;
};

class HistorySource : public MessageSource<v1::HistoryChunk> {
 public:
  HistorySource(Store& store, Window window) : store_(store), window_(std::move(window)) {}

  Step next(v1::HistoryChunk& out) override {
    if (window_.next_row >= window_.end_row) return Step::kEnd;
    const auto columns = static_cast<std::int64_t>(window_.columns.size());
    const std::int64_t count = std::min(window_.end_row - window_.next_row,
                                        std::max<std::int64_t>(1, kChunkValues / columns));
    out.Clear();
    out.set_start_row(window_.next_row);
    out.set_total_rows(window_.total_rows);
    try {
      for (const std::string& name : window_.columns) {
        v1::HistoryChunk::Column* column = out.add_columns();
        column->set_name(name);
        const auto values = store_.history_rows(window_.id, name, window_.next_row, count);
        *column->mutable_values() = {values.begin(), values.end()};
      }
    } catch (const StoreError& failure) {
      spdlog::error("{}", failure.what());
      error_ = store_failed();
      return Step::kEnd;
    }
    window_.next_row += count;
    return Step::kMessage;
  }

  google::rpc::Status error() const override { return error_; }

 private:
  Store& store_;
  Window window_;
  google::rpc::Status error_;
};

/// The stored names that a request means: "flank_load_newtons" stands for its three flanks.
std::vector<std::string> expand(const std::string& asked, const std::vector<std::string>& stored) {
  std::vector<std::string> out;
  for (const std::string& name : stored) {
    if (name == asked || name.starts_with(asked + "_flank_")) out.push_back(name);
  }
  return out;
}

std::optional<Window> window(const v1::ReadHistoryRequest& request,
                             const Store::HistoryShape& shape, Violations& violations) {
  Window out;
  out.total_rows = shape.rows;
  const int asked = std::min(request.columns_size(), kMaximumHistoryColumns);
  for (int i = 0; i < asked; ++i) {
    const std::vector<std::string> meant = expand(request.columns(i), shape.names);
    if (meant.empty()) {
      violations.push_back(
          {fmt::format("columns[{}]", i),
           fmt::format("no such column here{}", meant_text(request.columns(i), shape.names))});
    }
    for (const std::string& name : meant) {
      if (std::find(out.columns.begin(), out.columns.end(), name) == out.columns.end()) {
        out.columns.push_back(name);
      }
    }
  }
  if (request.columns_size() > kMaximumHistoryColumns) {
    violations.push_back({"columns", fmt::format("{} columns; legal: at most {}",
                                                 request.columns_size(), kMaximumHistoryColumns)});
  }
  if (request.columns().empty()) out.columns = shape.names;
  const std::int64_t start = request.start_row();
  if (start < 0 || start > shape.rows) {
    violations.push_back(
        {"start_row", fmt::format("start_row = {}; legal: 0 to {}", start, shape.rows)});
  }
  if (request.row_count() < 0) {
    violations.push_back({"row_count", fmt::format("row_count = {}; legal: 0 (to the end) or more",
                                                   request.row_count())});
  }
  if (!violations.empty()) return std::nullopt;
  out.next_row = start;
  const std::int64_t left = shape.rows - start;
  out.end_row = start + (request.row_count() == 0 ? left : std::min(left, request.row_count()));
  return out;
}

}  // namespace

StreamOutcome<v1::HistoryChunk> read_history(Application& application,
                                             const v1::ReadHistoryRequest& request) {
  using Source = std::shared_ptr<MessageSource<v1::HistoryChunk>>;
  return guarded<Source>([&]() -> Outcome<Source> {
    const auto found = find_simulation(application, request.name());
    if (!found.ok()) return found.error();
    const StoredSimulation& stored = found.message();
    if (stored.state != StoredState::kSucceeded) {
      return not_possible("NO_RESULT_YET", "tribodyn.v1.Simulation", request.name(),
                          request.name() + " has not succeeded, so it has no history");
    }
    const Store::HistoryShape shape = application.store.history_shape(stored.id);
    if (shape.names.empty()) {
      return not_found("tribodyn.v1.HistoryChunk", request.name(),
                       request.name() + " was run without history");
    }
    Violations violations;
    auto rows = window(request, shape, violations);
    if (!rows) return invalid(violations);
    rows->id = stored.id;
    return Source(std::make_shared<HistorySource>(application.store, std::move(*rows)));
  });
}

}  // namespace tribodyn::server
