#pragma once

#include <optional>

#include "client/cpp/commands/command.h"
#include "tribodyn/v1/simulations.pb.h"

namespace tribodyn::client {

/// The flags of an operating point: a speed (with acceleration and slope), or a torque with a
/// pinion speed.
struct OperatingPointFlags {
  std::optional<double> speed_kilometres_per_hour;
  std::optional<double> acceleration_metres_per_second_squared;
  std::optional<double> ascent_angle_degrees;
  std::optional<double> pinion_torque_newton_metres;
  std::optional<double> pinion_speed_radians_per_second;
  v1::OperatingPointStudy study;  ///< model, start, probe
};

/// Adds the flags; they write to `point`, which must outlive them.
void add_operating_point_flags(FlagList& flags, OperatingPointFlags& point);
void check_operating_point(const OperatingPointFlags& point, Complaints& complaints);
v1::OperatingPointStudy operating_point_study(const OperatingPointFlags& point);

/// Adds --model and --start, which point and curve have in common.
template <class Study>
void add_model_and_start_flags(FlagList& flags, Study& study) {
  flags.choice(
      "--model", {"automatic", "full", "quasi-static"},
      "automatic: the cheapest whose estimated error is within --tolerance, the report "
      "says which; full: the four degrees of freedom in time; quasi-static: equilibrium "
      "at constant speed, phase by phase. Curves, histories, --start and "
      "--probe-coexisting-response use the full model unless --model is given. Default: automatic.",
      [&study](int index) {
        constexpr v1::PointModel kModels[] = {v1::POINT_MODEL_AUTOMATIC, v1::POINT_MODEL_FULL,
                                              v1::POINT_MODEL_QUASI_STATIC};
        study.set_model(kModels[index]);
      });
  flags.choice(
      "--start", {"quasi-static", "large-vibration"},
      "Where the march starts; it decides the branch where two responses coexist. "
      "quasi-static: the low-amplitude one; large-vibration: vibro-impact where it exists. "
      "Default: quasi-static.",
      [&study](int index) {
        study.set_start(index == 0 ? v1::POINT_START_QUASI_STATIC_EQUILIBRIUM
                                   : v1::POINT_START_LARGE_VIBRATION);
      });
}

}  // namespace tribodyn::client
