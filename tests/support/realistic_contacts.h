#pragma once

#include <array>
#include <cmath>
#include <vector>

#include "core/contact/flank_contact.h"
#include "core/gear/mesh_data.h"
#include "core/vehicle/vehicle.h"
#include "tests/support/reference_scene.h"

namespace tribodyn {

/// The flank contacts of one scene at one speed over a mesh cycle.
struct RealisticContacts {
  double kilometres_per_hour;
  std::vector<ContactConditions> conditions;
};

inline FlankContactModel contact_model(const Scene& scene) {
  return {scene.lubricant,        scene.solid,
          scene.roughness,        scene.boundary,
          scene.sump_temperature, scene.inlet_temperature_rise,
          scene.options};
}

/// Returns loaded contacts of a gear set at a cruising speed: the mean mesh force by eq 7, shared
/// according to the tables, with a dynamic part of half of it and one of a tenth in the sliding
/// speed, at frequencies that are not multiples of the tables'.
inline RealisticContacts realistic_contacts(const Scene& scene, double kilometres_per_hour,
                                            int phases) {
  const MeshData mesh(scene.gear_set);
  const double speed = kilometres_per_hour / 3.6;
  const double wheel_speed = speed / scene.vehicle.wheel_radius;
  const double pinion_speed = wheel_speed * scene.gear_set.gear_teeth / scene.gear_set.pinion_teeth;
  const double force = wheel_torque(scene.vehicle, speed, 0, 0) / mesh.mean_gear_contact_radius();
  RealisticContacts out{kilometres_per_hour, {}};
  for (int j = 0; j < phases; ++j) {
    const double phase = (j + 0.5) / phases;
    std::array<FlankKinematics, kFlankPairs> flanks;
    mesh.flanks(static_cast<int>(phase * mesh.intervals()), phase, flanks);
    const double load = force * (1 + 0.5 * std::sin(2.7 * j));
    for (const FlankKinematics& flank : flanks) {
      if (!(flank.load_share * load > 0)) continue;
      const FlankMotion motion =
          flank_motion(flank, pinion_speed * (1 + 0.01 * std::sin(1.3 * j)), wheel_speed);
      out.conditions.push_back({flank.load_share * load, flank.radius_x, flank.radius_y,
                                motion.pinion_x, motion.pinion_y, motion.gear_x, motion.gear_y});
    }
  }
  return out;
}

}  // namespace tribodyn
