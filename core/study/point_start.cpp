#include "core/study/point_start.h"

#include <cmath>

#include "core/integrate/mesh_cycle_march.h"
#include "core/periodic/steady_state.h"
#include "core/reduced/quasi_static.h"

namespace tribodyn {

std::optional<CarriedState> loud_response(const PointProblem& problem) {
  return problem.gear_set.other_responses().loud(problem.periodic(problem.options.tolerance));
}

SectionPoint point_start(const PointProblem& problem, PointStart start) {
  const GearPairSystem& system = problem.system();
  if (start == PointStart::kLargeVibration) {
    if (const auto loud = loud_response(problem)) {
      return system.at_section(carried_start(system, *loud, problem.target),
                               problem.target.torques);
    }
  }
  const double offset = start == PointStart::kLargeVibration ? kLargeVibrationDeflection : 0;
  constexpr double kTolerance = 1e-3;
  FrictionArms friction;
  Torques torques = problem.target.torques;
  if (auto found = solve_quasi_static(problem.periodic(kTolerance))) {
    friction = found->friction.at(0);
    torques = found->torques;
  } else {
    throw_if_refused(problem.tally.refusal);
  }
  const double load =
      std::abs(torques.pinion) / system.mesh().functions(0, 0).pinion_contact_radius;
  // Under hardly any load friction may be anything: a start needs none.
  if (!(std::abs(friction.pinion) * load < 0.5 * std::abs(torques.pinion))) friction = {};
  return system.at_section(static_start(system, torques, problem.target.mean_pinion_speed,
                                        friction.pinion * load, friction.gear * load, offset),
                           torques);
}

MarchState carried_start(const GearPairSystem& system, const CarriedState& from,
                         const OperatingTarget& target) {
  const MeshData& mesh = system.mesh();
  const DrivelineDynamics& d = system.dynamics();
  const double ratio = mesh.mean_pinion_contact_radius() / mesh.mean_gear_contact_radius();
  SectionState section = from.section_state;
  const double pinion = target.torques.pinion - from.pinion_torque;
  const double wheel = target.torques.wheel - from.wheel_torque;
  section.pinion_shaft_twist += pinion / d.pinion_shaft_stiffness;
  section.gear_shaft_twist += wheel / d.gear_shaft_stiffness;
  section.mesh_deflection +=
      pinion / (mesh.mean_pinion_contact_radius() * mesh.mean_mesh_stiffness());
  const double speed = target.mean_pinion_speed - from.mean_pinion_speed;
  section.pinion_shaft_speed += speed;
  section.pinion_speed += speed;
  section.gear_speed += ratio * speed;
  section.wheel_speed += ratio * speed;
  MarchState state{};
  system.to_march(section, state.data());
  return state;
}

}  // namespace tribodyn
