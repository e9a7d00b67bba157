#pragma once

#include "core/laws/lubricant.h"

namespace tribodyn {

/// Kinematic viscosities for which the equation of ASTM D341 is stated [m2/s]: 0.21 to 2e7 mm2/s.
inline constexpr double kLowestKinematicViscosity = 0.21e-6;
inline constexpr double kHighestKinematicViscosity = 20;

struct KinematicViscosityPoint {
  double temperature;          ///< [K]
  double kinematic_viscosity;  ///< [m2/s]
};

/// The straight line of ASTM D341 (Walther 1931) through two measurements:
///
///   lg lg Z = A - B lg T,   Z = v + 0.7 + exp(-1.47 - 1.84 v - 0.51 v^2),
///
/// v in mm2/s, T in kelvin. This is the full form of D341-09 to -20 with its low-viscosity term,
/// used throughout: above 2 mm2/s, where the simplified Z = v + 0.7 is allowed too, the term is
/// below 0.03 % of Z and falls away. Kept through a point rather than as A and B, so that both
/// points come back to rounding.
struct ViscosityTemperatureLine {
  double reference_temperature;  ///< of the first point [K]
  double reference_ordinate;     ///< lg lg Z there [-]
  double slope;                  ///< B [-], positive: 2.1 (polyglycols) to 3.9 (mineral oils)
};

/// The line through two points, in either order.
/// Throws Refusal VISCOSITY_TEMPERATURE_LINE when a viscosity lies outside 0.21 to 2e7 mm2/s, a
/// temperature outside 200 to 620 K, the temperatures are less than 1 K apart, or the warmer point
/// is not the thinner one.
ViscosityTemperatureLine viscosity_temperature_line(const KinematicViscosityPoint& first,
                                                    const KinematicViscosityPoint& second);

/// Kinematic viscosity [m2/s] at a temperature [K] on the line; Z is inverted by Newton's method to
/// the last bits rather than by the approximate inverse that the standard prints.
/// The standard's range: from the cloud point to the initial boiling point; polymer-thickened oils
/// depart from the line below about -10 C (they are thicker or thinner by tens of percent at -40).
/// Throws Refusal VISCOSITY_TEMPERATURE_LINE when the result leaves 0.21 to 2e7 mm2/s.
double kinematic_viscosity(const ViscosityTemperatureLine& line, double temperature);

/// eta/rho of a lubricant [m2/s], eqs 26 and 34.
double kinematic_viscosity(const Lubricant& lubricant, double temperature);

/// The temperature [K] at which eq 34 gives a dynamic viscosity [Pa s] > eta_ref:
/// T_0 + A_1/ln(eta/eta_ref).
double temperature_of_viscosity(const Lubricant& lubricant, double viscosity);

}  // namespace tribodyn
