#pragma once

#include <array>

#include "core/lubricant/vogel_fit.h"

namespace tribodyn {

/// Vogel parameters of a drawn fluid.
struct VogelDraw {
  double viscosity_prefactor;      ///< eta_ref [Pa s]
  double temperature_coefficient;  ///< A_1 [K]
  double reference_temperature;    ///< T_0 [K]
};

/// Eq 34 with fitted parameters that err as their covariance says, `deviations` standard normal.
/// ln eta at 40 C, ln eta at 100 C and T_0 are drawn as jointly normal (both temperatures rise with
/// a T_0 above 0 C), and the law goes through them: its parameters depend on one another far from
/// linearly. T_0 stays 20 K below the colder one.
VogelDraw drawn_vogel(const VogelFit& fit, const std::array<double, 3>& deviations);

/// Eq 26 of a drawn fluid.
struct DensityDraw {
  double density_at_zero_kelvin;  ///< [kg/m3]
  double slope;                   ///< [kg/(m3 K)]
};

/// The error of the slope turns the line about a density: the one at `pivot` [K]. That density has
/// the rest of the stated variance of the intercept as its own. All uncertainties in the unit of
/// their value.
DensityDraw drawn_density(const DensityDraw& law, double density_at_zero_uncertainty,
                          double slope_uncertainty, double pivot,
                          const std::array<double, 2>& deviations);

}  // namespace tribodyn
