#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "google/rpc/status.pb.h"
#include "server/application/grant.h"
#include "server/application/outcome.h"
#include "server/support/observers.h"

namespace tribodyn::server {

/// What a call brings to show who makes it. The transport fills it in; the default is nobody.
struct Credentials {
  bool is_owner = false;  ///< the system says so: a Unix socket that only the owner reaches
  std::string authorization = {};  ///< "Bearer SECRET", as the client sent it; may be empty
  std::string certificate = {};    ///< common name of a client's certificate that TLS verified
  std::string token_hash = {};     ///< of a session that the transport verified
};

/// Returns what the database keeps of the secret of a token.
std::string token_hash(std::string_view secret);

/// Returns token_hash() of the secret in "Bearer SECRET"; nullopt for another form.
std::optional<std::string> token_hash_of_bearer(std::string_view authorization);

/// Returns what the database keeps in place of a secret for those whose certificates have the name.
std::string certificate_hash(std::string_view name);

/// Decides who calls. Keeps all grants in memory and reads no row. Safe for concurrent access.
class Authorizer {
 public:
  /// `quota` is that of tokens without one of their own.
  explicit Authorizer(const Quota& quota = {}) : quota_(quota) {}

  /// Replaces all tokens. Grants of tokens that are no longer valid end at once; the observers are
  /// told.
  void set_tokens(const std::vector<StoredToken>& tokens, Microseconds now);

  /// Returns the grant of a call, or UNAUTHENTICATED.
  Outcome<GrantPointer> authenticate(const Credentials& credentials, Microseconds now) const;

  /// Returns the error of a caller who may not read what concerns all projects, e.g. the metrics;
  /// nullopt for others.
  std::optional<google::rpc::Status> refuse_overview(const Credentials& credentials,
                                                     Microseconds now) const;

  /// Told whenever tokens change.
  Observers& observers() { return observers_; }

 private:
  using Grants = std::map<std::string, std::shared_ptr<Grant>, std::less<>>;  ///< by hash

  const Quota quota_;
  mutable std::mutex mutex_;
  Grants grants_;  // guarded by mutex_
  Observers observers_;
};

}  // namespace tribodyn::server
