#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/contact/flank_contact_batch.h"
#include "core/driveline/gear_pair_system.h"

namespace tribodyn {

/// A periodic response of one mesh cycle that is searched for, and where the search starts.
struct RivalProblem {
  const GearPairSystem& system;
  const FlankContactBatch& contacts;
  ContactTally& tally;
  double mean_pinion_speed;  ///< held [rad/s]
  MarchState start;          ///< at mesh phase 0
  Torques torques;           ///< T_s is a first guess: it is an unknown
  int first_cycles;          ///< marched from the start before the first iterate
};

/// Receives the RMS inefficiency [%] of each iterate.
using OnIterate = std::function<void(double inefficiency)>;

/// A common way to solve a periodic boundary value problem, at one accuracy. The last iterate is
/// the answer if it is finite. Throws std::runtime_error if an integrator fails.
struct PeriodicRival {
  std::string name;
  std::vector<double> accuracies;
  std::function<void(const RivalProblem& problem, double accuracy, const OnIterate& on_iterate)>
      solve;
};

/// Two rivals that solve eqs 1-11 with friction in the loop. Their unknowns are the states of
/// motion and T_s; their equations are that the state returns after a mesh cycle, at the mean speed
/// that is held. Both are Newton methods that keep the factored Jacobian while an iteration halves
/// the residual at least. The Jacobian is exact but for the friction arms, which it holds: what is
/// left out is a few percent of it, and the solution is not affected.
///
/// - "CVODE shooting": one period by CVODE (Adams). Whenever the Jacobian is renewed, the
///   variational equations are integrated together with the motion. Accuracy: tolerance of CVODE.
/// - "Gauss collocation": on equal intervals of mesh phase with four Gauss points each, as AUTO and
///   MATCONT have it, without their adaptive mesh. The points of an interval are eliminated by
///   dense LU, then its nodes from the first to the last. All contacts of an iterate are one batch.
///   Accuracy: intervals in a mesh cycle; where they divide the tooth contact tables evenly, kinks
///   of the tables fall between intervals, those of impacts never do.
///   (U. Ascher, R. Mattheij and R. Russell, Numerical Solution of Boundary Value Problems for
///   Ordinary Differential Equations, 1995, chapters 5 and 7.)
std::vector<PeriodicRival> periodic_rivals();

}  // namespace tribodyn
