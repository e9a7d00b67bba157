#pragma once

#include "core/driveline/gear_pair_system.h"
#include "core/periodic/periodic_problem.h"
#include "core/study/point_options.h"
#include "core/study/point_result.h"
#include "core/study/prepared_scene.h"

namespace tribodyn {

/// Speed and torques that an operating condition fixes; the unknown torque without friction.
struct OperatingTarget {
  double mean_pinion_speed;  ///< [rad/s]
  double vehicle_speed;      ///< [m/s]
  Torques torques;
  bool solve_wheel_torque;  ///< T_w is the unknown instead of T_s
};

/// Throws Refusal NO_FORWARD_ROTATION.
OperatingTarget target_of(const Scene& scene, const OperatingCondition& condition);

/// One operating point, as each way of solving it takes it.
struct PointProblem {
  const FlankContactBatch& contacts;
  PreparedGearSet& gear_set;
  const OperatingTarget& target;
  const PointOptions& options;
  ContactTally& tally;

  const GearPairSystem& system() const { return gear_set.system(); }
  /// Its periodic response, to a tolerance. The options must outlive it.
  PeriodicProblem periodic(double tolerance) const;
};

/// A result with the speeds of the target, all else empty.
PointResult empty_result(const OperatingTarget& target, PointModel model);

/// An estimate as results hold it: absent if it is infinite.
std::optional<double> known_error(double estimate);

}  // namespace tribodyn
