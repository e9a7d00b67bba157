#pragma once

#include <cmath>

#include "core/contact/contact_equations.h"
#include "core/contact/specific_sliding.h"
#include "core/model_options.h"

namespace tribodyn {

using ContactConditions = ContactConditionsOf<double>;

enum class ContactStatus {
  kOk,
  kNoLoad,                      ///< W <= 0: no contact; every force is zero
  kRefusedNotFinite,            ///< an input is not finite
  kRefusedRadius,               ///< a radius is not positive
  kRefusedNegativeEntrainment,  ///< only with as_published.eq17_atan
  kRefusedUnboundedShear,       ///< zero film, sliding, and no limiting stress
  kRefusedNoLoadSharing,  ///< no root of W_EHL + W_asp = W (as_published.eq43_44 or total-load
                          ///< ellipse)
  kRefusedNoTemperature,  ///< no thermal equilibrium while the density law is positive
  kRefusedFilmOverflow,   ///< the film left the range of double precision
  kRefusedOverflow,       ///< another law left the range of double precision
};

/// Highest contact temperature of an answer about a single contact [K]: steel melts at about 1800
/// K, and oil decomposes far below.
inline constexpr double kHottestContact = 1800;

/// UPPER_SNAKE_CASE name of a status, which several statuses may share, and one sentence for a
/// person that names the law and the likely cure.
const char* contact_status_name(ContactStatus status);
const char* contact_status_sentence(ContactStatus status);

/// The figures of a contact in records and histories; symbols and equations of the paper beside
/// each. SI units.
struct ContactFigures {
  ContactStatus status = ContactStatus::kNoLoad;
  double maximum_pressure = 0;        ///< p_max, eq 19 at the centre [Pa]
  double central_film_thickness = 0;  ///< h_cen, eq 12 [m]
  double film_ratio = 0;              ///< lambda_s = h_cen / sigma_G [-]
  double shear_rate =
      0;  ///< gamma_dot, eq 18 [1/s]; infinite where the film vanishes under sliding
  double contact_temperature = 0;         ///< T_c, eq 38 [K]
  double viscous_friction = 0;            ///< F_v, eq 27 [N]
  double boundary_friction = 0;           ///< F_b, eq 40 [N]
  double friction = 0;                    ///< F_fr, eq 28 [N]
  double limiting_stress_area_share = 0;  ///< share of A_EHL that sits on tau_L [-]
  bool limiting_stress_at_centre = false;
  double mean_shear_stress = 0;       ///< tau_bar, area mean of eq 23 under the limit [Pa]
  double flash_temperature_rise = 0;  ///< (dT_f)_av, eq 39 [K]
  double friction_coefficient = 0;    ///< F_fr / W [-]
  double specific_sliding_1 = 0;      ///< see SpecificSliding [-]
  double specific_sliding_2 = 0;      ///< likewise
  double entrainment_speed = 0;       ///< U_eff, eq 17 [m/s]
  double asperity_load = 0;           ///< W_asp, eq 41 [N]
};

/// Everything about one contact.
struct ContactSolution : ContactFigures {
  double film_load = 0;                             ///< W_EHL [N]
  double ellipse_load = 0;                          ///< see SharedContact [N]
  double contact_area = 0;                          ///< A_EHL = pi a_c b_c [m2]
  double asperity_area = 0;                         ///< A_asp, eq 42 [m2]
  double semi_major_axis = 0;                       ///< a_c, eq 20 [m]
  double semi_minor_axis = 0;                       ///< b_c, eq 20 [m]
  double entrainment_angle = 0;                     ///< theta, measured from x [rad]
  double entrainment_radius = 0;                    ///< R_e, eq 15 [m]
  double side_leakage_radius = 0;                   ///< R_s, eq 16 [m]
  double sliding_speed = 0;                         ///< V_s [m/s]
  double inlet_viscosity = 0;                       ///< eta_0(T_in), eq 34 [Pa s]
  double inlet_pressure_viscosity_coefficient = 0;  ///< alpha*(T_in), eq 33 [1/Pa]
  double pressure_viscosity_index = 0;              ///< Z [-]
  double reduced_modulus = 0;                       ///< E', eq 13 [Pa]
  double oil_temperature_rise = 0;                  ///< (dT_oil)_av, eq 39 [K]
  double active_length_1 = 0;                       ///< l_p, eq 36 [m]
  double active_length_2 = 0;                       ///< l_g, eq 36 [m]
  double film_thermal_resistance = 0;               ///< R_cf, eq 35 [K/W]
  double thermal_resistance_1 = 0;   ///< R_fp, eq 35 [K/W]; infinite for a surface at rest
  double thermal_resistance_2 = 0;   ///< R_fg, eq 35 [K/W]; infinite for a surface at rest
  double heat_partition = 0;         ///< a_h, eq 37 [-]
  double heat_rate = 0;              ///< q_dot = F_fr V_s [W]
  int limiting_stress_switches = 0;  ///< radii at which the stress meets tau_L
  int thermal_roots = 1;             ///< thermal equilibria found; above 1 the coldest is returned
};

/// The friction kernel of one fluid on one surface at one sump temperature.
/// Immutable after construction; safe for concurrent use; `solve` allocates nothing and never
/// throws.
class FlankContactModel {
 public:
  /// Prepares all that does not depend on the instant: Z and alpha* (eqs 31, 32 and 33), inlet
  /// viscosity (eq 34 at T_in = bath + rise), reduced modulus, Greenwood-Tripp prefactors.
  /// bath_temperature, inlet_temperature_rise in K.
  /// Throws Refusal when a parameter is none of a fluid, material or surface (check()), when T_in
  /// is at or below the Vogel reference temperature or the oil too thick there
  /// (check_ambient_viscosity), when no Z gives alpha* back, or when a parameter is outside the
  /// law's domain.
  FlankContactModel(const Lubricant& lubricant, const SolidPair& solids, const Roughness& roughness,
                    const BoundaryFriction& boundary, double bath_temperature,
                    double inlet_temperature_rise, const ModelOptions& options);

