#pragma once

#include <span>
#include <string>
#include <string_view>

namespace tribodyn::server {

/// Doubles as they are kept on disk: their bytes in planes, first bytes first, and these by zstd.
/// Neighbours share sign, exponent and leading digits, so the planes of these shrink to little and
/// the planes of trailing digits pass through at the speed of memory. The same bits come back.
std::string compress_column(std::span<const double> values);

/// Fills `values` with what was compressed. Throws std::runtime_error when it is damaged or was not
/// as many.
void decompress_column(std::string_view compressed, std::span<double> values);

}  // namespace tribodyn::server
