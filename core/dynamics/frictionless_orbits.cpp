#include "core/dynamics/frictionless_orbits.h"

#include <algorithm>

namespace tribodyn {

FrictionlessOrbits::Key FrictionlessOrbits::key(int steps, const OrbitRequest& request,
                                                const PeriodicOrbit& origin) {
  Key key{static_cast<double>(steps),
          static_cast<double>(request.keep_contact),
          static_cast<double>(request.first_cycles),
          static_cast<double>(request.solve_wheel_torque),
          static_cast<double>(origin.period),
          request.mean_pinion_speed,
          origin.torques.pinion,
          origin.torques.wheel};
  std::copy(origin.state.begin(), origin.state.end(), key.begin() + 8);
  return key;
}

}  // namespace tribodyn
