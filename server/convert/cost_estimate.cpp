#include "server/convert/cost_estimate.h"

#include <algorithm>
#include <cmath>

namespace tribodyn::server {
namespace {

/// Contact solutions, and what one takes with all that is computed around it.
struct Work {
  double contact_solutions = 0;
  double seconds_each = 0;
};

constexpr double kPreparationSeconds = 0.2e-3;  // of a scene, whatever is studied
constexpr Work kQuasiStaticPoint{270, 0.3e-6};
constexpr Work kShotPoint{430, 0.25e-6};  // at the tolerance
constexpr double kShotTolerance = 1e-3;
constexpr double kShotOrder = 0.35;  // contact solutions grow so with a sharper one
constexpr Work kMarchedCycle{2300, 1e-6};
constexpr double kUsualMarchedCycles = 35;
constexpr Work kSample{3, 2.2e-6};      // of a history, three flanks
constexpr double kValueSeconds = 6e-9;  // of a history, repeated from the first period

void add(const Work& work, double count, v1::CostEstimate& out) {
  const double solutions = count * work.contact_solutions;
  out.set_contact_solutions(out.contact_solutions() + solutions);
  out.set_processor_seconds(out.processor_seconds() + solutions * work.seconds_each);
}

void add_points(double points, v1::PointModel model, const v1::SolverOptions& solver,
                v1::CostEstimate& out) {
  if (model == v1::QUASI_STATIC) return add(kQuasiStaticPoint, points, out);
  if (solver.method() != v1::MARCH) {
    return add(kShotPoint, points * std::pow(kShotTolerance / solver.tolerance(), kShotOrder), out);
  }
  add(kMarchedCycle, points * std::min<double>(kUsualMarchedCycles, solver.maximum_mesh_cycles()),
      out);
}

/// Only a march works out every sample: an orbit repeats.
void add_history(const v1::HistoryRequest& history, bool is_marched, v1::CostEstimate& out) {
  const double samples = history.samples_per_mesh_cycle();
  const double rows = history.mesh_cycles() * samples;
  add(kSample, is_marched ? rows : samples, out);
  const int columns = history.columns_size() + 1;  // and time
  out.set_processor_seconds(out.processor_seconds() + rows * columns * kValueSeconds);
}

}  // namespace

v1::CostEstimate estimate_cost(const v1::Simulation& effective) {
  v1::CostEstimate out;
  out.set_processor_seconds(kPreparationSeconds);
  const v1::SolverOptions& solver = effective.solver_options();
  if (effective.has_inefficiency_curve()) {
    const v1::InefficiencyCurveStudy& curve = effective.inefficiency_curve();
    add_points(curve.speeds_kilometers_per_hour_size(), curve.model(), solver, out);
    return out;
  }
  const v1::OperatingPointStudy& point = effective.operating_point();
  add_points(1, point.model(), solver, out);
  if (point.probe_coexisting_response()) {
    add_points(1, point.model(), solver, out);
  }
  if (point.has_history()) add_history(point.history(), solver.method() == v1::MARCH, out);
  return out;
}

}  // namespace tribodyn::server
