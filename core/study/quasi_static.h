#pragma once

#include <functional>

#include "core/dynamics/gear_pair_system.h"
#include "core/study/history_sampler.h"
#include "core/study/response_record.h"

namespace tribodyn {

/// The cheap sibling of the march: constant speeds, xdot = 0, and at each mesh phase the load at
/// which the pinion is in equilibrium, R_p F = T_s + T_fr,p(F). The unknown torque follows from the
/// mean power. Two Gauss points in each interval of the tables (the integrand has kinks at their
/// ends). Sets the system's torques; fills `record` for one mesh cycle.
/// Throws a contact's refusal by name, and Cancelled when `progress` returns false.
struct QuasiStatic {
  Torques torques;
  double pinion_friction_torque;  ///< at mesh phase 0 [N m]
  double gear_friction_torque;
};
QuasiStatic solve_quasi_static(GearPairSystem& system, double mean_pinion_speed,
                               bool solve_wheel_torque, ResponseRecord& record,
                               HistorySampler& history,
                               const std::function<bool(double)>& progress);

}  // namespace tribodyn
