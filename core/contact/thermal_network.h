#pragma once

namespace tribodyn {

/// Coleman's active length l_i of eq 36 [m]: the semi-length of the ellipse along the surface
/// velocity (velocity_x, velocity_y) [m/s]. semi_x, semi_y [m]: semi-axes along x and y (b_c and
/// a_c while R_y >= R_x). A surface at rest has no direction: the length along x.
double active_length(double semi_x, double semi_y, double velocity_x, double velocity_y);

/// The network of fig 2 and eqs 35, 37: film R_cf and moving heat sources R_fp, R_fg [K/W].
struct ThermalNetwork {
  double film_resistance;     ///< R_cf, eq 35
  double pinion_conductance;  ///< 1/R_fp, eq 35 [W/K]; 0 for a surface at rest
  double gear_conductance;    ///< 1/R_fg

  /// a_h of eq 37; 1/2 when both surfaces are at rest.
  double heat_partition() const;
  /// R_fp a_h [K/W]: flash temperature per watt (eq 39); finite unless both surfaces are at rest.
  double flash_resistance() const;
};

/// Eq 35 for one surface, as a conductance [W/K]: A k_s sqrt(U/(chi l))/1.06. The 1.06 is
/// 4 sqrt2/(3 sqrt pi) on the semi-length (Carslaw and Jaeger, band source).
/// area [m2], solid_conductivity [W/(m K)], diffusivity [m2/s], length l_i [m], speed U_tot,i
/// [m/s].
double moving_source_conductance(double area, double solid_conductivity, double diffusivity,
                                 double length, double speed);

/// (dT_oil)_av of eq 39 [K]: V_s tau_bar h_cen/(8 k_f).
double oil_temperature_rise(double sliding_speed, double mean_shear_stress, double film_thickness,
                            double oil_conductivity);

}  // namespace tribodyn
