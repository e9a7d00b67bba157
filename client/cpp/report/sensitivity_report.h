#pragma once

#include <string>
#include <vector>

#include "client/cpp/text/csv.h"
#include "tribodyn/v1/results.pb.h"
#include "tribodyn/v1/simulations.pb.h"

namespace tribodyn::client {

/// Returns the elasticities of the inefficiency by every parameter as a table with bars, largest
/// first, beside those of loss power, film ratio and contact temperature; or why there are none.
std::string sensitivity_report(const v1::PointResult& result);

/// Returns the elasticities of the inefficiency by every parameter over the speeds of a curve,
/// largest first, and why speeds have none.
std::string curve_sensitivity_report(const v1::SimulationResult& result);

/// Returns a CSV line for every parameter, with the derivatives and elasticities of every figure.
std::string sensitivity_csv(const v1::PointResult& result);

/// Returns the headers of the sensitivities of all points, "derivative.FIGURE.PARAMETER" and
/// "elasticity.FIGURE.PARAMETER", with empty cells.
CsvRow empty_sensitivity_cells(const std::vector<v1::Simulation>& simulations);
/// Fills the cells of the sensitivities that a point has.
void fill_sensitivity_cells(const v1::PointResult& result, CsvRow& cells);

}  // namespace tribodyn::client
