#include <cstring>
#include <optional>
#include <thread>

#include "client/cpp/library/services.h"

namespace tribodyn::client {
namespace {

constexpr auto kBetweenReads = std::chrono::milliseconds(250);
constexpr int kReadRetries = 20;  // about 40 s in all: long enough for a server that restarts

/// Joins chunks of columns into rows.
class RowJoiner {
 public:
  explicit RowJoiner(int columns) { rows_.columns.resize(columns); }

  /// Returns the rows that are complete; null while a column is missing.
  const HistoryRows* add(const v1::HistoryChunk& chunk, std::int64_t offset) {
    std::vector<double>& column = rows_.columns.at(chunk.column());
    column.resize(chunk.values().size() / sizeof(double));
    std::memcpy(column.data(), chunk.values().data(), column.size() * sizeof(double));
    rows_.first_row = offset + chunk.first_row();
    const bool is_last = chunk.column() + 1 == static_cast<int>(rows_.columns.size());
    return is_last ? &rows_ : nullptr;
  }

 private:
  HistoryRows rows_;
};

}  // namespace

void Connection::stream_history(const std::string& name, const HistoryOptions& options,
                                const std::function<void(const v1::HistorySchema&)>& on_schema,
                                const std::function<void(const HistoryRows&)>& on_rows) {
  v1::ReadHistoryRequest request;
  request.set_name(name);
  add_project(services_->project, request);
  *request.mutable_columns() = {options.columns.begin(), options.columns.end()};
  request.set_max_points(options.maximum_points);
  std::optional<v1::HistorySchema> schema;
  std::int64_t done = 0;  // rows that on_rows has received
  Backoff backoff;
  for (int tries_left = kReadRetries;;) {
    // The buckets of an overview depend on its first row: a retry reads it from its start again and
    // skips the rows that were delivered.
    const bool is_overview = schema && schema->rows_per_pair() > 0;
    const std::int64_t skipped = is_overview ? 0 : done;
    request.set_start_row(options.start_row + skipped);
    request.set_row_count(options.row_count == 0 ? 0 : options.row_count - skipped);
    if (schema && done == schema->row_count()) return;
    grpc::ClientContext context;
    services_->prepare(context);
    const auto reader = services_->simulations->ReadHistory(&context, request);
    std::optional<RowJoiner> joiner;
    for (v1::ReadHistoryResponse part; reader->Read(&part);) {
      if (part.has_schema()) {
        joiner.emplace(part.schema().columns_size());
        if (!schema) {
          schema = part.schema();
          on_schema(*schema);
        }
        continue;
      }
      if (!joiner) break;  // chunks without a schema: not this contract
      const HistoryRows* rows = joiner->add(part.chunk(), skipped);
      if (rows == nullptr || rows->first_row < done) continue;
      on_rows(*rows);
      done = rows->first_row + static_cast<std::int64_t>(rows->columns.front().size());
      tries_left = kReadRetries;
      backoff.reset();
    }
    const grpc::Status status = reader->Finish();
    if (status.ok()) return;
    const bool is_broken = status.error_code() == grpc::StatusCode::UNAVAILABLE ||
                           status.error_code() == grpc::StatusCode::DEADLINE_EXCEEDED;
    if (!is_broken || tries_left-- == 0 || (never_connected(status) && !schema)) {
      throw service_error(status, address());
    }
    std::this_thread::sleep_for(backoff.next(kBetweenReads));
  }
}

v1::History Connection::read_history(const std::string& name, const HistoryOptions& options) {
  v1::History out;
  stream_history(
      name, options,
      [&out](const v1::HistorySchema& schema) {
        out.set_start_row(schema.start_row());
        out.set_total_rows(schema.total_rows());
        out.set_rows_per_pair(schema.rows_per_pair());
        *out.mutable_input_warnings() = schema.input_warnings();
        for (const auto& each : schema.columns()) {
          v1::History::Column* column = out.add_columns();
          column->set_name(each.name());
          column->set_unit(each.unit());
        }
      },
      [&out](const HistoryRows& rows) {
        for (std::size_t i = 0; i < rows.columns.size(); ++i) {
          out.mutable_columns(static_cast<int>(i))
              ->mutable_values()
              ->Add(rows.columns[i].begin(), rows.columns[i].end());
        }
      });
  return out;
}

}  // namespace tribodyn::client
