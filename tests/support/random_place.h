#pragma once

#include <cmath>
#include <random>
#include <vector>

#include "core/study/operating_point.h"
#include "tests/support/cruise.h"
#include "tests/support/reference_scene.h"

namespace tribodyn {

/// A random scene from the ranges of the validation table and beyond: every part of the driveline
/// and of the model varies.
struct RandomPlace {
  Scene scene;
  OperatingCondition condition;
};

inline RandomPlace random_place(std::mt19937_64& random, double kilometres_per_hour) {
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  const auto change = [&](double& value, double most) { value *= std::exp(between(-most, most)); };
  const int fluid = static_cast<int>(between(1, 4)), kind = static_cast<int>(between(0, 8));
  RandomPlace place{reference_scene(fluid, between(-30, 140)), cruise(kilometres_per_hour)};
  Scene& scene = place.scene;
  if (kind == 4) scene.gear_set = reference_gear_set("B");
  DrivelineDynamics& d = scene.gear_set.dynamics;
  FourierSeries& k = scene.gear_set.series.mesh_stiffness;
  const auto scale_ripple = [&](double factor) {
    for (std::vector<double>* series : {&k.sine, &k.cosine}) {
      for (double& c : *series) c *= factor;
    }
  };
  if (kind == 1) change(d.mesh_damping, 1.6);
  if (kind == 2) {
    const double factor = std::exp(between(-2.3, 2.3));
    k.mean *= factor;
    scale_ripple(factor);
  }
  if (kind == 3) d.half_backlash *= between(0, 3);
  if (kind == 5) {
    place.condition = prescribed(between(-60, 150),
                                 kilometres_per_hour / 3.6 / scene.vehicle.wheel_radius * 36 / 13);
  }
  if (kind == 6) {
    scene.options.energy_consistent = between(0, 1) < 0.5;
    scene.options.damping_in_contact_only = between(0, 1) < 0.5;
    scene.options.isothermal = between(0, 1) < 0.5;
    scene.options.newtonian = between(0, 1) < 0.5;
    scale_ripple(std::exp(between(-2.3, 1)));
  }
  if (kind == 7) {
    for (double* part :
         {&d.pinion_shaft_stiffness, &d.gear_shaft_stiffness, &d.pinion_inertia, &d.gear_inertia,
          &d.wheel_inertia, &d.pinion_shaft_damping, &d.gear_shaft_damping}) {
      change(*part, 1);
    }
  }
  return place;
}

}  // namespace tribodyn
