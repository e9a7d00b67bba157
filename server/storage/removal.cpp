#include "server/storage/removal.h"

#include <SQLiteCpp/Exception.h>
#include <sqlite3.h>

#include <algorithm>
#include <chrono>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "proto/resource_kinds.h"
#include "server/contract/resource_names.h"
#include "server/storage/campaign_rows.h"
#include "server/storage/event_rows.h"
#include "server/storage/properties.h"
#include "server/storage/resource_types.h"

namespace tribodyn::server {
namespace {

/// Returns true for a column of simulations and campaigns.
bool is_column(std::string_view name) {
  const auto& fields = property_fields(kCampaigns);
  return std::any_of(fields.begin(), fields.end(),
                     [&](const PropertyField& each) { return each.key == name; });
}

/// Returns the condition that a simulation or a campaign used a revision of resource ?1, the latter
/// also as one of its candidates. The columns have indexes.
std::string uses(const StoredResource& resource, bool is_of_campaigns = false) {
  const std::string of_resource = " IN (SELECT id FROM revisions WHERE resource = ?1)";
  std::string as_input = "?1 IS NULL";  // false, for a kind that is no column
#define TRIBODYN_USES(Resource, field, kind, seed) \
  if (collection_of(resource.name) == #kind && is_column(#field)) as_input = #field + of_resource;
  TRIBODYN_RESOURCE_KINDS(TRIBODYN_USES)
#undef TRIBODYN_USES
  if (!is_of_campaigns) return as_input;
  return "(" + as_input + " OR id IN (SELECT campaign FROM campaign_lubricants WHERE lubricant" +
         of_resource + "))";
}

/// Returns the rows of a table, simulations or campaigns, that used the resource.
std::vector<std::int64_t> users_of(Connection& db, const std::string& table,
                                   const StoredResource& resource) {
  Prepared query(db, "SELECT id FROM " + table + " WHERE " + uses(resource, table == "campaigns"),
                 resource.id);
  std::vector<std::int64_t> out;
  while (query.executeStep()) out.push_back(query.getColumn(0).getInt64());
  return out;
}

/// Copies the write-ahead log into the database and truncates the log. Returns false if a reader
/// still needs it.
bool empty_log(Connection& db) {
  return db.execAndGet("PRAGMA wal_checkpoint(TRUNCATE)").getInt() == 0;
}

}  // namespace

std::int64_t remove_simulation(Connection& db, std::int64_t id) {
  std::int64_t result = 0, ledger = 0;
  {
    Prepared query(
        db, "SELECT coalesce(result, 0), coalesce(ledger, 0) FROM simulations WHERE id = ?1", id);
    if (!query.executeStep()) return 0;
    result = query.getColumn(0).getInt64();
    ledger = query.getColumn(1).getInt64();
  }
  insert_deletion(db, id);
  execute(db, "DELETE FROM simulations WHERE id = ?1", id);
  execute(db,
          "DELETE FROM ledgers WHERE id = ?1 AND "
          "NOT EXISTS (SELECT 1 FROM simulations WHERE ledger = ?1)",
          ledger);
  Prepared remove(db,
                  "DELETE FROM results WHERE id = ?1 AND "
                  "NOT EXISTS (SELECT 1 FROM simulations WHERE result = ?1) "
                  "RETURNING stored_bytes",
                  result);
  return remove.returned().value_or(0);
}

Dependents dependents_of(Connection& db, const StoredResource& resource) {
  Dependents out;
  Prepared query(db, "SELECT id, state FROM simulations WHERE " + uses(resource), resource.id);
  while (query.executeStep()) {
    if (query.getColumn(1).getInt() < 3) {
      out.unfinished.push_back(query.getColumn(0).getInt64());
    } else {
      ++out.ended;
    }
  }
  Prepared results(db,
                   "SELECT count(DISTINCT result) FROM simulations AS own WHERE " + uses(resource) +
                       " AND NOT EXISTS (SELECT 1 FROM simulations WHERE result = own.result "
                       "AND NOT " +
                       uses(resource) + ")",
                   resource.id);
  out.results = results.value().getInt();
  Prepared campaigns(db, "SELECT id, state FROM campaigns WHERE " + uses(resource, true),
                     resource.id);
  while (campaigns.executeStep()) {
    if (has_ended(static_cast<CampaignState>(campaigns.getColumn(1).getInt()))) {
      ++out.ended_campaigns;
    } else {
      out.unfinished_campaigns.push_back(campaigns.getColumn(0).getInt64());
    }
  }
  return out;
}

int remove_resource(Connection& db, const StoredResource& resource) {
  for (const std::int64_t id : users_of(db, "simulations", resource)) remove_simulation(db, id);
  for (const std::int64_t id : users_of(db, "campaigns", resource)) remove_campaign(db, id);
  execute(db, "DELETE FROM properties WHERE resource = ?1", resource.id);
  // The trigger that protects revisions is dropped and created again within the transaction.
  const std::string trigger =
      db.execAndGet("SELECT sql FROM sqlite_master WHERE name = 'revisions_stay'").getString();
  db.exec("DROP TRIGGER revisions_stay");
  const int revisions = execute(db, "DELETE FROM revisions WHERE resource = ?1", resource.id);
  db.exec(trigger);
  execute(db, "DELETE FROM resources WHERE id = ?1", resource.id);
  return revisions;
}

void erase_removed(Connection& db) {
  // VACUUM copies the whole database: into a temporary file rather than memory.
  db.exec("PRAGMA temp_store = FILE");
  db.exec("VACUUM");
  db.exec("PRAGMA temp_store = MEMORY");
  const auto begin = std::chrono::steady_clock::now();
  while (!empty_log(db)) {
    if (std::chrono::steady_clock::now() - begin > std::chrono::seconds(kEraseSeconds)) {
      throw SQLite::Exception("readers still use the write-ahead log", SQLITE_BUSY);
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
}

}  // namespace tribodyn::server
