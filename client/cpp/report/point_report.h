#pragma once

#include <string>

#include "tribodyn/v1/simulations.pb.h"

namespace tribodyn::client {

/// Everything about one operating point that has succeeded, for a person. `shows_assumptions`
/// prints the whole ledger instead of counts.
std::string point_report(const v1::Simulation& simulation, bool shows_assumptions);

}  // namespace tribodyn::client
