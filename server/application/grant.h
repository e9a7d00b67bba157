#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <set>
#include <string>

#include "server/application/quota.h"
#include "server/storage/stored_token.h"

namespace tribodyn::server {

/// Principal of the owner of the server: whoever may read its database anyway.
inline constexpr char kOwner[] = "owner";

/// What one principal may do. Calls and streams share the grant that they began with.
struct Grant {
  std::string principal = kOwner;
  Scope scope = Scope::kAdmin;
  std::set<std::string> projects = {};  ///< empty: all
  std::optional<Microseconds> expire_time = {};
  Quota quota = {};  ///< the owner has none
  mutable Allowance allowance;
  mutable std::atomic<bool> is_revoked = false;

  bool is_valid(Microseconds now) const {
    return !is_revoked && (!expire_time || now < *expire_time);
  }
  bool covers(const std::string& project) const {
    return projects.empty() || projects.contains(project);
  }
};

using GrantPointer = std::shared_ptr<const Grant>;

/// Returns the grant of the owner, which is also that of calls within this process.
inline const GrantPointer& owner_grant() {
  static const GrantPointer kGrant = std::make_shared<Grant>();
  return kGrant;
}

}  // namespace tribodyn::server
