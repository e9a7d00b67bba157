#include "server/storage/checksum.h"

#include <SQLiteCpp/Column.h>
#include <sqlite3.h>
#include <xxhash.h>

#include "server/storage/store_error.h"

namespace tribodyn::server {

std::int64_t checksum(std::string_view bytes) {
  return static_cast<std::int64_t>(XXH3_64bits(bytes.data(), bytes.size()));
}

void require_undamaged(std::string_view bytes, std::int64_t stored_checksum, const char* what,
                       const std::string& name) {
  if (checksum(bytes) == stored_checksum) return;
  throw StoreError(StoreError::Kind::kDataLoss, what + name + " is damaged");
}

void add_checksum_function(Connection& db) {
  db.createFunction(
      "checksum", 1, true, nullptr, [](sqlite3_context* context, int, sqlite3_value** values) {
        const auto* bytes = static_cast<const char*>(sqlite3_value_blob(values[0]));
        const int count = sqlite3_value_bytes(values[0]);
        sqlite3_result_int64(context, checksum({bytes, static_cast<std::size_t>(count)}));
      });
}

std::string_view bytes_of(const SQLite::Column& column) {
  const auto* bytes = static_cast<const char*>(column.getBlob());
  return {bytes, static_cast<std::size_t>(column.getBytes())};
}

}  // namespace tribodyn::server
