#include "server/history/column_codec.h"

#include <zstd.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <new>
#include <stdexcept>
#include <vector>

namespace tribodyn::server {
namespace {

constexpr std::size_t kBytes = sizeof(double);
constexpr int kFastest = 1;

/// Swaps rows and columns of an 8 x 8 matrix of bytes, row 0 in words[0], column 0 lowest.
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

/// Plane k holds byte k of every value.
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

/// Its own for every thread, as making one takes longer than a block.
ZSTD_DCtx* context() {
  thread_local const std::unique_ptr<ZSTD_DCtx, FreeContext> kContext(ZSTD_createDCtx());
  if (!kContext) throw std::bad_alloc();
  return kContext.get();
}

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
  thread_local std::vector<char> planes;
  planes.resize(values.size_bytes());
  const std::size_t size = ZSTD_decompressDCtx(context(), planes.data(), planes.size(),
                                               compressed.data(), compressed.size());
  if (ZSTD_isError(size) != 0 || size != planes.size()) {
    throw std::runtime_error("a history column is damaged");
  }
  join_planes(planes.data(), values);
}

}  // namespace tribodyn::server
