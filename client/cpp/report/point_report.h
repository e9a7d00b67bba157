#pragma once

#include <string>

#include "client/cpp/report/result_details.h"
#include "tribodyn/v1/simulations.pb.h"

namespace tribodyn::client {

/// Returns one operating point that has succeeded. Where no steady state was found it shows the
/// solver's statistics whatever `details` is.
std::string point_report(const v1::Simulation& simulation, const ResultDetails& details);

}  // namespace tribodyn::client
