#pragma once

#include <string>

#include "client/cpp/text/output.h"
#include "tribodyn/v1/lubricants.pb.h"

namespace tribodyn::client {

/// The comparison of two fluids.
struct FluidDifference {
  std::string text;
  bool differs = false;  ///< in any figure or parameter
};

/// Compares KV40, KV100, viscosity index, density, SAE J306 grade and every parameter: its unit,
/// its origin and the relative difference (b - a)/|a|. Rows that differ come first; equal rows
/// follow only with `shows_equal`.
FluidDifference fluid_difference(const v1::Lubricant& a, const v1::Lubricant& b, bool shows_equal,
                                 OutputFormat format);

}  // namespace tribodyn::client
