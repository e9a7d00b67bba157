#pragma once

#include <functional>

#include "tribodyn/v1/contacts.pb.h"

namespace tribodyn::server {

/// Computes the figures of a contact with a lubricant. May throw Refusal.
using SolveContact = std::function<v1::EvaluateContactResponse(const v1::Lubricant&)>;

/// Adds the uncertainty that the stated uncertainties of a complete lubricant make of each figure
/// of `response`, by contacts of `draws` drawn lubricants, and what the inputs share of the
/// variance of the friction coefficient. A draw that the model refuses is left out.
void add_uncertainties(const v1::Lubricant& lubricant, int draws, const SolveContact& solve,
                       v1::EvaluateContactResponse& response);

}  // namespace tribodyn::server
