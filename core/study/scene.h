#pragma once

#include "core/gear/gear_set.h"
#include "core/laws/lubricant.h"
#include "core/lubricant/fluid_grounds.h"
#include "core/model_options.h"
#include "core/surface/surface.h"
#include "core/vehicle/vehicle.h"

namespace tribodyn {

/// All physical inputs of a study but the operating point. SI units, temperatures in K.
struct Scene {
  Lubricant lubricant;
  GearSet gear_set;
  Roughness roughness;
  BoundaryFriction boundary;  ///< of the surface
  Solid solid;
  Vehicle vehicle;
  double sump_temperature;        ///< T_b [K]
  double inlet_temperature_rise;  ///< eq 14 [K]
  ModelOptions options;
  FluidGrounds fluid_grounds = {};
  LubricantBoundary lubricant_boundary = {};
};

/// The boundary friction of the scene's lubricant on its surface.
inline BoundaryFriction boundary_friction(const Scene& scene) {
  return boundary_friction(scene.boundary, scene.lubricant_boundary,
                           scene.sump_temperature + scene.inlet_temperature_rise);
}

}  // namespace tribodyn
