#include "server/storage/history/column_codec.h"

#include <zstd.h>

#include <algorithm>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <mutex>
#include <new>
#include <stdexcept>
#include <utility>
#include <vector>

namespace tribodyn::server {
namespace {

constexpr std::size_t kBytes = sizeof(double);
constexpr int kFastest = 1;

/// Transposes an 8 x 8 matrix of bytes: row 0 in words[0], column 0 in the lowest byte.
void transpose(std::uint64_t (&words)[kBytes]) {
  const auto swap = [](std::uint64_t& a, std::uint64_t& b, int shift, std::uint64_t mask) {
    const std::uint64_t moved = ((a >> shift) ^ b) & mask;
    b ^= moved;
    a ^= moved << shift;
  };
  for (std::size_t i = 0; i < 4; ++i) swap(words[i], words[i + 4], 32, 0x00000000FFFFFFFFULL);
  for (const std::size_t i : {0, 1, 4, 5}) swap(words[i], words[i + 2], 16, 0x0000FFFF0000FFFFULL);
  for (const std::size_t i : {0, 2, 4, 6}) swap(words[i], words[i + 1], 8, 0x00FF00FF00FF00FFULL);
}

/// Writes the bytes of all values in planes: plane k holds byte k of every value.
void split_planes(std::span<const double> values, char* planes) {
  const std::size_t count = values.size();
  const std::size_t whole = count - count % kBytes;
  for (std::size_t i = 0; i < whole; i += kBytes) {
    std::uint64_t words[kBytes];
    std::memcpy(words, values.data() + i, sizeof(words));
    transpose(words);
    for (std::size_t k = 0; k < kBytes; ++k) std::memcpy(planes + k * count + i, &words[k], kBytes);
  }
  for (std::size_t i = whole; i < count; ++i) {
    char bytes[kBytes];
    std::memcpy(bytes, &values[i], kBytes);
    for (std::size_t k = 0; k < kBytes; ++k) planes[k * count + i] = bytes[k];
  }
}

void join_planes(const char* planes, std::span<double> values) {
  const std::size_t count = values.size();
  const std::size_t whole = count - count % kBytes;
  for (std::size_t i = 0; i < whole; i += kBytes) {
    std::uint64_t words[kBytes];
    for (std::size_t k = 0; k < kBytes; ++k) std::memcpy(&words[k], planes + k * count + i, kBytes);
    transpose(words);
    std::memcpy(values.data() + i, words, sizeof(words));
  }
  for (std::size_t i = whole; i < count; ++i) {
    char bytes[kBytes];
    for (std::size_t k = 0; k < kBytes; ++k) bytes[k] = planes[k * count + i];
    std::memcpy(&values[i], bytes, kBytes);
  }
}

struct FreeContext {
  void operator()(ZSTD_DCtx* context) const { ZSTD_freeDCtx(context); }
};

/// Memory for decompressing one block.
struct Workspace {
  std::unique_ptr<ZSTD_DCtx, FreeContext> context{ZSTD_createDCtx()};
  std::vector<char> planes;
};

/// A pool of workspaces, each lent to one thread at a time. Creating one takes longer than
/// decompressing a block, and one for every thread that ever reads a history would take megabytes.
/// Safe for concurrent access.
class Workspaces {
 public:
  std::unique_ptr<Workspace> borrow() {
    std::unique_lock lock(mutex_);
    returned_.wait(lock, [this] { return !idle_.empty() || made_ < kMost; });
    if (idle_.empty()) {
      auto fresh = std::make_unique<Workspace>();
      if (!fresh->context) throw std::bad_alloc();
      ++made_;
      return fresh;
    }
    auto out = std::move(idle_.back());
    idle_.pop_back();
    return out;
  }

  void give_back(std::unique_ptr<Workspace> workspace) {
    {
      const std::lock_guard lock(mutex_);
      idle_.push_back(std::move(workspace));
    }
    returned_.notify_one();
  }

 private:
  static constexpr int kMost = 4;

  std::mutex mutex_;
  std::condition_variable returned_;
  std::vector<std::unique_ptr<Workspace>> idle_;  // guarded by mutex_
  int made_ = 0;                                  // guarded by mutex_
};

}  // namespace

std::string compress_column(std::span<const double> values) {
  const std::size_t size = values.size() * kBytes;
  std::vector<char> planes(size);
  split_planes(values, planes.data());
  std::string out(ZSTD_compressBound(size), '\0');
  const std::size_t used = ZSTD_compress(out.data(), out.size(), planes.data(), size, kFastest);
  if (ZSTD_isError(used) != 0) throw std::runtime_error("a history column cannot be compressed");
  out.resize(used);
  return out;
}

void decompress_column(std::string_view compressed, std::span<double> values) {
  static Workspaces workspaces;
  auto workspace = workspaces.borrow();
  std::vector<char>& planes = workspace->planes;
  planes.resize(std::max(planes.size(), values.size_bytes()));
  const std::size_t size = ZSTD_decompressDCtx(workspace->context.get(), planes.data(),
                                               planes.size(), compressed.data(), compressed.size());
  const bool is_whole = ZSTD_isError(size) == 0 && size == values.size_bytes();
  if (is_whole) join_planes(planes.data(), values);
  workspaces.give_back(std::move(workspace));
  if (!is_whole) throw std::runtime_error("a history column is damaged");
}

}  // namespace tribodyn::server
