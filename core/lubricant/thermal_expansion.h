#pragma once

#include <span>

#include "core/lubricant/base_oil.h"

namespace tribodyn {

/// K_1 of the lubricating-oil group of ASTM D1250 (API MPMS 11.1, table 54D) [kg/(m3 K)]; K_0 = 0.
inline constexpr double kLubricatingOilExpansion = 0.6278;

struct DensityPoint {
  double temperature;  ///< [K]
  double density;      ///< [kg/m3]
};

/// Eq 26, rho = density_at_zero_kelvin + slope T, with the standard uncertainties of both.
struct DensityLaw {
  double density_at_zero_kelvin;         ///< [kg/m3]
  double slope;                          ///< [kg/(m3 K)], negative
  double density_at_zero_uncertainty;    ///< [kg/m3]; fully correlated with that of the slope
  double slope_uncertainty;              ///< [kg/(m3 K)]
  double root_mean_square_residual = 0;  ///< of a fit [kg/m3]
};

/// Density [kg/m3] at a temperature [K] of a lubricating oil of density_15 at 15 C, ASTM D1250-80:
///
///   rho = rho_15 exp(-a dT (1 + 0.8 a dT)),   a = K_1/rho_15,   dT = T - 288.15 K.
///
/// Stated for rho_15 of 800 to 1164 kg/m3 and -20 to 150 C.
double expanded_density(double density_15, double temperature);

/// Eq 26 through the density at 15 C and expanded_density at 100 C: within 0.13 % of it from -10 to
/// 150 C. Slope about -0.64 kg/(m3 K) for any oil of 850 to 950 kg/m3 (the paper's: -0.6323).
/// Standard uncertainty of the slope (assumed): 5 % for hydrocarbons, 15 % for esters, polyglycols
/// and unknown classes, which D1250 does not cover.
/// Throws Refusal DENSITY_OUT_OF_RANGE for a density outside 600 to 1500 kg/m3.
DensityLaw density_law(double density_15, BaseOilClass base_oil);

/// Eq 26 by least squares through measured densities: at least two temperatures 1 K apart. With one
/// temperature the slope is taken as above.
/// Throws Refusal DENSITY_OUT_OF_RANGE (naming the row: density outside 600 to 1500 kg/m3 or
/// temperature outside 200 to 620 K), DENSITY_TABLE_EMPTY, or DENSITY_RISES when the fitted slope
/// is not negative.
DensityLaw density_law(std::span<const DensityPoint> points, BaseOilClass base_oil);

}  // namespace tribodyn
