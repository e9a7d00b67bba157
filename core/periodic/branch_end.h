#pragma once

#include <functional>
#include <limits>
#include <optional>

#include "core/periodic/carried_state.h"

namespace tribodyn {

/// A response on a branch: the figures by which branches differ, and the state from which the
/// search for a neighbour starts.
struct BranchPoint {
  double speed = 0;         ///< of the vehicle [m/s]: the branch is continued over it
  double swing = 0;         ///< of the transmission error: greatest less least [m]
  bool settled = false;     ///< it repeats
  long marched_cycles = 0;  ///< mesh cycles marched to find it; 0 if shooting found it
  CarriedState state;
  /// Of the speed, relative, to a neighbour: a longer step might miss a bifurcation.
  double longest_step = std::numeric_limits<double>::infinity();
};

/// Where the branch that a sweep follows ends, as at a fold: the response jumps. In the sweep's
/// direction.
struct BranchEnd {
  double followed_to = 0;  ///< the last speed on the branch [m/s]
  /// The nearest speed at which it is not found [m/s]: 0.04 km/h farther, or more where hardly any
  /// response attracts and some hundred mesh cycles of marching do not decide.
  double gone_at = 0;
};

/// Finds the response at a speed [m/s] from another response. Returns nullopt if there is none.
using SolveOnBranch = std::function<std::optional<BranchPoint>(double, const BranchPoint&)>;

/// How the responses between two points are found; at least one of the functions is set.
struct BranchSolver {
  SolveOnBranch by_shooting;  ///< not set: responses are only marched
  /// By shooting, or marched where shooting does not decide; not set: only shooting is wanted.
  SolveOnBranch by_any_method;
  /// The response with contact loss at a speed, by shooting from PointStart::kLargeVibration.
  std::function<std::optional<BranchPoint>(double)> loud = {};
};

/// Tightest relative tolerance of the solutions that locate an end: a hundredth of the distance of
/// swings at which branches differ.
inline constexpr double kBranchTolerance = 1e-3;
/// Largest number of mesh cycles that one of these solutions may march: more than the periods that
/// shooting integrates in doubt (find_orbit.cpp, 300 of one mesh cycle). With 150 the sweeps of
/// core/README.md down across 65 km/h take twenty times as long.
inline constexpr int kMostBranchCycles = 400;

/// Whether two neighbours of a sweep may be on different branches: flanks part at one of them only,
/// the period differs, or the swing of the transmission error differs by 30 %.
bool may_be_branches(const BranchPoint& a, const BranchPoint& b);

/// Follows a branch towards a speed [m/s] by natural-parameter continuation, with steps that no
/// bifurcation hides in (BranchPoint::longest_step). Returns the last point, from where one step
/// reaches the speed, or `from` if none is found on the way. Where the branch ends on the way, it continues on that
/// of the response with contact loss, and `end` is set unless it is already.
BranchPoint follow_towards(double speed, const BranchPoint& from, const BranchSolver& solver,
                           std::optional<BranchEnd>& end);

/// Locates the end of a branch between two neighbours of a sweep by natural-parameter continuation
/// (R. Seydel, Practical Bifurcation and Stability Analysis, 3rd ed., 2010, chapter 4).
///  1. The interval between them is bisected: each middle starts from the last point on the branch
///     and becomes that point, or the point beyond, by its kind and its swing. If the swings close
///     up, there is no jump; otherwise it lies between the last two speeds.
///  2. Shooting bisects first. Where it finds nothing, as near a fold or a period doubling, the
///     other branch is followed to there, or some hundred mesh cycles are marched at a speed.
/// A branch that is left and found again between the neighbours is not noticed, nor is a jump by
/// some 10 % of the swing. By shooting alone an end is found only if shooting finds the branch
/// beyond it. Returns nullopt if no branch ends, and one of several ends.
std::optional<BranchEnd> find_branch_end(const BranchPoint& before, const BranchPoint& after,
                                         const BranchSolver& solver);

}  // namespace tribodyn
