#pragma once

#include "server/application/application.h"
#include "server/application/call_context.h"
#include "server/application/outcome.h"
#include "tribodyn/v1/schemas.pb.h"

namespace tribodyn::server {

/// The table of constraints and the words that texts may hold.
Outcome<v1::Schema> get_schema(Application& application, const v1::GetSchemaRequest& request,
                               const CallContext& call = {});

}  // namespace tribodyn::server
