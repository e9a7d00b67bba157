#include "core/integrate/rk4_with_events.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "core/driveline/gear_pair_motion.h"
#include "core/integrate/runge_kutta.h"
#include "core/numerics/bracketed_root.h"

namespace tribodyn {
namespace {

constexpr int kStates = 8;        // time and the seven of the section
constexpr int kTorqueColumn = 7;  // column of the unknown torque

/// Phase in the tables: the end of a period is an end there too.
double inside_cycle(double phase) { return phase - std::floor(phase); }

}  // namespace

Rk4WithEvents::Rk4WithEvents(const GearPairSystem& system, const MarchScales& scales,
                             const MeshGrid& grid, int period, bool solve_wheel_torque,
                             double event_tolerance, InstructionSet instruction_set)
    : system_(system),
      scales_(scales),
      grid_(grid),
      period_(period),
      event_tolerance_(event_tolerance),
      instruction_set_(instruction_set) {
  if (solve_wheel_torque) {
    by_torque_.wheel = -system.constants().per_wheel_inertia;
  } else {
    by_torque_.pinion_shaft = system.constants().per_pinion_shaft_inertia;
  }
}

void Rk4WithEvents::change_regime(int event, const FrictionArms& friction, const MeshPhase& phase,
                                  const MarchState& y, Sensitivity* s) {
  const ContactRegime next = system_.regime_after(event, phase, regime_, y.data());
  if (s == nullptr || next.side == regime_.side) {
    regime_ = next;
    return;
  }
  Mechanics at;
  Rates before, after;
  system_.motion(phase, regime_, y.data(), friction, torques_, at, before.data());
  regime_ = next;
  const double error_slope = at.transmission_velocity * before[kTime];  // dx/dphase
  if (error_slope == 0) return;
  system_.motion(phase, regime_, y.data(), friction, torques_, at, after.data());
  evaluations_ += 2;
  // dx/d(mesh approach) = R_g/R_g0 (eq 6); x depends on no other state.
  const double per_approach =
      at.mesh.gear_contact_radius / (system_.mesh().mean_gear_contact_radius() * error_slope);
  const Sensitivity::value_type later = -per_approach * (*s)[kMeshApproach];  // the event's phase
  for (int i = 0; i < kStates; ++i) (*s)[i] -= (after[i] - before[i]) * later;
}

void Rk4WithEvents::step(FrozenFriction& friction, const Span& span, const MarchState& y,
                         MarchState& to) {
  const MeshPhase* const phases[4] = {span.start, span.middle, span.middle, span.end};
  const double h = span.length;
  MarchState stage = y;
  Rates rate{};
  to = y;
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < kStates && i > 0; ++j) stage[j] = y[j] + kRungeKuttaNode[i] * h * rate[j];
    const FrictionArms here = friction.at(span.phase + kRungeKuttaNode[i] * h);
    Mechanics at;
    system_.motion(*phases[i], regime_, stage.data(), here, torques_, at, rate.data());
    for (int j = 0; j < kStates; ++j) to[j] += kRungeKuttaWeight[i] * h * rate[j];
    if (store_stages_) {
      system_.slopes(*phases[i], regime_, stage.data(), at, here, rate.data(), stages_[i]);
    }
    if (i == 0) first_rate_ = rate;
  }
  last_rate_ = rate;
  evaluations_ += 4;
}

MarchState Rk4WithEvents::middle(const MarchState& from, const MarchState& to, double h) const {
  MarchState out{};
  for (int i = 0; i < kStates; ++i) {
    out[i] = 0.5 * (from[i] + to[i]) + h / 8 * (first_rate_[i] - last_rate_[i]);
  }
  return out;
}

Rk4WithEvents::Events Rk4WithEvents::events(const MeshPhase& phase, const MarchState& y) const {
  return system_.events(phase, regime_, y.data(), scales_.length,
                        scales_.torque / system_.mesh().mean_pinion_contact_radius());
}

