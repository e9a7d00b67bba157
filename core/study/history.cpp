#include "core/study/history.h"

#include <iterator>

namespace tribodyn {

bool is_per_flank(HistoryColumn column) { return column >= HistoryColumn::kFlankLoad; }

std::string_view history_column_name(HistoryColumn column) {
  static constexpr std::string_view kNames[] = {
      "time_seconds",
      "mesh_phase_cycles",
      "pinion_shaft_speed_radians_per_second",
      "pinion_speed_radians_per_second",
      "gear_speed_radians_per_second",
      "wheel_speed_radians_per_second",
      "dynamic_transmission_error_metres",
      "dynamic_transmission_error_velocity_metres_per_second",
      "mesh_force_newtons",
      "pinion_shaft_torque_newton_metres",
      "gear_shaft_torque_newton_metres",
      "pinion_friction_torque_newton_metres",
      "gear_friction_torque_newton_metres",
      "mesh_loss_power_watts",
      "inefficiency_percent",
      "flank_load_newtons",
      "flank_friction_newtons",
      "flank_viscous_friction_newtons",
      "flank_boundary_friction_newtons",
      "flank_film_thickness_metres",
      "flank_film_ratio",
      "flank_contact_temperature_kelvin",
      "flank_maximum_pressure_pascals",
      "flank_shear_rate_per_second",
      "flank_sliding_speed_metres_per_second",
      "flank_friction_coefficient",
      "flank_flash_temperature_rise_kelvin",
      "flank_pinion_specific_sliding",
      "flank_gear_specific_sliding",
      "flank_entrainment_speed_metres_per_second",
      "flank_mean_shear_stress_pascals",
      "flank_limiting_stress_area_share",
      "flank_asperity_load_newtons",
  };
  static_assert(std::size(kNames) == kHistoryColumns);
  return kNames[static_cast<int>(column)];
}

}  // namespace tribodyn
