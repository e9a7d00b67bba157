#pragma once

#include <filesystem>

#include "server/storage/token_table.h"

namespace tribodyn::server {

/// Returns "<database>.token".
std::filesystem::path owner_token_file(const std::filesystem::path& database);

/// Returns a new secret of a token: "tribodyn_" and 64 hex digits of random bytes.
std::string new_secret();

/// Writes the secret of the owner to owner_token_file(), readable by the owner only. Replaces the
/// file. Throws StoreError.
void write_owner_token(const std::filesystem::path& database, const std::string& secret);

/// Makes the owner's token and its file if there is no file; accepts the secret of a file that the
/// database has no token of. Throws StoreError if others may read the file, and if it cannot be
/// read or written.
void provide_owner_token(TokenTable& tokens, const std::filesystem::path& database,
                         Microseconds now);

}  // namespace tribodyn::server
