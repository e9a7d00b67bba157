#pragma once

#include <optional>
#include <span>
#include <string>

#include "core/lubricant/vogel_fit.h"

namespace tribodyn {

/// The most that a gear oil may have at the temperature of its W grade [Pa s]: SAE J306.
inline constexpr double kColdViscosityLimit = 150;

/// Grade of a gear oil by SAE J306_201902.
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
/// | W grade | 150 Pa s at or below | at 100 C, at least |
/// |---------|----------------------|--------------------|
/// | 70W     | -55 C                | 3.8 mm2/s          |
/// | 75W     | -40 C                | 3.8 mm2/s          |
/// | 80W     | -26 C                | 8.5 mm2/s          |
/// | 85W     | -12 C                | 11.0 mm2/s         |
///
/// The others by mm2/s at 100 C, each up to but without the next: 65 from 3.8, 70 from 5.0, 75 from
/// 6.5, 80 from 8.5, 85 from 11.0, 90 from 13.5, 110 from 18.5, 140 from 24.0, 190 from 32.5, 250
/// from 41.0. Against the 2005 edition 65, 70 and 75 are new, 80 starts at 8.5 instead of 7.0, and
/// so does 80W, and 70W and 75W start at 3.8 instead of 4.1. Source: SAE J306_201902, table 1, as
/// oil suppliers print it.
///
/// Never throws: nonsense gives an empty designation and a note.
GearViscosityGrade gear_viscosity_grade(std::optional<double> kinematic_viscosity_100,
                                        std::span<const ViscosityPoint> cold_viscosities);

/// The W grade that a temperature [K] at which the oil reaches 150 Pa s would earn; empty for none.
std::string low_temperature_grade_of(double temperature_of_150_pascal_seconds,
                                     double kinematic_viscosity_100);

}  // namespace tribodyn
