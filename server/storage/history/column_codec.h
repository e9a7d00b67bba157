#pragma once

#include <span>
#include <string>
#include <string_view>

namespace tribodyn::server {

/// Compresses doubles for the disk: their bytes are ordered in planes, first bytes first, and
/// compressed by zstd. Neighbours share sign, exponent and leading digits, so their planes become
/// small; planes of trailing digits are copied at the speed of memory. Lossless.
std::string compress_column(std::span<const double> values);

/// Decompresses a column into `values`. Throws std::runtime_error if the data is damaged or has
/// another number of values.
void decompress_column(std::string_view compressed, std::span<double> values);

}  // namespace tribodyn::server
