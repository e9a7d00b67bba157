#pragma once

#include "server/daemon/settings.h"

namespace tribodyn::server {

/// Creates, lists, revokes or rotates tokens of a database, which a server may use meanwhile: the
/// function returns when the server applies the change. Prints a new secret to standard output.
/// Returns the exit code. Throws StoreError.
int change_tokens(const Settings& settings);

}  // namespace tribodyn::server
