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
constexpr Work kQuasiStaticPoint{4000, 4e-6};
constexpr Work kShotPoint{430, 0.4e-6};  // at the tolerance
constexpr double kShotTolerance = 1e-3;
constexpr double kShotOrder = 0.35;  // contact solutions grow so with a sharper one
constexpr Work kMarchedCycle{2300, 1e-6};
constexpr double kUsualMarchedCycles = 35;
constexpr Work kHistoryRow{3, 0.25e-6};  // three flanks

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
  if (point.has_history()) {
    const double rows =
        1.0 * point.history().mesh_cycles() * point.history().samples_per_mesh_cycle();
    add(kHistoryRow, rows, out);
  }
  return out;
}

}  // namespace tribodyn::server
