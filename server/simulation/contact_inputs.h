#pragma once

#include <optional>

#include "server/contract/resource_names.h"
#include "server/contract/violations.h"
#include "tribodyn/v1/contacts.pb.h"

namespace tribodyn::server {

/// Checks an explicit contact and resolves its fluid. Nothing, and all violations at once, when the
/// request is not acceptable.
std::optional<v1::Lubricant> read_contact(const v1::EvaluateContactRequest& request,
                                          const ResourceLookup& lookup, Violations& violations);

/// Contact temperature beyond which an answer means nothing [K]: steel melts at about 1800 K, and
/// no oil is left at half of that.
inline constexpr double kHottestContact = 1800;

/// Solves the contact with the core's kernel. Throws Refusal, also for a refused status and for a
/// contact hotter than kHottestContact.
v1::EvaluateContactResponse evaluate_contact(const v1::EvaluateContactRequest& request,
                                             const v1::Lubricant& lubricant);

}  // namespace tribodyn::server
