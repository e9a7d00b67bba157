#include "core/integrate/mesh_cycle_march.h"

#include <algorithm>

namespace tribodyn {

MarchScales march_scales(const GearPairSystem& system, const Torques& torques,
                         double mean_pinion_speed) {
  const MeshData& mesh = system.mesh();
  const double r_p = mesh.mean_pinion_contact_radius(), r_g = mesh.mean_gear_contact_radius();
  const double ratio = r_p / r_g;
  MarchScales s{};
  s.torque = std::max({std::abs(torques.pinion), ratio * std::abs(torques.wheel), 0.1});
  s.length = s.torque / (r_p * mesh.mean_mesh_stiffness());
  s.speed = s.length * system.mesh_frequency() / r_p;
  s.loss_work = 0.01 * s.torque * system.cycle_angle();
  s.loss_squared = 1e-4 * s.torque * s.torque * system.cycle_angle() / mean_pinion_speed;
  s.time = s.length / (r_p * mean_pinion_speed);
  return s;
}

double MarchScales::of(const MeshData& mesh, int component) const {
  const double r_p = mesh.mean_pinion_contact_radius(), r_g = mesh.mean_gear_contact_radius();
  switch (component) {
    case kTime:
      return time;
    case kPinionShaftTwist:
      return length / r_p;
    case kMeshApproach:
      return length;
    case kGearShaftTwist:
      return length / r_g;
    case kPinionShaftSpeed:
    case kPinionSpeed:
      return speed;
    case kGearSpeed:
    case kWheelSpeed:
      return speed * r_p / r_g;
    case kLossWork:
    case kShaftDampingWork:
    case kMeshDampingWork:
    case kParametricWork:
      return loss_work;
    case kLossShareSquared:
      return loss_squared;
    default:
      return std::numeric_limits<double>::infinity();
  }
}

void throw_if_refused(ContactStatus status) {
  if (status == ContactStatus::kOk) return;
  throw Refusal(contact_status_name(status), contact_status_sentence(status));
}

void march_mesh_cycle(const GearPairSystem& system, const MarchScales& scales,
                      const MarchOptions& options, ContactSolver& contacts, SectionPoint& at,
                      SolverWork& work) {
  MeshCycleSystem<false> phases(system, at.torques, scales, at.regime, contacts);
  DormandPrinceWithEvents<MeshCycleSystem<false>> march(phases, options);
  at.state[kTime] = at.state[kLossWork] = at.state[kLossShareSquared] = 0;
  double phase = 0;
  march.run(phase, at.state, 1.0);
  at.regime = phases.regime();
  work += march.work();
  ++work.mesh_cycles;
}

}  // namespace tribodyn
