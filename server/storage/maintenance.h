#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "tribodyn/v1/simulations.pb.h"

namespace tribodyn::server {

/// Copies a database as it is at one moment; a server may run on it and write meanwhile. The copy
/// is complete and on disk when its file appears. Throws StoreError, and leaves no file, if `copy`
/// exists, the database is damaged, or the copy cannot be written.
void backup_database(const std::filesystem::path& database, const std::filesystem::path& copy);

/// Copies a database of an older schema, as it is, to the first of "<database>.schema-4",
/// "<database>.schema-4.2", ... that does not exist (for schema 4), and returns that path. The copy
/// is on disk when its file appears. Throws StoreError, and leaves no file, if it cannot be
/// written.
std::filesystem::path backup_before_migration(const std::filesystem::path& database, int schema);

/// Removes the files that backup_before_migration made for a database. Throws StoreError.
void remove_migration_backups(const std::filesystem::path& database);

/// The former databases that restore_database kept beside a database, sorted. Throws StoreError.
std::vector<std::filesystem::path> former_databases(const std::filesystem::path& database);

/// Puts a backup in the place of a database and returns the path under which the former one is
/// kept:
/// "<database>.replaced", or ".replaced.2" and so on where that name is taken. Returns nullopt if
/// there was no database. Whenever the process or the power goes, the path holds the former or the
/// new database, complete; only if the former one is damaged may its log be found at the kept name
/// already. Throws StoreError, and leaves the database as it is, if a server runs on it, or if the
/// backup is damaged, inconsistent, newer than this program or another program's.
std::optional<std::filesystem::path> restore_database(const std::filesystem::path& copy,
                                                      const std::filesystem::path& database);

/// The body of a revision, "lubricants/1" and 2; nothing when there is none.
using FindRevision =
    std::function<std::optional<std::string>(const std::string& name, int revision)>;

/// The hash of the inputs of a simulation whose request names revisions; nothing when this
/// program's model is not the one that computed its result.
using HashInputs = std::function<std::optional<std::string>(
    const v1::Simulation& request, const std::string& model_version, const FindRevision& find)>;

/// The faults of a database, a sentence each: those that keep a server from serving it; damage that
/// SQLite finds, and rows that point at none; gaps in revisions and events; stored bytes that are
/// not what was written, by their checksums; properties, and with `hash_inputs` input hashes, that
/// are not those of the contents; bodies that are no message of their resource; states that
/// disagree with results; histories of unequal columns or missing blocks. Empty for a sound
/// database, and for a file in which a server would make a new one. A server may run on the
/// database. Throws StoreError if it cannot be opened or read.
std::vector<std::string> check_database(const std::filesystem::path& database,
                                        const HashInputs& hash_inputs = nullptr);

}  // namespace tribodyn::server
