#pragma once

#include <optional>

#include "server/convert/resource_names.h"
#include "server/convert/violations.h"
#include "tribodyn/v1/contacts.pb.h"

namespace tribodyn::server {

/// Checks an explicit contact and resolves its fluid. Nothing, and all violations at once, when the
/// request is not acceptable.
std::optional<v1::Lubricant> read_contact(const v1::EvaluateContactRequest& request,
                                          const ResourceLookup& lookup, Violations& violations);

/// Solves the contact with the core's kernel. Throws Refusal, also for a refused status.
v1::EvaluateContactResponse evaluate_contact(const v1::EvaluateContactRequest& request,
                                             const v1::Lubricant& lubricant);

}  // namespace tribodyn::server
