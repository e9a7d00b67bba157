#pragma once

#include <string>
#include <vector>

#include "tribodyn/v1/simulations.pb.h"

namespace tribodyn::client {

/// A curve for a person: heading, one line a speed, warnings, provenance.
std::string curve_report(const v1::Simulation& simulation, bool shows_assumptions);

/// Every point of every simulation (curves and single points alike), one line each, with the inputs
/// that tell them apart and every field of the result.
std::string points_csv(const std::vector<v1::Simulation>& simulations);

}  // namespace tribodyn::client
