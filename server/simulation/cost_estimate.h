#pragma once

#include <vector>

#include "tribodyn/v1/simulations.pb.h"

namespace tribodyn::server {

/// Estimates the cost of a simulation whose defaults are written out, from its study alone. The
/// figures by speed, tolerance and range of a curve were measured on the paper's axle, where the
/// estimate is correct within a factor of three (measured by service_benchmark). It is too low if
/// shooting finds no attracting response and the march takes over.
v1::CostEstimate estimate_cost(const v1::Simulation& effective);

/// Figures of screened points beside the usual ones.
struct ScreenedExtras {
  bool contact = false;
  bool elasticities = false;
};

/// Estimates the cost of points by screen_point() at these vehicle speeds [km/h], each for all
/// candidates. `effective` has the solver options. Right within a factor of three.
v1::CostEstimate estimate_screening_cost(const v1::Simulation& effective, int candidates,
                                         const std::vector<double>& speeds_kilometres_per_hour,
                                         const ScreenedExtras& extras);

/// Estimates the cost of running candidates on a rig at `conditions` of so many temperatures.
v1::CostEstimate estimate_rig_cost(int candidates, std::size_t temperatures, int conditions);

}  // namespace tribodyn::server
