#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "core/study/screening.h"
#include "core/study/speed_sweep.h"
#include "tests/benchmark/measurements.h"
#include "tests/benchmark/varied_scenes.h"
#include "tests/support/contact_batch.h"
#include "tests/support/realistic_contacts.h"
#include "tests/support/reference_scene.h"

// Screening: many fluids at 20 to 140 km/h by 10 and sumps of 20, 40 and 90 C on the reference gear
// set from the static start, in units of a batch evaluation's time and over threads, with and
// without the figures of the contacts; and a whole sweep in both directions against the time of its
// friction evaluations alone. Tolerance 1e-3. What runs on one thread is measured by processor
// time.
namespace tribodyn {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

struct Work {
  long points = 0, contacts = 0, marched = 0;
  double seconds = 0, processor_seconds = 0;
};

constexpr double kFirstSpeed = 20, kLastSpeed = 140, kSpeedStep = 10;  // [km/h]

Work screen(const std::vector<Scene>& scenes, int threads) {
  std::atomic<std::size_t> next{0};
  std::atomic<long> points{0}, contacts{0}, marched{0};
  const auto start = Clock::now();
  const double processor_start = processor_seconds();
  const auto work = [&] {
    constexpr std::size_t kShard = 15;
    const auto gear_set =
        std::make_shared<PreparedGearSet>(scenes[0].gear_set, scenes[0].solid, scenes[0].options);
    for (;;) {
      const std::size_t first = next.fetch_add(kShard);
      if (first >= scenes.size()) return;
      for (std::size_t i = first; i < std::min(first + kShard, scenes.size()); ++i) {
        PreparedScene prepared(scenes[i], gear_set);
        for (double speed = kFirstSpeed; speed <= kLastSpeed; speed += kSpeedStep) {
          OperatingCondition condition;
          condition.vehicle_speed = speed / 3.6;
          const PointFigures r = screen_point(prepared, condition, {});
          ++points;
          contacts += r.contact_solutions;
          marched += !r.estimated_relative_error;
        }
      }
    }
  };
  std::vector<std::thread> pool;
  for (int i = 0; i < threads; ++i) pool.emplace_back(work);
  for (std::thread& thread : pool) thread.join();
  return {points, contacts, marched, seconds_since(start), processor_seconds() - processor_start};
}

/// Processor time that the figures of the contacts add to a screened point [s].
double seconds_of_contact_figures(const std::vector<Scene>& scenes) {
  const auto gear_set =
      std::make_shared<PreparedGearSet>(scenes[0].gear_set, scenes[0].solid, scenes[0].options);
  double seconds[2] = {0, 0};  // without and with them
  long points = 0;
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    PreparedScene prepared(scenes[i], gear_set);
    for (double speed = kFirstSpeed; speed <= kLastSpeed; speed += kSpeedStep) {
      OperatingCondition condition;
      condition.vehicle_speed = speed / 3.6;
      screen_point(prepared, condition, {});  // Coulomb's orbit is there, and in the caches
      for (const bool turn : {false, true}) {
        PointOptions options;
        options.contact_summary = turn != (i % 2 == 0);
        const double start = processor_seconds();
        screen_point(prepared, condition, options);
        seconds[options.contact_summary ? 1 : 0] += processor_seconds() - start;
      }
      ++points;
    }
  }
  return (seconds[1] - seconds[0]) / static_cast<double>(points);
}

/// So many evaluations of friction on so many contacts each.
struct Evaluations {
  std::size_t contacts;
  int count;
};
/// How friction is evaluated.
struct Evaluation {
  std::vector<Evaluations> evaluations;
  Digits digits;
  bool all_figures;
};
/// The unit of what a point takes.
const Evaluation kBatch{{{256, 1}}, Digits::kFull, false};
/// As the sweep has it: its 1730 evaluations, counted by their contacts, refused solutions
/// included. The sizes hold four fifths of the contacts; the last of them stands for all others, by
/// their mean.
const Evaluation kOfSweep{{{18, 277},
                           {26, 74},
                           {34, 317},
                           {50, 120},
                           {54, 305},
                           {65, 53},
                           {81, 106},
                           {97, 69},
                           {106, 100},
                           {147, 10},
                           {161, 61},
                           {209, 26},
                           {461, 3},
                           {765, 4},
                           {104, 205}},
                          Digits::kHalf,
                          true};

/// Processor time of a contact of the reference gear set [s].
double seconds_per_evaluation(const Evaluation& evaluation) {
  const Scene scene = reference_scene();
  std::vector<ContactConditions> conditions;
  for (double speed = kFirstSpeed; speed <= kLastSpeed; speed += kSpeedStep) {
    const auto more = realistic_contacts(scene, speed, 40).conditions;
    conditions.insert(conditions.end(), more.begin(), more.end());
  }
  ContactArrays arrays(conditions, scene.solid, scene.options);
  const FlankContactBatch batch(contact_model(scene));
  constexpr std::size_t kLeastContacts = 100'000;
  std::size_t solved = 0, first = 0;
  const double start = processor_seconds();
  while (solved < kLeastContacts) {
    for (const Evaluations& each : evaluation.evaluations) {
      for (int n = 0; n < each.count; ++n) {
        if (each.contacts > arrays.size()) throw std::logic_error("too few contacts");
        if (first + each.contacts > arrays.size()) first = 0;
        batch.solve(arrays.geometries(), first, each.contacts, arrays.conditions(first),
                    evaluation.all_figures ? arrays.results(first) : arrays.friction(first),
                    evaluation.digits);
        first += each.contacts;
        solved += each.contacts;
      }
    }
  }
  return (processor_seconds() - start) / static_cast<double>(solved);
}

