#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "server/storage/connection.h"
#include "server/storage/schema.h"
#include "server/storage/stored_token.h"

namespace tribodyn::server {

/// The tokens of a database, over a connection of its own: of the server, or of a command that
/// changes tokens while a server runs. Every change has a number, and the server acknowledges the
/// number of the latest change that it applies. Not safe for concurrent access. Throws StoreError.
class TokenTable {
 public:
  /// Requires a database of the present schema. Another object may have it open for writing.
  explicit TokenTable(const std::filesystem::path& database,
                      const SchemaSteps& steps = schema_steps());

  /// Returns all tokens by name and time, also those that are no longer valid.
  std::vector<StoredToken> all();

  /// Adds a token. Returns false, and adds none, if its name has a valid token.
  bool add(const StoredToken& token);
  /// Adds a token in place of the valid ones of its name, which are refused from `end` on; at once
  /// if `end` is not after the token's create_time. Returns false if the name has no valid token.
  bool replace(const StoredToken& token, Microseconds end);
  /// Revokes every token of a name. Returns the number of tokens that were valid until now.
  int revoke(const std::string& name, Microseconds now);

  /// Returns the number of the latest change. Reads no row if no connection has changed the
  /// database since the call before.
  std::int64_t change();
  std::int64_t acknowledged_change();
  void acknowledge(std::int64_t change);

  /// Returns 32 random bytes that were made with the tables: the key of page tokens.
  std::string page_token_key();

 private:
  template <class Action>
  auto translated(const Action& action);

  const std::filesystem::path path_;
  Connection connection_;
  std::int64_t seen_version_ = -1;  ///< of the database, as this connection counts
  std::int64_t seen_change_ = 0;
};

}  // namespace tribodyn::server
