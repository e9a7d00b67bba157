#pragma once

namespace tribodyn {

/// Greenwood-Tripp description of the composite rough surface (eqs 41, 42, 48).
struct Roughness {
  double asperity_density;      ///< eta_G [1/m2]
  double asperity_radius;       ///< beta_G, mean summit radius [m]
  double composite_rms_height;  ///< sigma_G [m]
};

/// Boundary friction of eq 40: F_b = tau_0 A_asp + zeta W_asp.
struct BoundaryFriction {
  double tribofilm_shear_strength;       ///< tau_0 [Pa]
  double asperity_friction_coefficient;  ///< zeta [-]
};

/// The solid under the flanks; both members are made of it.
struct Solid {
  double youngs_modulus;          ///< E [Pa]
  double poissons_ratio;          ///< nu [-]
  double thermal_conductivity;    ///< k_s [W/(m K)]
  double density;                 ///< rho_s [kg/m3]
  double specific_heat_capacity;  ///< c_p,s [J/(kg K)]
};

}  // namespace tribodyn
