#include "core/periodic/period_correction.h"

namespace tribodyn {
namespace {

/// Of the wheel's side over the pinion's: speeds, and torques the other way round.
double ratio_of(const GearPairSystem& system) {
  const MeshData& mesh = system.mesh();
  return mesh.mean_pinion_contact_radius() / mesh.mean_gear_contact_radius();
}

}  // namespace

double accelerating_torque(const GearPairSystem& system, const MarchState& before,
                           const MarchState& after) {
  const DrivelineDynamics& d = system.dynamics();
  const double ratio = ratio_of(system);
  // As the pinion feels it.
  const auto momentum = [&](const MarchState& y) {
    return d.pinion_shaft_inertia * y[kPinionShaftSpeed] + d.pinion_inertia * y[kPinionSpeed] +
           ratio * (d.gear_inertia * y[kGearSpeed] + d.wheel_inertia * y[kWheelSpeed]);
  };
  return (momentum(after) - momentum(before)) / after[kTime];
}

void lower_torque(const GearPairSystem& system, double by, bool solve_wheel_torque,
                  Torques& torques, MarchState& state) {
  const DrivelineDynamics& d = system.dynamics();
  const MeshData& mesh = system.mesh();
  if (solve_wheel_torque) {
    const double ratio = ratio_of(system);
    torques.wheel += by / ratio;
    state[kGearShaftTwist] += by / ratio / d.gear_shaft_stiffness;
  } else {
    torques.pinion -= by;
    state[kPinionShaftTwist] -= by / d.pinion_shaft_stiffness;
    state[kMeshApproach] -= by / (mesh.mean_pinion_contact_radius() * mesh.mean_mesh_stiffness());
  }
}

void restore_mean_speed(const GearPairSystem& system, int mesh_cycles, double mean_pinion_speed,
                        MarchState& state) {
  const double ratio = ratio_of(system);
  const double shift = mean_pinion_speed - mesh_cycles * system.cycle_angle() / state[kTime];
  state[kPinionSpeed] += shift;
  state[kGearSpeed] += ratio * shift;
  state[kPinionShaftSpeed] += shift;
  state[kWheelSpeed] += ratio * shift;
}

void correct_period(const GearPairSystem& system, const MarchState& before, int period,
                    double mean_pinion_speed, bool solve_wheel_torque, Torques& torques,
                    MarchState& after) {
  lower_torque(system, accelerating_torque(system, before, after), solve_wheel_torque, torques,
               after);
  restore_mean_speed(system, period, mean_pinion_speed, after);
}

}  // namespace tribodyn
