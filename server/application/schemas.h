#pragma once

#include "server/application/application.h"
#include "server/application/call_context.h"
#include "server/application/outcome.h"
#include "tribodyn/v1/schemas.pb.h"

namespace tribodyn::server {

/// Returns the constraints of fields, and the lists of words that text fields accept.
Outcome<v1::Schema> get_schema(Application& application, const v1::GetSchemaRequest& request,
                               const CallContext& call = {});

}  // namespace tribodyn::server