namespace {

bool happened(const std::array<double, 2>& events, double tolerance) {
  return events[0] > tolerance || events[1] > tolerance;
}

/// Where in (0, 1) one of two functions rises above zero, going by the parabola through its values
/// at 0, 1/2 and 1; 0: nowhere.
double peak_of(const std::array<double, 2>& first, const std::array<double, 2>& middle,
               const std::array<double, 2>& last) {
  for (int i = 0; i < 2; ++i) {
    const double slope = last[i] - first[i];
    const double bend = first[i] - 2 * middle[i] + last[i];
    if (!(bend < 0) || !(std::abs(slope) < -2 * bend)) continue;
    const double at = 0.5 - 0.25 * slope / bend;
    if (middle[i] - slope * slope / (8 * bend) > 1e-10 && first[i] <= 0) {
      return std::clamp(at, 1e-3, 1 - 1e-3);
    }
  }
  return 0;
}

/// Where in [0, 1] the parabola through values at 0, 1/2 and 1 rises through zero, from `first` <=
/// 0 to `last` > 0, and its slope there; 0: nowhere.
double rising_root(double first, double middle, double last, double& slope) {
  const double bend = 2 * (first - 2 * middle + last), start = last - first - bend;
  const double square = start * start - 4 * bend * std::min(first, 0.0);
  slope = square > 0 ? std::sqrt(square) : 0;
  if (slope == 0) return 0;
  return start >= 0 ? -2 * std::min(first, 0.0) / (start + slope) : (slope - start) / (2 * bend);
}

/// Length at which a function passes through zero, from `first` at 0 to `last` > 0 at `high`; zero
/// is what is nearer to it than `nothing`.
template <class Function>
double root_of(double first, double last, double high, double nothing, Function&& at) {
  const double nearest = 1e-6 * high;  // what has just happened is zero at the start
  return bracketed_root(
      [&](double x) {
        const double value = at(x);
        return std::abs(value) <= nothing && x > nearest ? 0 : value;
      },
      0, high, std::min(first, -std::numeric_limits<double>::min()), last);
}

}  // namespace

/// Length of a step that ends on an event, from its values at the start and at `high`, the length
/// of the last step, to `to`. Leaves that step there, with its rates. `part`: the span of a length.
template <class Part>
double Rk4WithEvents::locate(FrozenFriction& friction, int index, double first, double last,
                             double high, Part&& part, const MarchState& y, MarchState& to) {
  const auto true_step = [&](double length) {
    const Span span = part(length);
    step(friction, span, y, to);
    return events(*span.end, to)[index];
  };
  // First by the cubic through both ends and a parabola, which cost no steps.
  const double start = part(high).phase;
  const MarchState end = to;
  const Rates start_rate = first_rate_, end_rate = last_rate_;
  const auto on_cubic = [&](double length) {
    const double t = length / high, u = 1 - t;
    const double at_start = (1 + 2 * t) * u * u, at_end = (1 + 2 * u) * t * t;
    MarchState state{};
    for (int i = 0; i < kStates; ++i) {
      state[i] =
          at_start * y[i] + at_end * end[i] + high * t * u * (u * start_rate[i] - t * end_rate[i]);
    }
    return events(system_.at_phase(inside_cycle(start + length)), state)[index];
  };
  const double nearest = 1e-6 * high;
  double slope = 0, before = 0, value_before = 0;
  double x = high * rising_root(first, on_cubic(0.5 * high), last, slope);
  slope /= high;
  if (slope > 0) x -= on_cubic(x) / slope;
  for (int i = 0; i < 6 && slope > 0 && x > nearest && x <= high; ++i) {
    const double value = true_step(x);
    if (std::abs(value) <= event_tolerance_) return x;
    if (i > 0) slope = (value - value_before) / (x - before);
    before = x;
    value_before = value;
    x -= value / slope;
  }
  x = root_of(first, last, high, event_tolerance_, true_step);
  true_step(x);
  return x;
}

