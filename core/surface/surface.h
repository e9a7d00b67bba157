#pragma once

#include <optional>
#include <utility>
#include <vector>

namespace tribodyn {

/// Greenwood-Tripp description of the composite rough surface (eqs 41, 42, 48).
template <class Real>
struct RoughnessOf {
  Real asperity_density;      ///< eta_G [1/m2]
  Real asperity_radius;       ///< beta_G, mean summit radius [m]
  Real composite_rms_height;  ///< sigma_G [m]
};
using Roughness = RoughnessOf<double>;

/// Boundary friction of eq 40: F_b = tau_0 A_asp + zeta W_asp.
template <class Real>
struct BoundaryFrictionOf {
  Real tribofilm_shear_strength;       ///< tau_0 [Pa]
  Real asperity_friction_coefficient;  ///< zeta at the inlet temperature [-]
  double coefficient_slope = 0;        ///< d zeta/d T_in [1/K]
};
using BoundaryFriction = BoundaryFrictionOf<double>;

/// The boundary friction that a lubricant's additives bring to any surface. What is absent is the
/// surface's.
struct LubricantBoundary {
  std::optional<double> tribofilm_shear_strength;       ///< tau_0 [Pa]
  std::optional<double> asperity_friction_coefficient;  ///< zeta [-]
  /// zeta by temperature of the inlet, instead: rising temperatures [K] and coefficients; linear
  /// between, constant beyond.
  std::vector<std::pair<double, double>> coefficient_by_temperature;
};

/// The boundary friction of a lubricant on a surface at an inlet temperature [K].
BoundaryFriction boundary_friction(const BoundaryFriction& of_surface,
                                   const LubricantBoundary& of_lubricant, double inlet_temperature);

/// The material of a body in contact.
template <class Real>
struct SolidOf {
  Real youngs_modulus;          ///< E [Pa]
  Real poissons_ratio;          ///< nu [-]
  Real thermal_conductivity;    ///< k_s [W/(m K)]
  Real density;                 ///< rho_s [kg/m3]
  Real specific_heat_capacity;  ///< c_p,s [J/(kg K)]
};
using Solid = SolidOf<double>;

/// The materials of both bodies.
template <class Real>
struct SolidPairOf {
  SolidOf<Real> body_1, body_2;

  SolidPairOf() = default;
  SolidPairOf(const SolidOf<Real>& both) : body_1(both), body_2(both) {}  // NOLINT: of one material
  SolidPairOf(const SolidOf<Real>& first, const SolidOf<Real>& second)
      : body_1(first), body_2(second) {}
};
using SolidPair = SolidPairOf<double>;

/// Throw Refusal PARAMETER_OUT_OF_RANGE, all violations in one sentence, where a value is not
/// finite or of a sign that no surface and no material has. An asperity density of 0 is a smooth
/// surface.
void check(const Roughness& roughness);
void check(const BoundaryFriction& boundary);
void check(const Solid& solid);

}  // namespace tribodyn
