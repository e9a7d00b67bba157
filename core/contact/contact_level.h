#pragma once

#include "core/contact/mean_shear_stress.h"

namespace tribodyn {

/// Quantities of a model through which its parameters act on a contact: one contact is
/// differentiated by these, and by the parameters through the chain rule. In the notation of
/// ContactConstants, ContactParametersOf and ShearLaw.
enum ContactLevel {
  kLevelRmsHeight,          ///< sigma_G [m]
  kLevelTribofilmStrength,  ///< tau_0 [Pa]
  kLevelAsperityFriction,   ///< zeta [-]
  kLevelOilConductivity,    ///< k_f [W/(m K)]
  kLevelInletTemperature,   ///< T_in [K]
  kLevelLogFilm,
  kLevelLogThermalLoading,
  kLevelReducedModulus,  ///< E' [Pa]
  kLevelAsperityLoadFactor,
  kLevelAsperityAreaFactor,
  kLevelConductanceFactor1,
  kLevelConductanceFactor2,
  kLevelLogVogelPrefactor,  ///< from here on those of log_stress()
  kLevelLogRelaxationTime,
  kLevelShiftReference,
  kLevelVogelCoefficient,
  kLevelVogelReference,
  kLevelThinningAlpha,
  kLevelThinningBeta,
  kLevelDensityAtZeroKelvin,
  kLevelDensitySlope,
  kLevelGrowth,  ///< the arguments of MeanShearStress::by_growth but the first one
  kLevelLimitAtZeroPressure = kLevelGrowth + kGrowthArguments - 1,  ///< tau_L0 [Pa]
  kLevelLimitCoefficient,                                           ///< gamma_L [-]
  kContactLevels
};

/// The levels of the contact itself, and those of the stress without pressure.
inline constexpr int kDirectLevels = kLevelLogVogelPrefactor;
inline constexpr int kStressLevels = kLevelGrowth - kLevelLogVogelPrefactor;

}  // namespace tribodyn
