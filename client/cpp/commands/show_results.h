#pragma once

#include <string>
#include <vector>

#include "client/cpp/commands/command.h"
#include "client/cpp/report/input_uncertainty.h"
#include "client/cpp/report/result_details.h"
#include "tribodyn/v1/simulations.pb.h"

namespace tribodyn::client {

/// Returns results_text() of simulations that have ended. For tables it fetches the gear sets, to
/// find torques far beyond their data.
std::string shown_results(const std::vector<v1::Simulation>& simulations, Connection& connection,
                          const CommonOptions& options, bool alone, const ResultDetails& details,
                          const CurveUncertainties& uncertainties = {});

}  // namespace tribodyn::client
