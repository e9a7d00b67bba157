#pragma once

#include <algorithm>
#include <cmath>

#include "core/study/operating_point.h"
#include "core/study/screening.h"

namespace tribodyn {

/// Returns the largest error of the figures that the estimate covers: both inefficiencies, torque,
/// extremes of the transmission error.
inline double true_error(const PointFigures& r, const PointResult& exact) {
  const auto relative = [](double a, double b) { return std::abs(a / b - 1); };
  const Extremes& y = exact.dynamic_transmission_error;
  const double size = std::max(std::abs(y.minimum), std::abs(y.maximum));
  return std::max(
      {relative(r.inefficiency_rms.value(), exact.inefficiency_rms.value()),
       relative(r.inefficiency_energy_mean.value(), exact.inefficiency_energy_mean.value()),
       relative(r.pinion_torque, exact.pinion_torque), relative(r.wheel_torque, exact.wheel_torque),
       std::abs(r.dte_minimum - y.minimum) / size, std::abs(r.dte_maximum - y.maximum) / size});
}

inline double true_error(const PointResult& r, const PointResult& exact) {
  PointFigures figures;
  figures.inefficiency_rms = r.inefficiency_rms;
  figures.inefficiency_energy_mean = r.inefficiency_energy_mean;
  figures.pinion_torque = r.pinion_torque;
  figures.wheel_torque = r.wheel_torque;
  figures.dte_minimum = r.dynamic_transmission_error.minimum;
  figures.dte_maximum = r.dynamic_transmission_error.maximum;
  return true_error(figures, exact);
}

}  // namespace tribodyn
