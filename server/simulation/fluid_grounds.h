#pragma once

#include <string>

#include "core/lubricant/fluid_grounds.h"
#include "tribodyn/v1/lubricants.pb.h"

namespace tribodyn::server {

/// What the laws of a lubricant rest on, by provenance and measurements.
FluidGrounds fluid_grounds(const v1::Lubricant& lubricant);

/// The same as a line for the input hash: two lubricants of equal numbers that were measured in
/// different ranges are warned of different things.
std::string text_of(const FluidGrounds& grounds);

}  // namespace tribodyn::server
