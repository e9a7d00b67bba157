#pragma once

#include <string>
#include <vector>

#include "client/cpp/commands/command.h"
#include "tribodyn/v1/simulations.pb.h"

namespace tribodyn::client {

/// Simulations that have ended, as results_text gives them; tables also say when the torque is far
/// beyond the data of the gear set, for which the gear set is fetched.
std::string shown_results(const std::vector<v1::Simulation>& simulations, Connection& connection,
                          const CommonOptions& options, bool alone, bool shows_assumptions);

}  // namespace tribodyn::client
