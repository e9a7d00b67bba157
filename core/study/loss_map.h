#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "core/study/map_box.h"

namespace tribodyn {

/// A place at which a map is read, and the distance [m] driven there.
struct MapReading {
  MapPlace place;
  double distance;
};

/// How long the response of a place is searched for.
enum class LossEffort {
  kQuasiStatic,  ///< not at all: by the quasi-static model, whatever its error
  kBrief,        ///< unless it takes more than some tens of mesh cycles to find
  kThorough,     ///< as long as it takes, e.g. by marching a rattle: a thousand times as long
};

/// Mesh loss power over vehicle speed.
struct LossForce {
  double value;         ///< [N]
  double solver_error;  ///< estimated [N]; NaN: not known
};

/// Returns the loss force at each place; no torque is 0. nullopt: not found by LossEffort::kBrief.
using LossForces =
    std::function<std::vector<std::optional<LossForce>>(const std::vector<MapPlace>&, LossEffort)>;

struct LossMapOptions {
  double tolerance = 2e-3;         ///< wanted error of the sum of losses over that sum
  int most_points = 20000;         ///< of the model; the first boxes may take more
  bool is_point_by_point = false;  ///< solves every place thoroughly instead of making a map
};

/// The losses of one fluid at the readings.
struct MappedLoss {
  std::vector<double> forces;  ///< by reading [N]
  double energy = 0;           ///< sum over the readings [J]; NaN if a force is NaN
  /// Estimated error of the energy by interpolation and by places whose response was not found [J].
  /// 0: every place was solved.
  double map_error = 0;
  double solver_error = 0;  ///< of the energy, as estimated place by place [J]; NaN: not known
  int points = 0;           ///< places at which the model was solved
};

/// Maps the loss of one fluid for the readings of a drive cycle:
///  1. Readings at few places, compared with those of the first boxes, are solved themselves.
///  2. Otherwise the box around the readings is cut at torque 0, where the loss is 0 and has a
///     kink, and at the ends of the light torques (5), then into boxes. A coordinate that all
///     readings share is not divided. In each box the loss force is a parabola in each coordinate
///     (their tensor product), through its values at both ends and in the middle.
///  3. The error at a reading counts as half of that of linear interpolation where second
///     derivatives are constant: the sum over the coordinates of
///     2 s (1 - s) |f(middle) - (f(low) + f(high))/2|, s = 0 to 1 across the box, the largest over
///     the lines of nodes. A heuristic bound: over losses with humps, kinks and jumps narrower than
///     the first boxes, errors of the energy are at most 0.4 of it.
///  4. Boxes are halved in the coordinate that deviates most from a line, those with the largest
///     errors first, until the errors of all readings, added without regard to sign, are within the
///     tolerance. Where the readings of a box are fewer than the nodes that halves would add, they
///     are solved themselves: a map takes at most about twice the points of its readings' places.
///  5. Under light torques flanks may rattle: to find that response takes a thousand times as long
///     as others, and it loses next to nothing. Torques are light up to the one at which all
///     lighter readings together would lose a share of the tolerance. There the quasi-static model
///     answers, and its whole loss counts as error: rattles lose 0.6 to 1.7 times as much
///     (reference axle, WLTC). So it does wherever a response is not found briefly, and once that
///     has happened often, wherever the nearest place that was searched is one of these.
///  6. If the error is then above the tolerance and thorough searches at a few places bring it
///     within, these are made.
/// Throws what `loss_forces` throws; a Refusal of a thorough search only if is_point_by_point.
MappedLoss map_losses(const std::vector<MapReading>& readings, const LossForces& loss_forces,
                      const LossMapOptions& options = {});

}  // namespace tribodyn
