// Periodic orbits: Newton's method on the section state and the input torque.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "yardstick_numerics.h"
#include "yardstick_orbit.h"

namespace tribodyn::yardstick {
namespace {

constexpr int kUnknowns = 8;  // the seven section variables and T_s
using Unknowns = std::array<double, kUnknowns>;

Unknowns pack(const SectionState& state, double input_torque) {
  return {state.pinion_shaft_twist, state.gear_shaft_twist,
          state.pinion_shaft_speed, state.pinion_speed,
          state.gear_speed,         state.gear_shaft_speed,
          state.advance_with_error, input_torque};
}

SectionState unpack(const Unknowns& values) {
  return {values[0], values[1], values[2], values[3], values[4], values[5], values[6]};
}

double largest_magnitude(const Unknowns& values) {
  double largest = 0.0;
  for (double value : values) largest = std::max(largest, std::abs(value));
  return largest;
}

// The shooting problem in scaled unknowns.
class ShootingProblem {
 public:
  ShootingProblem(const GearPairSystem& system, double vehicle_speed, const CycleOptions& options)
      : system_(system),
        vehicle_speed_(vehicle_speed),
        resistive_torque_(resistive_torque(system.vehicle(), vehicle_speed)),
        options_(options) {
    const GearPairParameters& gear = system.gear_pair();
    const double input_torque = frictionless_input_torque(system, vehicle_speed);
    scale_ = {input_torque / gear.pinion_shaft_stiffness,
              resistive_torque_ / gear.gear_shaft_stiffness,
              1.0,
              1.0,
              1.0,
              1.0,
              0.1 * gear.half_backlash,
              input_torque};
  }

  MeshCycle integrate(const Unknowns& values) {
    ++integrated_cycles_;
    return integrate_mesh_cycle(system_, unpack(values), values[7], resistive_torque_, options_);
  }

  // Scaled mismatch after one cycle; the last one is the mean speed, against 1 %.
  Unknowns mismatch(const Unknowns& values, const MeshCycle& cycle) const {
    const Unknowns end = pack(cycle.end, cycle.input_torque);
    Unknowns out;
    for (int i = 0; i < 7; ++i) out[i] = (end[i] - values[i]) / scale_[i];
    out[7] = 100.0 * (cycle.vehicle_speed / vehicle_speed_ - 1.0);
    return out;
  }

  std::vector<std::vector<double>> jacobian(const Unknowns& values, const Unknowns& base,
                                            double step) {
    std::vector<std::vector<double>> out(kUnknowns, std::vector<double>(kUnknowns));
    for (int column = 0; column < kUnknowns; ++column) {
      Unknowns moved = values;
      moved[column] += step * scale_[column];
      const Unknowns change = mismatch(moved, integrate(moved));
      for (int row = 0; row < kUnknowns; ++row) {
        out[row][column] = (change[row] - base[row]) / step;
      }
    }
    return out;
  }

  Unknowns moved(const Unknowns& values, const std::vector<double>& direction,
                 double length) const {
    Unknowns moved = values;
    for (int i = 0; i < kUnknowns; ++i) moved[i] += length * direction[i] * scale_[i];
    return moved;
  }

  int integrated_cycles() const { return integrated_cycles_; }

 private:
  const GearPairSystem& system_;
  double vehicle_speed_;
  double resistive_torque_;
  CycleOptions options_;
  Unknowns scale_;
  int integrated_cycles_ = 0;
};

}  // namespace

double frictionless_input_torque(const GearPairSystem& system, double vehicle_speed) {
  return resistive_torque(system.vehicle(), vehicle_speed) * system.gear_pair().pinion_teeth /
         system.gear_pair().gear_teeth;
}

SectionState quasi_static_start(const GearPairSystem& system, double vehicle_speed) {
  const GearPairParameters& gear = system.gear_pair();
  const double input_torque = frictionless_input_torque(system, vehicle_speed);
  const double gear_speed = vehicle_speed / system.vehicle().wheel_radius;
  const double pinion_speed = gear_speed * gear.gear_teeth / gear.pinion_teeth;
  const double mesh_force = input_torque / gear.pinion_contact_radius.value(0.0);
  SectionState start;
  start.pinion_shaft_twist = input_torque / gear.pinion_shaft_stiffness;
  start.gear_shaft_twist =
      resistive_torque(system.vehicle(), vehicle_speed) / gear.gear_shaft_stiffness;
  start.pinion_shaft_speed = start.pinion_speed = pinion_speed;
  start.gear_speed = start.gear_shaft_speed = gear_speed;
  start.advance_with_error = gear.half_backlash + mesh_force / gear.mesh_stiffness.value(0.0) +
                             gear.static_transmission_error.value(0.0);
  return start;
}

Orbit find_periodic_orbit(const GearPairSystem& system, const SectionState& start,
                          double input_torque, double vehicle_speed, const OrbitOptions& options) {
  ShootingProblem problem(system, vehicle_speed, options.cycle);
  Unknowns values = pack(start, input_torque);
  for (int cycle = 0; cycle < options.marching_cycles; ++cycle) {
    const MeshCycle marched = problem.integrate(values);
    values = pack(marched.end, input_torque);
    for (int i = 2; i <= 5; ++i) values[i] *= vehicle_speed / marched.vehicle_speed;
  }

  Orbit orbit;
  orbit.cycle = problem.integrate(values);
  Unknowns mismatch = problem.mismatch(values, orbit.cycle);
  std::vector<std::vector<double>> jacobian;
  bool fresh_jacobian = false;
  while (largest_magnitude(mismatch) > options.mismatch_tolerance &&
         orbit.iterations < options.maximum_iterations) {
    ++orbit.iterations;
    if (jacobian.empty()) {
      jacobian = problem.jacobian(values, mismatch, options.difference_step);
      fresh_jacobian = true;
    }
    std::vector<double> direction =
        solve_linear_system(jacobian, std::vector<double>(mismatch.begin(), mismatch.end()));
    for (double& component : direction) component = -component;
    // The longest step that lowers the mismatch.
    bool accepted = false;
    double reduction = 1.0;
    for (double length = 1.0; length > 1e-3 && !accepted; length *= 0.5) {
      const Unknowns trial = problem.moved(values, direction, length);
      const MeshCycle cycle = problem.integrate(trial);
      const Unknowns trial_mismatch = problem.mismatch(trial, cycle);
      reduction = largest_magnitude(trial_mismatch) / largest_magnitude(mismatch);
      accepted = reduction < 1.0 - 0.25 * length;
      if (accepted) {
        values = trial;
        mismatch = trial_mismatch;
        orbit.cycle = cycle;
      } else if (!fresh_jacobian) {
        break;
      }
    }
    if (!accepted && fresh_jacobian) break;
    // Keep the matrix while it serves well: a new one costs eight cycles.
    if (!accepted || reduction > 0.1) jacobian.clear();
    fresh_jacobian = false;
  }
  orbit.start = unpack(values);
  orbit.mismatch = largest_magnitude(mismatch);
  orbit.converged = orbit.mismatch <= options.mismatch_tolerance;
  orbit.integrated_cycles = problem.integrated_cycles();
  return orbit;
}

}  // namespace tribodyn::yardstick
