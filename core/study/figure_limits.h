#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/lubricant/fluid_grounds.h"

namespace tribodyn {

/// Smallest film ratio at which asperities are sparse, as Greenwood and Tripp take them [-].
inline constexpr double kSparseAsperities = 0.5;
/// Film ratio below which textbooks speak of boundary lubrication [-].
inline constexpr double kBoundaryLubrication = 1;
/// Greatest pressures of the contacts at which the friction model was compared with measurements,
/// fig 5 [Pa].
inline constexpr double kLowestComparedPressure = 0.85e9, kHighestComparedPressure = 1.35e9;
/// Viscosities at the inlet at which the laws hold [Pa s], and the thickest film [m].
inline constexpr double kLeastViscosity = 1e-4, kMostViscosity = 1e6, kThickestFilm = 10e-6;
/// Beyond these no contact is lubricated: friction [-], and the hottest film [K], in which every
/// oil decomposes.
inline constexpr double kMostFriction = 1, kHottestFilm = 1000;

/// Limits of the contacts of a mesh that a user states, e.g. of a scuffing test or of a material.
/// They change no figure.
struct StatedLimits {
  std::optional<double> film_ratio_minimum;           ///< lambda_s [-]
  std::optional<double> pressure_maximum;             ///< of p_max [Pa]
  std::optional<double> contact_temperature_maximum;  ///< of T_c [K]
  std::optional<double> flash_temperature_maximum;    ///< of (dT_f)_av [K]
  std::string source;                                 ///< who states them; may be empty

  bool operator==(const StatedLimits&) const = default;
};

/// The figures of a PointResult that have limits: an extreme of each.
enum class LimitedFigure {
  kFilmRatioMinimum,           ///< [-]
  kPressureMaximum,            ///< [Pa]
  kContactTemperatureMinimum,  ///< [K]
  kContactTemperatureMaximum,  ///< [K]
  kFlashTemperatureMaximum,    ///< [K]
};

/// A limit of a figure: of the laws that it comes from, of the measurements that they were compared
/// with, or as a user states it.
struct FigureLimit {
  LimitedFigure figure;
  std::optional<double> minimum, maximum;  ///< in the unit of the figure
  std::string source;                      ///< what the limit is of
};

/// The limits of all points of a fluid, by figure.
std::vector<FigureLimit> figure_limits(const FluidGrounds& fluid, const StatedLimits& stated);

}  // namespace tribodyn
