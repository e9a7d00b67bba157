#include "core/periodic/period_correction.h"

namespace tribodyn {

void correct_period(const GearPairSystem& system, const MarchState& before, int period,
                    double mean_pinion_speed, bool solve_wheel_torque, Torques& torques,
                    MarchState& after) {
  const DrivelineDynamics& d = system.dynamics();
  const MeshData& mesh = system.mesh();
  const double ratio = mesh.mean_pinion_contact_radius() / mesh.mean_gear_contact_radius();
  // As the pinion feels it.
  const auto momentum = [&](const MarchState& y) {
    return d.pinion_shaft_inertia * y[kPinionShaftSpeed] + d.pinion_inertia * y[kPinionSpeed] +
           ratio * (d.gear_inertia * y[kGearSpeed] + d.wheel_inertia * y[kWheelSpeed]);
  };
  const double excess = (momentum(after) - momentum(before)) / after[kTime];
  if (solve_wheel_torque) {
    torques.wheel += excess / ratio;
    after[kGearShaftTwist] += excess / ratio / d.gear_shaft_stiffness;
  } else {
    torques.pinion -= excess;
    after[kPinionShaftTwist] -= excess / d.pinion_shaft_stiffness;
    after[kMeshApproach] -=
        excess / (mesh.mean_pinion_contact_radius() * mesh.mean_mesh_stiffness());
  }
  const double shift = mean_pinion_speed - period * system.cycle_angle() / after[kTime];
  after[kPinionSpeed] += shift;
  after[kGearSpeed] += ratio * shift;
  after[kPinionShaftSpeed] += shift;
  after[kWheelSpeed] += ratio * shift;
}

}  // namespace tribodyn
