#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <iterator>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/study/operating_point.h"
#include "core/study/screening.h"
#include "tests/benchmark/approach.h"
#include "tests/benchmark/measurements.h"
#include "tests/support/figure_error.h"
#include "tests/support/reference_scene.h"

// Work against true error at eight operating points: this solver at several tolerances, against
// periodic solvers (periodic_rivals.h) and marching by common integrators (marching_solvers.h), all
// with the same batch friction kernel in one run.
//
// All rivals start from the static equilibrium, and each aims at errors of 1e-3 to 1e-7, with the
// accuracy that reaches the target in the least time. Marches correct T_s and the mean speed after
// every mesh cycle, discard cycles until the RMS inefficiency of each cycle is and stays within the
// target, and record one more. Periodic solvers march as few cycles as lead to the response, often
// none, then iterate until each iterate is and stays within the target. Rivals are told the right
// answer to know all of that, and judged by that one figure; this solver starts without knowing
// anything, must find out by itself how many steps it needs, how large its error is and whether the
// response is stable, and is judged by the worst of both inefficiencies, torque and extremes of the
// transmission error. "Unaided" periodic solvers are told the cycles only: they refine until two
// answers agree within the target.
//
// The truth is the event-exact march at a tolerance of 1e-10. Times are processor times, medians of
// interleaved turns.
//
// Where the machine has more than AVX2, smooth points are solved with AVX2 as well, by this solver
// and by CVODE's Adams. And the figures of all points are computed with all sensitivities and
// without, in turns, at a tolerance of 1e-3.
namespace tribodyn {
namespace {

/// Of an even number the mean of the middle two.
double middle(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return 0.5 * (values[(n - 1) / 2] + values[n / 2]);
}

/// Microseconds of one run: of the first where it is long, else of as many as fill a few
/// milliseconds, so that what ran before has left the processor's caches.
template <class Run>
double time_of(Run&& run) {
  constexpr double kLong = 3000;
  const double first = processor_seconds();
  run();
  const double one = microseconds_since(first);
  if (one > kLong) return one;
  const int count = 1 + static_cast<int>(kLong / one);
  const double start = processor_seconds();
  for (int i = 0; i < count; ++i) run();
  return microseconds_since(start) / count;
}

constexpr Place kPlaces[] = {{"20", 20, PointStart::kQuasiStatic, 1e-3},
                             {"37.5", 37.5, PointStart::kQuasiStatic, 1e-3},
                             {"67.5 up", 67.5, PointStart::kQuasiStatic, 1e-3},
                             {"67.5 down", 67.5, PointStart::kLargeVibration, 1e-4},
                             {"72.5", 72.5, PointStart::kQuasiStatic, 1e-4},
                             {"80", 80, PointStart::kQuasiStatic, 1e-4},
                             {"100", 100, PointStart::kQuasiStatic, 1e-3},
                             {"140", 140, PointStart::kQuasiStatic, 1e-3}};

PointResult truth_of(PreparedScene& scene, const OperatingCondition& condition, PointStart start) {
  PointOptions options;
  options.method = SteadyStateMethod::kMarch;
  options.start = start;
  options.tolerance = 1e-8;
  options.march_step_tolerance = 1e-10;
  options.march_settling_tolerance = 1e-9;
  return solve_prepared_point(scene, condition, options);
}

const char* const kShooting = "shooting";
const char* const kMarch = "event-exact march";
const char* const kAdams = "CVODE Adams";
const char* const kAdamsRoots = "CVODE Adams with roots";
const char* const kUnaided = " unaided";

/// What all methods take at a place: this solver by tolerance, rivals by target.
struct Contest {
  std::map<std::string, std::map<double, std::vector<double>>> microseconds;
  std::map<std::string, std::map<double, Run>> run;
  std::map<std::string, double> fifty;  // least of 50 recorded cycles of marches [us]
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
  contest.run[name][tolerance] = {tolerance, r.contact_solutions, 0, true_error(r, truth)};
}

void shoot_in_turn(PreparedScene& prepared, const Place& place, const PointResult& truth,
                   Contest& contest) {
  for (const double tolerance : {1e-2, 3e-3, 1e-3, 3e-4, 1e-4, 1e-5, 1e-6, 1e-7}) {
    solve_in_turn(prepared, place, truth, kShooting, SteadyStateMethod::kAutomatic, tolerance,
                  contest);
  }
}

/// Enters a rival's approaches, by accuracy: the cheapest one for each target.
void enter(const std::string& name, const Place& place, const PointResult& truth,
           const std::map<double, Approach>& approaches, int recorded, Contest& contest) {
  constexpr int kMany = 50;
  const double exact = truth.inefficiency_rms.value();
  for (const double target : kTargets) {
    std::optional<Run> best;
    for (const auto& [accuracy, approach] : approaches) {
      std::optional<Run> one = cost_of(approach, exact, target, recorded);
      if (!one) continue;
      one->accuracy = accuracy;
      if (!best || one->microseconds < best->microseconds) best = one;
      if (recorded == 0 || target != place.error) continue;
      const double many = cost_of(approach, exact, target, kMany)->microseconds;
      double& least = contest.fifty.try_emplace(name, many).first->second;
      least = std::min(least, many);
    }
    if (!best) continue;
    contest.microseconds[name][target].push_back(best->microseconds);
    contest.run[name][target] = *best;
  }
}

/// One turn of a common integrator, for targets down to the least.
void march_in_turn(PreparedScene& prepared, const Place& place, const PointResult& truth,
                   const MarchingSolver& solver, double least_target, Contest& contest) {
  std::map<double, Approach> approaches;
  for (const double accuracy : solver.accuracies) {
    try {
      approaches[accuracy] = march(prepared, place, solver, accuracy, least_target, truth);
    } catch (const std::exception&) {
      continue;  // its tolerance is too coarse for it
    }
  }
  enter(solver.name, place, truth, approaches, 1, contest);
}

/// One turn of a periodic solver.
void iterate_in_turn(PreparedScene& prepared, const Place& place, const PointResult& truth,
                     const PeriodicRival& rival, Contest& contest) {
  std::map<double, Approach> approaches;
  for (const double accuracy : rival.accuracies) {
    approaches[accuracy] = iterate(prepared, place, rival, accuracy, truth);
  }
  enter(rival.name, place, truth, approaches, 0, contest);
  const std::string unaided = rival.name + kUnaided;
  for (const double target : kTargets) {
    const std::optional<Run> run =
        unaided_cost_of(rival, approaches, truth.inefficiency_rms.value(), target);
    if (!run) continue;
    contest.microseconds[unaided][target].push_back(run->microseconds);
    contest.run[unaided][target] = *run;
  }
}

/// Sets the time of each run to its median. Returns, for each method, the least time of the runs
/// whose error is within that of the place.
std::map<std::string, double> least_times(const Place& place, Contest& contest) {
  std::map<std::string, double> best;
  for (auto& [name, runs] : contest.run) {
    for (auto& [aim, one] : runs) {
      one.microseconds = median(contest.microseconds[name][aim]);
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
    for (const auto& [aim, one] : runs) {
      csv << place.name << ',' << '"' << name << '"' << ',' << one.accuracy << ',' << one.contacts
          << ',' << one.microseconds << ',' << one.error << '\n';
    }
  }
  for (const auto& [name, least] : best) {
    for (const auto& [aim, one] : contest.run.at(name)) {
      if (one.microseconds != least) continue;
      std::printf("%-22s %10g %10ld %12.1f %10.1e", name.c_str(), one.accuracy, one.contacts, least,
                  one.error);
      const auto fifty = contest.fifty.find(name);
      if (fifty != contest.fifty.end()) std::printf("   50 cycles: %.0f", fifty->second);
      std::printf("\n");
      break;
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

/// Times of the better periodic solver over those of shooting; nullopt if none gets there.
/// `suffix`: of its name, kUnaided or none.
std::optional<double> rival_over_shooting(const std::map<std::string, double>& best,
                                          const std::vector<PeriodicRival>& rivals,
                                          const std::string& suffix) {
  double least = std::numeric_limits<double>::infinity();
  for (const PeriodicRival& rival : rivals) {
    const auto found = best.find(rival.name + suffix);
    if (found != best.end()) least = std::min(least, found->second);
  }
  if (std::isinf(least)) return std::nullopt;
  return least / best.at(kShooting);
}

/// The same of CVODE at a smooth point with another instruction set.
double adams_over_shooting(PreparedScene& prepared, const Place& place, const PointResult& truth,
                           const std::vector<MarchingSolver>& solvers, int turns) {
  Contest contest;
  for (int turn = 0; turn < turns; ++turn) {
    shoot_in_turn(prepared, place, truth, contest);
    for (const MarchingSolver& solver : solvers) {
      if (solver.name != kAdams && solver.name != kAdamsRoots) continue;
      march_in_turn(prepared, place, truth, solver, place.error, contest);
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
  const std::vector<PeriodicRival> rivals = periodic_rivals();
  std::ofstream csv(table);
  csv << "place,method,accuracy,contacts,microseconds,true_error\n";
  // By whether contact is lost:
  std::map<bool, std::vector<double>> ratios, times, sensitivities;
  std::map<std::string, std::map<bool, std::vector<double>>> rival_ratios;  // by suffix
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
        march_in_turn(prepared, place, truth, solver, *std::prev(std::end(kTargets)), contest);
      }
      for (const PeriodicRival& rival : rivals) {
        iterate_in_turn(prepared, place, truth, rival, contest);
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
    for (const std::string suffix : {"", kUnaided}) {
      const std::optional<double> rival = rival_over_shooting(best, rivals, suffix);
      if (!rival) continue;
      out.push_back({"periodic rival" + suffix + " over shooting" + at, *rival, "-", {}});
      if (asked) rival_ratios[suffix][truth.contact_loss].push_back(*rival);
    }
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
  for (const auto& [suffix, by_contact_loss] : rival_ratios) {
    for (const auto& [contact_loss, all] : by_contact_loss) {
      const std::string over = "periodic rival" + suffix + " over shooting, ";
      out.push_back(
          {over + (contact_loss ? "vibro-impact points, error 1e-4" : "smooth points, error 1e-3"),
           middle(all),
           "-",
           {}});
    }
  }
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
