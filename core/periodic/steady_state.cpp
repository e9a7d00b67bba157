#include "core/periodic/steady_state.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <vector>

#include "core/periodic/leading_multiplier.h"
#include "core/periodic/period_correction.h"

namespace tribodyn {
namespace {

constexpr int kUnknowns = 8;  // the seven states from kPinionShaftTwist on, the torque
// Varied over marches of the first 30 random scenes of core/README.md, at a step tolerance of 1e-6.
// Number of past periods that an extrapolation uses. With 4 the marches take 21 % more work, with
// 12 1 % more.
constexpr int kWindow = 8;
// Number of mesh cycles that are marched before the first extrapolation. With 2 they take 32 % more
// work, with 24 27 % more.
constexpr int kFirstCycles = 8;
using Vector = Eigen::Matrix<double, kUnknowns, 1>;

/// The period map with its corrections, in scaled unknowns.
class PeriodMap {
 public:
  PeriodMap(const PeriodicProblem& problem, const Torques& torques, const MarchOptions& march,
            ContactSolver& contacts, SolverWork& work)
      : system_(problem.system),
        problem_(problem),
        march_(march),
        contacts_(contacts),
        work_(work),
        scales_(march_scales(system_, torques, problem.mean_pinion_speed)) {
    for (int i = 0; i + 1 < kUnknowns; ++i) scale_(i) = scales_.of(system_.mesh(), i + 1);
    scale_(kUnknowns - 1) = scales_.torque;
  }

  Vector pack(const SectionPoint& at) const {
    Vector v;
    for (int i = 0; i + 1 < kUnknowns; ++i) v(i) = at.state[i + 1] / scale_(i);
    Torques torques = at.torques;
    v(kUnknowns - 1) = problem_.unknown(torques) / scale_(kUnknowns - 1);
    return v;
  }

  void unpack(const Vector& v, SectionPoint& at) const {
    for (int i = 0; i + 1 < kUnknowns; ++i) at.state[i + 1] = v(i) * scale_(i);
    problem_.unknown(at.torques) = v(kUnknowns - 1) * scale_(kUnknowns - 1);
    at.regime = system_.regime_of(0, at.state.data());
  }

  /// Whether an extrapolation leaves the mesh about where it is: far out the march goes step by
  /// tiny step.
  bool is_sensible(const Vector& from, const Vector& to) const {
    // Of the backlash and the static deflection. With inertias a thousand times off, an
    // extrapolation of half a metre ended the march as not finite; 10 takes the same work.
    constexpr double kFarthestExtrapolation = 100;
    constexpr int kApproachUnknown = 1;
    const double moved = std::abs(to(kApproachUnknown) - from(kApproachUnknown)) * scales_.length;
    return moved < kFarthestExtrapolation * (2 * system_.dynamics().half_backlash + scales_.length);
  }

  /// Mesh cycles at constant torques; returns the time that they take.
  double march(SectionPoint& at, int cycles) {
    double time = 0;
    for (int i = 0; i < cycles; ++i) {
      march_mesh_cycle(system_, scales_, march_, contacts_, at, work_);
      time += at.state[kTime];
    }
    return time;
  }

  /// One period, corrected for speed and torque.
  void advance(SectionPoint& at, int period) {
    const MarchState before = at.state;
    at.state[kTime] = march(at, period);
    correct_period(system_, before, period, problem_.mean_pinion_speed, problem_.solve_wheel_torque,
                   at.torques, at.state);
    const ContactRegime corrected = system_.regime_of(0, at.state.data());
    if (corrected.side != at.regime.side) at.regime = corrected;
  }

  /// Scaled change of the state over some mesh cycles.
  double change(const SectionPoint& from, int cycles) {
    SectionPoint moved = from;
    advance(moved, cycles);
    return (pack(moved) - pack(from)).norm();
  }

