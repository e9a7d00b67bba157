#include "core/study/point_start.h"

#include <cmath>

#include "core/integrate/mesh_cycle_march.h"
#include "core/periodic/steady_state.h"
#include "core/reduced/quasi_static.h"

namespace tribodyn {

MarchState point_start(const PointProblem& problem, PointStart start) {
  GearPairSystem& system = problem.system;
  const OperatingTarget& target = problem.target;
  const double offset = start == PointStart::kLargeVibration ? kLargeVibrationDeflection : 0;
  constexpr double kTolerance = 1e-3;
  FrictionArms friction;
  if (auto found = solve_quasi_static(problem.periodic(kTolerance))) {
    friction = found->friction.at(0);
  } else {
    throw_if_refused(system);
    system.set_torques(target.torques);
  }
  const double load =
      std::abs(system.torques().pinion) / system.mesh().functions(0, 0).pinion_contact_radius;
  // Under hardly any load friction may be anything: a start needs none.
  if (!(std::abs(friction.pinion) * load < 0.5 * std::abs(system.torques().pinion))) friction = {};
  return static_start(system, target.mean_pinion_speed, friction.pinion * load,
                      friction.gear * load, offset);
}

MarchState carried_start(const GearPairSystem& system, const CarriedState& from,
                         double mean_pinion_speed) {
  const MeshData& mesh = system.mesh();
  const DrivelineDynamics& d = system.dynamics();
  const double ratio = mesh.mean_pinion_contact_radius() / mesh.mean_gear_contact_radius();
  SectionState section = from.section_state;
  const double pinion = system.torques().pinion - from.pinion_torque;
  const double wheel = system.torques().wheel - from.wheel_torque;
  section.pinion_shaft_twist += pinion / d.pinion_shaft_stiffness;
  section.gear_shaft_twist += wheel / d.gear_shaft_stiffness;
  section.mesh_deflection +=
      pinion / (mesh.mean_pinion_contact_radius() * mesh.mean_mesh_stiffness());
  const double speed = mean_pinion_speed - from.mean_pinion_speed;
  section.pinion_shaft_speed += speed;
  section.pinion_speed += speed;
  section.gear_speed += ratio * speed;
  section.wheel_speed += ratio * speed;
  MarchState state{};
  system.to_march(section, state.data());
  return state;
}

}  // namespace tribodyn
