#pragma once

#include "core/contact/flank_contact.h"
#include "core/contact/hertz.h"

// A rig presses two bodies together and drives each at a speed of its own, under oil of one
// temperature: ball on disc, barrelled ring on disc. Its contact is solved by FlankContactModel, as
// those of the axle are; a rig adds only what a machine sets and shows.

namespace tribodyn {

/// The specimens and their oil. SI units.
struct RigScene {
  Lubricant lubricant;
  SolidPair solids;           ///< body 1, the ball or ring, and body 2, the disc
  EffectiveRadii radii;       ///< x along the motion; a ball on a flat disc has its radius twice
  Roughness roughness;        ///< asperity_density 0: smooth specimens, without asperities
  BoundaryFriction boundary;  ///< of the surface
  ModelOptions options;
  LubricantBoundary lubricant_boundary = {};
};

/// What the machine sets at one oil temperature.
struct RigCondition {
  double load;               ///< W [N] > 0
  double entrainment_speed;  ///< U = (u_1 + u_2)/2 [m/s] > 0
  double slide_roll_ratio;   ///< (u_1 - u_2)/U [-], positive where body 1 is faster
};

/// What the machine shows, and what stands behind it. SI units, temperatures in K.
struct RigPoint {
  double traction_coefficient;        ///< F_fr/W [-] with the sign of the slide-roll ratio; 0 at 0
  double central_film_thickness;      ///< h_cen, eq 12
  double minimum_film_thickness;      ///< see minimum_film_share
  double film_ratio;                  ///< lambda_s [-]; NaN for smooth specimens
  double mean_pressure;               ///< 2/3 of the greatest
  double maximum_pressure;            ///< p_max, eq 19
  double contact_temperature;         ///< T_c, eq 38
  double flash_temperature_rise;      ///< (dT_f)_av, eq 39
  double boundary_friction_share;     ///< F_b/F_fr [-]; 0 without friction
  double limiting_stress_area_share;  ///< share of the contact area on tau_L [-]
  double inlet_heating_factor;        ///< phi_T, whether the model has it or not [-]
  double inlet_viscosity;             ///< [Pa s]
};

/// The slide-roll ratio [-] at which half of the asperities' friction of eq 40 acts in a rig: F_b
/// is multiplied by S/(S + this), so that a traction curve passes through 0 at zero sliding. Eq 40
/// has no such factor. Assumed: it takes 1 % at a slide-roll ratio of 1 %, at any speed.
inline constexpr double kBoundaryCreep = 1e-4;

/// Returns the load [N] under which the mean pressure of the dry contact by exact Hertz, 2/3 of its
/// greatest, is `mean_pressure` [Pa] > 0.
double load_of_mean_pressure(const SolidPair& solids, const EffectiveRadii& radii,
                             double mean_pressure);

/// A rig whose inlet has one temperature. Immutable, safe for concurrent use.
class Rig {
 public:
  /// `supply_temperature` [K] is that of the oil at the inlet: no rise of eq 14. Throws Refusal as
  /// FlankContactModel does.
  Rig(const RigScene& scene, double supply_temperature);

  /// Throws Refusal if the contact has no solution (reason of contact_status_name) or if it is
  /// hotter than kHottestContact (CONTACT_TOO_HOT).
  RigPoint at(const RigCondition& condition) const;

 private:
  EffectiveRadii radii_;
  bool is_smooth_;
  FlankContactModel contact_;
};

}  // namespace tribodyn
