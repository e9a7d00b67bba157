#include "client/cpp/commands/operating_point.h"

namespace tribodyn::client {

void add_operating_point_flags(FlagList& flags, OperatingPointFlags& point) {
  flags.group("Operating point: a speed, or a torque with a pinion speed");
  flags.number("--speed-kilometres-per-hour,--speed", {"km/h", "0.1 to 400", ""}, "Vehicle speed",
               [&](double value) { point.speed_kilometres_per_hour = value; });
  flags.number("--acceleration-metres-per-second-squared,--acceleration",
               {"m/s2", "-50 to 50", "0"},
               "Acceleration of the vehicle, e.g. at an instant of a drive cycle",
               [&](double value) { point.acceleration_metres_per_second_squared = value; });
  flags.number("--ascent-angle-degrees,--ascent", {"degrees", "-45 to 45", "0"},
               "Road slope, also in percent: 6%",
               [&](double value) { point.ascent_angle_degrees = value; });
  flags.number("--pinion-torque-newton-metres,--torque", {"N m", "-1e5 to 1e5", ""},
               "Mean pinion torque, instead of a vehicle speed; negative means coast",
               [&](double value) { point.pinion_torque_newton_metres = value; });
  flags.number("--pinion-speed-radians-per-second,--pinion-speed", {"rad/s", "0.01 to 1e4", ""},
               "Mean pinion speed, for a given pinion torque",
               [&](double value) { point.pinion_speed_radians_per_second = value; });
  add_model_and_start_flags(flags, point.study);
  flags.toggle(
      "--probe-coexisting-response",
      "Also start from the other initial state and report a second steady state if there is one.",
      [&] { point.study.set_probe_coexisting_response(true); });
}

void check_operating_point(const OperatingPointFlags& point, Complaints& complaints) {
  const bool by_speed = point.speed_kilometres_per_hour.has_value();
  const bool has_torque = point.pinion_torque_newton_metres.has_value();
  const bool has_pinion_speed = point.pinion_speed_radians_per_second.has_value();
  if (by_speed && (has_torque || has_pinion_speed)) {
    complaints.emplace_back("give either --speed, or --torque with --pinion-speed, not both");
  } else if (has_torque != has_pinion_speed) {
    complaints.emplace_back(has_torque ? "--torque needs --pinion-speed"
                                       : "--pinion-speed needs --torque");
  } else if (!by_speed && !has_torque) {
    complaints.emplace_back("--speed is missing, e.g. --speed 72.5");
  }
  if (has_torque && point.acceleration_metres_per_second_squared) {
    complaints.emplace_back("--acceleration cannot be combined with --torque");
  }
  if (has_torque && point.ascent_angle_degrees) {
    complaints.emplace_back("--ascent cannot be combined with --torque");
  }
}

v1::OperatingPointStudy operating_point_study(const OperatingPointFlags& point) {
  v1::OperatingPointStudy study = point.study;
  const double ascent = point.ascent_angle_degrees.value_or(0);
  if (point.pinion_torque_newton_metres) {
    auto& torque = *study.mutable_prescribed_torque();
    torque.set_pinion_torque_newton_metres(*point.pinion_torque_newton_metres);
    torque.set_pinion_speed_radians_per_second(point.pinion_speed_radians_per_second.value_or(0));
  } else if (point.acceleration_metres_per_second_squared) {
    auto& snapshot = *study.mutable_drive_cycle_snapshot();
    snapshot.set_speed_kilometres_per_hour(point.speed_kilometres_per_hour.value_or(0));
    snapshot.set_acceleration_metres_per_second_squared(
        *point.acceleration_metres_per_second_squared);
    snapshot.set_ascent_angle_degrees(ascent);
  } else {
    study.mutable_cruise()->set_speed_kilometres_per_hour(
        point.speed_kilometres_per_hour.value_or(0));
    study.mutable_cruise()->set_ascent_angle_degrees(ascent);
  }
  return study;
}

}  // namespace tribodyn::client
