#pragma once

#include <atomic>
#include <chrono>
#include <string_view>

#include "server/application/call_context.h"

namespace tribodyn::server {

/// What a transport knows of a call in the client's own words; empty: the client says nothing.
struct CallWords {
  std::string_view client;      ///< name of the client
  std::string_view request_id;  ///< name of the call
  std::string_view peer;        ///< address, which stands for a client without a name
};

/// Returns the context of a call that ends after `left`. Words become part of log lines and are
/// cut and cleaned for that. A call without a name gets a number.
CallContext call_context(const CallWords& words, std::chrono::nanoseconds left,
                         const std::atomic<bool>& cancelled);

}  // namespace tribodyn::server
