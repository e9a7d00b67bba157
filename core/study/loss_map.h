#pragma once

#include <array>
#include <functional>
#include <map>
#include <vector>

namespace tribodyn {

/// Coordinates of a loss map: vehicle speed [m/s], torque at the ring gear shaft [N m], temperature
/// of the sump [K].
using MapPlace = std::array<double, 3>;

/// Returns the loss force [N], mesh loss power over vehicle speed, at each place; no torque is 0.
using LossForces = std::function<std::vector<double>(const std::vector<MapPlace>&)>;

/// A place at which a map is read, and the distance [m] driven there.
struct MapReading {
  MapPlace place;
  double distance;
};

struct LossMapOptions {
  double tolerance = 2e-3;  ///< wanted error of the sum of losses over that sum
  int most_points = 20000;  ///< of the model
};

/// An adaptive map of the loss of one fluid, made for readings: a drive cycle.
///
/// The box around the readings is cut at torque 0, where the loss is 0 and has a kink, then into
/// boxes in which the loss force is linear in each coordinate. The error of a box is the sum over
/// the coordinates of |f(centre) - (f(-) + f(+))/2|, where f(-), f(+) are the centres of the faces:
/// the largest error of the interpolation where the second derivatives are constant. Boxes are
/// halved in the coordinate with the largest term, those with most error times distance first,
/// until the errors of all readings, added without regard to sign, are within the tolerance. A
/// coordinate that all readings share is not divided. In a box with few readings, unless it
/// reaches torque 0, these are solved themselves, which takes less than its corners and has no
/// error: so a jagged cycle costs little more than its pieces.
class LossMap {
 public:
  /// Throws what `loss_forces` throws.
  LossMap(const std::vector<MapReading>& readings, const LossForces& loss_forces,
          const LossMapOptions& options = {});

  /// Returns the loss force [N] at a reading.
  double at(std::size_t reading) const { return values_[reading]; }
  /// Returns the sum of losses over all readings [J]; NaN if a loss force is NaN.
  double energy() const { return energy_; }
  /// Returns the estimated error of energy() [J].
  double estimated_error() const { return error_; }
  /// Returns how many points of the model the map took.
  int points() const { return static_cast<int>(forces_.size()); }

 private:
  struct Box {
    MapPlace low, high;
    std::vector<std::size_t> readings;
    MapPlace terms{};        ///< of the error, by coordinate
    bool is_solved = false;  ///< at its readings themselves
    double error() const { return terms[0] + terms[1] + terms[2]; }
  };

  std::vector<MapPlace> corners_of(const Box& box) const;
  static MapPlace centre_of(const Box& box);
  std::vector<MapPlace> places_of(const Box& box, const std::vector<MapReading>& readings) const;
  void evaluate(std::vector<Box>& boxes, const std::vector<MapReading>& readings,
                const LossForces& loss_forces);
  void set_terms(Box& box) const;
  double interpolated(const Box& box, const MapPlace& place) const;
  void sum(const std::vector<Box>& boxes, const std::vector<MapReading>& readings);

  std::map<MapPlace, double> forces_;
  std::array<bool, 3> is_divided_{};
  std::vector<double> values_;
  double energy_ = 0, error_ = 0;
};

}  // namespace tribodyn
