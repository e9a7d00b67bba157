#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/periodic/period_correction.h"
#include "core/periodic/steady_state.h"
#include "core/study/operating_point.h"
#include "core/study/screening.h"
#include "core/vehicle/vehicle.h"
#include "tests/benchmark/marching_solvers.h"
#include "tests/benchmark/measurements.h"
#include "tests/support/figure_error.h"
#include "tests/support/reference_scene.h"

// Work against true error at eight operating points: this solver at several tolerances, against
// marching by common integrators, all with the same batch friction kernel in one run.
//
// Marching starts from the static equilibrium, corrects T_s and the mean speed after every mesh
// cycle, discards cycles until the RMS inefficiency of each cycle is and stays within the error,
// and records one more. It is told the right answer to know when to stop, and judged by that one
// figure; this solver starts without knowing anything, must find out by itself when to stop, and is
// judged by the worst of both inefficiencies, torque and extremes of the transmission error. The
// truth is the event-exact march at a tolerance of 1e-10. Times are medians of interleaved turns.
//
// Where the machine has more than AVX2, smooth points are solved with AVX2 as well, by both. And
// the figures of all points are computed with all sensitivities and without, in turns, by processor
// time at a tolerance of 1e-3.
namespace tribodyn {
namespace {

using Clock = std::chrono::steady_clock;

/// Of an even number the mean of the middle two.
double middle(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return 0.5 * (values[(n - 1) / 2] + values[n / 2]);
}

double microseconds_since(Clock::time_point start) {
  return std::chrono::duration<double, std::micro>(Clock::now() - start).count();
}

/// Microseconds of one run: of the first where it is long, else of as many as fill a few
/// milliseconds, so that what ran before has left the processor's caches.
template <class Run>
double time_of(Run&& run) {
  constexpr double kLong = 3000;
  const auto first = Clock::now();
  run();
  const double one = microseconds_since(first);
  if (one > kLong) return one;
  const int count = 1 + static_cast<int>(kLong / one);
  const auto start = Clock::now();
  for (int i = 0; i < count; ++i) run();
  return microseconds_since(start) / count;
}

struct Place {
  const char* name;
  double kilometres_per_hour;
  PointStart start;
  double error;  // asked of all
};

constexpr Place kPlaces[] = {{"20", 20, PointStart::kQuasiStatic, 1e-3},
                             {"37.5", 37.5, PointStart::kQuasiStatic, 1e-3},
                             {"67.5 up", 67.5, PointStart::kQuasiStatic, 1e-3},
                             {"67.5 down", 67.5, PointStart::kLargeVibration, 1e-4},
                             {"72.5", 72.5, PointStart::kQuasiStatic, 1e-4},
                             {"80", 80, PointStart::kQuasiStatic, 1e-4},
                             {"100", 100, PointStart::kQuasiStatic, 1e-3},
                             {"140", 140, PointStart::kQuasiStatic, 1e-3}};

struct Run {
  long contacts = 0;
  double microseconds = 0;
  double error = 0;
};

PointResult truth_of(PreparedScene& scene, const OperatingCondition& condition, PointStart start) {
  PointOptions options;
  options.method = SteadyStateMethod::kMarch;
  options.start = start;
  options.tolerance = 1e-8;
  options.march_step_tolerance = 1e-10;
  options.march_settling_tolerance = 1e-9;
  return solve_prepared_point(scene, condition, options);
}

/// One way through the transient, cycle by cycle.
struct Transient {
  std::vector<double> inefficiency, microseconds;
  std::vector<long> contacts;
};

Transient march(PreparedScene& scene, const Place& place, const MarchingSolver& solver,
                double accuracy, const PointResult& truth) {
  constexpr int kMostCycles = 400;
  const GearPairSystem& system = scene.gear_set().system();
  ContactTally tally;
  ContactSolver contacts(scene.contacts(), tally);
  const double ratio =
      static_cast<double>(system.mesh().pinion_teeth()) / system.mesh().gear_teeth();
  const double wheel = wheel_torque(scene.scene().vehicle, place.kilometres_per_hour / 3.6, 0, 0);
  Transient out;
  const auto start = Clock::now();
  Torques torques{wheel * ratio, wheel};
  const double speed = truth.mean_pinion_speed;
  MarchState state = static_start(system, torques, speed, 0, 0,
                                  place.start == PointStart::kLargeVibration ? 60e-6 : 0);
  ScaledProblem problem(system, torques, contacts, speed);
  const CycleStepper step = solver.make(problem, accuracy);
  int settled = 0;
  for (int cycle = 0; cycle < kMostCycles && settled < 40; ++cycle) {
    const MarchState before = state;
    step(state);
    const double torque = torques.pinion;
    out.inefficiency.push_back(100 / std::abs(torque) *
                               std::sqrt(state[kLossShareSquared] / state[kTime]));
    correct_period(system, before, 1, speed, false, torques, state);
    out.microseconds.push_back(microseconds_since(start));
    out.contacts.push_back(tally.solutions);
    const double error = std::abs(out.inefficiency.back() / truth.inefficiency_rms.value() - 1);
    settled = error < 0.3 * place.error ? settled + 1 : 0;
    if (!std::isfinite(error)) break;
  }
  return out;
}

/// What it takes until each cycle is and stays within an error, and one recorded cycle on top;
/// nothing where that never happens.
bool cost_of(const Transient& transient, double truth, double error, int recorded, Run& out) {
  int first = static_cast<int>(transient.inefficiency.size());
  while (first > 0 && std::abs(transient.inefficiency[first - 1] / truth - 1) <= error) --first;
  const int last = first + recorded;
  if (first == static_cast<int>(transient.inefficiency.size())) return false;
  const auto scaled = [&](const auto& values) {
    // Cycles beyond the last cost what the last ones did.
    const int most = static_cast<int>(values.size()) - 1, half = most / 2;
    if (last <= most) return static_cast<double>(values[last]);
    return static_cast<double>(values[most]) +
           (last - most) * static_cast<double>(values[most] - values[half]) / (most - half);
  };
  out.microseconds = scaled(transient.microseconds);
  out.contacts = static_cast<long>(scaled(transient.contacts));
  out.error = std::abs(transient.inefficiency[first] / truth - 1);
  return true;
}

const char* const kShooting = "shooting";
const char* const kMarch = "event-exact march";
const char* const kAdams = "CVODE Adams";
const char* const kAdamsRoots = "CVODE Adams, roots";

/// What all methods take at a place, by name and accuracy.
struct Contest {
  std::map<std::string, std::map<double, std::vector<double>>> microseconds;
  std::map<std::string, std::map<double, Run>> run;
  std::map<std::string, double> fifty;  // least of 50 recorded cycles [us]
};

/// One turn of this solver.
void solve_in_turn(PreparedScene& prepared, const Place& place, const PointResult& truth,
                   const char* name, SteadyStateMethod method, double tolerance, Contest& contest) {
  OperatingCondition condition;
  condition.vehicle_speed = place.kilometres_per_hour / 3.6;
  PointOptions options;
  options.start = place.start;
  options.method = method;
  options.tolerance = tolerance;
  if (method == SteadyStateMethod::kMarch) {
    options.march_step_tolerance = std::min(1e-3, tolerance);
    options.march_settling_tolerance = std::min(1e-2, 0.1 * tolerance);
  }
  PointFigures r;
  contest.microseconds[name][tolerance].push_back(
      time_of([&] { r = solve_point_figures(prepared, condition, options); }));
  contest.run[name][tolerance] = {r.contact_solutions, 0, true_error(r, truth)};
}

void shoot_in_turn(PreparedScene& prepared, const Place& place, const PointResult& truth,
                   Contest& contest) {
  for (const double tolerance : {1e-2, 3e-3, 1e-3, 3e-4, 1e-4, 1e-5, 1e-6}) {
    solve_in_turn(prepared, place, truth, kShooting, SteadyStateMethod::kAutomatic, tolerance,
                  contest);
  }
}

/// One turn of a common integrator.
void march_in_turn(PreparedScene& prepared, const Place& place, const PointResult& truth,
                   const MarchingSolver& solver, Contest& contest) {
  for (const double accuracy : solver.accuracies) {
    Transient transient;
    try {
      transient = march(prepared, place, solver, accuracy, truth);
    } catch (const std::exception&) {
      continue;  // its tolerance is too coarse for it
    }
    Run one, many;
    const double exact = truth.inefficiency_rms.value();
    if (!cost_of(transient, exact, place.error, 1, one)) continue;
    cost_of(transient, exact, place.error, 50, many);
    contest.microseconds[solver.name][accuracy].push_back(one.microseconds);
    contest.run[solver.name][accuracy] = one;
    double& best = contest.fifty.try_emplace(solver.name, many.microseconds).first->second;
    best = std::min(best, many.microseconds);
  }
}

/// Sets the time of each run to its median. Returns, for each method, the least time of the runs
/// whose error is within that of the place.
std::map<std::string, double> least_times(const Place& place, Contest& contest) {
  std::map<std::string, double> best;
  for (auto& [name, runs] : contest.run) {
    for (auto& [accuracy, one] : runs) {
      one.microseconds = median(contest.microseconds[name][accuracy]);
      if (one.error > place.error) continue;
      double& least = best.try_emplace(name, std::numeric_limits<double>::infinity()).first->second;
      least = std::min(least, one.microseconds);
    }
  }
  return best;
}

void print_and_store(const Place& place, const Contest& contest,
                     const std::map<std::string, double>& best, std::ofstream& csv) {
  std::printf("\n%s km/h, error %g\n%-22s %10s %10s %12s %10s\n", place.name, place.error, "method",
              "accuracy", "contacts", "microseconds", "error");
  for (const auto& [name, runs] : contest.run) {
    for (const auto& [accuracy, one] : runs) {
      csv << place.name << ',' << '"' << name << '"' << ',' << accuracy << ',' << one.contacts
          << ',' << one.microseconds << ',' << one.error << '\n';
    }
  }
  for (const auto& [name, least] : best) {
    for (const auto& [accuracy, one] : contest.run.at(name)) {
      if (one.microseconds != least) continue;
      std::printf("%-22s %10g %10ld %12.1f %10.1e", name.c_str(), accuracy, one.contacts, least,
                  one.error);
      const auto fifty = contest.fifty.find(name);
      if (fifty != contest.fifty.end()) std::printf("   50 cycles: %.0f", fifty->second);
      std::printf("\n");
    }
  }
}

/// Times of the better CVODE by Adams over those of shooting.
double adams_over_shooting(const std::map<std::string, double>& best) {
  const double plain = best.at(kAdams);
  const double baseline =
      best.contains(kAdamsRoots) ? std::min(plain, best.at(kAdamsRoots)) : plain;
  return baseline / best.at(kShooting);
}

/// The same at a smooth point with another instruction set.
double adams_over_shooting(PreparedScene& prepared, const Place& place, const PointResult& truth,
                           const std::vector<MarchingSolver>& solvers, int turns) {
  Contest contest;
  for (int turn = 0; turn < turns; ++turn) {
    shoot_in_turn(prepared, place, truth, contest);
    for (const MarchingSolver& solver : solvers) {
      if (solver.name != kAdams && solver.name != kAdamsRoots) continue;
      march_in_turn(prepared, place, truth, solver, contest);
    }
  }
  return adams_over_shooting(least_times(place, contest));
}

/// Processor time of all sensitivities over that of a place's figures, at the usual tolerance.
double sensitivities_over_figures(PreparedScene& prepared, const Place& place, int turns) {
  OperatingCondition condition;
  condition.vehicle_speed = place.kilometres_per_hour / 3.6;
  constexpr int kRepetitions = 20;
  const auto seconds = [&](bool sensitivities) {
    PointOptions options;
    options.start = place.start;
    options.sensitivities = sensitivities;
    solve_point_figures(prepared, condition, options);  // brings its memory into the caches
    const double start = processor_seconds();
    for (int n = 0; n < kRepetitions; ++n) solve_point_figures(prepared, condition, options);
    return processor_seconds() - start;
  };
  std::vector<double> ratios;
  for (int turn = 0; turn < turns; ++turn) {
    const double without = seconds(false);
    ratios.push_back(seconds(true) / without - 1);
  }
  return median(ratios);
}

int run(const std::string& results, const std::string& table, int turns) {
  const Scene scene = reference_scene();
  PreparedScene prepared(scene);
  const InstructionSet widest = prepared.contacts().instruction_set();
  std::optional<PreparedScene> by_avx2;  // where the machine has more
  if (widest == InstructionSet::kAvx512) by_avx2.emplace(scene, nullptr, InstructionSet::kAvx2);
  const std::vector<MarchingSolver> solvers = marching_solvers();
  std::ofstream csv(table);
  csv << "place,method,accuracy,contacts,microseconds,true_error\n";
  std::map<bool, std::vector<double>> ratios, times, sensitivities;  // by whether contact is lost
  std::vector<double> avx2_ratios;
  std::vector<Measurement> out;
  std::printf("%s; medians of %d turns\n", machine_name().c_str(), turns);
  for (const Place& place : kPlaces) {
    OperatingCondition condition;
    condition.vehicle_speed = place.kilometres_per_hour / 3.6;
    const PointResult truth = truth_of(prepared, condition, place.start);
    Contest contest;
    for (int turn = 0; turn < turns; ++turn) {
      shoot_in_turn(prepared, place, truth, contest);
      for (const double tolerance : {1e-3, 1e-4}) {
        solve_in_turn(prepared, place, truth, kMarch, SteadyStateMethod::kMarch, tolerance,
                      contest);
      }
      for (const MarchingSolver& solver : solvers) {
        march_in_turn(prepared, place, truth, solver, contest);
      }
    }
    const std::map<std::string, double> best = least_times(place, contest);
    print_and_store(place, contest, best, csv);
    const double ratio = adams_over_shooting(best);
    const bool asked = place.error < 1e-3 || std::string(place.name) != "67.5 up";
    if (asked) {
      ratios[truth.contact_loss].push_back(ratio);
      times[truth.contact_loss].push_back(best.at(kShooting));
    }
    if (asked && by_avx2 && !truth.contact_loss) {
      avx2_ratios.push_back(adams_over_shooting(*by_avx2, place, truth, solvers, turns));
    }
    sensitivities[truth.contact_loss].push_back(
        sensitivities_over_figures(prepared, place, 2 * turns + 1));
    const std::string at = std::string(", ") + place.name + " km/h";
    out.push_back({"shooting" + at, best.at(kShooting), "us", {}});
    out.push_back({"CVODE Adams over shooting" + at, ratio, "-", {}});
    out.push_back({"all sensitivities over the figures" + at,
                   sensitivities[truth.contact_loss].back(),
                   "-",
                   {}});
  }
  const auto with = [](InstructionSet set) {
    return std::string(", ") + FlankContactBatch::name(set);
  };
  const std::string smooth = "CVODE Adams over shooting, smooth points, error 1e-3";
  out.push_back({smooth + with(widest), middle(ratios[false]), "-", 200, false});
  if (by_avx2) {
    out.push_back({smooth + with(InstructionSet::kAvx2), middle(avx2_ratios), "-", 200, false});
  }
  out.push_back({"CVODE Adams over shooting, vibro-impact points, error 1e-4", middle(ratios[true]),
                 "-", 60, false});
  out.push_back({"shooting, smooth points, error 1e-3", middle(times[false]), "us", 30.0});
  out.push_back({"shooting, vibro-impact points, error 1e-4", middle(times[true]), "us", 300.0});
  out.push_back({"all sensitivities over the figures, smooth point where they cost most",
                 *std::max_element(sensitivities[false].begin(), sensitivities[false].end()), "-",
                 3.0});
  out.push_back({"all sensitivities over the figures, vibro-impact points",
                 middle(sensitivities[true]),
                 "-",
                 {}});
  std::printf("\n");
  print(out);
  if (!results.empty()) record(results, out);
  return 0;
}

}  // namespace
}  // namespace tribodyn

/// usage: orbit_benchmark [results.json [table.csv [turns]]]
int main(int count, char** arguments) try {
  return tribodyn::run(count > 1 ? arguments[1] : "", count > 2 ? arguments[2] : "/dev/null",
                       count > 3 ? std::atoi(arguments[3]) : 5);
} catch (const std::exception& error) {
  std::fprintf(stderr, "orbit_benchmark: %s\n", error.what());
  return 1;
}
