#include "core/integrate/order_weights.h"

#include <algorithm>
#include <cmath>

#include "core/integrate/mesh_cycle_march.h"
#include "core/numerics/square.h"

namespace tribodyn {
namespace {

constexpr double kNodesPerWave = 2.5;
constexpr double kCaution = 2;

double order_frequency(const GearPairSystem& system, double mean_pinion_speed) {
  return mean_pinion_speed * system.mesh().pinion_teeth();
}

/// The order to which one aliases under so many samples a cycle.
int alias(int order, int samples) {
  const int rest = order % samples;
  return std::min(rest, samples - rest);
}

}  // namespace

OrderWeights::OrderWeights(const GearPairSystem& system, const Torques& torques, double first)
    : orders_(system.mesh().orders()),
      stiffness_(system.mesh().mean_mesh_stiffness()),
      damping_(system.dynamics().mesh_damping),
      natural_(system.mesh_frequency()),
      first_(first) {
  // Under hardly any load the vibration itself is the scale.
  double largest = 0;
  for (const MeshOrder& order : orders_) largest = std::max(largest, order.displacement);
  const double torque = march_scales(system, torques, first / system.mesh().pinion_teeth()).torque;
  force_ = torque / system.mesh().mean_pinion_contact_radius() + stiffness_ * largest;
}

double OrderWeights::weight(int order) const {
  const MeshOrder& o = orders_[order - 1];
  return std::hypot(stiffness_, order * first_ * damping_) * o.displacement / force_ + o.stiffness +
         o.radius;
}

double OrderWeights::magnification(int order) const {
  const double ratio = order * first_ / natural_;
  const double damping_ratio = 0.5 * damping_ * natural_ / stiffness_;
  return std::max(1.0, 1 / std::hypot(1 - square(ratio), 2 * damping_ratio * ratio));
}

double unresolved_error(const GearPairSystem& system, const Torques& torques,
                        double mean_pinion_speed, int steps) {
  const int resolved = static_cast<int>(2 * steps / kNodesPerWave);
  if (resolved >= static_cast<int>(system.mesh().orders().size())) return 0;
  const OrderWeights weights(system, torques, order_frequency(system, mean_pinion_speed));
  double squares = 0;
  for (int order = resolved + 1; order <= weights.highest(); ++order) {
    // Runge-Kutta weights starts and middles 1 to 2: a third of what starts alone would alias.
    const int by_nodes = alias(order, 2 * steps), by_starts = alias(order, steps);
    const double magnified = std::max(by_nodes > 0 ? weights.magnification(by_nodes) : 1,
                                      (by_starts > 0 ? weights.magnification(by_starts) : 1) / 3);
    squares += square(weights.weight(order) * magnified);
  }
  return kCaution * std::sqrt(squares);
}

int resolving_steps(const GearPairSystem& system, const Torques& torques, double mean_pinion_speed,
                    double error) {
  const OrderWeights weights(system, torques, order_frequency(system, mean_pinion_speed));
  int order = weights.highest();
  for (double squares = 0; order > 0; --order) {
    squares += square(weights.weight(order));
    if (kCaution * std::sqrt(squares) > error) break;
  }
  return static_cast<int>(std::ceil(0.5 * kNodesPerWave * order));
}

double weight_beyond(const GearPairSystem& system, const Torques& torques, double mean_pinion_speed,
                     int order) {
  const OrderWeights weights(system, torques, order_frequency(system, mean_pinion_speed));
  double squares = 0;
  for (int h = order + 1; h <= weights.highest(); ++h) {
    squares += square(weights.weight(h) * weights.magnification(h));
  }
  return kCaution * std::sqrt(squares);
}

double resonant_weight(const GearPairSystem& system, const Torques& torques,
                       double mean_pinion_speed) {
  constexpr double kNearResonance = 3;  // magnification
  const OrderWeights weights(system, torques, order_frequency(system, mean_pinion_speed));
  double out = 0;
  for (int order = 1; order <= weights.highest(); ++order) {
    const double magnified = weights.magnification(order);
    if (magnified >= kNearResonance) out = std::max(out, magnified * weights.weight(order));
  }
  return out;
}

}  // namespace tribodyn
