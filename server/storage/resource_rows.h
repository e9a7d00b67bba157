#pragma once

#include <string>
#include <vector>

#include "server/storage/connection.h"
#include "server/storage/properties.h"
#include "server/storage/stored_resource.h"
#include "server/storage/times.h"

namespace tribodyn::server {

// Rows of resources, revisions and properties on an open connection, inside the caller's
// transaction. All throw SQLite::Exception.

void bind_blob(SQLite::Statement& statement, int index, const std::string& bytes);
void bind_value(SQLite::Statement& statement, int index, const PropertyValue& value);

/// Whether there is a resource of that name, deleted or not.
bool is_taken(Connection& db, const std::string& name);

/// Whether a resource is still as it was read.
bool is_unchanged(Connection& db, const StoredResource& present);

/// A new resource with its first revision, as it is stored then.
StoredResource insert_resource(Connection& db, const NewResource& resource, Microseconds now);

/// A further revision, which becomes the present one, as it is stored then: at `now`, or at the
/// time of the former revision if that is later.
StoredResource insert_revision(Connection& db, const StoredResource& present,
                               const std::string& body, Microseconds now);

/// Columns of stored_resource, to be followed by the rest of a SELECT over r (resources) and v
/// (revisions).
inline constexpr char kResourceColumns[] =
    "SELECT r.id, r.name, v.revision, r.present = v.id, r.create_time, v.create_time, "
    "r.delete_time, v.content_hash, v.body ";
inline constexpr int kBodyColumn = 8;
StoredResource stored_resource(const SQLite::Statement& query);

/// Reads rows until `limit` of them or `byte_limit` bytes of the column that is large.
template <class Row, class Read>
Page<Row> read_page(SQLite::Statement& query, int limit, std::size_t byte_limit, int large_column,
                    const Read& read_row) {
  Page<Row> out;
  std::size_t bytes = 0;
  while (query.executeStep()) {
    bytes += static_cast<std::size_t>(query.getColumn(large_column).getBytes());
    const bool full =
        static_cast<int>(out.rows.size()) == limit || (!out.rows.empty() && bytes > byte_limit);
    if (full) {
      out.more = true;
      break;
    }
    out.rows.push_back(read_row(query));
  }
  return out;
}

}  // namespace tribodyn::server
