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

/// Highest contact temperature of an answer [K]: steel melts at about 1800 K, and oil decomposes
/// far below.
inline constexpr double kHottestContact = 1800;

/// Solves the contact with the core's kernel. Throws Refusal if the kernel refuses the contact or
/// if it is hotter than kHottestContact.
v1::EvaluateContactResponse evaluate_contact(const v1::EvaluateContactRequest& request,
                                             const v1::Lubricant& lubricant);

}  // namespace tribodyn::server
