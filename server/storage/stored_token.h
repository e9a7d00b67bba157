#pragma once

#include <optional>
#include <string>
#include <vector>

#include "server/storage/times.h"

namespace tribodyn::server {

/// What a principal may do. Each scope includes those before it.
enum class Scope {
  kRead = 1,   ///< read resources, simulations and results
  kWrite = 2,  ///< change resources, and run, cancel and delete simulations
  kAdmin = 3,  ///< purge resources
};

/// A bearer token as the database has it: without the secret.
struct StoredToken {
  std::string name;  ///< of the principal
  std::string hash;  ///< SHA-256 of the secret, 64 hex digits
  Scope scope = Scope::kRead;
  std::vector<std::string> projects = {};  ///< empty: all
  Microseconds create_time = 0;
  std::optional<Microseconds> expire_time = {};  ///< from then on it is refused
  std::optional<Microseconds> revoke_time = {};  ///< set once it is revoked or replaced
  // Quotas of its own, in place of the server's.
  std::optional<double> calls_per_second = {};
  std::optional<int> streams = {};
  std::optional<double> processor_hours = {};

  bool is_valid(Microseconds now) const {
    return !revoke_time && (!expire_time || now < *expire_time);
  }
};

}  // namespace tribodyn::server
