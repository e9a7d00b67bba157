#include "server/simulation/compared_fluid.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/numerics/square.h"
#include "core/study/warning_kinds.h"

namespace tribodyn::server {

std::optional<StatedFigures> stated_figures(const EvaluatedPoint& point) {
  if (!point.figures || !point.figures->inefficiency_energy_mean ||
      !point.figures->inefficiency_rms) {
    return std::nullopt;
  }
  constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();
  const PointFigures& f = *point.figures;
  StatedFigures out{{*f.inefficiency_energy_mean, *f.inefficiency_rms, f.mesh_loss_power,
                     f.pinion_torque, f.dte_minimum, f.dte_maximum},
                    {},
                    f.contact_loss};
  std::fill(out.value.begin() + kFilmRatio, out.value.end(), kNoNumber);
  if (f.contact) {
    out.value[kFilmRatio] = f.contact->film_ratio_minimum;
    out.value[kContactTemperature] = f.contact->contact_temperature_maximum;
    out.value[kFrictionCoefficient] = f.contact->friction_coefficient_mean;
    out.value[kPressure] = f.contact->pressure_maximum;
    out.value[kFlashTemperature] = f.contact->flash_temperature_rise_maximum;
  }
  const double relative_error = f.estimated_relative_error.value_or(0);
  for (std::size_t i = 0; i < kComparedFigures; ++i) {
    out.solver_error[i] = relative_error * std::abs(out.value[i]);
  }
  // The estimate is relative to the largest transmission error, and there is none of the contact.
  out.solver_error[kDteMinimum] = out.solver_error[kDteMaximum] =
      relative_error * std::max(std::abs(f.dte_minimum), std::abs(f.dte_maximum));
  std::fill(out.solver_error.begin() + kFilmRatio, out.solver_error.end(), kNoNumber);
  return out;
}

bool ComputedFluid::is_withheld(std::size_t condition) const {
  const auto is_so = [](const EvaluatedPoint& point) {
    return point.figures && any_withholds_verdict(point.figures->warnings);
  };
  return condition < points.size() ? is_so(points[condition])
                                   : std::any_of(points.begin(), points.end(), is_so);
}

double ErrorSource::squared_effect(std::size_t condition, ComparedFigure figure) const {
  double out = 0;
  for (const auto& each : effects) out += square(each[condition][figure]);
  return out;
}

}  // namespace tribodyn::server
