#pragma once

#include <Eigen/Core>
#include <array>

#include "core/driveline/motion.h"
#include "core/numerics/instruction_set.h"

namespace tribodyn {

/// Derivatives of time and the seven states, in the order of MarchComponent, by the seven states at
/// the section and by the unknown torque.
using Sensitivity = std::array<Eigen::Array<double, 1, 8>, 8>;

/// Derivatives of the rates of the shafts' speeds by the unknown torque [1/(kg m2)].
struct TorqueSlopes {
  double pinion_shaft = 0, wheel = 0;
};

/// Integrates the variational equations over one classical Runge-Kutta step of `length` [cycles].
void advance_sensitivity(InstructionSet instruction_set, const MotionConstants& constants,
                         const TorqueSlopes& by_torque, const std::array<MotionSlopes, 4>& stages,
                         double length, Sensitivity& sensitivity);

}  // namespace tribodyn
