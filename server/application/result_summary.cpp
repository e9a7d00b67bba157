#include "server/application/result_summary.h"

namespace tribodyn::server {
namespace {

v1::PointSummary summary_of(const v1::CurvePoint& point) {
  v1::PointSummary out;
  out.set_refusal_reason(point.refusal_reason());
  if (!point.has_result()) return out;
  const v1::PointResult& result = point.result();
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

void abridge(v1::SimulationResult& result) {
  if (result.ByteSizeLong() <= kMaximumSummaryBytes) return;
  result.set_is_abridged(true);
  for (v1::CurvePoint& point : *result.mutable_points()) {
    *point.mutable_summary() = summary_of(point);
    point.clear_result();
    point.clear_refusal_reason();
    point.clear_refusal_message();
  }
  if (result.ByteSizeLong() <= kMaximumSummaryBytes) return;
  result.clear_assumptions();
  result.set_assumptions_are_left_out(true);
}

}  // namespace tribodyn::server
