#pragma once

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
  /// Friction on the response as it is, and the figures with it. False when refused.
  virtual bool evaluate_friction() = 0;
  /// The same at fewer places, good enough to begin with.
  virtual bool estimate_friction() { return evaluate_friction(); }
  /// Hands over what has become of the response, and the work.
  virtual void finish(MarchStatistics& statistics, long& marched_cycles) = 0;

 protected:
  /// Keeps the references. Sets the system's torques to the orbit's: nothing of what was tried
  /// before may show in a response.
  Shooting(GearPairSystem& system, OrbitFriction& friction, const MeshGrid& grid,
           const OrbitRequest& request, PeriodicOrbit& orbit);

  /// Lengths of a step of Newton's method, scaled.
  struct Step {
    double section;  ///< of the state at the section and of the torque
    double left;     ///< at most, anywhere, to the response
  };
  /// One step, with the derivatives at hand if there are any; NaN where that breaks down.
  virtual Step improve() = 0;

  void throw_if_interrupted() const;
  void add_to_unknown(double change);
  /// What follows from evaluated friction.
  void take_figures();
  int side() const { return system_.torques().pinion >= 0 ? 1 : -1; }

  GearPairSystem& system_;
  OrbitFriction& friction_;
  const MeshGrid& grid_;
  const OrbitRequest& request_;
  PeriodicOrbit& orbit_;
  MarchScales scales_;
  double mean_force_, period_time_;
  SectionMap::Vector scale_;
};

}  // namespace tribodyn
