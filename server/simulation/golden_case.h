#pragma once

#include <string>

#include "server/simulation/compute.h"

namespace tribodyn::server {

/// Returns an operating point with known figures. A processor, library or build that computes other
/// figures must not compute for a server. Takes about 0.1 s.
internal::v1::ComputeTask golden_task();

/// Compares an executor's result of golden_task() with the known figures. Returns an empty string
/// if all agree, else a sentence that names the one that differs.
std::string check_golden_result(const internal::v1::ComputeResult& result);

/// Computes golden_task() on this thread and checks it.
std::string check_golden_case(const StudyFunctions& studies = {});

}  // namespace tribodyn::server
