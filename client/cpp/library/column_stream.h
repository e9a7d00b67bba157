#pragma once

#include <grpcpp/grpcpp.h>

#include <chrono>
#include <cstdint>
#include <cstring>
#include <functional>
#include <memory>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "client/cpp/library/retry.h"
#include "client/cpp/library/status.h"
#include "tribodyn/client/connection.h"

namespace tribodyn::client {

inline constexpr auto kBetweenReads = std::chrono::milliseconds(250);
/// About 40 s in all: long enough for a server that restarts.
inline constexpr int kReadRetries = 20;

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

/// Reads a stream of columns from request.start_row on. Calls `on_schema` once and `on_rows` for
/// rows as they arrive, once and in order. Resumes a broken stream at the first missing row, for a
/// limited time; unless `is_resumable`, only one that has brought no rows. Throws ServiceError.
template <class Response, class Services, class Stub, class Request>
void stream_columns(const Services& services, Stub& stub,
                    std::unique_ptr<grpc::ClientReader<Response>> (Stub::*method)(
                        grpc::ClientContext*, const Request&),
                    Request request, const std::function<void(const v1::HistorySchema&)>& on_schema,
                    const std::function<void(const HistoryRows&)>& on_rows,
                    bool is_resumable = true) {
  const std::int64_t start_row = request.start_row(), row_count = request.row_count();
  std::optional<v1::HistorySchema> schema;
  std::int64_t done = 0;  // rows that on_rows has received
  Backoff backoff;
  for (int tries_left = kReadRetries;;) {
    // The buckets of an overview depend on its first row: a retry reads it from its start again and
    // skips the rows that were delivered.
    const bool is_overview = schema && schema->rows_per_pair() > 0;
    const std::int64_t skipped = is_overview ? 0 : done;
    request.set_start_row(start_row + skipped);
    request.set_row_count(row_count == 0 ? 0 : row_count - skipped);
    if (schema && done == schema->row_count()) return;
    grpc::ClientContext context;
    services.prepare(context);
    const auto reader = (stub.*method)(&context, request);
    std::optional<RowJoiner> joiner;
    for (Response part; reader->Read(&part);) {
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
    const auto requested = retry_delay(status);
    if (!(is_broken || requested) || (!requested && tries_left-- == 0) ||
        (never_connected(status) && !schema) || (!is_resumable && done > 0)) {
      throw service_error(status, services.address);
    }
    std::this_thread::sleep_for(backoff.next(requested.value_or(kBetweenReads)));
  }
}

}  // namespace tribodyn::client
