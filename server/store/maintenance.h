#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "tribodyn/v1/simulations.pb.h"

namespace tribodyn::server {

/// Copies a database, also while a server runs on it, as it is at one moment. The copy is whole
/// when its file appears. Throws StoreError and leaves nothing behind when that cannot be; refuses
/// to write over a file, and to back up a damaged database as if it were whole.
void backup_database(const std::filesystem::path& database, const std::filesystem::path& copy);

/// Puts a backup in the place of a database, which is kept beside it as "<database>.replaced" (an
/// older one of that name goes). Throws StoreError and changes nothing when a server runs on the
/// database, or the backup is damaged, inconsistent, newer than this program or another program's.
void restore_database(const std::filesystem::path& copy, const std::filesystem::path& database);

/// The body of a revision, "lubricants/1" and 2; nothing when there is none.
using FindRevision =
    std::function<std::optional<std::string>(const std::string& name, int revision)>;

/// The hash of the inputs of a simulation whose request names revisions; nothing when this
/// program's model is not the one that computed its result.
using HashInputs = std::function<std::optional<std::string>(
    const v1::Simulation& request, const std::string& model_version, const FindRevision& find)>;

/// What is wrong with a database, one sentence each; empty when all is well: SQLite's integrity and
/// foreign keys, revisions numbered without gaps with the last one present, content hashes and
/// properties computed again, input hashes too when `hash_inputs` is there, every body a message
/// that bears its resource's name, states of simulations that agree with their results, histories
/// of equal columns and whole blocks. Also while a server runs. Throws StoreError when it cannot be
/// opened or read.
std::vector<std::string> check_database(const std::filesystem::path& database,
                                        const HashInputs& hash_inputs = nullptr);

}  // namespace tribodyn::server
