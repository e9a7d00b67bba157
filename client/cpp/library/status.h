#pragma once

#include <grpcpp/support/status.h>

#include <string>

#include "tribodyn/client/error.h"

namespace tribodyn::client {

/// The error of a call to `address`: its message, the stable reason (ErrorInfo), *every* field
/// violation (BadRequest) and when to try again (RetryInfo).
ServiceError service_error(const grpc::Status& status, const std::string& address);

/// Whether nothing was sent, so that even a call that is not idempotent may be tried again.
/// gRPC 1.51 reads errno too late after connect(): now and then a connection in progress passes for
/// a failed one (seen where /sys is not mounted, with "No such file or directory").
bool never_connected(const grpc::Status& status);

}  // namespace tribodyn::client
