#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "core/refusal.h"
#include "core/study/operating_point.h"
#include "core/study/screening.h"
#include "tests/benchmark/measurements.h"
#include "tests/support/figure_error.h"
#include "tests/support/random_place.h"

// The wild scenes of tests/support/random_place.h: does the answer err less than it says, what does
// it cost, and does the march stay where shooting has ended? Run it when a tuning constant changes.
//
// The truth is the same response at a tolerance of 1e-7. That this is right at all, an event-exact
// march shows: in every tenth scene it starts where the answer did, and leads to the same response,
// unless the answer warns of two.
namespace tribodyn {
namespace {

struct Scored {
  int scene, kind;
  double tolerance;
  double error = 0, estimate = 0;  ///< 0: no truth, or none is stated
  double microseconds = 0;
  std::string answer;  ///< shooting, march, quasi-static, or the reason of a refusal
  bool settled = false;
};

constexpr double kTolerances[] = {1e-5, 1e-3, 1e-2};  // the sharpest first: its truth serves all
constexpr double kCheckedTolerance = 1e-3;
constexpr int kCheckedEvery = 10;  // scenes

bool warns(const PointResult& r, const std::string& code) {
  return std::any_of(r.warnings.begin(), r.warnings.end(),
                     [&](const RangeWarning& warning) { return warning.code == code; });
}

/// The errors of a scene's answers.
class Judge {
 public:
  Judge(int scene, const RandomPlace& place, bool with_truth)
      : scene_(scene), place_(place), with_truth_(with_truth) {}

  Scored score(double tolerance) {
    Scored out{scene_, place_.kind, tolerance, 0, 0, 0, "", false};
    PointOptions options;
    options.tolerance = tolerance;
    const double start = processor_seconds();
    try {
      const PointResult r = solve_operating_point(place_.scene, place_.condition, options);
      out.microseconds = 1e6 * (processor_seconds() - start);
      out.settled = r.settled;
      out.answer = r.model == PointModel::kQuasiStatic        ? "quasi-static"
                   : r.method == SteadyStateMethod::kShooting ? "shooting"
                                                              : "march";
      out.estimate = r.estimated_relative_error.value_or(0);
      if (!with_truth_ || !r.settled) return out;
      out.error = error_of(r);
      if (tolerance == kCheckedTolerance && scene_ % kCheckedEvery == 0) check_from_start(r);
    } catch (const Refusal& refusal) {
      if (out.answer.empty()) {
        out.microseconds = 1e6 * (processor_seconds() - start);
        out.answer = refusal.reason();
      }
    }
    return out;
  }

 private:
  double error_of(const PointResult& r) {
    const double estimate = r.estimated_relative_error.value_or(0);
    if (truth_ && true_error(r, *truth_) <= estimate) return true_error(r, *truth_);
    PointOptions options;
    options.model = PointModel::kFull;
    options.method = SteadyStateMethod::kShooting;
    options.tolerance = 1e-7;
    options.warn_of_coexisting_response = false;
    if (r.model == PointModel::kFull) options.carried_state = carried_from(r);
    truth_ = solve_operating_point(place_.scene, place_.condition, options);
    return true_error(r, *truth_);
  }

  void check_from_start(const PointResult& r) const {
    PointOptions options;
    options.model = PointModel::kFull;
    options.method = SteadyStateMethod::kMarch;
    options.tolerance = 1e-4;
    options.maximum_mesh_cycles = 600;
    options.warn_of_coexisting_response = false;
    const PointResult marched = solve_operating_point(place_.scene, place_.condition, options);
    if (!marched.settled || !marched.inefficiency_rms) return;
    const double off = true_error(r, marched);
    if (off <= 1e-4 + r.estimated_relative_error.value_or(0)) return;
    std::printf("scene %d (kind %d): %.2e off the march from the start, stated %.2e%s\n", scene_,
                place_.kind, off, r.estimated_relative_error.value_or(0),
                warns(r, "RESPONSES_COEXIST") || warns(r, "FLANKS_TAP") ? ", warned" : "");
  }

  int scene_;
  const RandomPlace& place_;
  bool with_truth_;
  std::optional<PointResult> truth_;
};

double percentile(std::vector<double> values, double share) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

int run(int count, unsigned long seed, bool with_truth, const std::string& table) {
  std::ofstream csv(table);
  csv << "scene,kind,tolerance,error,estimate,microseconds,method,settled\n";
  std::array<std::vector<Scored>, std::size(kTolerances)> all;
  std::mt19937_64 random(seed);
  for (int i = 0; i < count; ++i) {
    const double speed =
        std::exp(std::uniform_real_distribution<double>(std::log(1.0), std::log(220.0))(random));
    const RandomPlace place = random_place(random, speed);
    Judge judge(i, place, with_truth);
    for (std::size_t t = 0; t < all.size(); ++t) {
      all[t].push_back(judge.score(kTolerances[t]));
      const Scored& s = all[t].back();
      csv << s.scene << ',' << s.kind << ',' << s.tolerance << ',' << s.error << ',' << s.estimate
          << ',' << s.microseconds << ',' << s.answer << ',' << s.settled << '\n';
      if (s.error > s.estimate) {
        std::printf("scene %d (kind %d, %.3g km/h) at %g: error %.2e, estimate %.2e, %s\n", i,
                    s.kind, speed, s.tolerance, s.error, s.estimate, s.answer.c_str());
      }
      if (s.microseconds > 5e5) {
        std::printf("scene %d (kind %d, %.3g km/h) at %g: %.2f s, %s\n", i, s.kind, speed,
                    s.tolerance, 1e-6 * s.microseconds, s.answer.c_str());
      }
    }
    std::fflush(stdout);
  }
  std::printf("\n%10s %9s %7s %8s %8s %10s %10s %10s %10s\n", "tolerance", "shooting", "march",
              "refused", "settled", "above", "ratio 1 %", "median us", "most us");
  for (const auto& scored : all) {
    int shot = 0, marched = 0, refused = 0, settled = 0, above = 0;
    std::vector<double> ratio, time;
    for (const Scored& s : scored) {
      shot += s.answer.starts_with("shooting") || s.answer.starts_with("quasi");
      marched += s.answer.starts_with("march");
      refused += s.answer[0] >= 'A' && s.answer[0] <= 'Z';
      settled += s.settled;
      above += s.error > s.estimate;
      if (s.error > 0 && s.estimate > 0) ratio.push_back(s.estimate / s.error);
      time.push_back(s.microseconds);
    }
    std::printf("%10g %9d %7d %8d %8d %10d %10.2f %10.1f %10.0f\n", scored.front().tolerance, shot,
                marched, refused, settled, above, percentile(ratio, 0.01), percentile(time, 0.5),
                percentile(time, 1));
  }
  return 0;
}

}  // namespace
}  // namespace tribodyn

/// usage: population_benchmark [scenes [seed [table.csv [no-truth]]]]
int main(int count, char** arguments) try {
  return tribodyn::run(count > 1 ? std::atoi(arguments[1]) : 2000,
                       count > 2 ? std::stoul(arguments[2]) : 1, count <= 4,
                       count > 3 ? arguments[3] : "/dev/null");
} catch (const std::exception& error) {
  std::fprintf(stderr, "population_benchmark: %s\n", error.what());
  return 1;
}
