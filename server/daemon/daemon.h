#pragma once

#include <csignal>

#include "server/daemon/settings.h"
#include "server/transport/listen_address.h"

namespace tribodyn::server {

/// Serves until one of the signals, which every thread must have blocked, tells it to stop. The
/// exit code. Throws StoreError and ListenError.
int serve(const Settings& settings, const ListenAddress& address, const sigset_t& signals);

/// Says on standard error what would keep a server from starting; the exit code that it would end
/// with.
int check(const Settings& settings);

}  // namespace tribodyn::server
