#include "core/study/history.h"

namespace tribodyn {

bool is_per_flank(HistoryColumn column) { return column >= HistoryColumn::kFlankLoad; }

std::string_view history_column_name(HistoryColumn column) {
  switch (column) {
    case HistoryColumn::kTime:
      return "time_seconds";
    case HistoryColumn::kMeshPhase:
      return "mesh_phase_cycles";
    case HistoryColumn::kPinionShaftSpeed:
      return "pinion_shaft_speed_radians_per_second";
    case HistoryColumn::kPinionSpeed:
      return "pinion_speed_radians_per_second";
    case HistoryColumn::kGearSpeed:
      return "gear_speed_radians_per_second";
    case HistoryColumn::kWheelSpeed:
      return "wheel_speed_radians_per_second";
    case HistoryColumn::kDynamicTransmissionError:
      return "dynamic_transmission_error_metres";
    case HistoryColumn::kDynamicTransmissionErrorVelocity:
      return "dynamic_transmission_error_velocity_metres_per_second";
    case HistoryColumn::kMeshForce:
      return "mesh_force_newtons";
    case HistoryColumn::kPinionShaftTorque:
      return "pinion_shaft_torque_newton_metres";
    case HistoryColumn::kGearShaftTorque:
      return "gear_shaft_torque_newton_metres";
    case HistoryColumn::kPinionFrictionTorque:
      return "pinion_friction_torque_newton_metres";
    case HistoryColumn::kGearFrictionTorque:
      return "gear_friction_torque_newton_metres";
    case HistoryColumn::kMeshLossPower:
      return "mesh_loss_power_watts";
    case HistoryColumn::kInefficiency:
      return "inefficiency_percent";
    case HistoryColumn::kFlankLoad:
      return "flank_load_newtons";
    case HistoryColumn::kFlankFriction:
      return "flank_friction_newtons";
    case HistoryColumn::kFlankViscousFriction:
      return "flank_viscous_friction_newtons";
    case HistoryColumn::kFlankBoundaryFriction:
      return "flank_boundary_friction_newtons";
    case HistoryColumn::kFlankFilmThickness:
      return "flank_film_thickness_metres";
    case HistoryColumn::kFlankFilmRatio:
      return "flank_film_ratio";
    case HistoryColumn::kFlankContactTemperature:
      return "flank_contact_temperature_kelvin";
    case HistoryColumn::kFlankMaximumPressure:
      return "flank_maximum_pressure_pascals";
    case HistoryColumn::kFlankShearRate:
      return "flank_shear_rate_per_second";
    case HistoryColumn::kFlankSlidingSpeed:
      return "flank_sliding_speed_metres_per_second";
    case HistoryColumn::kFlankFrictionCoefficient:
      return "flank_friction_coefficient";
    case HistoryColumn::kFlankFlashTemperatureRise:
      return "flank_flash_temperature_rise_kelvin";
    case HistoryColumn::kFlankPinionSpecificSliding:
      return "flank_pinion_specific_sliding";
    case HistoryColumn::kFlankGearSpecificSliding:
      return "flank_gear_specific_sliding";
    case HistoryColumn::kFlankEntrainmentSpeed:
      return "flank_entrainment_speed_metres_per_second";
    case HistoryColumn::kFlankMeanShearStress:
      return "flank_mean_shear_stress_pascals";
    case HistoryColumn::kFlankLimitingStressAreaShare:
      return "flank_limiting_stress_area_share";
    case HistoryColumn::kFlankAsperityLoad:
      return "flank_asperity_load_newtons";
  }
  return "";
}

}  // namespace tribodyn
