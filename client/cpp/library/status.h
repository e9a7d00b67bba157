#pragma once

#include <grpcpp/support/status.h>

#include <string>

#include "tribodyn/client/error.h"

namespace tribodyn::client {

/// Returns the error of a call to `address` with its message, the stable reason (ErrorInfo), every
/// field violation (BadRequest) and the pause before a retry (RetryInfo).
ServiceError service_error(const grpc::Status& status, const std::string& address);

/// Whether nothing was sent, so that even a call that is not idempotent may be retried. gRPC 1.51
/// reads errno too late after connect() and sometimes reports a connection in progress as failed
/// (seen where /sys is not mounted, with "No such file or directory").
bool never_connected(const grpc::Status& status);

}  // namespace tribodyn::client
