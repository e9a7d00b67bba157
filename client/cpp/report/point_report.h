#pragma once

#include <string>

#include "tribodyn/v1/simulations.pb.h"

namespace tribodyn::client {

/// Returns everything about one operating point that has succeeded. With `shows_assumptions` it
/// lists the assumptions instead of counting them.
std::string point_report(const v1::Simulation& simulation, bool shows_assumptions);

}  // namespace tribodyn::client
