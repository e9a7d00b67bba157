#pragma once

#include <string>

#include "server/storage/call_limits.h"

namespace tribodyn::server {

/// What a use case knows of the call that it answers. The default is a call of this process, which
/// waits for ever.
struct CallContext {
  std::string principal = "local";  ///< who calls; there is one principal only
  std::string project = "default";  ///< whose resources are meant; there is one project only
  std::string client = {};          ///< shares the processors with the other clients
  std::string request_id = {};      ///< names the call in log lines
  CallLimits limits = {};           ///< until when, and whether still, the client waits
};

}  // namespace tribodyn::server
