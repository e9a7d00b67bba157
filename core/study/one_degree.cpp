#include "core/study/one_degree.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/dynamics/linear_response.h"
#include "core/numerics/square.h"

namespace tribodyn {
namespace {

constexpr double kShaftMargin = 2.5;  // factor on the change that shafts are estimated to make
// Shafts move where periods double by some 2 % in speed.
constexpr double kNearDoublingOfOneDegree = 0.1;
constexpr double kMostShaftGrowth = 0.5;     // see InertialCorrection
constexpr double kLeastForceOnShafts = 0.2;  // smallest over mean mesh force, with shafts
constexpr double kMostOfForce = 0.25;        // change of the mesh force over its mean

/// A motion at one mesh phase, and what follows from it.
struct Place {
  Mechanics at;
  double pinion_speed, gear_speed, shaft_speed;
  FrictionPerLoad friction;

  /// sum V_s F_fr, by the arms (eq 29).
  double loss(double load) const {
    return -load * (friction.pinion * pinion_speed + friction.gear * gear_speed);
  }
};

/// At the starts of the steps.
std::vector<Place> places_of(const GearPairSystem& system, const MeshGrid& grid,
                             const PeriodicOrbit& orbit) {
  LaggedFriction friction = orbit.friction;
  std::vector<Place> out(orbit.pieces.size());
  for (std::size_t n = 0; n < out.size(); ++n) {
    const OrbitPiece& piece = orbit.pieces[n];
    const MarchState& y = piece.start;
    Place& place = out[n];
    system.mechanics(grid.at(piece.node), y.data(), place.at);
    place.pinion_speed = y[kPinionSpeed];
    place.gear_speed = y[kGearSpeed];
    place.shaft_speed = y[kPinionShaftSpeed];
    place.friction = friction.at(piece.phase);
  }
  return out;
}

TwoRotorMotion motion_of(const GearPairSystem& system, const std::vector<Place>& places) {
  TwoRotorMotion out;
  out.resize(places.size());
  double pinion = 0, gear = 0, force = 0;
  for (std::size_t n = 0; n < places.size(); ++n) {
    const Mechanics& at = places[n].at;
    const double load = system.regime.load(at.mesh_force);
    out.pinion_torque[n] =
        -at.mesh.pinion_contact_radius * at.mesh_force + places[n].friction.pinion * load;
    out.gear_torque[n] =
        at.mesh.gear_contact_radius * at.mesh_force + places[n].friction.gear * load;
    pinion -= out.pinion_torque[n];
    gear += out.gear_torque[n];
    force += at.mesh_force;
    if (system.options().energy_consistent) out.pinion_torque[n] += at.parametric_torque();
    out.mesh_stiffness[n] = at.mesh.mesh_stiffness;
  }
  out.pinion_arm = pinion / force;
  out.gear_arm = gear / force;
  return out;
}

std::vector<Place> corrected(const GearPairSystem& system, std::vector<Place> places,
                             const ShaftCorrection& change) {
  for (std::size_t n = 0; n < places.size(); ++n) {
    Place& place = places[n];
    Mechanics& at = place.at;
    const double damper = system.dynamics().mesh_damping * change.transmission_velocity[n];
    at.transmission_error += change.transmission_error[n];
    at.deflection += change.transmission_error[n];
    at.transmission_velocity += change.transmission_velocity[n];
    at.damper_force += damper;
    at.mesh_force += at.mesh.mesh_stiffness * change.transmission_error[n] + damper;
    place.pinion_speed += change.pinion_speed[n];
    place.gear_speed += change.gear_speed[n];
    place.shaft_speed += change.pinion_shaft_speed[n];
  }
  return places;
}

/// Of a mesh cycle; as torque the mean of all that is lost, over the speed. The loss is per speed
/// of the pinion's shaft, in coast too: what shafts change is compared, and the wheel hardly moves.
OrbitFigures figures_of(const GearPairSystem& system, const std::vector<Place>& places,
                        double shaft_damping_power, double mean_pinion_speed) {
  OrbitFigures out;
  out.dte_minimum = 1e300;
  out.dte_maximum = -1e300;
  double time = 0, squares = 0, other = 0;
  for (const Place& place : places) {
    const Mechanics& at = place.at;
    const double duration = 1 / place.pinion_speed;
    const double loss = place.loss(system.regime.load(at.mesh_force));
    time += duration;
    out.loss_energy += duration * loss;
    squares += duration * square(loss / place.shaft_speed);
    other += duration * at.damper_force * at.transmission_velocity;
    if (!system.options().energy_consistent) {
      other += duration * at.parametric_torque() * place.pinion_speed;
    }
    out.dte_minimum = std::min(out.dte_minimum, at.transmission_error);
    out.dte_maximum = std::max(out.dte_maximum, at.transmission_error);
  }
  out.loss_rms = std::sqrt(squares / time);
  out.loss_energy /= time;
  out.torque = (out.loss_energy + other / time + shaft_damping_power) / mean_pinion_speed;
  return out;
}

}  // namespace

double one_degree_model_error(GearPairSystem& system, MeshGrids& grids, const OrbitSearch& search,
                              const RefinedOrbit& found) {
  constexpr double kUnknown = std::numeric_limits<double>::infinity();
  const PeriodicOrbit& orbit = found.orbit;
  const double speed = search.mean_pinion_speed;
  const MeshGrid& grid = grids.with_steps(found.steps_per_mesh_cycle);
  const bool whole_steps = std::all_of(orbit.pieces.begin(), orbit.pieces.end(),
                                       [](const OrbitPiece& piece) { return piece.node >= 0; });
  if (orbit.contact_loss || orbit.period != 1 || !whole_steps) return kUnknown;
  if (orbit.map->distance_from_doubling() < kNearDoublingOfOneDegree) return kUnknown;
  system.regime = orbit.regime;
  const std::vector<Place> alone = places_of(system, grid, orbit);
  const TwoRotorMotion motion = motion_of(system, alone);
  const ShaftCorrection change = shaft_correction(system, speed, motion);
  if (!(change.growth < kMostShaftGrowth)) return kUnknown;
  const std::vector<Place> with_shafts = corrected(system, alone, change);

  double mean = 0, least = 1e300, largest_change = 0;
  for (std::size_t n = 0; n < alone.size(); ++n) {
    const double before = system.regime.side * alone[n].at.mesh_force;
    const double after = system.regime.side * with_shafts[n].at.mesh_force;
    mean += before / static_cast<double>(alone.size());
    least = std::min({least, before, after});
    largest_change = std::max(largest_change, std::abs(after - before));
  }
  if (!(least > kLeastForceOnShafts * mean) || !(largest_change < kMostOfForce * mean))
    return kUnknown;

  OrbitFigures before = figures_of(system, alone, 0, speed);
  OrbitFigures after = figures_of(system, with_shafts, change.shaft_damping_power, speed);
  const double torque = std::abs(orbit.figures.torque);
  const double ratio = search.solve_wheel_torque ? system.mesh().mean_gear_contact_radius() /
                                                       system.mesh().mean_pinion_contact_radius()
                                                 : 1;
  after.torque = torque + ratio * (after.torque - before.torque);
  before.torque = torque;
  return kShaftMargin * after.distance(before);
}

}  // namespace tribodyn
