// Friction of one lubricated flank contact, written independently of the product straight from
// equations 12-44 of Paouris et al., "Inefficiency Predictions in a Hypoid Gear Pair through
// Tribodynamics Analysis" (equation numbers below are theirs), with these corrections: squared
// ellipticity times eps in eq 20 and Rx/Ry in eq 22, (ln eta0 + 9.67) in eqs 31-32, exact asperity
// integrals instead of the polynomials of eqs 43-44, atan2 in eq 17.
//
// SI units, temperatures in kelvin. Not valid for a flank whose surface is at rest (eq 35).
// Objects are immutable after construction and may be shared between threads.
#pragma once

#include <vector>

#include "yardstick_numerics.h"

namespace tribodyn::yardstick {

/// Lubricant: eqs 24-26, 31-34 and the limiting shear stress below eq 23.
struct Lubricant {
  double vogel_prefactor = 0.0;                       ///< eta_0,ref of eq 34, Pa s
  double vogel_temperature_parameter = 0.0;           ///< A_1, K
  double vogel_reference_temperature = 0.0;           ///< T_0,ref, K
  double pressure_viscosity_coefficient = 0.0;        ///< alpha*, 1/Pa, at the temperature below
  double pressure_viscosity_temperature = 313.15;     ///< K
  double relaxation_time = 0.0;                       ///< lambda of eq 24, s
  double havriliak_negami_alpha = 0.0;                ///< -
  double havriliak_negami_beta = 0.0;                 ///< -
  double shear_reference_temperature = 343.15;        ///< T_ref of eq 25, K
  double limiting_shear_stress_at_zero_pressure = 0;  ///< tau_L,0 > 0, Pa
  double limiting_shear_stress_slope = 0.0;           ///< gamma_L, -
  double density_slope = 0.0;                         ///< eq 26, kg/(m3 K)
  double density_intercept = 0.0;                     ///< eq 26, kg/m3
  double thermal_conductivity = 0.0;                  ///< k_f, W/(m K)
};

/// Flank material: eqs 13 and 35.
struct Solid {
  double youngs_modulus = 0.0;        ///< E, Pa
  double poisson_ratio = 0.0;         ///< nu, -
  double thermal_conductivity = 0.0;  ///< k_s, W/(m K)
  double density = 0.0;               ///< rho_s, kg/m3
  double specific_heat = 0.0;         ///< c_p,s, J/(kg K)
};

/// Run-in surface and tribofilm: eqs 40-42.
struct Surface {
  double asperity_density = 0.0;           ///< eta_G, 1/m2
  double asperity_radius = 0.0;            ///< beta_G, m
  double roughness = 0.0;                  ///< sigma_G, composite RMS, m
  double tribofilm_shear_strength = 0.0;   ///< tau_0, Pa
  double boundary_friction_coefficient{};  ///< zeta, -
};

struct FrictionOptions {
  bool isothermal = false;              ///< T_c = T_in
  bool newtonian = false;               ///< F = 1 in eq 23
  bool houpert_pressure_index = false;  ///< Z from eq 32; alpha* is then the slope at zero pressure
  bool elliptic_integral_hertz = false;  ///< exact Hertz instead of eqs 21-22
  /// Eq 12 times the film reduction by shear heating of the inlet: Gupta and others, Tribol. Trans.
  /// 35 (1992) 269-274, its numerator at least 1/2.
  bool inlet_shear_heating = false;
  /// Gauss-Legendre nodes on every piece of the mean-stress integral.
  int quadrature_nodes = 16;
};

/// Load and kinematics of one contact. x is the direction of R_zx, y that of R_zy.
struct ContactInput {
  double load = 0.0;               ///< W, N
  double radius_x = 0.0;           ///< R_zx, m
  double radius_y = 0.0;           ///< R_zy, m
  double pinion_velocity_x = 0.0;  ///< u_s,p, m/s
  double pinion_velocity_y = 0.0;  ///< v_s,p, m/s
  double gear_velocity_x = 0.0;    ///< u_s,g, m/s
  double gear_velocity_y = 0.0;    ///< v_s,g, m/s
};

struct ContactResult {
  double film_load = 0.0;                  ///< W_EHL, N
  double asperity_load = 0.0;              ///< W_asp of eq 41, N
  double film_area = 0.0;                  ///< A_EHL, m2
  double asperity_area = 0.0;              ///< A_asp of eq 42, m2
  double semi_major_axis = 0.0;            ///< a_c, m
  double semi_minor_axis = 0.0;            ///< b_c, m
  double maximum_pressure = 0.0;           ///< p_max of eq 19, Pa
  double entrainment_angle = 0.0;          ///< theta, rad
  double entrainment_radius = 0.0;         ///< R_e of eq 15, m
  double side_radius = 0.0;                ///< R_s of eq 16, m
  double entrainment_speed = 0.0;          ///< U_eff of eq 17, m/s
  double sliding_speed = 0.0;              ///< V_s, m/s
  double central_film_thickness = 0.0;     ///< h_cen of eq 12, m
  double film_parameter = 0.0;             ///< lambda_s = h_cen / sigma_G, -
  double shear_rate = 0.0;                 ///< eq 18, 1/s; infinite without a film
  double temperature = 0.0;                ///< T_c of eq 38, K
  double flash_temperature_rise = 0.0;     ///< eq 39, K
  double film_temperature_rise = 0.0;      ///< eq 39, K
  double pinion_active_length = 0.0;       ///< l_p of eq 36, m
  double gear_active_length = 0.0;         ///< l_g of eq 36, m
  double film_thermal_resistance = 0.0;    ///< R_cf of eq 35, K/W
  double pinion_thermal_resistance = 0.0;  ///< R_fp of eq 35, K/W
  double gear_thermal_resistance = 0.0;    ///< R_fg of eq 35, K/W
  double heat_partition = 0.0;             ///< a_h of eq 37, -
  double mean_shear_stress = 0.0;          ///< tau-bar of eq 27, Pa
  double viscous_friction = 0.0;           ///< F_v of eq 27, N
  double boundary_friction = 0.0;          ///< F_b of eq 40, N
  double friction = 0.0;                   ///< F_fr of eq 28, N
  double heat_rate = 0.0;                  ///< F_fr V_s, W
  int limiting_stress_switches = 0;        ///< pressures where tau reaches tau_L
};

/// F_n(l) = (2 pi)^(-1/2) int_l^inf (s - l)^n exp(-s^2/2) ds by direct quadrature; n > -1, l >= 0.
double asperity_integral(double order, double film_parameter);

/// Friction of a flank contact for one lubricant, pair of materials, surface and sump temperature.
class ContactFriction {
 public:
  /// `inlet_temperature_rise` is eq 14. Throws std::invalid_argument if eq 33 has no solution Z.
  ContactFriction(const Lubricant& lubricant, const Solid& pinion_solid, const Solid& gear_solid,
                  const Surface& surface, double sump_temperature, double inlet_temperature_rise,
                  const FrictionOptions& options = {});
  /// The same with both flanks of one material.
  ContactFriction(const Lubricant& lubricant, const Solid& solid, const Surface& surface,
                  double sump_temperature, double inlet_temperature_rise,
                  const FrictionOptions& options = {})
      : ContactFriction(lubricant, solid, solid, surface, sump_temperature, inlet_temperature_rise,
                        options) {}

