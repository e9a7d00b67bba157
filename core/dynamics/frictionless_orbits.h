#pragma once

#include <array>
#include <map>
#include <optional>

#include "core/dynamics/periodic_orbit.h"

namespace tribodyn {

/// Responses without friction that have been found before, for the lubricants that come after. An
/// entry depends on gear set, load, speed and start alone: a response is the same bits from here
/// and found anew. Of one gear set, driveline and its options; one thread at a time; bounded.
class FrictionlessOrbits {
 public:
  /// The response from `origin` on a grid of `steps`, by `approach` where it is new: that solves
  /// for it, in `orbit`, and returns whether it converged. False where it does not.
  template <class Approach>
  bool find(int steps, const OrbitRequest& request, const PeriodicOrbit& origin,
            Approach&& approach, PeriodicOrbit& orbit) {
    const Key where = key(steps, request, origin);
    if (const auto known = orbits_.find(where); known != orbits_.end()) {
      if (known->second) orbit = *known->second;
      return known->second.has_value();
    }
    const bool converged = approach();
    if (orbits_.size() >= kMost) orbits_.clear();
    orbits_.emplace(where, converged ? std::optional(orbit) : std::nullopt);
    return converged;
  }

 private:
  static constexpr std::size_t kMost = 500;
  using Key = std::array<double, 8 + kMarchComponents>;
  static Key key(int steps, const OrbitRequest& request, const PeriodicOrbit& origin);

  std::map<Key, std::optional<PeriodicOrbit>> orbits_;
};

}  // namespace tribodyn
