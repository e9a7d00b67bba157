#pragma once

#include <string>

#include "tribodyn/v1/simulations.pb.h"

namespace tribodyn::client {

/// A finished curve with plausible, made-up numbers: 20 to 140 km/h by 5, contact loss at 65 to 80.
v1::Simulation sample_curve(const std::string& lubricant, double level);

/// A finished operating point with every optional part present.
v1::Simulation sample_point();

/// Two mesh cycles of time, one scalar and three flank columns.
v1::History sample_history();

}  // namespace tribodyn::client
