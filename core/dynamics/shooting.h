#pragma once

#include <cmath>

#include "core/dynamics/periodic_orbit.h"

namespace tribodyn {

/// Newton's method on a periodic response under lagged friction: what all its forms share.
class Shooting {
 public:
  Shooting(const Shooting&) = delete;
  Shooting& operator=(const Shooting&) = delete;
  virtual ~Shooting() = default;

  /// Improves until a step is shorter than `enough`, with derivatives from elsewhere while they
  /// serve.
  bool converge(double enough);
  enum class Places { kAll, kFew };
  /// Friction on the response as it is, at fewer places where that will do, and the figures with
  /// it. False when refused.
  bool evaluate_friction(Places places = Places::kAll);
  /// Hands over what has become of the response, and the work.
  virtual void finish(MarchStatistics& statistics, long& marched_cycles) = 0;

 protected:
  static constexpr int kUnknowns = SectionMap::kUnknowns;
  /// The floor of the scales, 0.1 N m, is five times this force [N].
  static constexpr double kLightForce = 1;

  /// Keeps the references. Sets the system's torques to the orbit's: nothing of what was tried
  /// before may show in a response.
  Shooting(GearPairSystem& system, OrbitFriction& friction, const MeshGrid& grid,
           const OrbitRequest& request, PeriodicOrbit& orbit);

  /// One step of Newton's method, with the derivatives at hand if there are any. Returns how far it
  /// may be to the response, scaled: the step's length or less; NaN where that breaks down.
  virtual double improve() = 0;

  /// Friction and figures but the torque, and whether contact is lost.
  virtual bool evaluate(Places places) = 0;

  void throw_if_interrupted() const;
  void add_to_unknown(double change);
  /// Under less load the friction per newton is held constant [N]. Of the torque itself, not of the
  /// scales, which have a floor.
  double light_load() const {
    const double of_torque =
        std::abs(orbit_.torques.pinion) / system_.mesh().mean_pinion_contact_radius();
    return 1e-3 * (of_torque < kLightForce ? of_torque : mean_force_);
  }
  int side() const { return system_.torques().pinion >= 0 ? 1 : -1; }

  GearPairSystem& system_;
  OrbitFriction& friction_;
  const MeshGrid& grid_;
  const OrbitRequest& request_;
  PeriodicOrbit& orbit_;
  MarchScales scales_;
  double mean_force_, period_time_;
  SectionMap::Vector scale_;
  LaggedFriction friction_before_;
};

}  // namespace tribodyn
