#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <string>

#include "core/integrate/solver_work.h"
#include "core/refusal.h"

namespace tribodyn {

struct MarchOptions {
  double relative_tolerance = 1e-7;  ///< of each component's scale, per step
  double maximum_step = std::numeric_limits<double>::infinity();
  long maximum_steps = 2000000;  ///< of one run(); beyond it Refusal("WORK_LIMIT")
  /// Asked every few hundred steps; true stops the run with Cancelled. May be empty.
  std::function<bool()> interrupted;
  /// The same, with Refusal("WORK_LIMIT").
  std::function<bool()> is_out_of_work;
};

/// One accepted step with its continuous extension; valid during the callback only.
template <int N>
struct MarchStep {
  using State = std::array<double, N>;
  double start, length;
  const State& from;
  const State& to;
  const std::array<State, 7>& stage;

  /// State at start + theta length, theta in [0, 1]: fourth-order extension of the pair
  /// (Hairer, Norsett and Wanner, Solving Ordinary Differential Equations I, II.6).
  State at(double theta) const {
    const double t = theta, u = 1 - theta;
    constexpr double d1 = -12715105075.0 / 11282082432.0, d3 = 87487479700.0 / 32700410799.0,
                     d4 = -10690763975.0 / 1880347072.0, d5 = 701980252875.0 / 199316789632.0,
                     d6 = -1453857185.0 / 822651844.0, d7 = 69997945.0 / 29380423.0;
    State out;
    for (int i = 0; i < N; ++i) {
      const double difference = to[i] - from[i];
      const double bend = length * stage[0][i] - difference;
      const double rest = difference - length * stage[6][i] - bend;
      const double last = length * (d1 * stage[0][i] + d3 * stage[2][i] + d4 * stage[3][i] +
                                    d5 * stage[4][i] + d6 * stage[5][i] + d7 * stage[6][i]);
      out[i] = from[i] + t * (difference + u * (bend + t * (rest + u * last)));
    }
    return out;
  }
};

/// Dormand-Prince 5(4) march of a piecewise smooth system. Within a regime and between breakpoints
/// the right-hand side is smooth; steps end exactly on breakpoints and on events, so the order is
/// that of the pair everywhere (Dormand and Prince, J. Comput. Appl. Math. 6, 1980, 19).
///
/// Corners: a piece may end at an event like a power t^p, 0 < p < 1, of the distance (friction
/// under a load that falls to zero). The embedded estimate covers only a part of the error there.
/// Steps that come near such an event are tested more sharply, so that they shrink towards it and
/// the error of the whole stays in proportion to the tolerance. Corners in known places are better
/// taken out of the right-hand side by a substitution.
///
/// System provides
///   static constexpr int kSize, kEvents; using State = std::array<double, kSize>;
///   void derivative(double s, const State& y, State& dy)      in the current regime, continued
///                                                             smoothly a little beyond its edge
///   void events(double s, const State& y, std::array<double, kEvents>& g)
///       an event happens where g rises through 0; scaled so that 1e-13 is nothing; -1 if none
///   void on_event(int index, double s, const State& y)        changes the regime
///   double next_breakpoint(double s)  first point beyond s where the right-hand side of the
///                                     current regime has a kink
///   void on_breakpoint(double s)      s was reached
///   double scale(int i)               size of component i for the error test; infinity: not tested
/// and may provide
///   bool corner_at(int index)         the piece ends with a corner at this event
///   void on_no_step()                 no step however short succeeds: may throw the reason
/// No allocation; throws Refusal CHATTER, NOT_FINITE, WORK_LIMIT, and Cancelled.
template <class System>
class DormandPrinceWithEvents {
 public:
  static constexpr int N = System::kSize;
  using State = std::array<double, N>;

  DormandPrinceWithEvents(System& system, const MarchOptions& options)
      : system_(system), options_(options) {}

