#include "core/study/expected_work.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/driveline/linear_modes.h"
#include "core/numerics/square.h"
#include "core/periodic/find_orbit.h"
#include "core/periodic/tapping_start.h"
#include "core/study/point_by_marching.h"

namespace tribodyn {
namespace {

// The constants were fitted to the reference axle, see the header.

double contacts_of_shooting(double oscillations, double tolerance) {
  constexpr double kAtOneThousandth = 130, kOrder = 0.48, kPerOscillation = 170;
  return kAtOneThousandth * std::pow(1e-3 / tolerance, kOrder) + kPerOscillation * oscillations;
}

double contacts_of_mesh_cycle(const MeshData& mesh, double oscillations, double step_tolerance) {
  constexpr double kPerInterval = 23, kPerOscillation = 60, kOrder = 0.2;
  return kPerInterval * mesh.intervals() +
         kPerOscillation * oscillations * std::pow(1e-7 / step_tolerance, kOrder);
}

/// The rate at which the slowest vibration dies out, like e^(-rate t) [1/s].
double slowest_decay_rate(const GearPairSystem& system) {
  double out = std::numeric_limits<double>::infinity();
  for (const LinearMode& mode : linear_modes(system)) {
    const double beyond_critical = std::sqrt(std::max(0.0, square(mode.damping) - 1));
    out = std::min(out, mode.frequency * (mode.damping - beyond_critical));
  }
  return out;
}

/// `decay`: exponent by which the slowest vibration dies out in a mesh cycle.
double mesh_cycles_to_settle(double decay, double settling_tolerance) {
  constexpr double kExtrapolated = 20, kLeast = 6;
  constexpr double kMultiplierAndRecord = 9;
  const double plain = std::log(1e2 / settling_tolerance) / decay;
  return std::clamp(plain, kLeast, kExtrapolated) + kMultiplierAndRecord;
}

double contacts_of_march(const GearPairSystem& system, double mean_pinion_speed,
                         double oscillations, const PointOptions& options) {
  const double period = system.cycle_angle() / mean_pinion_speed;
  const double cycles = std::min<double>(options.maximum_mesh_cycles,
                                         mesh_cycles_to_settle(slowest_decay_rate(system) * period,
                                                               march_settling_tolerance(options)));
  return std::min(
      most_contacts_of_march(options),
      cycles * contacts_of_mesh_cycle(system.mesh(), oscillations, march_step_tolerance(options)));
}

}  // namespace

ExpectedWork expected_work(const GearPairSystem& system, const OperatingTarget& target,
                           const PointOptions& options) {
  constexpr double kShareThatRattles = 9.0 / 16;  // of the light points of core/README.md
  const double oscillations = mesh_oscillations(system, target.mean_pinion_speed);
  ExpectedWork out;
  if (options.method == SteadyStateMethod::kMarch) {
    out.marching = contacts_of_march(system, target.mean_pinion_speed, oscillations, options);
    return out;
  }
  out.shooting = contacts_of_shooting(oscillations, options.tolerance);
  if (options.method == SteadyStateMethod::kAutomatic && target.torques.pinion != 0 &&
      flanks_tap(system.mesh(), target.torques.pinion)) {
    out.marching = kShareThatRattles * most_contacts_of_march(options);
  }
  return out;
}

}  // namespace tribodyn
