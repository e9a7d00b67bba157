#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "server/storage/connection.h"
#include "server/storage/properties.h"
#include "server/storage/stored_resource.h"
#include "server/storage/times.h"

namespace tribodyn::server {

// Functions for rows of resources, revisions and properties on an open connection, inside the
// caller's transaction. All throw SQLite::Exception.

/// A revision in the columns of revision_names.
struct RevisionRow {
  std::string name;  ///< full name of the resource
  std::optional<int> number;
};
/// Returns the row of a relative name, e.g. "lubricants/paper-fluid-1@2"; one without a number if
/// the name is empty.
RevisionRow revision_row(const std::string& project, const std::string& revision);

/// Names of revisions by row. Each row is read once: the simulations of a page share a few
/// revisions.
class RevisionNames {
 public:
  explicit RevisionNames(Connection& db) : db_(db) {}
  /// Returns the relative name, e.g. "lubricants/paper-fluid-1@2", of the revision in a column;
  /// empty if the column is NULL.
  const std::string& of(const SQLite::Column& revision);

 private:
  Connection& db_;
  std::map<std::int64_t, std::string> known_;
};

/// Returns true if a resource, deleted or not, has this name.
bool is_taken(Connection& db, const std::string& name);

/// Returns true if the resource has not changed since `present` was read.
bool is_unchanged(Connection& db, const StoredResource& present);

/// Inserts a resource and its first revision. Returns the stored resource.
StoredResource insert_resource(Connection& db, const NewResource& resource, Microseconds now);

/// Inserts a revision and makes it the current one. Its time is `now`, or that of the previous
/// revision if that is later. Returns the stored resource.
StoredResource insert_revision(Connection& db, const StoredResource& present,
                               const std::string& body, Microseconds now);

/// Adds the properties that resources lack because the server that wrote them did not know the
/// field of the contract: lists could neither filter nor order by it. Returns the number of
/// resources.
int add_missing_properties(Connection& db);

/// Columns that stored_resource() reads. The caller appends the rest of a SELECT over r (resources)
/// and v (revisions).
inline constexpr char kResourceColumns[] =
    "SELECT r.id, r.name, v.revision, r.present = v.id, r.create_time, v.create_time, "
    "r.delete_time, v.content_hash, v.body ";
inline constexpr int kBodyColumn = 8;
StoredResource stored_resource(const SQLite::Statement& query);

/// Reads at most `limit` rows, and at most `byte_limit` bytes of column `large_column` but at least
/// one row.
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
