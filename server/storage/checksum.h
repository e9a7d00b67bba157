#pragma once

#include <cstdint>
#include <string_view>

#include "server/storage/connection.h"

namespace tribodyn::server {

/// XXH3 of stored bytes, 64 bits as SQLite's signed INTEGER. Accidental damage goes unnoticed once
/// in 2^64 cases; the function does not protect against intent. XXH3, because a block of 40 kB
/// takes it 2.2 us and zlib's CRC-32, which has half of the bits, 6.3 us (measured, AVX-512).
std::int64_t checksum(std::string_view bytes);

/// Adds `checksum(BLOB)` to the SQL functions of a connection. Throws SQLite::Exception.
void add_checksum_function(Connection& db);

/// The bytes of a column, valid until the next step of its statement.
std::string_view bytes_of(const SQLite::Column& column);

}  // namespace tribodyn::server
