#pragma once

#include <string>

namespace tribodyn::server {

/// Tells the service manager that started this process how things stand, e.g. "READY=1" (sd_notify
/// protocol: a datagram to $NOTIFY_SOCKET). Without such a manager nothing happens.
void notify_service_manager(const std::string& state);

}  // namespace tribodyn::server
