#pragma once

#include "google/rpc/status.pb.h"
#include "server/application/outcome.h"

namespace tribodyn::server {

/// The error that a client is told of the exception that is being handled. Logs failures of the
/// database and defects; of an unexpected exception only what().
google::rpc::Status error_of_exception();

/// Runs the body of an RPC and turns every exception into an error.
template <class Message, class Body>
Outcome<Message> guarded(const Body& body) {
  try {
    return body();
  } catch (...) {
    return error_of_exception();
  }
}

}  // namespace tribodyn::server
