#pragma once

#include <array>
#include <map>
#include <vector>

#include "core/contact/flank_contact_batch.h"
#include "core/dynamics/mesh_grid.h"
#include "core/dynamics/periodic_orbit.h"

namespace tribodyn {

/// From here on few steps may do.
inline constexpr double kLooseTolerance = 3e-4;
/// Of a tolerance, what the doubt about the steps may take; the rest is for sweeps.
inline constexpr double kShareOfSteps = 0.75;

/// A response under Coulomb's friction in place of a lubricant's. Those of all lubricants are near,
/// and what the steps do to them is nearly the same.
struct ReferenceOrbit {
  int steps = 0;  ///< per mesh cycle
  PeriodicOrbit orbit;
  double step_error = 0;  ///< of the figures, relative; infinite: not known

  /// What the steps may do to a lubricant's figures: its losses may follow the mesh force more than
  /// Coulomb's do.
  double doubt() const { return kCaution * step_error; }
  static constexpr double kCaution = 3;
};

/// The response from `origin` on one grid after another, until the error of the steps is small
/// enough for kLooseTolerance. Empty where there is none. `least`: steps of the first grid.
std::vector<ReferenceOrbit> reference_orbits(GearPairSystem& system,
                                             const FlankContactBatch& contacts, MeshGrids& grids,
                                             const OrbitRequest& request,
                                             const PeriodicOrbit& origin, int least);

/// Those that have been found before, for the lubricants that come after. An entry depends on gear
/// set, load, speed and start alone: it is the same bits from here and found anew. Of one gear set
/// and its options; one thread at a time; bounded.
class ReferenceOrbits {
 public:
  /// As reference_orbits(). Valid until the next call.
  const std::vector<ReferenceOrbit>& find(GearPairSystem& system, const FlankContactBatch& contacts,
                                          MeshGrids& grids, const OrbitRequest& request,
                                          const PeriodicOrbit& origin, int least);

 private:
  static constexpr int kMostStepsKept = 20'000;  // of some 2 KB each
  using Key = std::array<double, 8 + kMarchComponents>;

  std::map<Key, std::vector<ReferenceOrbit>> found_;
  int steps_kept_ = 0;
};

}  // namespace tribodyn
