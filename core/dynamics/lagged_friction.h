#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace tribodyn {

/// Friction torques per newton of load [m]: what eqs 2 and 3 need of the contacts at one phase.
struct FrictionPerLoad {
  double pinion = 0;
  double gear = 0;
};

/// Friction of a whole response, frozen in proportion to the load. Friction goes nearly like the
/// load, so the dynamics under it are off by little, and by less each time it is evaluated anew on
/// the response that follows. Between its phases a straight line.
class LaggedFriction {
 public:
  /// Empty, with room for as many phases.
  void clear(std::size_t room) {
    nodes_.clear();
    nodes_.reserve(room);
    cursor_ = 0;
  }
  /// Phases [cycles] must not fall. load [N]: there, on all flanks.
  void add(double phase, const FrictionPerLoad& value, double load) {
    if (!nodes_.empty()) {
      const double width = phase - nodes_.back().phase;
      nodes_.back().per_width = width > 0 ? 1 / width : 0;
    }
    nodes_.push_back({phase, 0, load, value});
  }
  /// The last value added, or none.
  FrictionPerLoad last() const { return nodes_.empty() ? FrictionPerLoad{} : nodes_.back().value; }

  /// Fast where phases follow each other.
  FrictionPerLoad at(double phase) {
    if (nodes_.size() < 2) return last();
    while (cursor_ > 0 && nodes_[cursor_].phase > phase) --cursor_;
    while (cursor_ + 2 < nodes_.size() && nodes_[cursor_ + 1].phase <= phase) ++cursor_;
    const Node& from = nodes_[cursor_];
    const double t = std::clamp((phase - from.phase) * from.per_width, 0.0, 1.0);
    const FrictionPerLoad &a = from.value, &b = nodes_[cursor_ + 1].value;
    return {a.pinion + t * (b.pinion - a.pinion), a.gear + t * (b.gear - a.gear)};
  }

  /// The same, at once where value number i is at that phase.
  FrictionPerLoad at(double phase, std::size_t i) {
    return i < nodes_.size() && nodes_[i].phase == phase ? nodes_[i].value : at(phase);
  }

  /// How far it is from another one: root of the mean square of the torques that they make of the
  /// loads at its own phases, relative.
  double distance(LaggedFriction& other) const {
    double change = 0, size = 0;
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      const Node& node = nodes_[i];
      const FrictionPerLoad there = other.at(node.phase, i);
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
    FrictionPerLoad value;
  };
  std::vector<Node> nodes_;
  std::size_t cursor_ = 0;
};

}  // namespace tribodyn
