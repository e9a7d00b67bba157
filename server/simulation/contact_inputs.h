#pragma once

#include <optional>

#include "server/contract/resource_names.h"
#include "server/contract/violations.h"
#include "tribodyn/v1/contacts.pb.h"

namespace tribodyn::server {

/// Checks an explicit contact and finds its lubricant. Returns nullopt and adds all violations if
/// the request is invalid.
std::optional<v1::Lubricant> read_contact(const v1::EvaluateContactRequest& request,
                                          const ResourceLookup& lookup, Violations& violations);

/// Solves the contact with the core's kernel. Throws Refusal if the kernel refuses the contact or
/// if it is hotter than kHottestContact.
v1::EvaluateContactResponse evaluate_contact(const v1::EvaluateContactRequest& request,
                                             const v1::Lubricant& lubricant);

}  // namespace tribodyn::server
