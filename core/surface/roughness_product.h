#pragma once

#include "core/surface/surface.h"

namespace tribodyn {

/// What eta_G beta_G sigma_G is of steel on steel [-]. Source: J. A. Greenwood and J. H. Tripp,
/// Proc. Instn Mech. Engrs 185 (1970) 625-633.
inline constexpr double kLeastRoughnessProduct = 0.03;
inline constexpr double kMostRoughnessProduct = 0.05;

inline double roughness_product(const Roughness& roughness) {
  return roughness.asperity_density * roughness.asperity_radius * roughness.composite_rms_height;
}

}  // namespace tribodyn