  /// Largest modulus of the Floquet multipliers of a periodic response under its own constant
  /// torques, by forward differences, but for the one nearest to 1: the train as a whole runs on at
  /// any speed. (Corrections would shift the others: where the period doubles, by more than 1 %.)
  double largest_multiplier(const SectionPoint& at, int period) {
    // Scaled. Increments from 1e-5 to 1e-3, and step tolerances from 1e-8 to 1e-6, agree to 4e-7 in
    // the multipliers of the first twelve random scenes of core/README.md.
    constexpr double kStep = 1e-4;
    const Vector origin = pack(at);
    SectionPoint moved = at;
    march(moved, period);
    const Vector image = pack(moved);
    constexpr int kStates = kWheelSpeed;  // the seven of the section
    Eigen::Matrix<double, kStates, kStates> monodromy;
    for (int j = 0; j < kStates; ++j) {
      Vector shifted = origin;
      shifted(j) += kStep;
      moved = at;
      unpack(shifted, moved);
      march(moved, period);
      const Vector change = pack(moved) - image;
      for (int i = 0; i < kStates; ++i) monodromy(i, j) = change(i) / kStep;
    }
    return leading_multiplier(monodromy).modulus;
  }

 private:
  const GearPairSystem& system_;
  const PeriodicProblem& problem_;
  const MarchOptions& march_;
  ContactSolver& contacts_;
  SolverWork& work_;
  MarchScales scales_;
  Vector scale_;
};

/// Anderson's extrapolation from the last arguments and images of a map.
class Extrapolation {
 public:
  void clear() {
    arguments_.clear();
    images_.clear();
  }
  void add(const Vector& argument, const Vector& image) {
    if (arguments_.size() > kWindow) {
      arguments_.erase(arguments_.begin());
      images_.erase(images_.begin());
    }
    arguments_.push_back(argument);
    images_.push_back(image);
  }
  bool ready() const { return arguments_.size() >= 2; }
  Vector next() const {
    const int columns = static_cast<int>(arguments_.size()) - 1;
    Eigen::Matrix<double, kUnknowns, Eigen::Dynamic> residuals(kUnknowns, columns),
        images(kUnknowns, columns);
    const Vector last = images_.back() - arguments_.back();
    for (int j = 0; j < columns; ++j) {
      residuals.col(j) = (images_[j + 1] - arguments_[j + 1]) - (images_[j] - arguments_[j]);
      images.col(j) = images_[j + 1] - images_[j];
    }
    Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(residuals);
    qr.setThreshold(1e-10);
    const Eigen::VectorXd weights = qr.solve(last);
    return images_.back() - images * weights;
  }

