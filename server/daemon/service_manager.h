#pragma once

#include <string>

namespace tribodyn::server {

/// Sends a state such as "READY=1" to the service manager that started this process (sd_notify
/// protocol: a datagram to $NOTIFY_SOCKET). Does nothing without a service manager.
void notify_service_manager(const std::string& state);

}  // namespace tribodyn::server
