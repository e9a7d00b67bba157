#include "core/periodic/branch_end.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace tribodyn {
namespace {

/// How much wider the one's transmission error swings than the other's, over the wider swing.
double distance(const BranchPoint& a, const BranchPoint& b) {
  const double larger = std::max(a.swing, b.swing);
  return larger > 0 ? std::abs(a.swing - b.swing) / larger : 0;
}

/// Whether flanks part in both or in neither, and both repeat after as many mesh cycles. Responses
/// of two kinds are on two branches, or their branch changes its kind in between without a jump.
bool of_one_kind(const BranchPoint& a, const BranchPoint& b) {
  return a.state.contact_loss == b.state.contact_loss && a.state.period == b.state.period;
}

// The constants below were varied over the sweeps of core/README.md.

// Distance of swings, relative, up to which two responses are on one branch. With 0.02 and 0.3 the
// sweeps report the same ends, with 0.4 the one at 71.4 km/h is missed.
constexpr double kSameBranchDistance = 0.1;
// Not critical: with 0.15 and 0.6 the sweeps report the same ends.
constexpr double kSwingDifferenceOfBranches = 0.3;  // relative
// Width to which an end is located [m/s], as BranchEnd states; not tuned.
constexpr double kSpeedResolution = 0.04 / 3.6;
constexpr double kUnlimitedStride = std::numeric_limits<double>::infinity();

/// Where a branch may end: a response on it, one on another, and between them or at the other one
/// the nearest speed at which the branch is not found.
struct Bracket {
  BranchPoint before, beyond;
  double gone_at;    // [m/s]
  long cycles_left;  // to march, where shooting does not decide
};

/// Whether a response found in between is on the branch rather than with the response beyond. Over
/// a wide step swings of one branch may differ more than those of two: the kind decides first.
bool is_on_branch(const Bracket& bracket, const BranchPoint& found) {
  if (of_one_kind(found, bracket.before) && !of_one_kind(found, bracket.beyond)) return true;
  return distance(bracket.before, found) <= distance(found, bracket.beyond);
}

/// Solves at a speed from the branch and narrows the bracket to either side of it. Returns false if
/// the branch connects to the response beyond, so that there is no end between them.
bool narrow_at(double speed, const SolveOnBranch& solve, Bracket& bracket) {
  const std::optional<BranchPoint> found = solve(speed, bracket.before);
  if (!found) {
    bracket.gone_at = speed;
    return true;
  }
  bracket.cycles_left -= found->marched_cycles;
  const double first = distance(bracket.before, *found), second = distance(*found, bracket.beyond);
  if (found->settled && bracket.before.state.period == bracket.beyond.state.period &&
      std::max(first, second) < kSameBranchDistance) {
    // Contact loss in one of the two responses only is no jump either: flanks begin to part.
    return false;
  }
  if (found->settled && is_on_branch(bracket, *found)) {
    bracket.before = *found;
    return true;
  }
  bracket.gone_at = speed;
  if (found->settled) bracket.beyond = *found;
  return true;
}

/// Repeats narrow_at(), halving the bracket, until it is as narrow as the speed resolution or no
/// mesh cycles are left to march. `stride`: the longest first step from the branch [m/s]; doubled
/// after each. Returns false if narrow_at() does.
bool narrow(const SolveOnBranch& solve, double stride, Bracket& bracket) {
  for (;; stride *= 2) {
    const double width = bracket.gone_at - bracket.before.speed;
    if (std::abs(width) <= 1.001 * kSpeedResolution || bracket.cycles_left <= 0) return true;
    const double step =
        std::copysign(std::max(std::min(0.5 * std::abs(width), stride), kSpeedResolution), width);
    if (!narrow_at(bracket.before.speed + step, solve, bracket)) return false;
  }
}

/// Follows a response to a speed, or as near to it as its branch reaches, with steps that are
/// doubled on the branch and halved where it is missed.
BranchPoint follow(const SolveOnBranch& solve, BranchPoint from, double to) {
  constexpr int kMostPoints = 24;  // a limit of work: with 8 the sweeps report the same ends
  double step = to - from.speed;
  for (int i = 0; i < kMostPoints && from.speed != to; ++i) {
    const bool arrives = std::abs(to - from.speed) <= std::abs(step);
    const std::optional<BranchPoint> next = solve(arrives ? to : from.speed + step, from);
    if (next && !may_be_branches(from, *next)) {
      from = *next;
      step *= 2;
      continue;
    }
    step /= 2;  // a shorter step may stay on the branch
    if (std::abs(step) < kSpeedResolution) break;
  }
  return from;
}

std::optional<BranchEnd> end_of(const Bracket& bracket) {
  if (distance(bracket.before, bracket.beyond) < kSameBranchDistance) return std::nullopt;
  return BranchEnd{bracket.before.speed, bracket.gone_at};
}

}  // namespace

