#include "server/mapping/history_columns.h"

namespace tribodyn::server {

std::optional<HistoryColumn> history_column(std::string_view name) {
  for (int i = 0; i < kHistoryColumns; ++i) {
    const auto column = static_cast<HistoryColumn>(i);
    if (history_column_name(column) == name) return column;
  }
  return std::nullopt;
}

std::vector<std::string> history_column_names() {
  std::vector<std::string> names;
  names.reserve(kHistoryColumns);
  for (int i = 0; i < kHistoryColumns; ++i) {
    names.emplace_back(history_column_name(static_cast<HistoryColumn>(i)));
  }
  return names;
}

std::string_view history_column_description(HistoryColumn column) {
  switch (column) {
    case HistoryColumn::kTime:
      return "time from the first row";
    case HistoryColumn::kMeshPhase:
      return "mesh cycles from the first row";
    case HistoryColumn::kPinionShaftSpeed:
      return "speed of the pinion shaft";
    case HistoryColumn::kPinionSpeed:
      return "speed of the pinion";
    case HistoryColumn::kGearSpeed:
      return "speed of the gear";
    case HistoryColumn::kWheelSpeed:
      return "speed of the wheel";
    case HistoryColumn::kDynamicTransmissionError:
      return "dynamic transmission error, eq 6";
    case HistoryColumn::kDynamicTransmissionErrorVelocity:
      return "rate of the dynamic transmission error";
    case HistoryColumn::kMeshForce:
      return "force of the mesh, spring and damper";
    case HistoryColumn::kPinionShaftTorque:
      return "torque in the shaft of the pinion, spring and damper";
    case HistoryColumn::kGearShaftTorque:
      return "torque in the shaft of the gear, spring and damper";
    case HistoryColumn::kPinionFrictionTorque:
      return "torque of the flanks' friction on the pinion, eq 29";
    case HistoryColumn::kGearFrictionTorque:
      return "torque of the flanks' friction on the gear, eq 29";
    case HistoryColumn::kMeshLossPower:
      return "loss power of the mesh: friction times sliding speed over all flanks";
    case HistoryColumn::kInefficiency:
      return "loss power over the power that comes in, eq 30, at this instant";
    case HistoryColumn::kFlankLoad:
      return "normal load of the flank";
    case HistoryColumn::kFlankFriction:
      return "friction of the flank, viscous and boundary";
    case HistoryColumn::kFlankViscousFriction:
      return "viscous friction F_v of the flank";
    case HistoryColumn::kFlankBoundaryFriction:
      return "boundary friction F_b of the flank, eq 40";
    case HistoryColumn::kFlankFilmThickness:
      return "central film thickness of the flank, eq 12";
    case HistoryColumn::kFlankFilmRatio:
      return "film ratio lambda_s of the flank: film thickness over roughness";
    case HistoryColumn::kFlankContactTemperature:
      return "mean temperature T_c of the film of the flank, eq 38";
    case HistoryColumn::kFlankMaximumPressure:
      return "largest pressure of the flank, eq 19";
    case HistoryColumn::kFlankShearRate:
      return "shear rate of the film of the flank, eq 18";
    case HistoryColumn::kFlankSlidingSpeed:
      return "sliding speed V_s of the flank";
    case HistoryColumn::kFlankFrictionCoefficient:
      return "friction coefficient of the flank: friction over normal load";
    case HistoryColumn::kFlankFlashTemperatureRise:
      return "flash temperature rise of the flank: of its surfaces above the inlet, eq 39";
    case HistoryColumn::kFlankPinionSpecificSliding:
      return "specific sliding of the pinion: sliding speed over the speed of its surface";
    case HistoryColumn::kFlankGearSpecificSliding:
      return "specific sliding of the gear: sliding speed over the speed of its surface";
    case HistoryColumn::kFlankEntrainmentSpeed:
      return "entrainment speed U_eff of the flank, eq 17";
    case HistoryColumn::kFlankMeanShearStress:
      return "mean shear stress of the film of the flank, eq 23 under the limiting shear stress";
    case HistoryColumn::kFlankLimitingStressAreaShare:
      return "share of the contact area of the flank at the limiting shear stress";
    case HistoryColumn::kFlankAsperityLoad:
      return "part of the normal load that asperities carry, W_asp, eq 41";
  }
  return "";
}

std::string_view history_column_unit(std::string_view name) {
  struct Unit {
    std::string_view suffix;
    std::string_view symbol;
  };
  // Longest suffix first: "_metres_per_second" before "_per_second".
  static constexpr Unit kUnits[] = {
      {"_radians_per_second", "rad/s"},
      {"_metres_per_second", "m/s"},
      {"_per_second", "1/s"},
      {"_seconds", "s"},
      {"_newton_metres", "N m"},
      {"_metres", "m"},
      {"_newtons", "N"},
      {"_watts", "W"},
      {"_percent", "%"},
      {"_hertz", "Hz"},
      {"_joules", "J"},
      {"_kilometres_per_hour", "km/h"},
      {"_kelvin", "K"},
      {"_celsius", "C"},
      {"_pascals", "Pa"},
  };
  const std::string_view quantity = name.substr(0, name.rfind("_flank_"));
  for (const Unit& each : kUnits) {
    if (quantity.ends_with(each.suffix)) return each.symbol;
  }
  return "";
}

}  // namespace tribodyn::server
