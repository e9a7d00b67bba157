#pragma once

#include <array>
#include <string_view>

#include "server/simulation/point_evaluation.h"

namespace tribodyn::server {

/// The columns that the store keeps of a campaign, by number. A number never changes its meaning:
/// databases hold it. The names are those of EvaluatePointsResponse.
inline constexpr std::array<std::string_view, 13> kCampaignColumns = {
    "refusal_number",  // 0: the row has figures; n: refusal n
    "pinion_torque_newton_metres",
    "wheel_torque_newton_metres",
    "inefficiency_rms_percent",
    "inefficiency_energy_mean_percent",
    "mesh_loss_power_watts",
    "dynamic_transmission_error_minimum_metres",
    "dynamic_transmission_error_maximum_metres",
    "contact_loss",
    "settled",
    "period_in_mesh_cycles",
    "estimated_relative_error",
    "model",
};
inline constexpr double kNotComputed = -1;  ///< refusal_number of a row without a tile

/// Returns what a row holds in all columns. `refusal` is the number of its refusal, 0 for a point
/// with figures.
std::array<double, kCampaignColumns.size()> campaign_row(const EvaluatedPoint& point, int refusal);

}  // namespace tribodyn::server
