#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace tribodyn {

/// Friction torques per newton of load [m]: what eqs 2 and 3 need of the contacts at one phase.
struct FrictionPerLoad {
  double pinion = 0;
  double gear = 0;
};

/// Friction of a whole response, frozen in proportion to the load. Friction goes nearly like the
/// load, so the dynamics under it are off by little, and by less each time it is evaluated anew on
/// the response that follows. Between its phases a straight line.
class LaggedFriction {
 public:
  void clear() {
    phases_.clear();
    values_.clear();
    cursor_ = 0;
  }
  /// Phases [cycles] must not fall.
  void add(double phase, const FrictionPerLoad& value) {
    phases_.push_back(phase);
    values_.push_back(value);
  }
  /// The last value added, or none.
  FrictionPerLoad last() const { return values_.empty() ? FrictionPerLoad{} : values_.back(); }

  /// Fast where phases follow each other.
  FrictionPerLoad at(double phase) {
    if (phases_.size() < 2) return last();
    while (cursor_ > 0 && phases_[cursor_] > phase) --cursor_;
    while (cursor_ + 2 < phases_.size() && phases_[cursor_ + 1] <= phase) ++cursor_;
    const double width = phases_[cursor_ + 1] - phases_[cursor_];
    const double t = width > 0 ? std::clamp((phase - phases_[cursor_]) / width, 0.0, 1.0) : 0;
    const FrictionPerLoad &a = values_[cursor_], &b = values_[cursor_ + 1];
    return {a.pinion + t * (b.pinion - a.pinion), a.gear + t * (b.gear - a.gear)};
  }

 private:
  std::vector<double> phases_;
  std::vector<FrictionPerLoad> values_;
  std::size_t cursor_ = 0;
};

}  // namespace tribodyn
