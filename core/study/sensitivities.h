#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/periodic/orbit_sensitivity.h"
#include "core/study/scene.h"

namespace tribodyn {

struct OperatingCondition;

/// What one scalar parameter of a point does to its figures. SI units.
struct ParameterSensitivity {
  /// "lubricant.pressure_viscosity_coefficient", ..., "solid.youngs_modulus" (of both flanks),
  /// "bath_temperature", "vehicle_speed" and "wheel_torque", or "pinion_speed" and
  /// "pinion_torque" where those are prescribed.
  std::string parameter;
  std::string unit;
  double value;
  /// By OrbitFigure: the figure's unit over the parameter's.
  std::array<double, kOrbitFigures> derivative;
};

/// The figures of a point and their derivatives by every scalar parameter of lubricant, roughness,
/// boundary film, solid and sump, by speed and by load (orbit_sensitivity.h). By the speed of a
/// vehicle the torque of eq 7 moves with it; "wheel_torque" is its derivative at constant speed.
struct PointSensitivities {
  std::array<double, kOrbitFigures> figure;
  std::vector<ParameterSensitivity> parameters;
  /// The response is at the edge of an event: flanks that hardly press, or a contact at an edge of
  /// its laws. The derivatives are those of the side that the point is on.
  bool one_sided;

  /// d ln(figure) / d ln(parameter); of the contact temperature in K.
  double elasticity(const ParameterSensitivity& of, OrbitFigure by_figure) const {
    const auto at = static_cast<std::size_t>(by_figure);
    return of.derivative[at] * of.value / figure[at];
  }
};

/// Converts the derivatives of an orbit to those by the parameters of its point, with their names,
/// units and values.
PointSensitivities point_sensitivities(const Scene& scene, const OperatingCondition& condition,
                                       const Torques& torques, const OrbitSensitivity& orbit);

}  // namespace tribodyn
