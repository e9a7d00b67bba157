#pragma once

#include <string>
#include <vector>

#include "client/cpp/text/output.h"
#include "tribodyn/v1/simulations.pb.h"

namespace tribodyn::client {

/// Simulations that have ended, in any format. Tables and CSV show those that succeeded; JSON shows
/// all, as one Simulation when `alone`, else as a ListSimulationsResponse.
std::string results_text(const std::vector<v1::Simulation>& simulations, OutputFormat format,
                         bool alone, bool shows_assumptions);

}  // namespace tribodyn::client
