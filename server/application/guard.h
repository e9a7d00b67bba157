#pragma once

#include "google/rpc/status.pb.h"
#include "server/application/outcome.h"

namespace tribodyn::server {

/// Returns the error for the exception that is being handled; call it in a catch block. Logs
/// failures of the database, and what() of an unexpected exception.
google::rpc::Status error_of_exception();

/// Runs `body` and turns every exception into an error.
template <class Message, class Body>
Outcome<Message> guarded(const Body& body) {
  try {
    return body();
  } catch (...) {
    return error_of_exception();
  }
}

}  // namespace tribodyn::server
