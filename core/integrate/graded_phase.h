#pragma once

#include "core/numerics/bracketed_root.h"

namespace tribodyn {

/// Independent variable for a smooth piece of the mesh cycle that may begin or end at a corner:
/// friction under a load that starts from zero goes like the power 0.74 of the distance, which no
/// Runge-Kutta step integrates at its order. Mesh phase goes like the cube of the variable s
/// there, so that the integrand becomes a power 4.2 of s and even steps keep their fifth order (the
/// substitution that makes end-point singularities harmless in quadrature: P. J. Davis and
/// P. Rabinowitz, Methods of Numerical Integration, 2nd ed., 1984, section 2.9).
///
/// s and phase [cycles] agree at the end of the piece; without corners they differ at most by a
/// straight line.
class GradedPhase {
 public:
  GradedPhase() = default;
  /// From (s, phase) to `end`, which both reach together.
  GradedPhase(double s, double phase, double end, bool corner_at_start, bool corner_at_end)
      : first_s_(s),
        first_phase_(phase),
        last_(end),
        at_start_(corner_at_start),
        at_end_(corner_at_end) {}

  double phase(double s) const {
    const double length = last_ - first_s_;
    if (!(length > 0) || s == last_) return last_;
    const double v = (s - first_s_) / length;
    if (at_end_ && !at_start_) return last_ - (last_ - first_phase_) * share(1 - v);
    return first_phase_ + (last_ - first_phase_) * share(v);
  }

  /// d phase / d s.
  double slope(double s) const {
    const double length = last_ - first_s_;
    if (!(length > 0)) return 1;
    const double v = (s - first_s_) / length;
    return (last_ - first_phase_) / length * share_slope(at_end_ && !at_start_ ? 1 - v : v);
  }

  /// Inverse of phase().
  double s_of(double phase) const {
    if (phase <= first_phase_) return first_s_;
    if (phase >= last_) return last_;
    const auto miss = [&](double at) { return this->phase(at) - phase; };
    return bracketed_root(miss, first_s_, last_);
  }

 private:
  /// Share of the piece's phase at the share v of its s.
  double share(double v) const {
    if (at_start_ && at_end_) return v * v * v * (10 + v * (6 * v - 15));
    return at_start_ || at_end_ ? v * v * v : v;
  }
  double share_slope(double v) const {
    if (at_start_ && at_end_) return 30 * v * v * (1 - v) * (1 - v);
    return at_start_ || at_end_ ? 3 * v * v : 1;
  }

  double first_s_ = 0, first_phase_ = 0, last_ = 0;
  bool at_start_ = false, at_end_ = false;
};

}  // namespace tribodyn
