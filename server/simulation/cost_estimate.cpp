#include "server/simulation/cost_estimate.h"

#include <algorithm>
#include <cmath>

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
// A point by shooting: the first term grows with 1 / tolerance, the second with the duration of a
// mesh cycle.
constexpr double kShotSolutions = 130;  // at the usual tolerance
constexpr double kShotOrder = 0.48;
constexpr double kShotSolutionsAtOneKilometrePerHour = 12'800;
constexpr double kShotSecondsEach = 0.21e-6;
constexpr double kPinionSpeedAtOneKilometrePerHour = 3.2;  // [rad/s], paper's axle
// Extra cost per e-fold of the speed range of a curve that follows a branch: distant points
// converge more slowly, and a wide curve is more likely to need step halving to locate the end of a
// branch.
constexpr double kSpreadSeconds = 0.7e-3;
constexpr double kHalvingSeconds = 0.13e-3;
constexpr double kEndInterval = 0.04;           // [km/h]
constexpr double kPreparedRigSeconds = 1.5e-6;  // [s] for each candidate and temperature (measured)
constexpr Work kRigRow{1, 4e-6};                // with what a campaign does about it (measured)
constexpr Work kMarchedCycle{2300, 0.8e-6};
constexpr double kUsualMarchedCycles = 35;
constexpr Work kOrbitSample{3, 2.3e-6};  // one sample of a history, three flanks
constexpr Work kMarchedSample{3, 1.3e-6};
// [s] for each value of a history, copied from the first period
constexpr double kValueSeconds = 3e-9;

void add(const Work& work, double count, v1::CostEstimate& out) {
  const double solutions = count * work.contact_solutions;
  out.set_contact_solutions(out.contact_solutions() + solutions);
  out.set_processor_seconds(out.processor_seconds() + solutions * work.seconds_each);
}

double times_sharper(const v1::SolverOptions& solver) {
  return kUsualTolerance / solver.tolerance();
}

void add_shot_point(double speed_kilometres_per_hour, const v1::SolverOptions& solver,
                    bool sensitivities, v1::CostEstimate& out) {
  const double solutions = kShotSolutions * std::pow(times_sharper(solver), kShotOrder) +
                           kShotSolutionsAtOneKilometrePerHour / speed_kilometres_per_hour;
  add({solutions, kShotSecondsEach * (sensitivities ? kSensitivityFactor : 1)}, 1, out);
}

void add_point(double speed_kilometres_per_hour, v1::PointModel model,
               const v1::SolverOptions& solver, bool sensitivities, v1::CostEstimate& out) {
  if (model == v1::POINT_MODEL_QUASI_STATIC) {
    add(kQuasiStaticPoint, std::pow(times_sharper(solver), kQuasiStaticOrder), out);
  } else if (solver.method() == v1::STEADY_STATE_METHOD_MARCH) {
    add(kMarchedCycle, std::min<double>(kUsualMarchedCycles, solver.maximum_mesh_cycles()), out);
  } else {
    add_shot_point(speed_kilometres_per_hour, solver, sensitivities, out);
  }
}

/// Returns the time [s] that a curve needs in addition to its points. Requires ascending speeds.
double branch_following_seconds(const google::protobuf::RepeatedField<double>& speeds) {
  if (speeds.size() < 2) return 0;
  const double first = *speeds.begin();
  const double last = *speeds.rbegin();
  const double step = (last - first) / (speeds.size() - 1);
  const double halvings = std::max(0.0, std::log2(step / kEndInterval));
  return std::log(last / first) * (kSpreadSeconds + kHalvingSeconds * halvings);
}

void add_curve(const v1::InefficiencyCurveStudy& curve, const v1::SolverOptions& solver,
               v1::CostEstimate& out) {
  const auto& speeds = curve.speeds_kilometres_per_hour();
  for (const double speed : speeds) {
    add_point(speed, curve.model(), solver, curve.sensitivities(), out);
  }
  if (curve.model() == v1::POINT_MODEL_QUASI_STATIC || curve.independent_points()) return;
  out.set_processor_seconds(out.processor_seconds() + branch_following_seconds(speeds));
}

/// Returns the vehicle speed of a point [km/h]. For a prescribed pinion speed it is that of the
/// paper's axle.
double speed_of(const v1::OperatingPointStudy& point) {
  if (point.has_cruise()) return point.cruise().speed_kilometres_per_hour();
  if (point.has_drive_cycle_snapshot()) {
    return point.drive_cycle_snapshot().speed_kilometres_per_hour();
  }
  return point.prescribed_torque().pinion_speed_radians_per_second() /
         kPinionSpeedAtOneKilometrePerHour;
}

/// Adds the cost of a history. A march computes every sample; an orbit repeats its first period.
void add_history(const v1::HistoryRequest& history, bool is_marched, v1::CostEstimate& out) {
  const double samples = history.samples_per_mesh_cycle();
  const double rows = history.mesh_cycles() * samples;
  if (is_marched) {
    add(kMarchedSample, rows, out);
  } else {
    add(kOrbitSample, samples, out);
  }
  const int columns = history.columns_size() + 1;  // the columns and time
  out.set_processor_seconds(out.processor_seconds() + rows * columns * kValueSeconds);
}

void add_study(const v1::Simulation& effective, v1::CostEstimate& out) {
  const v1::SolverOptions& solver = effective.solver_options();
  if (effective.has_inefficiency_curve()) {
    return add_curve(effective.inefficiency_curve(), solver, out);
  }
  const v1::OperatingPointStudy& point = effective.operating_point();
  const double speed = speed_of(point);
  add_point(speed, point.model(), solver, point.sensitivities(), out);
  if (point.probe_coexisting_response()) add_point(speed, point.model(), solver, false, out);
  if (point.has_history())
    add_history(point.history(), solver.method() == v1::STEADY_STATE_METHOD_MARCH, out);
}

/// Rounds to two digits.
double rounded(double value) {
  const double scale = std::pow(10.0, 1 - std::floor(std::log10(value)));
  return std::round(value * scale) / scale;
}

}  // namespace

v1::CostEstimate estimate_cost(const v1::Simulation& effective) {
  v1::CostEstimate out;
  out.set_processor_seconds(kPreparationSeconds);
  add_study(effective, out);
  // Round, so that jobs of practically equal cost are served first in, first out.
  out.set_processor_seconds(rounded(out.processor_seconds()));
  return out;
}

v1::CostEstimate estimate_screening_cost(const v1::Simulation& effective, int candidates,
                                         const std::vector<double>& speeds_kilometres_per_hour,
                                         const ScreenedExtras& extras) {
  v1::CostEstimate out;
  for (const double speed : speeds_kilometres_per_hour) {
    add_shot_point(speed, effective.solver_options(), extras.elasticities, out);
  }
  double seconds = out.processor_seconds();
  if (extras.contact) seconds *= kContactFiguresFactor;
  out.set_processor_seconds(seconds);
  out.set_contact_solutions(candidates * out.contact_solutions());
  out.set_processor_seconds(rounded(candidates * out.processor_seconds()));
  return out;
}

v1::CostEstimate estimate_rig_cost(int candidates, std::size_t temperatures, int conditions) {
  v1::CostEstimate out;
  out.set_processor_seconds(candidates * static_cast<double>(temperatures) * kPreparedRigSeconds);
  add(kRigRow, static_cast<double>(candidates) * conditions, out);
  out.set_processor_seconds(rounded(out.processor_seconds()));
  return out;
}

}  // namespace tribodyn::server
