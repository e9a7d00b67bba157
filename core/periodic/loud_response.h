#pragma once

#include <array>
#include <map>
#include <optional>

#include "core/periodic/carried_state.h"
#include "core/periodic/periodic_problem.h"

namespace tribodyn {

/// The response with contact loss that may coexist with a quiet one. Backlash softens the mesh, so
/// such a response begins near a resonance and reaches from there to lower speeds:
///  1. An order h of the mesh can drive the flanks apart where its weight (order_weights.h),
///     magnified by resonance, comes near the mean force: at h Omega = omega, and by the ripple of
///     the stiffness at h Omega = 2 omega, where the response of an odd order repeats after two
///     mesh cycles.
///  2. At that speed, or at the one wanted if it is just above, periods are integrated from flanks
///     pressed together by half of the backlash more than at rest; shooting finds the orbit.
///  3. The orbit is continued down to the speed wanted, under the same known torque.
/// Friction is Coulomb's, so that the answer is the same for all lubricants: where the branch of
/// one of them ends differs by some tenths of a percent in speed. (A. Kahraman and R. Singh, J.
/// Sound Vib. 142, 1990, 49, for such responses of gears; R. Seydel, Practical Bifurcation and
/// Stability Analysis, 3rd ed., 2010, chapter 4, for continuation.)
///
/// Returns nullopt if there is none, or it does not attract.
std::optional<CarriedState> find_loud_response(const PeriodicProblem& problem);

/// Whether a response without contact loss exists and attracts, under the same friction.
bool has_quiet_response(const PeriodicProblem& problem);

/// A bounded cache of both, keyed by speed and load: a hit is bit-identical to recomputation. Of
/// one gear set and its options; one thread at a time.
class OtherResponses {
 public:
  std::optional<CarriedState> loud(const PeriodicProblem& problem);
  bool has_quiet(const PeriodicProblem& problem);

 private:
  static constexpr std::size_t kMostKept = 2000;
  /// Speed, torques and which torque is unknown.
  using Key = std::array<double, 4>;
  std::map<Key, std::optional<CarriedState>> loud_;
  std::map<Key, bool> quiet_;
};

}  // namespace tribodyn
