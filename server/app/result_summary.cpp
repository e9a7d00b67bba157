#include "server/app/result_summary.h"

namespace tribodyn::server {
namespace {

v1::PointResult main_figures(const v1::PointResult& point) {
  v1::PointResult out;
  out.set_pinion_torque_newton_metres(point.pinion_torque_newton_metres());
  out.set_mesh_loss_power_watts(point.mesh_loss_power_watts());
  if (point.has_inefficiency_rms_percent()) {
    out.set_inefficiency_rms_percent(point.inefficiency_rms_percent());
  }
  if (point.has_inefficiency_energy_mean_percent()) {
    out.set_inefficiency_energy_mean_percent(point.inefficiency_energy_mean_percent());
  }
  return out;
}

}  // namespace

void abridge(v1::SimulationResult& result) {
  if (result.ByteSizeLong() <= kMaximumSummaryBytes) return;
  result.set_is_abridged(true);
  for (v1::CurvePoint& point : *result.mutable_points()) {
    point.clear_refusal_message();
    if (point.has_result()) *point.mutable_result() = main_figures(point.result());
  }
  if (result.ByteSizeLong() > kMaximumSummaryBytes) result.clear_assumptions();
}

}  // namespace tribodyn::server
