// Store: resources and their revisions, and what becomes of a resource that is purged.
#include <SQLiteCpp/Transaction.h>

#include <limits>

#include "server/storage/maintenance.h"
#include "server/storage/resource_queries.h"
#include "server/storage/resource_rows.h"
#include "server/storage/store_access.h"

namespace tribodyn::server {

std::optional<StoredResource> Store::resource(const std::string& name, const CallLimits& limits) {
  return read(limits, [&](Connection& db) {
    Prepared query(db,
                   std::string(kResourceColumns) +
                       "FROM resources r JOIN revisions v ON v.id = r.present WHERE r.name = ?",
                   name);
    return query.first(stored_resource);
  });
}

std::optional<StoredResource> Store::revision(const std::string& name, int revision,
                                              const CallLimits& limits) {
  return read(limits, [&](Connection& db) {
    Prepared query(db,
                   std::string(kResourceColumns) +
                       "FROM resources r JOIN revisions v ON v.resource = r.id "
                       "WHERE r.name = ? AND v.revision = ?",
                   name, revision);
    return query.first(stored_resource);
  });
}

Page<StoredResource> Store::resources(const ResourceQuery& query, const CallLimits& limits) {
  return read(limits, [&](Connection& db) { return query_resources(db, query); });
}

Page<StoredResource> Store::revisions(const std::string& name, int before, int limit,
                                      std::size_t byte_limit, const CallLimits& limits) {
  return read(limits, [&](Connection& db) {
    Prepared query(db,
                   std::string(kResourceColumns) +
                       "FROM resources r JOIN revisions v ON v.resource = r.id "
                       "WHERE r.name = ? AND v.revision < ? "
                       "ORDER BY v.revision DESC LIMIT ?",
                   name, before == 0 ? std::numeric_limits<int>::max() : before, limit + 1);
    return read_page<StoredResource>(query, limit, byte_limit, kBodyColumn, stored_resource);
  });
}

std::vector<std::string> Store::resource_names(const std::string& project,
                                               const std::string& collection,
                                               const CallLimits& limits) {
  return read(limits, [&](Connection& db) {
    Prepared query(
        db, "SELECT name FROM resources WHERE collection = ? AND delete_time IS NULL ORDER BY name",
        full_name(project, collection));
    std::vector<std::string> names;
    while (query.executeStep()) names.push_back(relative_name(query.getColumn(0).getString()));
    return names;
  });
}

std::optional<std::vector<StoredResource>> Store::write_resources(
    const std::vector<ResourceWrite>& writes, Microseconds now, const CallLimits& limits) {
  return write(limits, [&](Connection& db) -> std::optional<std::vector<StoredResource>> {
    SQLite::Transaction transaction(db, SQLite::TransactionBehavior::IMMEDIATE);
    std::vector<StoredResource> written;
    written.reserve(writes.size());
    for (const auto& [resource, present] : writes) {
      if (present ? !is_unchanged(db, *present) : is_taken(db, resource.name)) return std::nullopt;
      written.push_back(present ? insert_revision(db, *present, resource.body, now)
                                : insert_resource(db, resource, now));
    }
    transaction.commit();
    return written;
  });
}

template <class Change>
bool Store::change(const CallLimits& limits, const StoredResource& present, const Change& change) {
  return write(limits, [&](Connection& db) {
    SQLite::Transaction transaction(db, SQLite::TransactionBehavior::IMMEDIATE);
    if (!is_unchanged(db, present)) return false;
    change(db);
    transaction.commit();
    return true;
  });
}

bool Store::delete_resource(const StoredResource& present, Microseconds now,
                            const CallLimits& limits) {
  return change(limits, present, [&](Connection& db) {
    execute(db, "UPDATE resources SET delete_time = ? WHERE id = ?", now, present.id);
  });
}

bool Store::undelete_resource(const StoredResource& present, const CallLimits& limits) {
  return change(limits, present, [&](Connection& db) {
    execute(db, "UPDATE resources SET delete_time = NULL WHERE id = ?", present.id);
  });
}

Store::Purge Store::purge_resource(const StoredResource& present, bool with_dependents,
                                   const CallLimits& limits) {
  return write(limits, [&](Connection& db) {
    SQLite::Transaction transaction(db, SQLite::TransactionBehavior::IMMEDIATE);
    Purge out{.is_current = is_unchanged(db, present),
              .dependents = server::dependents_of(db, present)};
    const bool may_go = out.dependents.are_ended() && (with_dependents || !out.dependents.exist());
    if (!out.is_current || !may_go) return out;
    has_unerased_purge_ = true;
    out.revisions = remove_resource(db, present);
    transaction.commit();
    return out;
  });
}

Dependents Store::dependents_of(const StoredResource& present, const CallLimits& limits) {
  return read(limits, [&](Connection& db) { return server::dependents_of(db, present); });
}

std::vector<std::filesystem::path> Store::erase_removed(bool also_from_copies) {
  run_write({}, [&](Connection& db) {
    server::erase_removed(db);
    if (also_from_copies) remove_migration_backups(path_);
    // Under the writer's lock: no purge comes between.
    has_unerased_purge_ = !migration_backups(path_).empty();
  });
  std::vector<std::filesystem::path> out = former_databases(path_);
  for (std::filesystem::path& each : migration_backups(path_)) out.push_back(std::move(each));
  return out;
}

}  // namespace tribodyn::server
