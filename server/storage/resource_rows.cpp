#include "server/storage/resource_rows.h"

#include <algorithm>
#include <string>
#include <vector>

#include "server/contract/resource_names.h"
#include "server/storage/properties.h"
#include "server/storage/resource_types.h"
#include "server/storage/store_error.h"
#include "server/support/sha256.h"

namespace tribodyn::server {
namespace {

void insert_properties(Connection& db, const StoredResource& resource) {
  const std::string collection = collection_of(resource.name);
  Prepared insert(db, "INSERT INTO properties VALUES (?, ?, ?, ?, ?)");
  for (const Property& each : properties_of(collection, resource.body, resource.create_time,
                                            resource.revision_create_time)) {
    insert.run(resource.id, each.key, each.value, full_collection_of(resource.name), resource.name);
  }
}

void replace_properties(Connection& db, const StoredResource& resource) {
  execute(db, "DELETE FROM properties WHERE resource = ?", resource.id);
  insert_properties(db, resource);
}

/// Returns true if every resource of a collection has every property that all of them have. Unset
/// numbers have none.
bool has_all_properties(Connection& db, const std::string& collection) {
  Prepared resources(db, "SELECT count(*) FROM resources WHERE collection = ?", collection);
  const int count = resources.value().getInt();
  const auto& fields = property_fields(relative_name(collection));
  return std::all_of(fields.begin(), fields.end(), [&](const PropertyField& field) {
    if (field.kind == PropertyKind::kNumber) return true;
    Prepared properties(db, "SELECT count(*) FROM properties WHERE collection = ? AND key = ?",
                        collection, field.key);
    return properties.value().getInt() == count;
  });
}

/// Inserts a revision and makes it the current one.
void add_revision(Connection& db, const StoredResource& added) {
  execute(db,
          "INSERT INTO revisions (resource, revision, create_time, content_hash, body) "
          "VALUES (?, ?, ?, ?, ?)",
          added.id, added.revision, added.revision_create_time, added.content_hash,
          Blob{added.body});
  execute(db, "UPDATE resources SET present = ? WHERE id = ?", db.getLastInsertRowid(), added.id);
}

}  // namespace

RevisionRow revision_row(const std::string& project, const std::string& revision) {
  const std::size_t at = std::min(revision.find('@'), revision.size());
  RevisionRow out{full_name(project, revision.substr(0, at)), {}};
  if (at < revision.size()) out.number = std::stoi(revision.substr(at + 1));
  return out;
}

const std::string& RevisionNames::of(const SQLite::Column& revision) {
  const auto [known, is_new] =
      known_.try_emplace(revision.getInt64());  // NULL: 0, which no row has
  if (is_new && !revision.isNull()) {
    Prepared query(db_, "SELECT name || '@' || revision FROM revision_names WHERE revision_id = ?",
                   known->first);
    if (query.executeStep()) known->second = relative_name(query.getColumn(0).getString());
  }
  return known->second;
}

bool is_taken(Connection& db, const std::string& name) {
  Prepared taken(db, "SELECT 1 FROM resources WHERE name = ?", name);
  return taken.executeStep();
}

// After a purge a new resource may get the id of the purged one: name and contents tell them apart.
bool is_unchanged(Connection& db, const StoredResource& present) {
  Prepared unchanged(db,
                     "SELECT 1 FROM resources r JOIN revisions v ON v.id = r.present "
                     "WHERE r.id = ? AND v.revision = ? AND "
                     "(r.delete_time IS NULL) = ? AND r.name = ? AND v.content_hash = ?",
                     present.id, present.revision, !present.delete_time, present.name,
                     present.content_hash);
  return unchanged.executeStep();
}

StoredResource insert_resource(Connection& db, const NewResource& resource, Microseconds now) {
  execute(db, "INSERT INTO resources (name, collection, present, create_time) VALUES (?, ?, 0, ?)",
          resource.name, full_collection_of(resource.name), now);
  StoredResource added;
  added.id = db.getLastInsertRowid();
  added.name = resource.name;
  added.revision = 1;
  added.create_time = now;
  added.revision_create_time = now;
  added.content_hash = sha256(resource.body);
  added.body = resource.body;
  add_revision(db, added);
  insert_properties(db, added);
  return added;
}

StoredResource insert_revision(Connection& db, const StoredResource& present,
                               const std::string& body, Microseconds now) {
  StoredResource added = present;
  added.revision = present.revision + 1;
  // The wall clock may have been set back since the previous revision.
  added.revision_create_time = std::max(now, present.revision_create_time);
  added.content_hash = sha256(body);
  added.body = body;
  add_revision(db, added);
  replace_properties(db, added);
  return added;
}

int add_missing_properties(Connection& db) {
  std::vector<std::string> collections;
  SQLite::Statement names(db, "SELECT DISTINCT collection FROM resources");
  while (names.executeStep()) collections.push_back(names.getColumn(0).getString());
  int added = 0;
  for (const std::string& collection : collections) {
    if (has_all_properties(db, collection)) continue;
    std::vector<StoredResource> resources;
    SQLite::Statement query(db, std::string(kResourceColumns) +
                                    "FROM resources r JOIN revisions v ON v.id = r.present "
                                    "WHERE r.collection = ?");
    query.bind(1, collection);
    while (query.executeStep()) resources.push_back(stored_resource(query));
    for (const StoredResource& each : resources) replace_properties(db, each);
    added += static_cast<int>(resources.size());
  }
  return added;
}

StoredResource stored_resource(const SQLite::Statement& query) {
  StoredResource out;
  out.id = query.getColumn(0).getInt64();
  out.name = query.getColumn(1).getString();
  out.revision = query.getColumn(2).getInt();
  out.is_present = query.getColumn(3).getInt() != 0;
  out.create_time = query.getColumn(4).getInt64();
  out.revision_create_time = query.getColumn(5).getInt64();
  if (!query.getColumn(6).isNull()) out.delete_time = query.getColumn(6).getInt64();
  out.content_hash = query.getColumn(7).getString();
  out.body = query.getColumn(8).getString();
  if (sha256(out.body) != out.content_hash) {
    throw StoreError(StoreError::Kind::kDataLoss,
                     out.name + "@" + std::to_string(out.revision) + " is damaged");
  }
  return out;
}

}  // namespace tribodyn::server