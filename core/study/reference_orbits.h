#pragma once

#include <array>
#include <map>
#include <vector>

#include "core/contact/flank_contact_batch.h"
#include "core/dynamics/mesh_grid.h"
#include "core/dynamics/periodic_orbit.h"

namespace tribodyn {

/// A response under Coulomb's friction in place of a lubricant's. Those of all lubricants are near,
/// and what the steps do to them is nearly the same.
struct ReferenceOrbit {
  int steps = 0;  ///< per mesh cycle
  PeriodicOrbit orbit;
  double step_error = 0;  ///< of the figures, relative
};

/// The response from `origin` on one grid after another, until the error of the steps is small
/// enough for any tolerance that few steps may do for. Empty where there is none. `least`: steps of
/// the first grid.
std::vector<ReferenceOrbit> reference_orbits(GearPairSystem& system,
                                             const FlankContactBatch& contacts, MeshGrids& grids,
                                             const OrbitRequest& request,
                                             const PeriodicOrbit& origin, int least);

/// Those that have been found before, for the lubricants that come after. An entry depends on gear
/// set, load, speed and start alone: it is the same bits from here and found anew. Of one gear set,
/// driveline and its options; one thread at a time; bounded.
class ReferenceOrbits {
 public:
  /// As reference_orbits(). Valid until the next call.
  const std::vector<ReferenceOrbit>& find(GearPairSystem& system, const FlankContactBatch& contacts,
                                          MeshGrids& grids, const OrbitRequest& request,
                                          const PeriodicOrbit& origin, int least);

 private:
  static constexpr std::size_t kMost = 200;  // of some 200 KB
  using Key = std::array<double, 8 + kMarchComponents>;

  std::map<Key, std::vector<ReferenceOrbit>> found_;
};

}  // namespace tribodyn
