#include "core/surface/surface.h"

#include <algorithm>

#include "core/parameter_check.h"

namespace tribodyn {

void check(const Roughness& r) {
  ParameterCheck check;
  check.expect("asperity_density", r.asperity_density, "1/m2", Bound::kNotNegative);
  check.expect("asperity_radius", r.asperity_radius, "m", Bound::kPositive);
  check.expect("composite_rms_height", r.composite_rms_height, "m", Bound::kPositive);
  check.conclude();
}

void check(const BoundaryFriction& b) {
  ParameterCheck check;
  check.expect("tribofilm_shear_strength", b.tribofilm_shear_strength, "Pa", Bound::kNotNegative);
  check.expect("asperity_friction_coefficient", b.asperity_friction_coefficient, "1",
               Bound::kNotNegative);
  check.conclude();
}

BoundaryFriction boundary_friction(const BoundaryFriction& of_surface,
                                   const LubricantBoundary& of_lubricant,
                                   double inlet_temperature) {
  BoundaryFriction out = of_surface;
  if (of_lubricant.tribofilm_shear_strength) {
    out.tribofilm_shear_strength = *of_lubricant.tribofilm_shear_strength;
  }
  if (of_lubricant.asperity_friction_coefficient) {
    out.asperity_friction_coefficient = *of_lubricant.asperity_friction_coefficient;
  }
  const auto& table = of_lubricant.coefficient_by_temperature;
  if (table.empty()) return out;
  const auto above =
      std::upper_bound(table.begin(), table.end(), inlet_temperature,
                       [](double value, const auto& entry) { return value < entry.first; });
  if (above == table.begin() || above == table.end()) {
    out.asperity_friction_coefficient = (above == table.end() ? table.back() : *above).second;
    return out;
  }
  const auto& below = *(above - 1);
  out.coefficient_slope = (above->second - below.second) / (above->first - below.first);
  out.asperity_friction_coefficient =
      below.second + out.coefficient_slope * (inlet_temperature - below.first);
  return out;
}

void check(const Solid& s) {
  ParameterCheck check;
  check.expect("youngs_modulus", s.youngs_modulus, "Pa", Bound::kPositive);
  check.expect(s.poissons_ratio > -1 && s.poissons_ratio <= 0.5, "poissons_ratio", s.poissons_ratio,
               "1", "above -1 and at most 0.5");
  check.expect("thermal_conductivity", s.thermal_conductivity, "W/(m K)", Bound::kPositive);
  check.expect("density", s.density, "kg/m3", Bound::kPositive);
  check.expect("specific_heat_capacity", s.specific_heat_capacity, "J/(kg K)", Bound::kPositive);
  check.conclude();
}

}  // namespace tribodyn
