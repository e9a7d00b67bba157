#pragma once

#include <grpcpp/support/status.h>

#include <string>

#include "client/cpp/failure.h"

namespace tribodyn::client {

/// A refusal in words: the message, the stable reason (ErrorInfo), *every* field violation
/// (BadRequest) with the flag that sets the field, and when to try again (RetryInfo).
std::string readable_error(const grpc::Status& status);

/// The failure that ends a command: kExitCannotConnect when nothing answered at `address`,
/// kExitFailed when the server did answer, with a refusal.
Failure to_failure(const grpc::Status& status, const std::string& address);

/// "--sump-temperature-celsius" from "simulation.sump_temperature_celsius": flags are named after
/// the fields they set.
std::string flag_of_field(const std::string& field_path);

}  // namespace tribodyn::client
