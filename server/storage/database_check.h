#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "server/storage/connection.h"
#include "server/storage/maintenance.h"
#include "server/storage/schema.h"

namespace tribodyn::server {

/// One sentence for each problem of a database.
using Problems = std::vector<std::string>;

/// Throws StoreError kForeign if the database is empty or belongs to another program, and
/// kOtherVersion if its fingerprint is not that of a schema of `steps`. Then no file of the
/// database changes when the connection closes. Throws SQLite::Exception.
void check_identity(Connection& db, const std::filesystem::path& path,
                    const SchemaSteps& steps = schema_steps());

/// Throws StoreError if a server can neither use the database nor create its tables in it: like
/// check_identity() unless the database is empty, and kCorrupt if its tables, indexes, triggers and
/// views are not those of its schema. Throws SQLite::Exception.
void require_servable(Connection& db, const std::filesystem::path& path, const SchemaSteps& steps);

/// Returns the problems of an open database as check_database() (maintenance.h) does. Throws like
/// check_identity() unless the database is empty.
Problems problems_of(Connection& db, const std::filesystem::path& path,
                     const HashInputs& hash_inputs = nullptr,
                     const SchemaSteps& steps = schema_steps());

}  // namespace tribodyn::server
