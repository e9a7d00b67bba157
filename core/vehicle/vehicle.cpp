#include "core/vehicle/vehicle.h"

#include <cmath>
#include <string>

#include "core/number_text.h"
#include "core/parameter_check.h"
#include "core/refusal.h"

namespace tribodyn {

void check(const Vehicle& v) {
  ParameterCheck check;
  check.expect("mass", v.mass, "kg", Bound::kPositive);
  check.expect("rolling_resistance_coefficient", v.rolling_resistance_coefficient, "1",
               Bound::kNotNegative);
  check.expect("drag_coefficient", v.drag_coefficient, "1", Bound::kNotNegative);
  check.expect("frontal_area", v.frontal_area, "m2", Bound::kNotNegative);
  check.expect("air_density", v.air_density, "kg/m3", Bound::kNotNegative);
  check.expect("wheel_radius", v.wheel_radius, "m", Bound::kPositive);
  check.expect("gravity", v.gravity, "m/s2", Bound::kNotNegative);
  check.conclude();
}

double wheel_torque(const Vehicle& vehicle, double speed, double ascent_angle,
                    double acceleration) {
  check(vehicle);
  if (!(speed >= 0 && std::isfinite(speed))) {
    throw Refusal("SPEED_NOT_FORWARD", "A vehicle speed of " + number_text(speed) +
                                           " m/s: eq 7 is for forward speeds from 0 m/s.");
  }
  const double weight = vehicle.mass * vehicle.gravity;
  const double rolling = weight * vehicle.rolling_resistance_coefficient * std::cos(ascent_angle);
  const double grade = weight * std::sin(ascent_angle);
  const double drag =
      vehicle.drag_coefficient * vehicle.frontal_area * 0.5 * vehicle.air_density * speed * speed;
  return vehicle.wheel_radius * (rolling + grade + drag + vehicle.mass * acceleration);  // (eq 7)
}

}  // namespace tribodyn
