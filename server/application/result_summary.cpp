#include "server/application/result_summary.h"

namespace tribodyn::server {
namespace {

v1::PointSummary summary_of(const v1::PointResult& result) {
  v1::PointSummary out;
  out.set_pinion_torque_newton_metres(result.pinion_torque_newton_metres());
  out.set_mesh_loss_power_watts(result.mesh_loss_power_watts());
  if (result.has_inefficiency_rms_percent()) {
    out.set_inefficiency_rms_percent(result.inefficiency_rms_percent());
  }
  if (result.has_inefficiency_energy_mean_percent()) {
    out.set_inefficiency_energy_mean_percent(result.inefficiency_energy_mean_percent());
  }
  return out;
}

}  // namespace

void summarise(v1::SimulationResult& result) {
  for (v1::CurvePoint& point : *result.mutable_points()) {
    if (!point.has_result()) continue;  // a refused point
    *point.mutable_summary() = summary_of(point.result());
    point.clear_result();
  }
  result.clear_assumptions();
  result.clear_limits();
}

}  // namespace tribodyn::server
