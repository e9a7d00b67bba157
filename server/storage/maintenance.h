#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "server/storage/schema.h"
#include "tribodyn/v1/simulations.pb.h"

namespace tribodyn::server {

/// Copies a snapshot of a database to a new file. A server may write to the database meanwhile. The
/// file `copy` appears complete and on disk. Throws StoreError, and leaves no file, if `copy`
/// exists, if the database is damaged, or if the copy cannot be written.
void backup_database(const std::filesystem::path& database, const std::filesystem::path& copy);

/// Copies a database of an older schema unchanged to the first of "<database>.schema-4",
/// "<database>.schema-4.2", ... (for schema 4) that does not exist. Returns that path. The file
/// appears complete and on disk. Throws StoreError, and leaves no file, if it cannot be written.
std::filesystem::path backup_before_migration(const std::filesystem::path& database, int schema);

/// Returns the files that backup_before_migration() made for a database, sorted. Throws StoreError.
std::vector<std::filesystem::path> migration_backups(const std::filesystem::path& database);
/// Removes these files. Throws StoreError.
void remove_migration_backups(const std::filesystem::path& database);

/// Returns the old databases that restore_database() kept beside a database, sorted. Throws
/// StoreError.
std::vector<std::filesystem::path> former_databases(const std::filesystem::path& database);

/// Replaces a database by a backup. Returns the path under which the old database is kept:
/// "<database>.replaced", or ".replaced.2" and so on if that name is taken; nullopt if there was no
/// database. Whenever the process or the power fails, the path has the old or the new database,
/// complete; only the log of a damaged old database may already be at the kept name. Throws
/// StoreError, and leaves the database unchanged, if a server uses it, or if the backup is damaged,
/// inconsistent, of another version of this program or another program's.
std::optional<std::filesystem::path> restore_database(const std::filesystem::path& copy,
                                                      const std::filesystem::path& database);

/// Returns the body of a revision, e.g. of "lubricants/paper-fluid-1" and 2; nullopt if it does not
/// exist.
using FindRevision =
    std::function<std::optional<std::string>(const std::string& name, int revision)>;

/// Returns the input hash of a simulation whose request names revisions; nullopt if another model
/// version computed its result.
using HashInputs = std::function<std::optional<std::string>(
    const v1::Simulation& request, const std::string& model_version, const FindRevision& find)>;

/// Returns the problems of a database, one sentence each. Checks: whether a server can use it;
/// damage that SQLite finds; rows that refer to missing rows; gaps in revisions and events; stored
/// bytes that differ from their checksums; properties and (with `hash_inputs`) input hashes that
/// differ from those of the contents; bodies that are not messages of their kind; states that
/// disagree with results; histories with unequal columns or missing blocks. Returns an empty list
/// for a sound database, and for a file in which a server would create a new one. A server may use
/// the database meanwhile. Throws StoreError if the database cannot be opened or read.
std::vector<std::string> check_database(const std::filesystem::path& database,
                                        const HashInputs& hash_inputs = nullptr,
                                        const SchemaSteps& steps = schema_steps());

}  // namespace tribodyn::server
