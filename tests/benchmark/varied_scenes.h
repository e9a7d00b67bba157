#pragma once

#include <random>
#include <vector>

#include "tests/support/reference_scene.h"

namespace tribodyn {

/// A parameter that differs from lubricant to lubricant, and by how much at most [-].
struct VariedParameter {
  double& (*of)(Scene& scene);
  double share;
};

inline constexpr VariedParameter kVariedParameters[] = {
    {[](Scene& s) -> double& { return s.lubricant.vogel_viscosity_prefactor; }, 0.1},
    {[](Scene& s) -> double& { return s.lubricant.pressure_viscosity_coefficient; }, 0.1},
    {[](Scene& s) -> double& { return s.lubricant.relaxation_time; }, 0.3},
    {[](Scene& s) -> double& { return s.lubricant.limiting_shear_stress_coefficient; }, 0.1},
    {[](Scene& s) -> double& { return s.boundary.asperity_friction_coefficient; }, 0.1}};

/// Returns random lubricants on the reference gear set, each at sumps of 20, 40 and 90 C.
inline std::vector<Scene> varied_scenes(int lubricants) {
  std::mt19937_64 random(20261121);
  std::vector<Scene> out;
  for (int i = 0; i < lubricants; ++i) {
    Scene scene = reference_scene(1 + i % 3);
    for (const VariedParameter& each : kVariedParameters) {
      each.of(scene) *=
          std::uniform_real_distribution<double>(1 - each.share, 1 + each.share)(random);
    }
    for (const double sump : {20.0, 40.0, 90.0}) {
      scene.sump_temperature = sump + 273.15;
      out.push_back(scene);
    }
  }
  return out;
}

}  // namespace tribodyn
