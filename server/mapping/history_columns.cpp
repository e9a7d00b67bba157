#include "server/mapping/history_columns.h"

#include <iterator>

#include "server/support/value_of.h"

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
  using enum HistoryColumn;
  static constexpr std::pair<HistoryColumn, const char*> kDescriptions[] = {
      {kTime, "time from the first row"},
      {kMeshPhase, "mesh cycles from the first row"},
      {kPinionShaftSpeed, "speed of the pinion shaft"},
      {kPinionSpeed, "speed of the pinion"},
      {kGearSpeed, "speed of the gear"},
      {kWheelSpeed, "speed of the wheel"},
      {kDynamicTransmissionError, "dynamic transmission error, eq 6"},
      {kDynamicTransmissionErrorVelocity, "rate of the dynamic transmission error"},
      {kMeshForce, "force of the mesh, spring and damper"},
      {kPinionShaftTorque, "torque in the shaft of the pinion, spring and damper"},
      {kGearShaftTorque, "torque in the shaft of the gear, spring and damper"},
      {kPinionFrictionTorque, "torque of the flanks' friction on the pinion, eq 29"},
      {kGearFrictionTorque, "torque of the flanks' friction on the gear, eq 29"},
      {kMeshLossPower, "loss power of the mesh: friction times sliding speed over all flanks"},
      {kInefficiency, "loss power over the power that comes in, eq 30, at this instant"},
      {kFlankLoad, "normal load of the flank"},
      {kFlankFriction, "friction of the flank, viscous and boundary"},
      {kFlankViscousFriction, "viscous friction F_v of the flank"},
      {kFlankBoundaryFriction, "boundary friction F_b of the flank, eq 40"},
      {kFlankFilmThickness, "central film thickness of the flank, eq 12"},
      {kFlankFilmRatio, "film ratio lambda_s of the flank: film thickness over roughness"},
      {kFlankContactTemperature, "mean temperature T_c of the film of the flank, eq 38"},
      {kFlankMaximumPressure, "largest pressure of the flank, eq 19"},
      {kFlankShearRate, "shear rate of the film of the flank, eq 18"},
      {kFlankSlidingSpeed, "sliding speed V_s of the flank"},
      {kFlankFrictionCoefficient, "friction coefficient of the flank: friction over normal load"},
      {kFlankFlashTemperatureRise,
       "flash temperature rise of the flank: of its surfaces above the inlet, eq 39"},
      {kFlankPinionSpecificSliding,
       "specific sliding of the pinion: sliding speed over the speed of its surface"},
      {kFlankGearSpecificSliding,
       "specific sliding of the gear: sliding speed over the speed of its surface"},
      {kFlankEntrainmentSpeed, "entrainment speed U_eff of the flank, eq 17"},
      {kFlankMeanShearStress,
       "mean shear stress of the film of the flank, eq 23 under the limiting shear stress"},
      {kFlankLimitingStressAreaShare,
       "share of the contact area of the flank at the limiting shear stress"},
      {kFlankAsperityLoad, "part of the normal load that asperities carry, W_asp, eq 41"}};
  static_assert(std::size(kDescriptions) == kHistoryColumns);
  return value_of(kDescriptions, column, "");
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
