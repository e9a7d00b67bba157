#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/laws/lubricant.h"
#include "core/lubricant/base_oil.h"
#include "core/lubricant/base_oil_estimates.h"
#include "core/lubricant/gear_viscosity_grade.h"
#include "core/lubricant/lubricant_parameters.h"
#include "core/lubricant/thermal_expansion.h"
#include "core/lubricant/viscosity_temperature.h"
#include "core/lubricant/vogel_fit.h"

namespace tribodyn {

/// A fluid as a formulator knows it. Everything is optional; SI units; tables in any order.
struct FluidMeasurements {
  BaseOilClass base_oil = BaseOilClass::kUnspecified;
  std::optional<double> kinematic_viscosity_40;   ///< ASTM D445 at 40 C [m2/s]
  std::optional<double> kinematic_viscosity_100;  ///< ASTM D445 at 100 C [m2/s]
  /// At 100 C after the 20 h KRL shear test [m2/s]; decides the J306 grade where given.
  std::optional<double> sheared_kinematic_viscosity_100;
  std::optional<double> density_15;              ///< at 15 C [kg/m3]
  std::vector<DensityPoint> densities;           ///< others; two temperatures give the slope
  std::vector<ViscosityPoint> viscosities;       ///< dynamic
  std::vector<ViscosityPoint> cold_viscosities;  ///< Brookfield, ASTM D2983: joined to the fit
  /// A law other than Roelands's determines alpha* at 40 C, whatever is stated.
  PressureViscosityLaw pressure_viscosity_law = PressureViscosityLaw::kRoelands;
  std::array<double, kMostLawParameters> law_parameters{};
  /// Parameters stated outright: they win over everything above. The Vogel parameters and the two
  /// of the density law count only as a set; alpha* wants its temperature (else 40 C is taken).
  LubricantParameters<std::optional<KnownParameter>> stated;
};

/// Which of a fluid's measurements something is about.
enum class Measurement {
  kKinematicViscosity40,
  kKinematicViscosity100,
  kShearedKinematicViscosity100,
  kViscosity,      ///< a row of `viscosities`
  kColdViscosity,  ///< a row of `cold_viscosities`
};

/// A measured viscosity as a dynamic one, with a typical uncertainty where none is stated.
struct MeasuredViscosity {
  Measurement measurement;
  std::size_t row;  ///< of its table; 0 for a single number
  ViscosityPoint point;
};

/// A measurement that cannot be right (gross_errors.h).
struct GrossError {
  std::string code;  ///< stable UPPER_SNAKE_CASE
  Measurement measurement;
  std::size_t row;  ///< of its table; 0 for a single number
  std::string sentence;
};

struct CharacterisationWarning {
  std::string code;  ///< stable UPPER_SNAKE_CASE, listed at characterise()
  std::string
      parameter;  ///< member of LubricantParameters it concerns; empty: the fluid as a whole
  std::string sentence;
};

/// What ASTM D341 and the fitted law think of each other.
struct ViscosityLawComparison {
  double temperature;        ///< [K]
  double walther_viscosity;  ///< dynamic, by ASTM D341 and the density law [Pa s]
  double vogel_viscosity;    ///< dynamic, by eq 34 [Pa s]
};

struct CharacterisedFluid {
  Lubricant lubricant;                             ///< the values alone
  LubricantParameters<KnownParameter> parameters;  ///< the same, with where each comes from
  std::vector<CharacterisationWarning> warnings;   ///< every assumption, none silent

  /// Kinematic viscosities at 40 C and at 100 C where given, then viscosities, then
  /// cold_viscosities.
  std::vector<MeasuredViscosity> measured_viscosities;
  /// The fit to them, a residual each; empty when the Vogel parameters were stated.
  std::optional<VogelFit> viscosity_fit;
  /// Measurements that cannot be right. A fluid that has any is not to be stored.
  std::vector<GrossError> gross_errors;

  /// -10 to 150 C in steps of 10 K where both laws exist, for a fluid with kinematic viscosities at
  /// 40 and 100 C.
  std::vector<ViscosityLawComparison> walther_comparison;

  // As the fluid would be described on a data sheet: the measured value where there is one, else
  // the law's.
  double kinematic_viscosity_40;               ///< [m2/s]
  double kinematic_viscosity_100;              ///< [m2/s]
  std::optional<double> viscosity_index;       ///< ASTM D2270; absent where that is undefined
  GearViscosityGrade grade;                    ///< SAE J306, from measurements only
  double temperature_of_150_pascal_seconds;    ///< by the law, usually an extrapolation [K]
  std::string expected_low_temperature_grade;  ///< the W grade that would earn
};

/// Makes a Lubricant of what is known of a fluid. For each parameter, in this order: stated;
/// fitted to measurements; estimated from the base-oil class, with a warning.
///
/// Viscosity: kinematic viscosities at 40 and 100 C alone give the Vogel law through both, exactly,
/// whose T_0 follows ASTM D341 most closely (walther_vogel.h; 15 K of standard uncertainty,
/// assumed). As soon as any other viscosity is given, all are fitted by fit_vogel
/// (kinematic ones times density; 0.5 % for D445, 1 % for dynamic viscosities, 5 % for Brookfield
/// where no uncertainty is stated; assumed).
///
/// Warnings: BASE_OIL_UNSPECIFIED (and an estimate depends on it), PARAMETER_ESTIMATED (one per
/// parameter), ESTIMATE_OUT_OF_RANGE, DENSITY_ESTIMATED, EXPANSION_ESTIMATED,
/// VOGEL_REFERENCE_TEMPERATURE_ASSUMED, VISCOSITY_EXTRAPOLATED (nothing measured at or below 40 C,
/// or at or above 100 C), VISCOSITY_MISFIT (naming the row), VISCOSITY_INDEX_UNDEFINED,
/// VISCOSITY_INDEX_UNUSUAL (below -60 or above 300), TEMPERATURE_ASSUMED (of a stated alpha* or
/// lambda).
///
/// A measured viscosity beyond the limit of VISCOSITY_CONTRADICTED (gross_errors.h) earns no W
/// grade.
///
/// Throws Refusal FLUID_UNDERDETERMINED (not two viscosities, nor a stated Vogel law),
/// PARAMETER_INCOMPLETE (part of a set stated), PARAMETER_OUT_OF_RANGE (stated and not finite or of
/// impossible sign, or a law that does not hold at 40 and 100 C), and those of fit_vogel,
/// density_law and viscosity_temperature_line.
CharacterisedFluid characterise(const FluidMeasurements& fluid);

}  // namespace tribodyn
