#pragma once

#include "server/application/application.h"
#include "server/application/call_context.h"
#include "server/application/outcome.h"
#include "tribodyn/v1/contacts.pb.h"

namespace tribodyn::server {

/// Solves one contact and returns the result. Stores nothing.
Outcome<v1::EvaluateContactResponse> evaluate_contact(Application& application,
                                                      const v1::EvaluateContactRequest& request,
                                                      const CallContext& call = {});

}  // namespace tribodyn::server
