#pragma once

#include <vector>

#include "server/application/method_table.h"
#include "server/transport/http/media_types.h"

namespace tribodyn::server {

/// Returns the forms in which a method answers, the usual one first.
std::vector<Form> forms_of(const Method& method);

}  // namespace tribodyn::server
