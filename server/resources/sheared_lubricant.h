#pragma once

#include <optional>

#include "tribodyn/v1/lubricants.pb.h"

namespace tribodyn::server {

/// Returns a complete lubricant as it is after the 20 h KRL shear test (CEC L-45): its measured
/// viscosities times KV100 after the test over KV100 before it, and the law of eq 34 fitted to
/// them, or, if a client stated that law, its prefactor times that ratio. The ratio is assumed at
/// all temperatures: data sheets state no other. Estimates are made anew. Returns nullopt if the
/// viscosity after the test is not measured, or if the scaled measurements are refused.
std::optional<v1::Lubricant> sheared_lubricant(const v1::Lubricant& lubricant);

}  // namespace tribodyn::server
