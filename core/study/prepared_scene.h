#pragma once

#include <array>
#include <memory>

#include "core/contact/flank_contact_batch.h"
#include "core/driveline/gear_pair_system.h"
#include "core/driveline/linear_modes.h"
#include "core/gear/flank_extremes.h"
#include "core/integrate/mesh_grid.h"
#include "core/periodic/coulomb_orbits.h"
#include "core/periodic/loud_response.h"
#include "core/reduced/quasi_static.h"
#include "core/study/scene.h"

namespace tribodyn {

/// Everything that depends on the gear set alone, for all fluids, speeds and loads. Parts are made
/// at their first use and do not depend on the user. One thread at a time.
class PreparedGearSet {
 public:
  /// Throws Refusal as check(GearSet) does.
  PreparedGearSet(const GearSet& gear_set, const Solid& solid, const ModelOptions& options);
  PreparedGearSet(const PreparedGearSet&) = delete;
  PreparedGearSet& operator=(const PreparedGearSet&) = delete;

  const GearSet& gear_set() const { return gear_set_; }
  const GearPairSystem& system() const { return system_; }
  const std::array<LinearMode, 3>& modes() const { return modes_; }
  MeshGrids& grids() { return grids_; }
  /// For studies that meet the same speeds and loads with many lubricants.
  CoulombOrbits& coulomb_orbits() { return coulomb_orbits_; }
  QuasiStaticScreen& quasi_static_screen() { return quasi_static_screen_; }
  OtherResponses& other_responses() { return other_responses_; }
  const FlankExtremes& extremes() const { return extremes_; }

 private:
  GearSet gear_set_;
  MeshData mesh_;
  GearPairSystem system_;
  std::array<LinearMode, 3> modes_;
  MeshGrids grids_;
  CoulombOrbits coulomb_orbits_;
  QuasiStaticScreen quasi_static_screen_;
  OtherResponses other_responses_;
  FlankExtremes extremes_;
};

/// A scene with everything that its points share. One thread at a time. Keeps the scene's
/// reference.
class PreparedScene {
 public:
  /// `gear_set`: one that other scenes use too; it must be that of the scene, of the same solid and
  /// options, and used with the same instruction set. Null: it is prepared here. `instruction_set`
  /// must be supported. Throws Refusal as FlankContactModel and PreparedGearSet do.
  explicit PreparedScene(const Scene& scene, std::shared_ptr<PreparedGearSet> gear_set = nullptr,
                         InstructionSet instruction_set = FlankContactBatch::widest());
  explicit PreparedScene(const Scene&&, std::shared_ptr<PreparedGearSet> = nullptr,
                         InstructionSet = FlankContactBatch::widest()) = delete;

  const Scene& scene() const { return scene_; }
  const FlankContactBatch& contacts() const { return contacts_; }
  PreparedGearSet& gear_set() { return *gear_set_; }

 private:
  const Scene& scene_;
  FlankContactBatch contacts_;
  std::shared_ptr<PreparedGearSet> gear_set_;
};

}  // namespace tribodyn
