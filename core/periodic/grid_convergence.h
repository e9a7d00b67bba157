#pragma once

#include <algorithm>

#include "core/integrate/order_weights.h"
#include "core/periodic/orbit_friction.h"
#include "core/periodic/periodic_problem.h"

namespace tribodyn {

// How few steps give an orbit's figures to a tolerance:
//  1. The orbit is solved on a sequence of grids, each finer by 1.5 or more (StepSequence).
//  2. From one grid to the next that is r times finer, the figures change by d. If their error
//     falls by r^p, it is d / (r^p - 1) on the finer grid (Richardson). Runge-Kutta's steps are of
//     the fourth order, but kinks of the tables inside of steps leave the second: p = 2 is assumed.
//     Only after two halvings is the fall measured, and taken between 2.5 and 8.
//  3. Times a safety factor; and never below what the error of the coarser grid allows at the
//     second order, halved, nor below what kinks of the tables do to the grid's quadrature
//     (MeshGrid::kink_error): two grids may agree by accident.
//  4. Orders of the mesh that the grid does not resolve are bounded from their amplitudes and added
//     (order_weights.h): both grids may alias them alike.
// (E. Hairer, S. P. Norsett and G. Wanner, Solving Ordinary Differential Equations I, 2nd ed.,
// 1993, section II.4; for safety factors P. J. Roache, J. Fluids Eng. 116, 1994, 405.)

/// From these tolerances on twelve and eight steps a mesh cycle may do. (Below 5e-4 eight save
/// nothing: random scenes then need a third grid.)
inline constexpr double kLooseTolerance = 3e-4, kVeryLooseTolerance = 5e-4;

/// More steps per mesh cycle are not tried.
inline constexpr int kMostStepsPerCycle = 4000;

/// Numbers of steps per mesh cycle, each larger than the one before. Where the number of samples of
/// the mesh tables allows it, the steps of the first grid end on samples; those of the second do
/// not: the errors that kinks at the samples cause then differ between the grids, and Richardson's
/// estimate is meaningful. On the last grids no step has a kink inside.
class StepSequence {
 public:
  /// `intervals`: of the tables; `least`: steps of the first.
  StepSequence(int intervals, int least) : intervals_(intervals), coarsest_(least) {
    const int most = least + least / 2;
    for (int steps = least; steps <= most; ++steps) {
      if (intervals % steps != 0 && steps % intervals != 0) continue;
      coarsest_ = steps;
      break;
    }
  }
  int first() const { return coarsest_; }
  /// `excess`: the error over the tolerance. Below 2 the next grid has only half as many steps
  /// more.
  int after(int steps, double excess) const {
    if (steps == coarsest_) return coarsest_ * 5 / 3;
    if (steps == coarsest_ * 5 / 3 && excess < 2) return coarsest_ * 5 / 2;
    if (steps % intervals_ == 0 || 3 * steps <= intervals_) return 2 * steps;
    int next = intervals_;
    while (next < 2 * steps) next *= 2;
    return next;
  }

 private:
  int intervals_, coarsest_;
};

/// Factor on the error estimate of two grids: measured against marches of random scenes.
inline constexpr double kGridSafety = 1.7;

/// The error of figures whose steps are `finer` times shorter than those of a coarser grid, by what
/// that has changed of them: Richardson's estimate, for errors that fall by `gain`.
/// `coarser_error`: of the coarser grid's figures. Two step lengths may agree by accident, three
/// rarely do.
inline double step_error(double change, double gain, double coarser_error, double finer) {
  return std::max(kGridSafety * change / (gain - 1), coarser_error / (2 * finer * finer));
}

/// Share of the tolerance that orders without enough nodes may take on the second grid.
inline constexpr double kShareOfUnresolved = 0.3;

/// The fewest steps of a first grid, by the orders of the mesh: the second grid resolves those that
/// matter.
inline int least_steps_for_orders(const PeriodicProblem& problem) {
  return resolving_steps(problem.system, problem.torques, problem.mean_pinion_speed,
                         kShareOfUnresolved * problem.tolerance) *
         3 / 5;
}

/// Estimates the error of an orbit's figures from their changes on successive grids.
class GridComparison {
 public:
  /// Keeps the reference.
  explicit GridComparison(const PeriodicProblem& problem) : problem_(&problem) {}

  /// Whether there is a coarser grid to compare with, and how many steps it has.
  bool is_possible() const { return steps_ > 0; }
  int steps() const { return steps_; }

  /// Of the figures on a grid of more steps, relative.
  double error(const MeshGrid& grid, const OrbitFigures& figures) const {
    const double finer = static_cast<double>(grid.steps()) / steps_;
    const double change = figures.distance(figures_);
    // Second order at kinks and events; more only where two halvings have shown it.
    double gain = finer * finer;
    if (finer == 2 && halving_difference_ > 0) {
      gain = std::clamp(halving_difference_ / std::max(change, 1e-300), 2.5, 8.0);
    }
    return std::max(step_error(change, gain, error_, finer), grid.kink_error()) +
           unresolved_error(problem_->system, problem_->torques, problem_->mean_pinion_speed,
                            grid.steps());
  }

  /// The grid that the next one is compared with; `error`: of its figures, 0 where not known.
  void add(int steps, const OrbitFigures& figures, double error) {
    halving_difference_ = steps == 2 * steps_ ? figures.distance(figures_) : 0;
    steps_ = steps;
    figures_ = figures;
    error_ = error;
  }
  void clear() { *this = GridComparison(*problem_); }

 private:
  const PeriodicProblem* problem_;
  int steps_ = 0;
  OrbitFigures figures_;
  double error_ = 0;
  double halving_difference_ = 0;  // of the figures to those of twice the step length; 0: unknown
};

}  // namespace tribodyn
