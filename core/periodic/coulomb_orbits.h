#pragma once

#include <array>
#include <map>
#include <vector>

#include "core/periodic/periodic_orbit.h"
#include "core/periodic/periodic_problem.h"

namespace tribodyn {

// Varied over screen_point() of the first 250 random scenes of core/README.md: as they stand, none
// of 248 estimates is below the error (of the first 1000 scenes, two of 996).

/// Share of a tolerance for the error of the steps; the rest is for the Picard iteration. Not
/// critical: 0.5 and 0.9 leave the estimates bounds as well.
inline constexpr double kShareOfSteps = 0.75;

/// A lubricant's losses may follow the mesh force more than those of Coulomb's friction do: what
/// the steps do to its figures is at most so many times the error of Coulomb's orbit. With 1 five
/// of 248 screened scenes err more than estimated and three more than the tolerance; with 6 they
/// take 1.8 % more contacts.
inline constexpr double kCoulombErrorFactor = 3;

/// Finds the orbit from `origin` under Coulomb's friction in place of a lubricant's, to start every
/// lubricant's search and to give the error of its steps: the orbits of all lubricants are near,
/// and the steps do nearly the same to them.
///  1. OrbitSolver solves on one grid after another, at most five, until Richardson's estimate
///     (grid_convergence.h) is small enough for kLooseTolerance, or bilateral contact needs
///     tension.
///  2. The error of each coarser grid is its distance from the finest one and the error of that.
///  3. If the error falls more slowly than the square of the steps from the first grid to the next,
///     the first one is measured under another friction coefficient too: one may hide it.
/// (Richardson's extrapolation: E. Hairer, S. P. Norsett and G. Wanner, Solving Ordinary
/// Differential Equations I, 2nd ed., 1993, section II.4.) `estimated_error` is that of the steps;
/// infinite if it is not known. Returns nothing if there is no such orbit. `least`: steps of the
/// first grid.
std::vector<PeriodicOrbit> coulomb_orbits(const PeriodicProblem& problem,
                                          const ShootingOptions& options,
                                          const PeriodicOrbit& origin, int least);

/// A bounded cache of coulomb_orbits(), keyed by gear set, load, speed and start alone: a hit is
/// bit-identical to recomputation. Of one gear set and its options; one thread at a time.
class CoulombOrbits {
 public:
  /// As coulomb_orbits(). Valid until the next call.
  const std::vector<PeriodicOrbit>& find(const PeriodicProblem& problem,
                                         const ShootingOptions& options,
                                         const PeriodicOrbit& origin, int least);

 private:
  static constexpr int kMostStepsKept = 20'000;  // of some 2 KB each
  using Key = std::array<double, 8 + kMarchComponents>;

  std::map<Key, std::vector<PeriodicOrbit>> found_;
  int steps_kept_ = 0;
};

}  // namespace tribodyn
