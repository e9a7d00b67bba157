#pragma once

#include <string>

#include "tribodyn/v1/simulations.pb.h"

namespace tribodyn::client {

/// Returns a finished curve with plausible, invented numbers: 20 to 140 km/h in steps of 5, contact
/// loss from 65 to 80 km/h.
v1::Simulation sample_curve(const std::string& lubricant, double level);

/// Returns a finished operating point with every optional part.
v1::Simulation sample_point();

/// Returns a history of two mesh cycles with time, one scalar and three flank columns.
v1::History sample_history();

}  // namespace tribodyn::client
