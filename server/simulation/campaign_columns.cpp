#include "server/simulation/campaign_columns.h"

#include <limits>

#include "server/mapping/from_core.h"

namespace tribodyn::server {

std::array<double, kCampaignColumns.size()> campaign_row(const EvaluatedPoint& point, int refusal) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  std::array<double, kCampaignColumns.size()> out;
  out.fill(kNone);
  out[0] = refusal;
  if (!point.figures) return out;
  const PointFigures& figures = *point.figures;
  return {static_cast<double>(refusal),
          figures.pinion_torque,
          figures.wheel_torque,
          figures.inefficiency_rms.value_or(kNone),
          figures.inefficiency_energy_mean.value_or(kNone),
          figures.mesh_loss_power,
          figures.dte_minimum,
          figures.dte_maximum,
          figures.contact_loss ? 1.0 : 0.0,
          figures.settled ? 1.0 : 0.0,
          static_cast<double>(figures.period_in_mesh_cycles),
          figures.estimated_relative_error.value_or(kNone),
          static_cast<double>(to_message(figures.model))};
}

}  // namespace tribodyn::server
