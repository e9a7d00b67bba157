#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "server/storage/connection.h"
#include "server/storage/maintenance.h"

namespace tribodyn::server {

/// One sentence for each fault of a database.
using Problems = std::vector<std::string>;

/// Throws StoreError kForeign if another program made the database or it is empty, and kNewerSchema
/// if a newer version of this program made it. Throws SQLite::Exception.
void check_identity(Connection& db, const std::filesystem::path& path);

/// Throws StoreError if a server can neither serve the database nor make its tables in it: as
/// check_identity does unless it is empty, and kCorrupt if its tables, indexes, triggers and views
/// are not those of its schema. Throws SQLite::Exception.
void require_servable(Connection& db, const std::filesystem::path& path);

/// The faults that check_database (maintenance.h) lists, of an open database. Throws as
/// check_identity does unless the database is empty.
Problems problems_of(Connection& db, const std::filesystem::path& path,
                     const HashInputs& hash_inputs = nullptr);

}  // namespace tribodyn::server
