#include "core/study/prepared_scene.h"

#include <utility>

#include "core/contact/hertz.h"

namespace tribodyn {
namespace {

const GearSet& checked(const GearSet& gear_set) {
  check(gear_set);
  return gear_set;
}

}  // namespace

PreparedGearSet::PreparedGearSet(const GearSet& gear_set, const Solid& solid,
                                 const ModelOptions& options)
    : gear_set_(checked(gear_set)),
      mesh_(gear_set_),
      system_(mesh_, gear_set_.dynamics, options),
      modes_(linear_modes(system_)),
      grids_(mesh_, gear_set_.dynamics.half_backlash,
             reduced_modulus(solid.youngs_modulus, solid.poissons_ratio), options),
      extremes_(flank_extremes(gear_set_)) {}

PreparedScene::PreparedScene(const Scene& scene, std::shared_ptr<PreparedGearSet> gear_set,
                             InstructionSet instruction_set)
    : scene_(scene),
      contacts_(
          FlankContactModel(scene.lubricant, scene.solid, scene.roughness, boundary_friction(scene),
                            scene.sump_temperature, scene.inlet_temperature_rise, scene.options),
          instruction_set),
      gear_set_(gear_set ? std::move(gear_set)
                         : std::make_shared<PreparedGearSet>(scene.gear_set, scene.solid,
                                                             scene.options)) {}

}  // namespace tribodyn
