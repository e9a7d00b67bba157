#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace tribodyn {

/// Coordinates of a loss map: vehicle speed [m/s], torque at the ring gear shaft [N m], temperature
/// of the sump [K].
using MapPlace = std::array<double, 3>;

/// A range of places in which a function is interpolated by a parabola in each coordinate (their
/// tensor product), through its values at both ends and in the middle. A coordinate whose ends are
/// equal takes no part.
struct MapBox {
  MapPlace low{}, high{};

  static constexpr std::size_t kMostNodes = 27;

  bool has_width(std::size_t d) const { return low[d] < high[d]; }
  /// Returns how many coordinates have a width.
  int dimensions() const;
  MapPlace centre() const;
  /// Returns all combinations of ends and middle, the first coordinate with a width running
  /// fastest.
  std::vector<MapPlace> nodes() const;
  /// Returns the weights of the nodes in the interpolation at a place; the rest are 0.
  std::array<double, kMostNodes> weights_at(const MapPlace& place) const;
  /// Returns by how much values at the nodes deviate in the middle from the mean of the ends, by
  /// coordinate: the largest over the lines of three nodes. NaN if a value is NaN.
  MapPlace deviations(const std::vector<double>& values) const;
  /// Returns the error of linear interpolation at a place, added up over the coordinates, where
  /// second derivatives are constant: 4 s (1 - s) times each deviation, s = 0 to 1 across the box.
  double linear_error(const MapPlace& deviations, const MapPlace& place) const;

 private:
  double share(std::size_t d, const MapPlace& place) const {
    return (place[d] - low[d]) / (high[d] - low[d]);
  }
};

}  // namespace tribodyn
