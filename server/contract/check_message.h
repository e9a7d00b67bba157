#pragma once

#include <google/protobuf/message.h>

#include <string>

#include "server/contract/violations.h"

namespace tribodyn::server {

/// Meaning of an unset parameter that the model needs.
enum class Missing {
  kViolation,
  kAllowed,  ///< the server computes it later
};

/// Checks every number, enum and text in a message and its nested messages against the table of
/// constraints. A number must be finite and inside its allowed range, an enum value must exist, and
/// a text must not be too long. Adds all violations in field order. A number without a row in the
/// table must only be finite. Other unset optional fields, unset messages and output-only fields
/// are not checked.
void check_message(const google::protobuf::Message& message, const std::string& path,
                   Violations& violations, Missing missing = Missing::kViolation);

/// Checks the number of elements of a top-level list of a request against its row in the table of
/// constraints.
void check_size(const google::protobuf::Message& request, const std::string& list,
                Violations& violations);

/// Checks that the value of an enum field of a request exists.
void check_choice(const google::protobuf::Message& request, const std::string& field,
                  Violations& violations);

/// Returns the path of the first number that is not finite, or an empty string if there is none.
/// Two numbers may be infinite: a shear rate without film, and the thermal resistance of a surface
/// at rest.
std::string first_not_finite(const google::protobuf::Message& message);

}  // namespace tribodyn::server
