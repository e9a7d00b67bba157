#include "server/storage/resource_queries.h"

#include <SQLiteCpp/Statement.h>

#include <algorithm>

#include "server/storage/list_conditions.h"
#include "server/storage/resource_rows.h"

namespace tribodyn::server {
namespace {

using Comparison = Restriction::Comparison;

constexpr int kSelectiveRowLimit = 500;  ///< rows that a query may sort

/// Returns a restriction on the name. Equal names are compared in full, others without the project.
Condition compared_name(const std::string& project, Restriction restriction) {
  if (restriction.comparison == Comparison::kEqual) {
    restriction.value = name_in(project, std::get<std::string>(restriction.value));
    return compared("r.name", restriction);
  }
  const std::size_t begin = full_name(project, "").size() + 1;
  return compared("substr(r.name, " + std::to_string(begin) + ")", restriction);
}

/// Returns a restriction as a condition on the resource r, which works in any query.
Condition condition(const std::string& project, Restriction restriction) {
  Condition out;
  const bool negated = restriction.comparison == Comparison::kNotEqual;
  if (negated) restriction.comparison = Comparison::kEqual;
  const std::string begin = negated ? " AND NOT " : " AND ";
  if (restriction.key == "name") {
    const Condition test = compared_name(project, restriction);
    out.add(begin + "(" + test.sql + ")", test.values);
    return out;
  }
  const Condition test = compared("p.value", restriction);
  out.add(begin + "EXISTS (SELECT 1 FROM properties p WHERE p.resource = r.id AND p.key = ? AND ",
          {restriction.key});
  out.add(test.sql + ")", test.values);
  return out;
}

/// Returns the condition on the rows d of the index that a restriction selects.
Condition selected(const std::string& collection, const Restriction& restriction) {
  const Condition test = compared("d.value", restriction);
  Condition out{" d.collection = ? AND d.key = ? AND ", {collection, restriction.key}};
  out.add(test.sql, test.values);
  return out;
}

bool has_index(const Restriction& restriction) {
  return restriction.key != "name" && restriction.comparison != Comparison::kNotEqual &&
         restriction.comparison != Comparison::kContains;
}

/// Returns the number of rows that a restriction selects, at most kSelectiveRowLimit.
int count_up_to_limit(Connection& db, const std::string& collection,
                      const Restriction& restriction) {
  const Condition rows = selected(collection, restriction);
  SQLite::Statement query(db, "SELECT count(*) FROM (SELECT 1 FROM properties d WHERE" + rows.sql +
                                  " LIMIT " + std::to_string(kSelectiveRowLimit) + ")");
  bind_values(query, rows.values);
  query.executeStep();
  return query.getColumn(0).getInt();
}

/// Returns the restriction that selects the fewest rows, or null if each selects kSelectiveRowLimit
/// or more.
const Restriction* most_selective(Connection& db, const ResourceQuery& query) {
  const Restriction* best = nullptr;
  int fewest = kSelectiveRowLimit;
  for (const Restriction& each : query.restrictions) {
    if (!has_index(each)) continue;
    const int count = count_up_to_limit(db, full_name(query.project, query.collection), each);
    if (count < fewest) {
      fewest = count;
      best = &each;
    }
  }
  return best;
}

constexpr char kJoined[] = " CROSS JOIN resources r ON r.id = d.resource";
constexpr char kRevisions[] = " CROSS JOIN revisions v ON v.id = r.present";

/// Adds the start of a page and its order.
void add_start_and_order(Condition& sql, const ResourceQuery& query,
                         const std::string& value_column, const std::string& name_column) {
  const std::string beyond = query.descending ? " < " : " > ";
  const std::string direction = query.descending ? " DESC" : "";
  if (query.order_key.empty()) {
    if (query.after) sql.add(" AND " + name_column + beyond + "?", {query.after->name});
    sql.add(" ORDER BY " + name_column + direction);
    return;
  }
  if (query.after) {
    sql.add(" AND (" + value_column + ", " + name_column + ")" + beyond + "(?, ?)",
            {query.after->value, query.after->name});
  }
  sql.add(" ORDER BY " + value_column + direction + ", " + name_column + direction);
}

void add_conditions(Condition& sql, const ResourceQuery& query, const Restriction* but) {
  if (!query.show_deleted) sql.add(" AND r.delete_time IS NULL");
  for (const Restriction& each : query.restrictions) {
    if (&each == but) continue;
    const Condition more = condition(query.project, each);
    sql.add(more.sql, more.values);
  }
}

/// What a statement is for. Counting reads no revisions: they take most of the time.
enum class Purpose { kRows, kCount };

/// The rows of a query, or a 1 for each of them.
Condition statement(Connection& db, const ResourceQuery& query, Purpose purpose) {
  Condition sql{purpose == Purpose::kRows ? kResourceColumns : "SELECT 1 ", {}};
  const std::string collection = full_name(query.project, query.collection);
  const std::string revisions = purpose == Purpose::kRows ? kRevisions : "";
  const bool by_name = query.order_key.empty();
  const Restriction* leading = most_selective(db, query);
  const bool sorted = leading != nullptr;
  if (leading == nullptr && by_name) {
    const auto equal = std::find_if(
        query.restrictions.begin(), query.restrictions.end(), [](const Restriction& each) {
          return has_index(each) && each.comparison == Comparison::kEqual;
        });
    if (equal != query.restrictions.end()) leading = &*equal;
  }
  if (leading != nullptr) {
    const Condition rows = selected(collection, *leading);
    sql.add(std::string("FROM properties d") + kJoined + revisions);
    if (!by_name) {
      sql.add(" CROSS JOIN properties o ON o.resource = r.id AND o.key = ?", {query.order_key});
    }
    sql.add(" WHERE" + rows.sql, rows.values);
    add_conditions(sql, query, leading);
    // "+" prevents SQLite from using an index for the order of names.
    add_start_and_order(sql, query, "o.value", sorted ? "+d.name" : "d.name");
    return sql;
  }
  if (by_name) {
    sql.add("FROM resources r" + revisions + " WHERE r.collection = ?", {collection});
    add_conditions(sql, query, nullptr);
    add_start_and_order(sql, query, "", "r.name");
    return sql;
  }
  sql.add(std::string("FROM properties d") + kJoined + revisions +
              " WHERE d.collection = ? AND d.key = ?",
          {collection, query.order_key});
  add_conditions(sql, query, nullptr);
  add_start_and_order(sql, query, "d.value", "d.name");
  return sql;
}

/// How many rows the query has from its start, whatever its limit.
std::int64_t count_all(Connection& db, const ResourceQuery& query) {
  const Condition rows = statement(db, query, Purpose::kCount);
  SQLite::Statement count(db, "SELECT count(*) FROM (" + rows.sql + ")");
  bind_values(count, rows.values);
  count.executeStep();
  return count.getColumn(0).getInt64();
}

}  // namespace

Page<StoredResource> query_resources(Connection& db, const ResourceQuery& query) {
  const Condition sql = statement(db, query, Purpose::kRows);
  SQLite::Statement rows(db, sql.sql + " LIMIT " + std::to_string(query.limit + 1));
  bind_values(rows, sql.values);
  auto page =
      read_page<StoredResource>(rows, query.limit, query.byte_limit, kBodyColumn, stored_resource);
  if (query.counts_all) {
    page.total = page.more ? count_all(db, query) : static_cast<std::int64_t>(page.rows.size());
  }
  return page;
}

}  // namespace tribodyn::server
