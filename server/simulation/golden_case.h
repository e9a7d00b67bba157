#pragma once

#include <string>

#include "server/simulation/compute.h"

namespace tribodyn::server {

/// Computes an operating point with known figures and compares. A processor, library or build that
/// computes other figures must not serve. Takes about 0.1 s. Returns an empty string if all figures
/// agree, else a sentence that names the one that differs.
std::string check_golden_case(const StudyFunctions& studies = {});

}  // namespace tribodyn::server
