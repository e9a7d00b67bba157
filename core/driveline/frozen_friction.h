#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace tribodyn {

/// Friction torques per newton of load [m]: what eqs 2 and 3 need of the contacts at one phase.
struct FrictionArms {
  double pinion = 0;
  double gear = 0;
};

/// Friction along an orbit, frozen in proportion to the load: friction torque = arm times load, the
/// arm a piecewise linear function of mesh phase. Friction is nearly proportional to the load, so
/// the motion under frozen friction has a small error, and the Picard iteration (solve for the
/// motion, evaluate the friction on it, freeze that) contracts quickly.
class FrozenFriction {
 public:
  /// Empty, with room for as many phases.
  void clear(std::size_t room) {
    nodes_.clear();
    nodes_.reserve(room);
    cursor_ = 0;
  }
  /// Phases [cycles] must not fall. load [N]: there, on all flanks.
  void add(double phase, const FrictionArms& value, double load) {
    if (!nodes_.empty()) {
      const double width = phase - nodes_.back().phase;
      nodes_.back().per_width = width > 0 ? 1 / width : 0;
    }
    nodes_.push_back({phase, 0, load, value});
  }
  /// The same for phases that are all 1/`per_width` apart.
  void add_evenly(double phase, const FrictionArms& value, double load, double per_width) {
    nodes_.push_back({phase, per_width, load, value});
  }
  /// The last value added; zero arms if there is none.
  FrictionArms last() const { return nodes_.empty() ? FrictionArms{} : nodes_.back().value; }

  /// The arms at a phase. Successive calls are fast if their phases are near each other.
  FrictionArms at(double phase) {
    if (nodes_.size() < 2) return last();
    while (cursor_ > 0 && nodes_[cursor_].phase > phase) --cursor_;
    while (cursor_ + 2 < nodes_.size() && nodes_[cursor_ + 1].phase <= phase) ++cursor_;
    const Node& from = nodes_[cursor_];
    const double t = std::clamp((phase - from.phase) * from.per_width, 0.0, 1.0);
    const FrictionArms &a = from.value, &b = nodes_[cursor_ + 1].value;
    return {a.pinion + t * (b.pinion - a.pinion), a.gear + t * (b.gear - a.gear)};
  }

  /// The same; takes constant time if value number i is at that phase.
  FrictionArms at(double phase, std::size_t i) {
    return i < nodes_.size() && nodes_[i].phase == phase ? nodes_[i].value : at(phase);
  }

  /// Relative distance from another friction: root mean square of the difference of their torques
  /// under the loads at the phases of this one.
  double distance(FrozenFriction& other) const {
    double change = 0, size = 0;
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      const Node& node = nodes_[i];
      const FrictionArms there = other.at(node.phase, i);
      const double pinion = node.value.pinion - there.pinion, gear = node.value.gear - there.gear;
      const double weight = node.load * node.load;
      change += weight * (pinion * pinion + gear * gear);
      size += weight * (node.value.pinion * node.value.pinion + node.value.gear * node.value.gear);
    }
    return size > 0 ? std::sqrt(change / size) : 0;
  }

 private:
  struct Node {
    double phase;
    double per_width;  ///< of the way to the next
    double load;       ///< [N]
    FrictionArms value;
  };
  std::vector<Node> nodes_;
  std::size_t cursor_ = 0;
};

}  // namespace tribodyn
