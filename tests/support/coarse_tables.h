#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "core/study/scene.h"

namespace tribodyn {

/// The scene with each `kept`-th sample of the tooth contact tables, so that steps need not end at
/// 96 samples per mesh cycle: the kinks there would hide the order of the steps.
inline Scene with_coarse_tables(Scene scene, int kept) {
  ToothContactTables& t = scene.gear_set.tables;
  for (SlotTable* table :
       {&t.load_share, &t.radius_x, &t.radius_y, &t.pinion_velocity_x, &t.pinion_velocity_y,
        &t.gear_velocity_x, &t.gear_velocity_y, &t.contact_point_velocity_x,
        &t.contact_point_velocity_y, &t.pinion_friction_arm, &t.gear_friction_arm}) {
    for (std::vector<double>& slot : *table) {
      std::vector<double> samples;
      for (std::size_t i = 0; i < slot.size(); i += static_cast<std::size_t>(kept)) {
        samples.push_back(slot[i]);
      }
      slot = std::move(samples);
    }
  }
  return scene;
}

}  // namespace tribodyn
