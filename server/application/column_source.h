#pragma once

#include <algorithm>
#include <atomic>
#include <bit>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>

#include "server/application/application.h"
#include "server/application/message_source.h"
#include "server/application/streams.h"
#include "server/storage/history_rows.h"
#include "tribodyn/v1/simulations.pb.h"

static_assert(std::endian::native == std::endian::little, "chunks are little-endian");

namespace tribodyn::server {

/// A place among the open sources of columns, all of which share one budget of memory.
class OpenColumns {
 public:
  explicit OpenColumns(std::shared_ptr<std::atomic<int>> open) : open_(std::move(open)) {
    ++*open_;
  }
  ~OpenColumns() { --*open_; }
  OpenColumns(const OpenColumns&) = delete;
  OpenColumns& operator=(const OpenColumns&) = delete;

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

  /// Returns true if every open source may have two of the longest chunks.
  bool has_room_for_two() const { return 2 * kChunkValues * open_->load() <= kOpenHistoryValues; }

 private:
  static constexpr std::int64_t kLeastRun = 512;  // rows; even, as pairs of an overview are
  std::shared_ptr<std::atomic<int>> open_;
};

/// A stream of columns: the schema, then chunks, each column as far as the others before any goes
/// on. `Response` has the parts `schema` and `chunk`.
template <class Response>
class ColumnSource : public MessageSource<Response> {
 public:
  using Order = AnyMessageSource::Order;
  using Step = AnyMessageSource::Step;

  void set_order(Order order) final { order_ = order; }

  Step next(Response& out) final {
    out.Clear();
    if (!told_schema_) {
      told_schema_ = true;
      tell_schema(*out.mutable_schema());
      return Step::kMessage;
    }
    if (next_row_ >= rows_ || columns_ == 0) return Step::kEnd;
    if (column_ == 0 || order_ == Order::kColumns) {
      run_ = std::min(longest_run(), rows_ - next_row_);
    }
    v1::HistoryChunk& chunk = *out.mutable_chunk();
    chunk.set_column(static_cast<int>(column_));
    chunk.set_first_row(next_row_);
    // The values are written where they are sent from. std::string aligns its bytes for doubles.
    const auto count = static_cast<std::size_t>(run_);
    chunk.mutable_values()->resize(count * sizeof(double));
    read(column_, next_row_, {reinterpret_cast<double*>(chunk.mutable_values()->data()), count});
    if (error_.code() != 0) return Step::kEnd;
    if (order_ == Order::kColumns) {
      next_row_ += run_;
      if (next_row_ == rows_ && ++column_ < columns_) next_row_ = 0;
    } else if (++column_ == columns_) {
      column_ = 0;
      next_row_ += run_;
    }
    return Step::kMessage;
  }

  bool is_short() const final { return rows_ <= kHistoryBlock; }
  /// Not beside the schema: the thread that prepares a chunk would compete with the client for the
  /// processors and delay the first message.
  bool may_be_ahead() const final {
    return (next_row_ > 0 || column_ > 0) && open_.has_room_for_two();
  }
  google::rpc::Status error() const final { return error_; }

 protected:
  ColumnSource(Application& application, std::size_t columns)
      : columns_(columns), open_(application.open_histories) {}

  virtual void tell_schema(v1::HistorySchema& out) const = 0;
  /// Reads rows [first, first + values.size()) of the stream in the column at this place of the
  /// schema. A failure sets error_.
  virtual void read(std::size_t place, std::int64_t first, std::span<double> values) = 0;

  std::int64_t rows_ = 0;  ///< to come in all
  google::rpc::Status error_;

 private:
  std::int64_t longest_run() const {
    if (order_ != Order::kRows) return open_.chunk_values();
    return open_.row_run(static_cast<std::int64_t>(columns_));
  }

  const std::size_t columns_;
  const OpenColumns open_;
  bool told_schema_ = false;
  std::int64_t next_row_ = 0;
  std::int64_t run_ = 0;  // rows of the present chunks
  std::size_t column_ = 0;
  Order order_ = Order::kChunks;
};

}  // namespace tribodyn::server
