#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "server/simulation/point_evaluation.h"
#include "server/simulation/rig_evaluation.h"
#include "tribodyn/v1/campaigns.pb.h"

namespace tribodyn::server {

/// Columns of every campaign: the sum of 2^n over the warnings of the row, n their
/// warning_number(), and whether one of them withholds the verdict.
inline constexpr std::string_view kWarningBits = "warning_bits",
                                  kVerdictWithheld = "verdict_withheld";

/// The columns that every campaign of the axle has, by number. A number never changes its meaning:
/// databases hold it. The names are those of EvaluatePointsResponse.
inline constexpr std::array<std::string_view, 16> kCampaignColumns = {
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
    "responses_coexist",
    kWarningBits,
    kVerdictWithheld,
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
/// with elasticities elasticities_one_sided and "elasticity.{figure}.{parameter}", by figure. Of a
/// rig: refusal_number, kWarningBits, kVerdictWithheld and rig_columns(), whose numbers databases
/// hold too.
std::vector<std::string> campaign_columns(const v1::Campaign& campaign);

/// Returns the column that is the figure of a candidate if a request names none.
std::string usual_figure(const v1::Campaign& campaign);

/// A candidate at one condition.
struct CampaignRow {
  std::vector<double> figures;  ///< columns 1, 2, ...; empty: refused
  std::string refusal_reason;   ///< UPPER_SNAKE_CASE; empty if there are figures
  std::string refusal_message;

  /// Sets the figures of a point, or why it has none.
  void set(const PointEvaluation& evaluation, const EvaluatedPoint& point);
  void set(const RigPoint& point, const std::vector<RangeWarning>& warnings);
  void refuse(std::string reason, std::string message);
  /// Returns the value of a column but the first one; NaN if the row is refused.
  double value(int column) const;
};

/// Adds a row to all columns of its campaign. `refusal` is the number of its refusal, 0 for a row
/// with figures.
void add_campaign_row(const CampaignRow& row, int refusal,
                      std::vector<std::vector<double>>& columns);

}  // namespace tribodyn::server
