#pragma once

#include <optional>

#include "core/periodic/periodic_orbit.h"
#include "core/study/operating_target.h"
#include "core/study/point_result.h"

namespace tribodyn {

/// Figures of the loaded flanks over the steady state.
struct ContactSummary {
  double film_ratio_minimum;              ///< lambda_s [-]
  double film_ratio_mean;                 ///< weighted with load and time [-]
  double contact_temperature_maximum;     ///< T_c [K]
  double contact_temperature_mean;        ///< weighted with load and time [K]
  double viscous_loss_power;              ///< mean [W]
  double boundary_loss_power;             ///< mean [W]
  double friction_coefficient_mean;       ///< as PointResult::friction_coefficient [-]
  double pressure_maximum;                ///< p_max [Pa]
  double flash_temperature_rise_maximum;  ///< (dT_f)_av [K]
};

/// Returns nullopt if no flank carries a load.
std::optional<ContactSummary> contact_summary(const PointResult& result);

/// The same of an orbit whose contacts are solved, without the rest of its result: the same bits as
/// those of the orbit's PointResult, for a third of the time.
std::optional<ContactSummary> contact_summary(const PointProblem& problem,
                                              const PeriodicOrbit& orbit);

}  // namespace tribodyn
