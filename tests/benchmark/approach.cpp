#include "tests/benchmark/approach.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>

#include "core/periodic/period_correction.h"
#include "core/periodic/steady_state.h"
#include "core/vehicle/vehicle.h"

namespace tribodyn {
namespace {

/// Adds mesh cycles or iterates to an approach as they come.
class Stopwatch {
 public:
  ContactTally tally;
  Approach approach;
  void add(double inefficiency) {
    approach.inefficiency.push_back(inefficiency);
    approach.microseconds.push_back(microseconds_since(start_));
    approach.contacts.push_back(tally.solutions);
  }

 private:
  double start_ = processor_seconds();
};

/// Where all rivals start, with T_s as it were without friction.
SectionPoint cold_start(PreparedScene& scene, const Place& place, const PointResult& truth) {
  const GearPairSystem& system = scene.gear_set().system();
  const double ratio =
      static_cast<double>(system.mesh().pinion_teeth()) / system.mesh().gear_teeth();
  const double wheel = wheel_torque(scene.scene().vehicle, place.kilometres_per_hour / 3.6, 0, 0);
  const Torques torques{wheel * ratio, wheel};
  return system.at_section(static_start(system, torques, truth.mean_pinion_speed, 0, 0,
                                        place.start == PointStart::kLargeVibration ? 60e-6 : 0),
                           torques);
}

/// Whether a march has come as near as it can, or near enough for a target.
bool has_settled(const std::vector<double>& errors, double target) {
  constexpr int kWindow = 50;  // in which the slowest transients decay by a third
  if (errors.size() < 2 * kWindow) return false;
  const auto end = errors.end();
  const double last = *std::max_element(end - kWindow, end);
  const double before = *std::max_element(end - 2 * kWindow, end - kWindow);
  return last > 0.9 * before || last < 0.3 * target;
}

}  // namespace

Approach march(PreparedScene& scene, const Place& place, const MarchingSolver& solver,
               double accuracy, double least_target, const PointResult& truth) {
  constexpr int kMostCycles = 3000;
  const GearPairSystem& system = scene.gear_set().system();
  Stopwatch watch;
  ContactSolver contacts(scene.contacts(), watch.tally);
  const double speed = truth.mean_pinion_speed;
  SectionPoint at = cold_start(scene, place, truth);
  ScaledProblem problem(system, at.torques, contacts, speed);
  const CycleStepper step = solver.make(problem, accuracy);
  std::vector<double> errors;
  while (errors.size() < kMostCycles && !has_settled(errors, least_target)) {
    const MarchState before = at.state;
    step(at.state);
    const double inefficiency = 100 / std::abs(at.torques.pinion) *
                                std::sqrt(at.state[kLossShareSquared] / at.state[kTime]);
    correct_period(system, before, 1, speed, false, at.torques, at.state);
    watch.add(inefficiency);
    errors.push_back(std::abs(inefficiency / truth.inefficiency_rms.value() - 1));
    if (!std::isfinite(errors.back())) break;
  }
  return watch.approach;
}

Approach iterate(PreparedScene& scene, const Place& place, const PeriodicRival& rival,
                 double accuracy, const PointResult& truth) {
  constexpr double kSameResponse = 1e-2;  // the nearest other one differs by more
  const SectionPoint start = cold_start(scene, place, truth);
  for (const int cycles : {0, 2, 4, 8, 16, 32, 64}) {
    Stopwatch watch;
    try {
      rival.solve({scene.gear_set().system(), scene.contacts(), watch.tally,
                   truth.mean_pinion_speed, start.state, start.torques, cycles},
                  accuracy, [&](double inefficiency) { watch.add(inefficiency); });
    } catch (const std::exception&) {
      continue;  // its integrator fails
    }
    const double last = watch.approach.inefficiency.back();
    if (std::abs(last / truth.inefficiency_rms.value() - 1) < kSameResponse) return watch.approach;
  }
  return {};
}

std::optional<Run> cost_of(const Approach& approach, double truth, double target, int recorded) {
  const auto error = [&](int i) { return std::abs(approach.inefficiency[i] / truth - 1); };
  const int count = static_cast<int>(approach.inefficiency.size());
  Run out;
  int first = count;
  while (first > 0 && error(first - 1) <= target) out.error = std::max(out.error, error(--first));
  const int last = first + recorded;
  if (first == count) return std::nullopt;
  const auto scaled = [&](const auto& values) {
    // Cycles beyond the last cost what the last ones did.
    const int most = count - 1, half = most / 2;
    if (last <= most) return static_cast<double>(values[last]);
    return static_cast<double>(values[most]) +
           (last - most) * static_cast<double>(values[most] - values[half]) / (most - half);
  };
  out.microseconds = scaled(approach.microseconds);
  out.contacts = static_cast<long>(scaled(approach.contacts));
  return out;
}

std::optional<Run> unaided_cost_of(const PeriodicRival& rival,
                                   const std::map<double, Approach>& approaches, double truth,
                                   double target) {
  Run out;
  double coarser = std::numeric_limits<double>::quiet_NaN();
  for (const double accuracy : rival.accuracies) {
    const std::vector<double>& found = approaches.at(accuracy).inefficiency;
    if (found.empty()) continue;
    std::size_t i = 0;
    while (i + 1 < found.size()) {
      ++i;
      if (std::abs(found[i] / found[i - 1] - 1) < 0.1 * target) break;
    }
    out.microseconds += approaches.at(accuracy).microseconds[i];
    out.contacts += approaches.at(accuracy).contacts[i];
    out.accuracy = accuracy;
    out.error = std::abs(found[i] / truth - 1);
    if (std::abs(found[i] / coarser - 1) < target) return out;
    coarser = found[i];
  }
  return std::nullopt;
}

}  // namespace tribodyn
