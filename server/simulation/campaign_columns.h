#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "server/simulation/point_evaluation.h"
#include "tribodyn/v1/campaigns.pb.h"

namespace tribodyn::server {

/// The columns that every campaign has, by number. A number never changes its meaning: databases
/// hold it. The names are those of EvaluatePointsResponse.
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
/// The columns that follow in a campaign with contact_figures.
inline constexpr std::array<std::string_view, 9> kContactFigureColumns = {
    "film_ratio_minimum",
    "film_ratio_mean",
    "contact_temperature_maximum_kelvin",
    "contact_temperature_mean_kelvin",
    "viscous_loss_power_watts",
    "boundary_loss_power_watts",
    "mean_friction_coefficient",
    "maximum_pressure_maximum_pascals",
    "flash_temperature_rise_maximum_kelvin",
};
inline constexpr double kNotComputed = -1;  ///< refusal_number of a row without a tile

/// Returns the names of the columns that the store keeps of a campaign, by number: those above, and
/// with elasticities elasticities_one_sided and "elasticity.{figure}.{parameter}", by figure.
std::vector<std::string> campaign_columns(const v1::Campaign& campaign);

/// Adds the row of a point to all columns of its campaign. `refusal` is the number of its refusal,
/// 0 for a point with figures.
void add_campaign_row(const PointEvaluation& evaluation, const EvaluatedPoint& point, int refusal,
                      std::vector<std::vector<double>>& columns);

/// Returns the value of a column in the row of a point; NaN if the point has none. `column`: a
/// number below that of all columns of the evaluation.
double campaign_value(const PointEvaluation& evaluation, const EvaluatedPoint& point, int column);

}  // namespace tribodyn::server
