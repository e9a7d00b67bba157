#pragma once

#include <string>
#include <vector>

#include "client/cpp/report/input_uncertainty.h"
#include "client/cpp/report/result_details.h"
#include "tribodyn/v1/simulations.pb.h"

namespace tribodyn::client {

/// Returns a curve as text: heading, one line per speed, warnings, provenance. `uncertainty`: of
/// its inputs; null: not asked for.
std::string curve_report(const v1::Simulation& simulation, const ResultDetails& details,
                         const CurveUncertainty* uncertainty = nullptr);

/// Returns a CSV line for every point of every simulation, of curves and of single points, with the
/// inputs that distinguish the simulations and every field of the result; sensitivities behind them
/// (sensitivity_report.h).
std::string points_csv(const std::vector<v1::Simulation>& simulations);

}  // namespace tribodyn::client
