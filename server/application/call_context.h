#pragma once

#include <string>

#include "server/application/grant.h"
#include "server/contract/resource_names.h"
#include "server/storage/call_limits.h"

namespace tribodyn::server {

/// What a use case knows about its call: who calls, on whose behalf, and for how long the client
/// waits. The default is a call of this process, which waits without limit.
struct CallContext {
  GrantPointer grant = owner_grant();     ///< who calls, and what that principal may do
  std::string project = kDefaultProject;  ///< of the request (request_project.h)
  std::string client = {};                ///< name of the client; clients share the processors
  std::string request_id = {};            ///< identifies the call in log lines
  CallLimits limits = {};          ///< deadline of the call, and whether the client cancelled
  bool sends_wire_format = false;  ///< true: the transport reads no field of the answer
};

/// Returns whose share of threads and processors pays for a call. The owner's programs are told
/// apart by the names that they give themselves.
inline const std::string& payer(const CallContext& call) {
  return call.grant->principal == kOwner ? call.client : call.grant->principal;
}

}  // namespace tribodyn::server
