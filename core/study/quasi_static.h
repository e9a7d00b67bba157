#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <map>
#include <optional>

#include "core/dynamics/periodic_orbit.h"
#include "core/study/history_sampler.h"

namespace tribodyn {

struct QuasiStaticRequest {
  double mean_pinion_speed = 0;       ///< [rad/s]
  bool solve_wheel_torque = false;    ///< T_w is the unknown instead of T_s
  double tolerance = 1e-3;            ///< of the figures, relative, > 0
  std::function<bool()> interrupted;  ///< true: throws Cancelled
};

/// The cheap sibling of the full model: constant speeds, xdot = 0, and at each mesh phase the load
/// at which the pinion is in equilibrium, R_p F = T_s + T_fr,p(F). The unknown torque follows from
/// the mean power.
struct QuasiStatic {
  PeriodicOrbit orbit;  ///< its pieces hold the equilibria; no map
  int steps_per_mesh_cycle = 0;
  /// Of the figures, relative: what the last change of the grid tells and what sweeps left.
  double discretisation_error = 0;
};

/// Contacts of the whole mesh cycle together under lagged friction: each sweep divides the error
/// by some thirty. Two grids or more, until the estimate is within the tolerance or steps are
/// finest. Sets the system's torques and regime. None where a contact is refused (the system tells
/// why) or sweeps do not converge.
std::optional<QuasiStatic> solve_quasi_static(GearPairSystem& system,
                                              const FlankContactBatch& contacts, MeshGrids& grids,
                                              const QuasiStaticRequest& request);

/// Histories of it: solved anew at each phase that is wanted, by the reference kernel. Calls
/// `interrupted` in between; throws Cancelled.
void sample_quasi_static(GearPairSystem& system, QuasiStatic& solution, double mean_pinion_speed,
                         HistorySampler& history, const std::function<bool()>& interrupted);

/// How far the quasi-static figures are from those of the full model, relative, as
/// PointResult::estimated_relative_error means it. Inertia and dampers are added to first order
/// (inertial_correction), the contacts solved once more on the motion that results, and the figures
/// compared; the ripple of the mesh stiffness, harmonics beyond the grid and a margin come on top.
/// Infinite where that cannot tell: flanks may part, the mesh may resonate, or the ripple of the
/// stiffness may keep a vibration going.
double quasi_static_model_error(GearPairSystem& system, const FlankContactBatch& contacts,
                                MeshGrids& grids, const QuasiStaticRequest& request,
                                const QuasiStatic& solution);

/// False where the mechanics alone, before any friction is computed, say that the model's error is
/// beyond the tolerance. Costs two microseconds where that is far off, eight where it is near.
bool quasi_static_may_do(GearPairSystem& system, MeshGrids& grids,
                         const QuasiStaticRequest& request);

/// What quasi_static_may_do has said, for the lubricants that come after: it does not depend on
/// them. Of one gear set and its options; one thread at a time; bounded.
class QuasiStaticChances {
 public:
  bool may_do(GearPairSystem& system, MeshGrids& grids, const QuasiStaticRequest& request);

 private:
  static constexpr std::size_t kMost = 500;
  /// Speed, torques, tolerance and which torque is unknown.
  std::map<std::array<double, 5>, bool> known_;
};

}  // namespace tribodyn
