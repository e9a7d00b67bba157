#pragma once

#include <string>

#include "server/simulation/compute.h"

namespace tribodyn::server {

/// Recomputes an operating point whose figures are known and compares: a processor, a library or a
/// build that computes something else must not serve. About 0.1 s. Empty when all agree, else a
/// sentence that says which does not.
std::string check_golden_case(const StudyFunctions& studies = {});

}  // namespace tribodyn::server
