#pragma once

#include <functional>
#include <optional>

#include "core/dynamics/periodic_orbit.h"
#include "core/study/reference_orbits.h"

namespace tribodyn {

/// Where a response is looked for.
struct OrbitSearch {
  double mean_pinion_speed = 0;     ///< held exactly [rad/s]
  bool solve_wheel_torque = false;  ///< T_w is the unknown instead of T_s
  MarchState start{};               ///< at mesh phase 0
  int period = 1;                   ///< [mesh cycles]
  bool try_contact_first = true;    ///< the response without contact loss, if there is one
  int few_cycles = 12;              ///< periods marched from the start when there is none,
  int first_cycles = 60;            ///< and when that does not lead to any
  int maximum_mesh_cycles = 4000;   ///< marched in search of a response
  bool patient = true;              ///< further tries, and hundreds of cycles in the end
  bool renew_friction = false;      ///< on the way: they lead where friction leads
  double tolerance = 1e-5;          ///< wanted, of the figures; see RefinedOrbit::estimated_error
  ReferenceOrbits* references = nullptr;  ///< shared by lubricants, to start from; null: none
  std::function<bool()> interrupted;
};

/// What is known of a motion that repeats in no period looked for: the responses that were found
/// surely repel, at the longest period too.
struct Rattle {
  MarchState start{};  ///< at mesh phase 0, beside a response that repels
  Torques torques;     ///< of that response
};

struct RefinedOrbit {
  PeriodicOrbit orbit;
  int steps_per_mesh_cycle = 0;
  /// Floquet, modulus, with friction in the loop; absent: by the orbit's map it is clear enough.
  std::optional<double> marched_multiplier;
  /// Of loss (RMS and energy), torque and extremes of the transmission error, relative: what the
  /// last shortening of the steps changed, less what its order took away, or what a reference tells
  /// of the steps; and what sweeps left.
  double estimated_error = 0;
};

/// Oscillations of the mesh on its mean stiffness in a mesh cycle.
double mesh_oscillations(const GearPairSystem& system, double mean_pinion_speed);

/// More of them than refine_orbit() has steps for.
bool oscillates_too_often(double mesh_oscillations);

/// An attracting periodic response on a sequence of step lengths, each shorter than the one before,
/// until the estimated error is below the tolerance. None where shooting does not converge, the
/// response repels or nearly so, or the tolerance asks for more than the shortest steps: marching
/// decides then: `rattle` says where from if the march will not settle either. Adds to
/// `statistics`.
std::optional<RefinedOrbit> refine_orbit(GearPairSystem& system, const FlankContactBatch& contacts,
                                         MeshGrids& grids, const OrbitSearch& search,
                                         MarchStatistics& statistics, long& marched_cycles,
                                         std::optional<Rattle>& rattle);

}  // namespace tribodyn