  /// Solves load sharing (eqs 12, 20 and 41), then the shear stress and the temperature that depend
  /// on each other (eqs 23, 38 and 39), by bracketed roots.
  /// Any finite input gives a finite answer (but for the infinities documented above) or a refusal.
  ContactSolution solve(const ContactConditions& conditions) const;

  /// Fills in the figures of a contact under load that follow from its conditions, friction,
  /// temperature, film and mean shear stress: those that FlankContactBatch has no columns for.
  void complete(const ContactConditions& conditions, ContactFigures& figures) const;

  /// (dT_f)_av of eq 39 [K]: what eq 38 adds to the inlet's temperature beside the rise of the oil.
  /// Film thickness [m], mean shear stress [Pa] and contact temperature [K] are those of a
  /// solution.
  double flash_temperature_rise(const ContactConditions& conditions, double film_thickness,
                                double mean_shear_stress, double contact_temperature) const;

  /// ln(tau/tau_L) at the centre of a solved contact under load, tau the stress without limit:
  /// positive where the centre is on tau_L; infinite without sliding or without a film.
  double log_stress_over_limit(const ContactFigures& figures) const;

  /// phi_T, to what shear heating of the inlet thins the film [-], whether the options include it
  /// or not. Squares of the entrainment and sliding speeds [m2/s2], greatest pressure [Pa].
  double inlet_heating_factor(double entrainment_squared, double sliding_squared,
                              double maximum_pressure) const;

  double inlet_temperature() const { return constants_.inlet_temperature; }
  double inlet_viscosity() const { return std::exp(constants_.log_inlet_viscosity); }  ///< [Pa s]
  double pressure_viscosity_index() const { return constants_.shear.index; }
  double reduced_modulus() const { return constants_.reduced_modulus; }  ///< E', eq 13 [Pa]
  const ModelOptions& options() const { return options_; }
  const ContactParametersOf<double>& parameters() const { return parameters_; }
  const ContactConstants<double>& constants() const { return constants_; }

 private:
  ContactStatus share_load(const ContactConditions& conditions, SharedContact<double>& shared,
                           ContactSolution& out) const;
  ContactStatus heat(const ContactConditions& conditions, const SharedContact<double>& shared,
                     ContactSolution& out) const;

  ContactParametersOf<double> parameters_;
  ModelOptions options_;
  ContactConstants<double> constants_;
};

}  // namespace tribodyn
