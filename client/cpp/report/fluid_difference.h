#pragma once

#include <string>

#include "client/cpp/text/output.h"
#include "tribodyn/v1/lubricants.pb.h"

namespace tribodyn::client {

/// Two fluids side by side.
struct FluidDifference {
  std::string text;
  bool differs = false;  ///< in any figure or parameter
};

/// KV40, KV100, viscosity index, density, SAE J306 grade and every parameter with its unit, how it
/// is known and the relative difference (b - a)/a; what differs first, the rest only with
/// `shows_equal`.
FluidDifference fluid_difference(const v1::Lubricant& a, const v1::Lubricant& b, bool shows_equal,
                                 OutputFormat format);

}  // namespace tribodyn::client
