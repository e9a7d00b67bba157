#include "core/vehicle/vehicle.h"

#include <cmath>
#include <string>

#include "core/number_text.h"
#include "core/refusal.h"

namespace tribodyn {

double wheel_torque(const Vehicle& vehicle, double speed, double ascent_angle,
                    double acceleration) {
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
