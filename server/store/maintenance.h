#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace tribodyn::server {

/// Copies a database, also while a server runs on it, as it is at one moment. The copy is whole
/// when its file appears. Throws StoreError; refuses to write over a file.
void backup_database(const std::filesystem::path& database, const std::filesystem::path& copy);

/// Puts a backup in the place of a database, which is kept beside it as "<database>.replaced" (an
/// older one of that name goes). Throws StoreError and changes nothing when a server runs on the
/// database, or the backup is damaged, inconsistent, newer than this program or another program's.
void restore_database(const std::filesystem::path& copy, const std::filesystem::path& database);

/// What is wrong with a database, one sentence each; empty when all is well: SQLite's integrity and
/// foreign keys, revisions numbered without gaps with the last one present, content hashes and
/// properties computed again, every body a message that bears its resource's name, states of
/// simulations that agree with their results, histories of equal columns. Also while a server runs.
/// Throws StoreError when it cannot be opened or read.
std::vector<std::string> check_database(const std::filesystem::path& database);

}  // namespace tribodyn::server
