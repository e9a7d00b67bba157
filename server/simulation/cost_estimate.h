#pragma once

#include "tribodyn/v1/simulations.pb.h"

namespace tribodyn::server {

/// What a simulation with every default written out will take, from its study alone: typical
/// figures of the solver by speed, tolerance and spread of a curve, measured on the paper's axle.
/// Within a factor of three there (a part of service_benchmark); where shooting finds no attracting
/// response and the march takes over, it is more.
v1::CostEstimate estimate_cost(const v1::Simulation& effective);

}  // namespace tribodyn::server
