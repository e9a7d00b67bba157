#pragma once

#include <Eigen/Core>
#include <array>

#include "core/numerics/instruction_set.h"

namespace tribodyn {

/// Derivatives of time and the seven states, in the order of MarchComponent, by the seven states at
/// the section and by the unknown torque.
using Sensitivity = std::array<Eigen::Array<double, 1, 8>, 8>;

/// What the variational equations need of the driveline. SI units.
struct SensitivityConstants {
  double pinion_shaft_stiffness, pinion_shaft_damping, gear_shaft_stiffness, gear_shaft_damping;
  double per_pinion_shaft_inertia, per_pinion_inertia, per_gear_inertia, per_wheel_inertia;
  double pinion_radius, gear_radius;  ///< R_p0, R_g0
  /// Derivatives of the rates of the speeds by the unknown torque [1/(kg m2)].
  double pinion_shaft_per_torque, wheel_per_torque;
};

/// The quantities that the variational equations need of one stage of a Runge-Kutta step.
struct SensitivityStage {
  double relative_radius, gear_radius;  ///< R_p - e', R_g [m]
  double stiffness, damping;            ///< of the mesh force; 0 across a gap
  double pinion_arm, gear_arm;          ///< what a mesh force turns, friction included [m]
  double torque_per_approach;           ///< on the pinion, besides the mesh force's [N]
  double time, per_speed;               ///< of a mesh cycle at that speed [s]; 1/speed
  std::array<double, 8> rate;           ///< of time and the seven states by phase
};

/// Integrates the variational equations over one classical Runge-Kutta step of `length` [cycles].
void advance_sensitivity(InstructionSet instruction_set, const SensitivityConstants& constants,
                         const std::array<SensitivityStage, 4>& stages, double length,
                         Sensitivity& sensitivity);

}  // namespace tribodyn
