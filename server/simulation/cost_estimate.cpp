#include "server/simulation/cost_estimate.h"

#include <algorithm>
#include <cmath>
#include <variant>
#include <vector>

#include "core/study/expected_work.h"

namespace tribodyn::server {
namespace {

/// Number of contact solutions, and processor time of one with all computation around it.
struct Work {
  double contact_solutions = 0;
  double seconds_each = 0;
};

constexpr double kPreparationSeconds = 0.26e-3;  // [s] for each scene
// Of a point by shooting, also screened. Measured: 2 to 3.5, where flanks part 1.4 to 2.8, at
// tolerances of 1e-5 to 1e-3.
constexpr double kSensitivityFactor = 2.5;
constexpr double kContactFiguresFactor = 1.4;  // of a screened point (measured)
constexpr double kUsualTolerance = 1e-3;
constexpr Work kQuasiStaticPoint{340, 0.25e-6};  // at the usual tolerance
constexpr double kQuasiStaticOrder = 0.4;        // exponent of their growth with 1 / tolerance
// [s] for each contact solution, with all computation around it (measured).
constexpr double kShotSecondsEach = 0.21e-6;
constexpr double kMarchedSecondsEach = 2e-6;
// Extra cost per e-fold of the speed range of a curve that follows a branch: distant points
// converge more slowly, and a wide curve is more likely to need step halving to locate the end of a
// branch.
constexpr double kSpreadSeconds = 0.7e-3;
constexpr double kHalvingSeconds = 0.13e-3;
constexpr double kEndInterval = 0.04 / 3.6;     // [m/s]
constexpr double kPreparedRigSeconds = 1.5e-6;  // [s] for each candidate and temperature (measured)
constexpr Work kRigRow{1, 4e-6};                // with what a campaign does about it (measured)
constexpr Work kOrbitSample{3, 2.3e-6};         // one sample of a history, three flanks
constexpr Work kMarchedSample{3, 1.3e-6};
// [s] for each value of a history, copied from the first period
constexpr double kValueSeconds = 3e-9;

void add_work(const Work& work, double count, v1::CostEstimate& out) {
  const double solutions = count * work.contact_solutions;
  out.set_contact_solutions(out.contact_solutions() + solutions);
  out.set_processor_seconds(out.processor_seconds() + solutions * work.seconds_each);
}

/// The points of a simulation, as far as their cost depends on them.
class CostedPoints {
 public:
  explicit CostedPoints(const SimulationInputs& inputs)
      : scene_(scene(inputs)),
        mesh_(scene_.gear_set),
        system_(mesh_, scene_.gear_set.dynamics, scene_.options) {}
  CostedPoints(const CostedPoints&) = delete;
  CostedPoints& operator=(const CostedPoints&) = delete;

  void add(const OperatingCondition& condition, const PointOptions& options, double count,
           v1::CostEstimate& out) const {
    if (options.model == PointModel::kQuasiStatic) {
      const double times_sharper = kUsualTolerance / options.tolerance;
      add_work(kQuasiStaticPoint, count * std::pow(times_sharper, kQuasiStaticOrder), out);
      return;
    }
    const ExpectedWork work = expected_work(system_, target_of(scene_, condition), options);
    add_work({work.shooting, kShotSecondsEach * (options.sensitivities ? kSensitivityFactor : 1)},
             count, out);
    add_work({work.marching, kMarchedSecondsEach}, count, out);
  }

 private:
  Scene scene_;
  MeshData mesh_;
  GearPairSystem system_;
};

/// Returns the time [s] that a curve needs in addition to its points. Requires ascending speeds.
double branch_following_seconds(const std::vector<double>& speeds) {
  if (speeds.size() < 2) return 0;
  const double first = speeds.front();
  const double last = speeds.back();
  const double step = (last - first) / static_cast<double>(speeds.size() - 1);
  const double halvings = std::max(0.0, std::log2(step / kEndInterval));
  return std::log(last / first) * (kSpreadSeconds + kHalvingSeconds * halvings);
}

void add_curve(const CurveStudy& curve, const CostedPoints& points, v1::CostEstimate& out) {
  OperatingCondition condition;
  condition.ascent_angle = curve.ascent_angle;
  for (const double speed : curve.vehicle_speeds) {
    condition.vehicle_speed = speed;
    points.add(condition, curve.options.point, 1, out);
  }
  if (curve.options.point.model == PointModel::kQuasiStatic || curve.options.independent_points) {
    return;
  }
  out.set_processor_seconds(out.processor_seconds() +
                            branch_following_seconds(curve.vehicle_speeds));
}

/// Adds the cost of a history. A march computes every sample; an orbit repeats its first period.
void add_history(const HistoryRequest& history, bool is_marched, v1::CostEstimate& out) {
  const double samples = history.samples_per_mesh_cycle;
  const double rows = history.mesh_cycles * samples;
  if (is_marched) {
    add_work(kMarchedSample, rows, out);
  } else {
    add_work(kOrbitSample, samples, out);
  }
  const auto columns = static_cast<double>(history.columns.size() + 1);  // the columns and time
  out.set_processor_seconds(out.processor_seconds() + rows * columns * kValueSeconds);
}

void add_point(const PointStudy& point, const CostedPoints& points, v1::CostEstimate& out) {
  PointOptions options = point.options;
  points.add(point.condition, options, 1, out);
  if (options.probe_coexisting_response) {
    options.sensitivities = false;
    points.add(point.condition, options, 1, out);
  }
  if (!options.history.columns.empty()) {
    add_history(options.history, options.method == SteadyStateMethod::kMarch, out);
  }
}

/// Rounds to two digits.
double rounded(double value) {
  const double scale = std::pow(10.0, 1 - std::floor(std::log10(value)));
  return std::round(value * scale) / scale;
}

}  // namespace

v1::CostEstimate estimate_cost(const SimulationInputs& inputs) {
  v1::CostEstimate out;
  out.set_processor_seconds(kPreparationSeconds);
  const CostedPoints points(inputs);
  const Study asked = study(inputs);
  if (const auto* curve = std::get_if<CurveStudy>(&asked)) {
    add_curve(*curve, points, out);
  } else {
    add_point(std::get<PointStudy>(asked), points, out);
  }
  // Round, so that jobs of practically equal cost are served first in, first out.
  out.set_processor_seconds(rounded(out.processor_seconds()));
  return out;
}

v1::CostEstimate estimate_screening_cost(const PointEvaluation& evaluation) {
  v1::CostEstimate out;
  const CostedPoints points(evaluation.base);
  const PointOptions options = point_options(evaluation);
  for (const PointEvaluation::Group& group : evaluation.groups) {
    for (const auto& [position, condition] : group.conditions) {
      points.add(condition, options, evaluation.candidates, out);
    }
  }
  double seconds = out.processor_seconds();
  if (evaluation.with_contact) seconds *= kContactFiguresFactor;
  out.set_processor_seconds(rounded(seconds));
  return out;
}

v1::CostEstimate estimate_rig_cost(int candidates, std::size_t temperatures, int conditions) {
  v1::CostEstimate out;
  out.set_processor_seconds(candidates * static_cast<double>(temperatures) * kPreparedRigSeconds);
  add_work(kRigRow, static_cast<double>(candidates) * conditions, out);
  out.set_processor_seconds(rounded(out.processor_seconds()));
  return out;
}

}  // namespace tribodyn::server
