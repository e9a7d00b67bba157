#pragma once

#include <csignal>
#include <vector>

#include "server/daemon/settings.h"
#include "server/transport/listen_address.h"

namespace tribodyn::server {

/// Serves until one of `signals` arrives. Every thread must have blocked them. Returns the exit
/// code. Throws StoreError and ListenError.
int serve(const Settings& settings, const std::vector<ListenAddress>& addresses,
          const sigset_t& signals);

/// Returns the addresses of gRPC, and checks those of REST. Throws ListenError.
std::vector<ListenAddress> listen_addresses(const Settings& settings);

/// Checks settings, database and golden case. Prints everything that would prevent a start to
/// standard error. Returns the exit code that the server would return.
int check(const Settings& settings);

}  // namespace tribodyn::server
