#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>
#include <vector>

#include "core/study/operating_point.h"
#include "core/study/screening.h"
#include "tests/benchmark/measurements.h"
#include "tests/support/figure_error.h"
#include "tests/support/reference_scene.h"

// Where a cheaper model pays: time and true error of the quasi-static model, of the full one and of
// the automatic choice, at slow and fast points and three tolerances, on the
// reference gear set. The truth is the full model at 1e-6. Gear set and fluid are prepared,
// responses without friction are not. Times are medians of interleaved turns.
namespace tribodyn {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kSpeeds[] = {1, 2, 5, 10, 20, 37.5, 45, 60, 80, 100, 140};  // [km/h]
constexpr double kTolerances[] = {1e-3, 1e-2, 5e-2};
constexpr int kModelCount = 3;
constexpr PointModel kModels[kModelCount] = {PointModel::kQuasiStatic, PointModel::kFull,
                                             PointModel::kAutomatic};
enum { kQuasiStatic, kFull, kAutomatic };  // places in it

struct Run {
  PointFigures figures;
  double microseconds;
};

Run run_once(PreparedScene& scene, const OperatingCondition& condition,
             const PointOptions& options) {
  const auto start = Clock::now();
  PointFigures figures = solve_point_figures(scene, condition, options);
  return {figures, std::chrono::duration<double, std::micro>(Clock::now() - start).count()};
}

std::string estimate_text(const PointFigures& r) {
  char text[16] = "  none";
  if (r.estimated_relative_error) {
    std::snprintf(text, sizeof text, "%.0e", *r.estimated_relative_error);
  }
  return text;
}

int run(const std::string& path, int turns) {
  const Scene scene = reference_scene();
  PreparedScene prepared(scene);
  std::vector<Measurement> figures;
  std::printf("%s; medians of %d turns; times in us\n\n", machine_name().c_str(), turns);
  std::printf(
      "               quasi-static             full"
      "                automatic\n"
      " km/h  asked   time  says    errs     time  says    errs"
      "     time    errs  model\n");
  for (const double speed : kSpeeds) {
    OperatingCondition condition;
    condition.vehicle_speed = speed / 3.6;
    PointOptions sharp;
    sharp.model = PointModel::kFull;
    sharp.tolerance = 1e-6;
    const PointResult truth = solve_prepared_point(prepared, condition, sharp);
    for (const double tolerance : kTolerances) {
      std::vector<double> times[kModelCount];
      PointFigures r[kModelCount];
      for (int turn = 0; turn < turns; ++turn) {
        for (int m = 0; m < kModelCount; ++m) {
          PointOptions options;
          options.model = kModels[m];
          options.tolerance = tolerance;
          const Run once = run_once(prepared, condition, options);
          r[m] = once.figures;
          times[m].push_back(once.microseconds);
        }
      }
      double error[kModelCount], time[kModelCount];
      std::printf("%5g  %.0e", speed, tolerance);
      for (int m = 0; m < kModelCount; ++m) {
        error[m] = true_error(r[m], truth);
        time[m] = median(times[m]);
        std::printf("%s%7.0f ", m > 0 ? " " : "", time[m]);
        if (m != kAutomatic) std::printf("%6s ", estimate_text(r[m]).c_str());
        std::printf("%7.0e", error[m]);
      }
      std::printf("  %s\n",
                  r[kAutomatic].model == PointModel::kQuasiStatic ? "quasi-static" : "full");
      const std::string at =
          std::to_string(speed).substr(0, 4) + " km/h at " + std::to_string(tolerance).substr(0, 5);
      figures.push_back(
          {"automatic, true error over tolerance, " + at, error[kAutomatic] / tolerance, "-", 1.0});
      figures.push_back(
          {"automatic over full model, time, " + at, time[kAutomatic] / time[kFull], "-", {}});
      if (speed == 1 && tolerance == 1e-3) {
        figures.push_back(
            {"quasi-static point with its estimates, " + at, time[kQuasiStatic], "us", 99.0});
      }
    }
  }
  record(path, figures);
  return 0;
}

}  // namespace
}  // namespace tribodyn

int main(int count, char** arguments) {
  if (count < 2) {
    std::fprintf(stderr, "usage: reduced_models_benchmark RESULTS_JSON [TURNS]\n");
    return 2;
  }
  try {
    return tribodyn::run(arguments[1], count > 2 ? 20 * std::atoi(arguments[2]) : 100);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
