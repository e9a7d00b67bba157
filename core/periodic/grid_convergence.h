#pragma once

#include <algorithm>

#include "core/periodic/orbit_friction.h"

namespace tribodyn {

// How few steps give an orbit's figures to a tolerance:
//  1. The orbit is solved on a sequence of grids, each finer by 1.5 or more (StepSequence).
//  2. From one grid to the next that is r times finer, the figures change by d. If their error
//     falls by r^p, it is d / (r^p - 1) on the finer grid (Richardson). Runge-Kutta's steps are of
//     the fourth order, but kinks of the tables inside of steps leave the second: p = 2 is assumed.
//     Only after two halvings is the fall measured, and taken between 2.5 and 8.
//  3. Times a safety factor; and never below what the error of the coarser grid allows at the
//     second order, halved, nor below a bound of what kinks do: two grids may agree by accident.
// (E. Hairer, S. P. Norsett and G. Wanner, Solving Ordinary Differential Equations I, 2nd ed.,
// 1993, section II.4; for safety factors P. J. Roache, J. Fluids Eng. 116, 1994, 405.)

/// From these tolerances on twelve and eight steps a mesh cycle may do. (Below 5e-4 eight save
/// nothing: random scenes then need a third grid.)
inline constexpr double kLooseTolerance = 3e-4, kVeryLooseTolerance = 5e-4;

/// More steps per mesh cycle are not tried.
inline constexpr int kMostStepsPerCycle = 4000;

/// Numbers of steps per mesh cycle, each larger than the one before. The steps of the first grid
/// end on samples of the mesh tables, those of the second do not: the errors that kinks at the
/// samples cause then differ between the grids, and Richardson's estimate is meaningful. On the
/// last grids no step has a kink inside.
class StepSequence {
 public:
  /// `intervals`: of the tables; `least`: steps of the first.
  StepSequence(int intervals, int least) : intervals_(intervals), coarsest_(least) {
    while (coarsest_ < intervals && intervals % coarsest_ != 0) ++coarsest_;
    if (coarsest_ > intervals) {
      coarsest_ = intervals;
      while (coarsest_ < least) coarsest_ *= 2;
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

/// Estimates the error of an orbit's figures from their changes on successive grids.
class GridComparison {
 public:
  /// `intervals`: of the mesh tables.
  explicit GridComparison(int intervals) : intervals_(intervals) {}

  /// Whether there is a coarser grid to compare with, and how many steps it has.
  bool is_possible() const { return steps_ > 0; }
  int steps() const { return steps_; }

  /// Of the figures on a grid of more steps, relative.
  double error(int steps, const OrbitFigures& figures) const {
    const double finer = static_cast<double>(steps) / steps_;
    const double change = figures.distance(figures_);
    // Second order at kinks and events; more only where two halvings have shown it.
    double gain = finer * finer;
    if (finer == 2 && halving_difference_ > 0) {
      gain = std::clamp(halving_difference_ / std::max(change, 1e-300), 2.5, 8.0);
    }
    return std::max(step_error(change, gain, error_, finer), kink_error(steps));
  }

  /// The grid that the next one is compared with; `error`: of its figures, 0 where not known.
  void add(int steps, const OrbitFigures& figures, double error) {
    halving_difference_ = steps == 2 * steps_ ? figures.distance(figures_) : 0;
    steps_ = steps;
    figures_ = figures;
    error_ = error;
  }
  void clear() { *this = GridComparison(intervals_); }

 private:
  /// Bound of the error by kinks of the tables inside of steps, where two step lengths agree by
  /// accident: twice the errors met. Without it the smallest percentile of estimate over error of
  /// random scenes (core/README.md) falls from 2.8 to 2.4.
  double kink_error(int steps) const {
    return steps % intervals_ == 0 ? 0 : 0.025 / (static_cast<double>(steps) * steps);
  }

  int intervals_, steps_ = 0;
  OrbitFigures figures_;
  double error_ = 0;
  double halving_difference_ = 0;  // of the figures to those of twice the step length; 0: unknown
};

}  // namespace tribodyn
