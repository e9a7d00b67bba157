#pragma once

namespace tribodyn {

/// More steps per mesh cycle are not tried.
inline constexpr int kMostSteps = 4000;

/// Numbers of steps per mesh cycle. The first end on samples of the tables and the second do not:
/// else both would see the kinks there in the same way and agree on the same error. In the end no
/// step has a kink inside.
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
  /// `excess`: the error over what is wanted. Where little is missing, few more are tried.
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

}  // namespace tribodyn
