#include "core/study/quasi_static.h"

#include <cmath>
#include <numbers>
#include <vector>

#include "core/dynamics/steady_state.h"

namespace tribodyn {
namespace {

/// State at a phase under a mesh force F: x from F, speeds for xdot = 0.
void equilibrium_state(const GearPairSystem& system, double phase, double force, double speed,
                       RecordComponent count, double* y) {
  for (int i = 0; i < count; ++i) y[i] = 0;
  const MeshData& mesh = system.mesh();
  const double theta = 2 * std::numbers::pi * phase;
  const double lag = mesh.gear_teeth() / mesh.mean_gear_contact_radius();
  const double side = system.regime.side;
  MeshFunctions at = mesh.functions(theta, theta);
  for (int i = 0; i < 4; ++i) {  // R_g's ripple over the winding: contracts by 1e-2 and is tiny
    const double x = side * system.dynamics().half_backlash + force / at.mesh_stiffness;
    y[kWinding] =
        x + at.static_transmission_error - at.radius_integral - system.dynamics().half_backlash;
    at = mesh.functions(theta, theta - lag * y[kWinding]);
  }
  const double ratio = mesh.mean_pinion_contact_radius() / mesh.mean_gear_contact_radius();
  y[kPinionShaftSpeed] = y[kPinionSpeed] = speed;
  y[kGearSpeed] = (at.pinion_contact_radius - at.static_transmission_error_slope) * speed /
                  at.gear_contact_radius;
  y[kWheelSpeed] = ratio * speed;
  y[kPinionShaftTwist] = system.torques().pinion / system.dynamics().pinion_shaft_stiffness;
  y[kGearShaftTwist] = system.torques().wheel / system.dynamics().gear_shaft_stiffness;
}

}  // namespace

QuasiStatic solve_quasi_static(GearPairSystem& system, double speed, bool solve_wheel_torque,
                               ResponseRecord& record, HistorySampler& history,
                               const std::function<bool(double)>& progress) {
  const MeshData& mesh = system.mesh();
  const double ratio = mesh.mean_pinion_contact_radius() / mesh.mean_gear_contact_radius();
  const int intervals = mesh.intervals(), points = 2 * intervals;
  const double gauss[2] = {0.5 - 0.5 / std::sqrt(3.0), 0.5 + 0.5 / std::sqrt(3.0)};
  system.regime = {system.torques().pinion >= 0 ? 1 : -1, true};

  std::vector<double> friction_torque(points, 0.0);
  std::array<double, kRecordComponents> state{}, rate{};
  Instant at;
  const auto solve_at = [&](double phase, int interval, double& torque) {
    const MeshFunctions f =
        mesh.functions(2 * std::numbers::pi * phase, 2 * std::numbers::pi * phase);
    const double force = (system.torques().pinion + torque) / f.pinion_contact_radius;
    equilibrium_state(system, phase, force, speed, kRecordComponents, state.data());
    system.set_interval(interval);
    system.evaluate(phase, state.data(), at);
    torque = at.pinion_friction_torque;
  };

  const auto phase_of = [&](int point) {
    const int interval = point / 2;
    return (interval + gauss[point % 2]) / intervals;
  };

  // Load and torque settle together: each sweep divides the error by about thirty.
  for (int sweep = 0; sweep < 40; ++sweep) {
    if (progress && !progress(sweep / 40.0)) throw Cancelled();
    double loss = 0, change = 0;
    for (int i = 0; i < points; ++i) {
      const double before = friction_torque[i];
      solve_at(phase_of(i), i / 2, friction_torque[i]);
      change = std::max(change, std::abs(friction_torque[i] - before));
      loss += at.loss_power / points;
    }
    throw_if_refused(system);
    Torques torques = system.torques();
    const double unknown = solve_wheel_torque ? torques.wheel : torques.pinion;
    if (solve_wheel_torque) {
      torques.wheel = (torques.pinion - loss / speed) / ratio;
    } else {
      torques.pinion = ratio * torques.wheel + loss / speed;
    }
    system.set_torques(torques);
    change += std::abs((solve_wheel_torque ? torques.wheel : torques.pinion) - unknown);
    if (change <= 1e-14 * (std::abs(torques.pinion) + std::abs(torques.wheel))) break;
  }

  record.integrals = {};
  for (int i = 0; i < points; ++i) {
    solve_at(phase_of(i), i / 2, friction_torque[i]);
    system.derivative(state.data(), at, true, rate.data());
    for (int c = 0; c < kRecordComponents; ++c) record.integrals[c] += rate[c] / points;
    record.add_instant(at);
  }
  while (history.wanted_in_first_cycles(1)) {
    if (progress && !progress(1)) throw Cancelled();
    const double phase = history.next_phase();
    const int interval = std::min(static_cast<int>(phase * intervals), intervals - 1);
    double torque = friction_torque[2 * interval];
    for (int i = 0; i < 8; ++i) solve_at(phase, interval, torque);
    state[kTime] = phase * system.cycle_angle() / speed;
    history.add(phase, state.data(), at, system.torques().pinion);
  }
  history.repeat_first_cycles(1, system.cycle_angle() / speed);
  throw_if_refused(system);
  double torque = friction_torque[0];
  for (int i = 0; i < 8; ++i) solve_at(0, 0, torque);
  return {system.torques(), at.pinion_friction_torque, at.gear_friction_torque};
}

}  // namespace tribodyn