bool may_be_branches(const BranchPoint& a, const BranchPoint& b) {
  return a.settled && b.settled &&
         (!of_one_kind(a, b) || distance(a, b) > kSwingDifferenceOfBranches);
}

BranchPoint follow_towards(double speed, const BranchPoint& from, const BranchSolver& solver,
                           std::optional<BranchEnd>& end) {
  // Of the speed, relative: where a branch doubles, shooting finds nothing that far.
  constexpr double kLongestGap = 0.05;
  BranchPoint at = from;
  if (!solver.by_shooting) return at;
  const auto left = [&] { return std::log(speed / at.speed); };
  while (at.settled && std::abs(left()) > at.longest_step) {
    std::optional<BranchPoint> found;
    for (double step = at.longest_step; !found; step *= 2) {
      if (step > std::max(at.longest_step, kLongestGap) || step > std::abs(left())) {
        return end ? at : from;
      }
      const double next = at.speed * std::exp(std::copysign(step, left()));
      found = solver.by_shooting(next, at);
      if (!found) found = solver.loud(next);
    }
    if (!end && may_be_branches(at, *found)) end = find_branch_end(at, *found, solver);
    at = *found;
  }
  return at;
}

std::optional<BranchEnd> find_branch_end(const BranchPoint& before, const BranchPoint& after,
                                         const BranchSolver& solver) {
  const SolveOnBranch& any_method = solver.by_any_method;
  Bracket bracket{before, after, after.speed, std::numeric_limits<long>::max()};
  if (!solver.by_shooting) {
    return narrow(any_method, kUnlimitedStride, bracket) ? end_of(bracket) : std::nullopt;
  }
  constexpr long kMostMarchedCycles = 600;  // with 200 and 2000 the sweeps report the same ends
  bracket.cycles_left = kMostMarchedCycles;
  if (!narrow(solver.by_shooting, kUnlimitedStride, bracket)) return std::nullopt;
  if (bracket.gone_at != bracket.beyond.speed) {
    if (!any_method) return std::nullopt;
    // Where the period changes orbits hardly attract, and a march takes its time: the other branch
    // decides, followed to where this one is not found.
    if (bracket.before.state.period != bracket.beyond.state.period) {
      const BranchPoint there = follow(solver.by_shooting, bracket.beyond, bracket.gone_at);
      if (std::abs(there.speed - bracket.gone_at) < 4 * kSpeedResolution) {
        if (distance(bracket.before, there) < kSameBranchDistance) return std::nullopt;
        return BranchEnd{bracket.before.speed, bracket.gone_at};
      }
    }
    // The branch may go on with another period, or attract too weakly for shooting to decide.
    const double speed = std::exchange(bracket.gone_at, bracket.beyond.speed);
    if (!narrow_at(speed, any_method, bracket)) return std::nullopt;
  }
  // Close to an end marching takes its time: steps begin short.
  if (any_method && !narrow(any_method, 2 * kSpeedResolution, bracket)) return std::nullopt;
  return end_of(bracket);
}

}  // namespace tribodyn
