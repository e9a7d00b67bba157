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
///     pressed together by some half backlashes more than at rest; shooting finds the orbit.
///  3. The orbit is continued down to the speed wanted, under the same known torque.
/// Friction is Coulomb's, so that the answer is the same for all lubricants: where the branch of
/// one of them ends differs by some tenths of a percent in speed. (A. Kahraman and R. Singh, J.
/// Sound Vib. 142, 1990, 49, for such responses of gears; R. Seydel, Practical Bifurcation and
/// Stability Analysis, 3rd ed., 2010, chapter 4, for continuation.)
///
/// Returns nullopt if there is none, or it does not attract.
std::optional<CarriedState> find_loud_response(const PeriodicProblem& problem);

/// Whether a response without contact loss, or hardly any, exists and attracts, under the same
/// friction.
bool has_quiet_response(const PeriodicProblem& problem);

/// Bounded caches of both, which depend on speed and load alone: a hit is bit-identical to
/// recomputation. Of one gear set and its options; one thread at a time.
class OtherResponses {
 public:
  /// As find_loud_response().
  std::optional<CarriedState> loud(const PeriodicProblem& problem);
  /// Whether the speed is within the range of a loud response under the next torque on a lattice of
  /// ratio 1.15: good to a percent or two of the speed. The range of a torque takes some
  /// milliseconds to find, and serves all speeds.
  bool may_be_loud(const PeriodicProblem& problem);
  /// As has_quiet_response().
  bool may_be_quiet(const PeriodicProblem& problem);

 private:
  static constexpr std::size_t kMostKept = 2000;
  /// Speed, torques and which torque is unknown.
  using StateKey = std::array<double, 4>;
  /// Torque of the lattice, which torque is unknown, speed and period of the resonance.
  using BranchKey = std::array<double, 4>;
  double natural_ = 0;  ///< of the mesh [rad/s]; 0: not known yet
  std::map<StateKey, std::optional<CarriedState>> loud_;
  std::map<StateKey, bool> quiet_;
  std::map<BranchKey, double> lowest_;  ///< speed that the branch reaches [rad/s]
};

}  // namespace tribodyn
