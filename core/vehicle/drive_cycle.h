#pragma once

#include <string>
#include <vector>

#include "core/vehicle/vehicle.h"

namespace tribodyn {

/// Speed below which a vehicle counts as standing [m/s]: 0.1 km/h, the least speed of a point.
inline constexpr double kStandstillSpeed = 0.1 / 3.6;

/// A place of a drive cycle. Speed and temperature are linear in time between two places.
struct CyclePlace {
  double time;                  ///< from the start [s]
  double speed;                 ///< of the vehicle, from 0 [m/s]
  double ascent_angle = 0;      ///< of the road, up to the next place [rad]
  double sump_temperature = 0;  ///< [K]
};

/// Speed over time, in ascending order of time.
struct DriveCycle {
  std::string name;
  std::vector<CyclePlace> places;
};

/// A time during which acceleration and slope are constant, and speed and temperature count as
/// constant: a quasi-steady operating point.
struct CyclePiece {
  double start;             ///< [s]
  double duration;          ///< [s]
  double speed;             ///< mean [m/s]; 0 at standstill
  double acceleration;      ///< [m/s2]
  double ascent_angle;      ///< [rad]
  double sump_temperature;  ///< mean [K]
};

/// Returns the pieces between consecutive places, those longer than `longest` [s] cut into equal
/// parts. Throws Refusal PARAMETER_OUT_OF_RANGE, naming the place (from 1), if there are less than
/// two places, time does not rise, a number is not finite, a speed is negative, or there are more
/// than 1,000,000 pieces.
std::vector<CyclePiece> pieces_of(const DriveCycle& cycle, double longest = 1);

/// The New European Driving Cycle: four times the urban part of 195 s and once the extra-urban part
/// of 400 s (UN Regulation 83, type I test): 1180 s, 11.03 km. Standstill is what its operations
/// call idling: 60 s of each urban and 40 s of the extra-urban part, 280 s in all; decelerations
/// with the clutch disengaged count as driving.
DriveCycle nedc();

}  // namespace tribodyn
