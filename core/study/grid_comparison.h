#pragma once

#include <algorithm>

#include "core/dynamics/orbit_friction.h"

namespace tribodyn {

/// The factor on an error that two grids give: measured against marches over random scenes.
inline constexpr double kGridSafety = 1.7;

/// The error of a response's figures by what shorter steps have changed of them.
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
    // Two step lengths may agree by accident, three rarely do.
    return std::max(
        {kGridSafety * change / (gain - 1), error_ / (2 * finer * finer), kink_error(steps)});
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
  /// What kinks of the tables inside of steps may do where two step lengths agree by accident: by
  /// experience half of it.
  double kink_error(int steps) const {
    return steps % intervals_ == 0 ? 0 : 0.025 / (static_cast<double>(steps) * steps);
  }

  int intervals_, steps_ = 0;
  OrbitFigures figures_;
  double error_ = 0;
  double halving_difference_ = 0;  // of the figures to those of twice the step length; 0: unknown
};

}  // namespace tribodyn
