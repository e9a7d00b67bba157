#pragma once

#include <string>
#include <vector>

#include "client/cpp/report/input_uncertainty.h"
#include "tribodyn/client/connection.h"
#include "tribodyn/v1/simulations.pb.h"

namespace tribodyn::client {

/// Returns the figures of a succeeded point with the uncertainty of its inputs, or why there are
/// none; an empty text for a point that screened points do not stand for: no cruise, another start,
/// a march or the quasi-static model.
std::string point_uncertainty(const v1::Simulation& simulation, Connection& connection);

/// Returns the uncertainty of curves that have succeeded, by screened points at their speeds. A
/// speed at which the curve follows another branch than a screened point finds has none.
CurveUncertainties curve_uncertainties(const std::vector<v1::Simulation>& simulations,
                                       Connection& connection);

}  // namespace tribodyn::client
