#pragma once

#include <optional>
#include <span>
#include <string>

#include "core/lubricant/vogel_fit.h"

namespace tribodyn {

/// Grade of a gear oil by SAE J306 (February 2019).
struct GearViscosityGrade {
  std::string designation;             ///< "75W-90", "90", "75W", or empty
  std::string low_temperature_grade;   ///< "75W", or empty
  std::string high_temperature_grade;  ///< "90", or empty
  std::string note;  ///< why a part is missing, or what is not proven; may be empty
};

/// kinematic_viscosity_100 [m2/s]: of the fresh oil, or after the 20 h KRL shear test (CEC
/// L-45-A-99), on which the standard's limits hold for formulated oils: say which in the caller.
/// cold_viscosities: Brookfield viscosities (ASTM D2983) at low temperatures, not extrapolations.
/// A W grade is met when a measurement at its temperature or below is at most 150 Pa s, missed when
/// one at its temperature or above exceeds that, otherwise unproven; the lowest W grade met counts.
///
///   grade  150 Pa s at [C]  KV100 [mm2/s] at least     grade  KV100 [mm2/s]     grade  KV100
///   70W    -55              3.8                        65     3.8 to < 5        90     13.5 to
///   < 18.5 75W    -40              3.8                        70     5 to < 6.5        110    18.5
///   to < 24 80W    -26              8.5                        75     6.5 to < 8.5      140    24
///   to < 32.5 85W    -12              11.0                       80     8.5 to < 11 190    32.5 to
///   < 41
///                                                      85     11 to < 13.5      250    41 and
///                                                      above
///
/// Never throws: nonsense gives an empty designation and a note.
GearViscosityGrade gear_viscosity_grade(std::optional<double> kinematic_viscosity_100,
                                        std::span<const ViscosityPoint> cold_viscosities);

/// The W grade that a temperature [K] at which the oil reaches 150 Pa s would earn; empty for none.
std::string low_temperature_grade_of(double temperature_of_150_pascal_seconds,
                                     double kinematic_viscosity_100);

}  // namespace tribodyn