  /// Marches y from s to end. Calls `on_step(MarchStep<N>)` after every accepted step.
  template <class OnStep>
  void run(double& s, State& y, double end, OnStep&& on_step) {
    evaluate(s, y, k_[0]);
    double breakpoint = std::min(end, system_.next_breakpoint(s));
    if (next_step_ <= 0) next_step_ = std::min(breakpoint - s, options_.maximum_step);
    int chatter = 0;
    long attempts = 0;
    bool towards_corner = false;
    while (s < end) {
      if (++attempts % 256 == 0) {
        if (attempts > options_.maximum_steps ||
            (options_.is_out_of_work && options_.is_out_of_work())) {
          throw Refusal("WORK_LIMIT", "the march took " + std::to_string(attempts) +
                                          " steps without reaching the end of the mesh cycle");
        }
        if (options_.interrupted && options_.interrupted()) throw Cancelled();
      }
      const double room = breakpoint - s;
      double h = std::min({next_step_, options_.maximum_step, room});
      bool at_breakpoint = false;
      if (h > 0.999999 * room) {
        h = room;
        at_breakpoint = true;
      } else if (h > 0.5 * room && !towards_corner) {
        h = 0.5 * room;  // two even steps instead of a long and a sliver
      }
      const double error = attempt(s, y, h);
      if (!(error <= 1)) {
        ++work_.rejected_steps;
        next_step_ = h * (std::isfinite(error) ? std::max(0.2, 0.9 * std::pow(error, -0.2)) : 0.1);
        if (!(s + next_step_ > s)) {
          if constexpr (requires { system_.on_no_step(); }) system_.on_no_step();
          throw Refusal("NOT_FINITE", "the march cannot go on: step size vanished");
        }
        continue;
      }
      const double growth = std::clamp(0.9 * std::pow(std::max(error, 1e-10), -0.2), 0.5, 4.0);
      double suggested = h * growth;
      if (at_breakpoint || h < next_step_)
        suggested = std::max(suggested, std::min(next_step_, 4 * h));

      const int event = first_event(s, y, h);
      if (event >= 0 && event_error_ * kUnseenBeforeCorner > 1 && corner_at(event) &&
          event_step_ > 1e-9 * h) {
        ++work_.rejected_steps;
        next_step_ = event_step_ * (1 - nearer_corner(event_error_ * kUnseenBeforeCorner));
        towards_corner = true;
        continue;
      }
      if (event < 0 && towards_corner && error * kUnseenBeforeCorner > 1) {
        ++work_.rejected_steps;
        next_step_ = 0.5 * h;
        continue;
      }
      if (event >= 0) {
        at_breakpoint = false;
        suggested = std::max(suggested, next_step_);
      }
      finish_step(s, y, event >= 0 ? event_step_ : h, on_step);
      if (at_breakpoint) s = breakpoint;
      if (event >= 0) {
        ++work_.events;
        chatter = event_step_ < 1e-12 * h ? chatter + 1 : 0;
        if (chatter > 50) throw Refusal("CHATTER", "contact opens and closes without end");
        system_.on_event(event, s, y);
        breakpoint = std::min(end, system_.next_breakpoint(s));
        evaluate(s, y, k_[0]);
        towards_corner = false;
      } else {
        chatter = 0;
      }
      next_step_ = suggested;
      if (at_breakpoint && s < end) {
        system_.on_breakpoint(s);
        breakpoint = std::min(end, system_.next_breakpoint(s));
        towards_corner = false;
      }
    }
  }

  void run(double& s, State& y, double end) {
    run(s, y, end, [](const MarchStep<N>&) {});
  }

  const SolverWork& work() const { return work_; }
  void restart() { next_step_ = 0; }

 private:
  /// Error over estimate for t^p, 0.6 < p < 1, on a step that ends at the corner.
  static constexpr double kUnseenBeforeCorner = 100;

  bool corner_at(int event) const {
    if constexpr (requires { system_.corner_at(event); }) return system_.corner_at(event);
    return false;
  }
  /// By how much a step must come nearer to a corner, where errors fall like h^(1 + p) only.
  static double nearer_corner(double error) { return std::max(0.02, 0.9 / std::sqrt(error)); }

  void evaluate(double s, const State& y, State& dy) {
    ++work_.right_hand_sides;
    system_.derivative(s, y, dy);
  }