/// The contacts of the search for ends of branches count too, but for those of refused solutions.
Work sweep() {
  const Scene scene = reference_scene();
  std::vector<double> speeds;
  for (int half = 40; half <= 280; ++half) speeds.push_back(0.5 * half / 3.6);
  Work out;
  const double start = processor_seconds();
  for (const SweepDirection direction : {SweepDirection::kUp, SweepDirection::kDown}) {
    SweepOptions options;
    options.direction = direction;
    for (const SweepPoint& at : sweep_speed(scene, speeds, 0, options)) {
      ++out.points;
      out.contacts += at.result->statistics.contact_solutions + at.contact_solutions_of_search;
      out.marched += at.result->method == SteadyStateMethod::kMarch;
    }
  }
  out.processor_seconds = processor_seconds() - start;
  return out;
}

int run(const std::string& path, int fluids, int turns) {
  const std::vector<Scene> scenes = varied_scenes(fluids);
  const int processors = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  std::vector<double> evaluation, of_sweep, per_point, over_threads, sweep_ratio, sweep_units, rate,
      contact_figures, contact_figures_share;
  Work alone, swept;
  for (int turn = 0; turn < turns; ++turn) {
    const auto evaluate = [&] {
      evaluation.push_back(seconds_per_evaluation(kBatch));
      of_sweep.push_back(seconds_per_evaluation(kOfSweep));
    };
    const auto around = [](const std::vector<double>& values) {
      return 0.5 * (values.back() + values[values.size() - 2]);
    };
    evaluate();
    alone = screen(scenes, 1);
    const Work together = screen(scenes, std::min(4, processors));
    contact_figures.push_back(seconds_of_contact_figures(scenes));
    contact_figures_share.push_back(contact_figures.back() * static_cast<double>(alone.points) /
                                    alone.processor_seconds);
    swept = sweep();
    evaluate();
    const double unit = around(evaluation);
    per_point.push_back(alone.processor_seconds / static_cast<double>(alone.points) / unit);
    rate.push_back(static_cast<double>(alone.points) / alone.seconds);
    over_threads.push_back(alone.seconds / together.seconds);
    const double per_contact = swept.processor_seconds / static_cast<double>(swept.contacts);
    sweep_ratio.push_back(per_contact / around(of_sweep));
    sweep_units.push_back(per_contact / unit);
  }
  const auto mean = [](long sum, long count) {
    return static_cast<double>(sum) / static_cast<double>(count);
  };
  std::vector<Measurement> out = {
      {"batch evaluation", 1e9 * median(evaluation), "ns/contact", {}},
      {"screening, time of a point", median(per_point), "batch evaluations", 450.0},
      {"screening, friction evaluations of a point", mean(alone.contacts, alone.points), "-", {}},
      {"screening, points marched and not estimated",
       mean(alone.marched, alone.points),
       "share",
       {}},
      {"screening, points a second on one thread", median(rate), "1/s", 40000.0, false},
      {"screening, contact figures of a point", 1e6 * median(contact_figures), "us", 10.0},
      {"screening, contact figures over the point without", median(contact_figures_share), "-", {}},
      {"sweep 20 to 140 km/h by 0.5 both ways, over its friction evaluations alone",
       median(sweep_ratio), "-", 6.0},
      {"sweep, one of its friction evaluations alone", 1e9 * median(of_sweep), "ns/contact", {}},
      {"sweep, over as many batch evaluations", median(sweep_units), "-", 6.0},
      {"sweep, friction evaluations of a point", mean(swept.contacts, swept.points), "-", {}},
      {"sweep, points marched", mean(swept.marched, swept.points), "share", {}}};
  if (processors >= 4) {
    out.push_back({"screening, 4 threads over one", median(over_threads), "-", 3.6, false});
  }
  std::printf("%s; %zu scenes, medians of %d turns\n", machine_name().c_str(), scenes.size(),
              turns);
  print(out);
  if (!path.empty()) record(path, out);
  return 0;
}

}  // namespace
}  // namespace tribodyn

/// usage: screening_benchmark [results.json [fluids [turns]]]
int main(int count, char** arguments) try {
  return tribodyn::run(count > 1 ? arguments[1] : "", count > 2 ? std::atoi(arguments[2]) : 1000,
                       count > 3 ? std::atoi(arguments[3]) : 3);
} catch (const std::exception& error) {
  std::fprintf(stderr, "screening_benchmark: %s\n", error.what());
  return 1;
}
