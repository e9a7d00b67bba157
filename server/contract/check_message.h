#pragma once

#include <google/protobuf/message.h>

#include <string>

#include "server/contract/violations.h"

namespace tribodyn::server {

/// What an unset parameter that the model needs is.
enum class Missing {
  kViolation,
  kAllowed,  ///< something else will fill it in
};

/// Checks every number, enum and text inside a message, nested messages too, against the table of
/// constraints: finite, inside its allowed range, a value the enum has, a text of sensible length.
/// Adds all violations, in field order. A number without a row in the table is only checked to be
/// finite; other unset optional fields, unset messages and what only the server sets are left
/// alone.
void check_message(const google::protobuf::Message& message, const std::string& path,
                   Violations& violations, Missing missing = Missing::kViolation);

/// Checks how many elements a list at the top of a request has against its row in the table.
void check_size(const google::protobuf::Message& request, const std::string& list,
                Violations& violations);

/// Path of the first number that is NaN, or infinite where that has no documented meaning; empty
/// when there is none. A shear rate without film and the thermal resistance of a surface at rest
/// are infinite.
std::string first_not_finite(const google::protobuf::Message& message);

}  // namespace tribodyn::server