  /// Stages 2 to 7 from k_[0]; the new state in next_. Returns the scaled error (NaN possible).
  double attempt(double s, const State& y, double h) {
    static constexpr double c[6] = {0.2, 0.3, 0.8, 8.0 / 9, 1, 1};
    static constexpr double a[6][6] = {
        {0.2},
        {3.0 / 40, 9.0 / 40},
        {44.0 / 45, -56.0 / 15, 32.0 / 9},
        {19372.0 / 6561, -25360.0 / 2187, 64448.0 / 6561, -212.0 / 729},
        {9017.0 / 3168, -355.0 / 33, 46732.0 / 5247, 49.0 / 176, -5103.0 / 18656},
        {35.0 / 384, 0, 500.0 / 1113, 125.0 / 192, -2187.0 / 6784, 11.0 / 84}};
    static constexpr double e[7] = {71.0 / 57600,      0,          -71.0 / 16695, 71.0 / 1920,
                                    -17253.0 / 339200, 22.0 / 525, -1.0 / 40};
    for (int stage = 0; stage < 6; ++stage) {
      for (int i = 0; i < N; ++i) {
        double sum = 0;
        for (int j = 0; j <= stage; ++j) sum += a[stage][j] * k_[j][i];
        next_[i] = y[i] + h * sum;
      }
      evaluate(s + c[stage] * h, next_, k_[stage + 1]);
    }
    double worst = 0;
    for (int i = 0; i < N; ++i) {
      const double scale = system_.scale(i);
      if (std::isinf(scale)) continue;
      double error = 0;
      for (int j = 0; j < 7; ++j) error += e[j] * k_[j][i];
      error = std::abs(h * error) / (scale * options_.relative_tolerance);
      if (std::isnan(error)) return error;
      worst = std::max(worst, error);
    }
    return worst;
  }

  template <class OnStep>
  void finish_step(double& s, State& y, double h, OnStep&& on_step) {
    on_step(MarchStep<N>{s, h, y, next_, k_});
    ++work_.accepted_steps;
    s += h;
    y = next_;
    k_[0] = k_[6];
  }

  double event_value(double s, const State& y, int index) {
    std::array<double, System::kEvents> g;
    system_.events(s, y, g);
    return g[index];
  }

  /// The first event inside the step, or -1. Its place is found on true steps of the pair, not on
  /// the extension; the stages and next_ then belong to the step up to the event, event_step_.
  int first_event(double s, const State& y, double h) {
    constexpr double kNothing = 1e-13;
    constexpr int kProbes = 4;
    const MarchStep<N> step{s, h, y, next_, k_};
    std::array<std::array<double, System::kEvents>, kProbes + 1> g;
    system_.events(s, y, g[0]);
    int found = -1;
    double upper = std::numeric_limits<double>::infinity();
    for (int probe = 1; probe <= kProbes && found < 0; ++probe) {
      const double theta = static_cast<double>(probe) / kProbes;
      system_.events(s + theta * h, probe == kProbes ? next_ : step.at(theta), g[probe]);
      for (int index = 0; index < System::kEvents; ++index) {
        double left = theta - 1.0 / kProbes, right = theta;
        if (!(g[probe][index] > kNothing)) {
          // Up and down again between the probes: look at the top of their parabola.
          if (probe < 2) continue;
          const double before = g[probe - 2][index], top = g[probe - 1][index];
          const double after = g[probe][index];
          const double bend = 2 * top - before - after;
          if (!(bend > 0 && std::abs(after - before) < 2 * bend)) continue;
          right = left + 0.5 / kProbes * (after - before) / bend;
          left -= 1.0 / kProbes;
          if (!(event_value(s + right * h, step.at(right), index) > kNothing)) continue;
        }
        // Where on the extension, to tell which comes first.
        for (int i = 0; i < 40; ++i) {
          const double middle = 0.5 * (left + right);
          (event_value(s + middle * h, step.at(middle), index) > 0 ? right : left) = middle;
        }
        if (right < upper) {
          upper = right;
          found = index;
        }
      }
    }
    if (found < 0) return -1;

    // Secant steps on the length of a true step, inside a bracket.
    double low = 0, high = h, x = std::max(upper * h, 1e-15 * h);
    double best = x, previous = 0, g_previous = 0;
    bool have_previous = false;
    for (int i = 0; i < 30; ++i) {
      event_error_ = attempt(s, y, x);
      const double gx = event_value(s + x, next_, found);
      best = x;
      if (std::abs(gx) <= kNothing) break;
      (gx > 0 ? high : low) = x;
      double trial = have_previous && gx != g_previous ? x - gx * (x - previous) / (gx - g_previous)
                                                       : x * (gx > 0 ? 1 - 1e-6 : 1 + 1e-6);
      if (!(trial > low && trial < high)) trial = 0.5 * (low + high);
      if (high - low <= 4e-16 * h) break;
      previous = x;
      g_previous = gx;
      have_previous = true;
      x = trial;
    }
    event_step_ = best;
    return found;
  }

  System& system_;
  MarchOptions options_;
  SolverWork work_;
  std::array<State, 7> k_{};
  State next_{};
  double next_step_ = 0;
  double event_step_ = 0;
  double event_error_ = 0;
};

}  // namespace tribodyn