bool Rk4WithEvents::run(const Torques& torques, FrozenFriction& friction, bool bilateral_contact,
                        MarchState& y, Sensitivity* s, std::vector<OrbitPiece>* pieces) {
  constexpr int kMostPieces = 20;  // of one step
  int index = 0;                   // of an event
  if (pieces != nullptr) {
    pieces->clear();
    pieces->reserve(static_cast<std::size_t>(grid_.steps()) * static_cast<std::size_t>(period_));
  }
  torques_ = torques;
  regime_ = bilateral_contact ? ContactRegime{torques.pinion >= 0 ? 1 : -1, true}
                              : system_.regime_of(0, y.data());
  y[kTime] = y[kLossWork] = y[kLossShareSquared] = 0;
  store_stages_ = s != nullptr;
  if (s != nullptr) {
    for (auto& row : *s) row.setZero();
    for (int i = 0; i < kTorqueColumn; ++i) (*s)[i + 1](i) = 1;
  }
  MarchState to{};
  std::optional<Events> at_end_before;  // of the step before, in the same regime
  for (int i = 0; i < grid_.steps() * period_; ++i) {
    const int node = 2 * (i % grid_.steps());
    double phase = static_cast<double>(i) / grid_.steps();
    const double end = static_cast<double>(i + 1) / grid_.steps();
    MeshPhase at_start = grid_.at(node), at_middle, at_end;
    const auto part = [&](double length) {
      at_middle = system_.at_phase(inside_cycle(phase + 0.5 * length));
      at_end = system_.at_phase(inside_cycle(phase + length));
      return Span{phase, length, &at_start, &at_middle, &at_end};
    };
    for (int piece = 0; phase < end; ++piece) {
      if (piece == kMostPieces) return false;
      double h = end - phase;
      const auto whole = [&] {
        at_middle = piece == 0 ? grid_.at(node + 1)
                               : system_.at_phase(inside_cycle(phase + 0.5 * (end - phase)));
        return Span{phase, end - phase, &at_start, &at_middle, &grid_.at(node + 2)};
      };
      Span span = whole();
      step(friction, span, y, to);
      bool happens = false;
      MarchState half = middle(y, to, h);
      if (!bilateral_contact) {
        const Events at_first = at_end_before ? *at_end_before : events(at_start, y);
        double high = h;
        Events at_high = events(*span.end, to);
        if (!happened(at_high, event_tolerance_)) {
          // Perhaps it came and went: by the parabola through start, middle and end.
          const double peak = peak_of(at_first, events(*span.middle, half), at_high);
          if (peak > 0) {
            high = peak * h;
            step(friction, part(high), y, to);
            at_high = events(at_end, to);
          }
        }
        happens = happened(at_high, event_tolerance_);
        at_end_before.reset();
        if (!happens && high == h) at_end_before = at_high;
        if (happens) {
          // The one that has gone farthest, unless another one has happened before it.
          index = at_high[0] > at_high[1] ? 0 : 1;
          for (int tries = 0; tries < 2; ++tries) {
            h = locate(friction, index, at_first[index], at_high[index], high, part, y, to);
            const Events here = events(at_end, to);
            const int other = 1 - index;
            if (!(here[other] > event_tolerance_)) break;
            index = other;
            high = h;
            at_high = here;
          }
          span = part(h);
        }
        if (!happens && high < h) {
          span = whole();
          step(friction, span, y, to);
        }
        if (happens || high < h) half = middle(y, to, h);
      }
      if (!(std::isfinite(to[kPinionSpeed]) && to[kPinionSpeed] > 0)) return false;
      ++taken_;
      if (pieces != nullptr) {
        const bool on_grid = piece == 0 && !happens;
        pieces->push_back({phase, h, on_grid ? node : -1, regime_, y, half, to});
      }
      y = to;
      if (s != nullptr)
        advance_sensitivity(instruction_set_, system_.constants(), by_torque_, stages_, h, *s);
      phase += h;
      if (happens) {
        at_start = at_end;
        ++events_;
        change_regime(index, friction.at(phase), at_start, y, s);
      }
      if (!happens || end - phase < 1e-13) phase = end;
    }
  }
  return true;
}

}  // namespace tribodyn