  /// A load of zero or less gives a result of zeros at inlet temperature.
  ContactResult evaluate(const ContactInput& input) const;

  double inlet_temperature() const { return inlet_temperature_; }  ///< T_in, K
  double inlet_viscosity() const { return inlet_viscosity_; }      ///< eta_0(T_in), Pa s
  /// alpha*(T_in), 1/Pa
  double inlet_pressure_viscosity_coefficient() const { return inlet_alpha_; }
  double pressure_viscosity_index() const { return pressure_index_; }  ///< Z, -
  double reduced_modulus() const { return reduced_modulus_; }          ///< E' of eq 13, Pa

  /// Mean of min(tau(p), tau_L(p)) over the Hertz ellipse at uniform temperature: eqs 19, 23-27.
  /// `switches`, if not null, receives the number of pressures where tau reaches tau_L.
  double mean_shear_stress(double maximum_pressure, double shear_rate, double temperature,
                           int* switches = nullptr) const;

 private:
  double ambient_viscosity(double temperature) const;
  double shear_thinning(double shear_rate, double temperature) const;
  double mean_limiting_shear_stress(double maximum_pressure) const;
  void set_ellipse(const ContactInput& input, double film_load, ContactResult* result) const;
  void share_load(const ContactInput& input, ContactResult* result) const;
  void set_thermal_network(const ContactInput& input, ContactResult* result) const;
  void solve_temperature(ContactResult* result) const;

  Lubricant lubricant_;
  Solid pinion_solid_, gear_solid_;
  Surface surface_;
  FrictionOptions options_;
  GaussLegendreRule rule_;
  double inlet_temperature_;
  double reduced_modulus_;
  double pressure_index_;
  double inlet_viscosity_;
  double inlet_alpha_;
};

}  // namespace tribodyn::yardstick
