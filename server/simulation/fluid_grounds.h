#pragma once

#include <string>

#include "core/lubricant/fluid_grounds.h"
#include "tribodyn/v1/lubricants.pb.h"

namespace tribodyn::server {

/// Returns the origin of a lubricant's laws, from its provenance and measurements.
FluidGrounds fluid_grounds(const v1::Lubricant& lubricant);

/// Returns the grounds as a line of the hashed inputs: lubricants with equal numbers that were
/// measured in different ranges have different warnings.
std::string text_of(const FluidGrounds& grounds);

}  // namespace tribodyn::server
