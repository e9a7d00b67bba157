#pragma once

#include <string>

#include "server/simulation/compute.h"

namespace tribodyn::server {

/// An operating point whose figures are known: a processor, a library or a build that computes
/// something else must not compute for a server. About 0.1 s.
internal::v1::ComputeTask golden_task();

/// Compares what an executor made of golden_task() with the known figures. Returns an empty text if
/// all agree, else a sentence that says which does not.
std::string check_golden_result(const internal::v1::ComputeResult& result);

/// Both, on this thread.
std::string check_golden_case(const StudyFunctions& studies = {});

}  // namespace tribodyn::server
