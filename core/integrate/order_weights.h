#pragma once

#include "core/driveline/gear_pair_system.h"

namespace tribodyn {

// What single orders of the mesh can do to the response, from their amplitudes:
//  1. Rotors do not follow a high order, so its displacement d_h becomes a force of
//     |k + i h Omega c| d_h; the ripple of stiffness and radii acts on the mean force.
//  2. Relative to the mean force this is its weight. The resonance of the mesh magnifies it.

/// The weights of orders at an operating point, the mesh taken as one oscillator.
class OrderWeights {
 public:
  /// `first`: the frequency of order 1 [rad/s]. Keeps the reference.
  OrderWeights(const GearPairSystem& system, const Torques& torques, double first);

  /// Orders are 1 ... highest().
  int highest() const { return static_cast<int>(orders_.size()); }
  double weight(int order) const;
  /// At least 1.
  double magnification(int order) const;

 private:
  const std::vector<MeshOrder>& orders_;
  double stiffness_, damping_, natural_, first_, force_;
};

// Even steps evaluate the mesh functions at their starts and middles. An order with fewer than 2.5
// of these nodes a wave is not resolved: it aliases to a lower order, on a finer grid perhaps to
// the same one, so that two grids agree on a wrong answer. What it can do is bounded by its weight,
// magnified as the order that it aliases to; several add up as twice the root of their squares.
// (A. V. Oppenheim and R. W. Schafer, Discrete-Time Signal Processing, 3rd ed., 2010, section 4.2.)

/// Bound of the relative error of an orbit's figures by orders that `steps` a mesh cycle do not
/// resolve; 0 if they resolve all.
double unresolved_error(const GearPairSystem& system, const Torques& torques,
                        double mean_pinion_speed, int steps);

/// The fewest steps a mesh cycle for which unresolved_error() is at most `error`, but for the
/// magnification.
int resolving_steps(const GearPairSystem& system, const Torques& torques, double mean_pinion_speed,
                    double error);

/// Bound of what the orders above one add to the response by inertia, relative to it: their weights,
/// magnified; several add up as twice the root of their squares.
double weight_beyond(const GearPairSystem& system, const Torques& torques, double mean_pinion_speed,
                     int order);

/// The largest weight that resonance magnifies threefold or more, magnified; 0: none is.
double resonant_weight(const GearPairSystem& system, const Torques& torques,
                       double mean_pinion_speed);

}  // namespace tribodyn
