#pragma once

#include <cstddef>

#include "server/simulation/point_evaluation.h"
#include "server/simulation/simulation_inputs.h"
#include "tribodyn/v1/simulations.pb.h"

namespace tribodyn::server {

/// Estimates the cost of a simulation before it runs. The figures by speed, tolerance and range of
/// a curve were measured on the paper's axle, where the estimate is correct within a factor of
/// three (measured by service_benchmark). It is too low if shooting finds no attracting response
/// although the load holds the flanks together, and the march takes over: by up to 0.3 s for each
/// point.
v1::CostEstimate estimate_cost(const SimulationInputs& inputs);

/// Estimates the cost of points by screen_point(), for all candidates and conditions. Right within
/// a factor of three.
v1::CostEstimate estimate_screening_cost(const PointEvaluation& points);

/// Estimates the cost of running candidates on a rig at `conditions` of so many temperatures.
v1::CostEstimate estimate_rig_cost(int candidates, std::size_t temperatures, int conditions);

}  // namespace tribodyn::server