 private:
  std::vector<Vector> arguments_, images_;
};

/// The shortest period, up to 4, after which the sections repeat clearly better than after 1.
int shortest_period(const std::vector<Vector>& sections) {
  const auto repeat = [&](int p) { return (sections.back() - sections.end()[-1 - p]).norm(); };
  int period = 1;
  for (int p = 2; p <= 4 && static_cast<int>(sections.size()) > p; ++p) {
    if (repeat(p) < 0.3 * repeat(period)) period = p;
  }
  return period;
}

}  // namespace

MarchState static_start(const GearPairSystem& system, const Torques& torques,
                        double mean_pinion_speed, double pinion_friction_torque,
                        double gear_friction_torque, double offset) {
  const MeshData& mesh = system.mesh();
  const DrivelineDynamics& d = system.dynamics();
  const double ratio = mesh.mean_pinion_contact_radius() / mesh.mean_gear_contact_radius();
  const MeshFunctions at = mesh.functions(0, 0);
  const double force = (torques.pinion + pinion_friction_torque) / at.pinion_contact_radius;
  const double side = force >= 0 ? 1 : -1;
  SectionState section;
  section.pinion_shaft_twist = torques.pinion / d.pinion_shaft_stiffness;
  section.gear_shaft_twist =
      (force * at.gear_contact_radius + gear_friction_torque) / d.gear_shaft_stiffness;
  section.pinion_shaft_speed = section.pinion_speed = mean_pinion_speed;
  // xdot = 0 at the section.
  section.gear_speed = (at.pinion_contact_radius - at.static_transmission_error_slope) *
                       mean_pinion_speed / at.gear_contact_radius;
  section.wheel_speed = mean_pinion_speed * ratio;
  section.mesh_deflection = side * d.half_backlash + at.static_transmission_error +
                            force / at.mesh_stiffness + side * offset;
  MarchState state{};
  system.to_march(section, state.data());
  return state;
}

SteadyState solve_steady_state(const PeriodicProblem& problem, ContactSolver& contacts,
                               const SectionPoint& start, const SteadyStateOptions& options) {
  SteadyState out;
  static_cast<SectionPoint&>(out) = start;
  PeriodMap map(problem, start.torques, options.march, contacts, out.work);

  // An extrapolated residual is about (1 - slowest multiplier) times the error, 0.01 at worst.
  const double wanted = 0.01 * problem.tolerance;
  constexpr double kNone = 1e300;
  int period = options.first_period, failures = 0, plain_left = kFirstCycles, confirmed = 0,
      without_gain = 0;
  double best = kNone, reported = 0;
  bool extrapolated = false;  // the state has not been marched to
  Vector best_image, marched = map.pack(out);
  Extrapolation extrapolation;
  std::vector<Vector> sections;  // of consecutive plain mesh cycles, for finding the period
  const auto may_go_on = [&] {
    return out.work.mesh_cycles + period <= options.maximum_mesh_cycles &&
           !(options.is_over && options.is_over());
  };
  while (may_go_on()) {
    if (options.progress) {
      const double done = best >= 1 ? 0 : std::log(std::max(best, wanted)) / std::log(wanted);
      reported = std::max(reported, std::clamp(done, 0.0, 0.99));
      if (!options.progress(reported)) throw Cancelled();
    }
    const Vector argument = map.pack(out);
    try {
      map.advance(out, period);
    } catch (const Refusal&) {
      if (!extrapolated) throw;
      // The march breaks down from the extrapolated state: back to the last state marched to.
      extrapolated = false;
      map.unpack(best < kNone ? best_image : marched, out);
      plain_left = std::min(16 * ++failures, 96);
      continue;
    }
    extrapolated = false;
    const Vector image = map.pack(out);
    out.defect = (image - argument).norm();
    if (out.defect <= wanted) {
      // Once more without extrapolation: the answer lies on a marched orbit.
      if (++confirmed < 2) continue;
      confirmed = 0;
      out.largest_multiplier = map.largest_multiplier(out, period);
      if (out.largest_multiplier <= 1 + kDoubtOfMarchedMultiplier) {
        out.settled = true;
        // What repeats after 2 or 4 cycles may do so after fewer.
        for (int fewer = 1; fewer < period; ++fewer) {
          if (period % fewer != 0 || map.change(out, fewer) > 10 * problem.tolerance) continue;
          period = fewer;
          out.largest_multiplier = map.largest_multiplier(out, period);
        }
        break;
      }
      // Extrapolation finds repelling orbits too, between two branches. The march would have left
      // it: go back to where it was and let it run on for longer.
      map.unpack(marched, out);
      plain_left = 24 * ++failures;
      sections.clear();
      continue;
    }
    confirmed = 0;
    if (plain_left > 0) {
      sections.push_back(image);
      if (--plain_left == 0) {
        marched = image;
        if (failures >= 2 && period == 1 && sections.size() > 8) period = shortest_period(sections);
        sections.clear();
        best = kNone;
        without_gain = 0;
        extrapolation.clear();
      }
      continue;
    }
    if (out.defect < 0.9 * best) {
      best = out.defect;
      best_image = image;
      without_gain = 0;
    } else if (++without_gain > 3 + (best < 1e-3 ? kWindow : 0)) {
      // Not contracting: take it back and let the transients die for a while. A period that does
      // not settle either gives way to single cycles.
      if (best < kNone) map.unpack(best_image, out);
      if (++failures % 4 == 0) period = 1;
      plain_left = std::min(16 * failures, 96);
      continue;
    }
    extrapolation.add(argument, image);
    if (extrapolation.ready()) {
      const Vector next = extrapolation.next();
      if (!map.is_sensible(image, next)) continue;
      map.unpack(next, out);
      extrapolated = true;
      ++out.accelerations;
    }
  }
  // An extrapolation may have led far from any attractor, or close to an orbit that repels.
  if (!out.settled && plain_left == 0) map.unpack(marched, out);
  out.period = out.settled ? period : 0;
  return out;
}

double marched_multiplier(const PeriodicProblem& problem, const PeriodicOrbit& orbit,
                          const MarchOptions& march, SolverWork& work) {
  SolverWork marched;
  ContactSolver contacts(problem.contacts, problem.tally);
  const double multiplier =
      PeriodMap(problem, orbit.torques, march, contacts, marched)
          .largest_multiplier(problem.system.at_section(orbit.pieces.front().start, orbit.torques),
                              orbit.period);
  work += marched;
  return multiplier;
}

}  // namespace tribodyn
