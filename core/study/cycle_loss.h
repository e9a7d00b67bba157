#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/study/loss_map.h"
#include "core/vehicle/drive_cycle.h"
#include "core/vehicle/vehicle.h"

namespace tribodyn {

/// A drive cycle on the road load of a vehicle.
struct DrivenCycle {
  std::vector<CyclePiece> pieces;
  /// By piece, eq 7 with the vehicle's inertia [N m]; 0 at standstill. Negative: coast.
  std::vector<double> wheel_torques;
  std::vector<double> wheel_energies;  ///< by piece, of these torques [J]
};

/// Pieces slower than kStandstillSpeed are standstill.
DrivenCycle driven_cycle(std::vector<CyclePiece> pieces, const Vehicle& vehicle);

/// The mesh loss of one fluid over a cycle, as a sequence of steady points.
struct CycleLoss {
  std::vector<double> energies;  ///< by piece [J]; 0 at standstill
  /// Of their sum, and `points`: as MappedLoss.
  double map_error = 0, solver_error = 0;
  int points = 0;
};

/// Throws what `loss_forces` throws.
CycleLoss cycle_loss(const DrivenCycle& cycle, const LossForces& loss_forces,
                     const LossMapOptions& options);

/// What the pieces of a part of a cycle have in common.
enum class CyclePartKind {
  kAll,
  kStandstill,
  kDrive,              ///< the drive flanks carry: wheel torque above 0
  kDriveAccelerating,  ///< drive, acceleration above kSteadyAcceleration
  kDriveSteady,
  kDriveDecelerating,
  kCoast,      ///< the coast flanks carry: wheel torque below 0
  kSpeedBand,  ///< a range of speeds, without standstill
};

/// Magnitude of acceleration up to which driving counts as steady [m/s2].
inline constexpr double kSteadyAcceleration = 0.02;

/// Pieces of a cycle that have something in common.
struct CyclePart {
  CyclePartKind kind;
  double low = 0, high = 0;         ///< kSpeedBand: speeds from low to below high [m/s]; 0: no end
  std::vector<std::size_t> pieces;  ///< positions
  double duration = 0, distance = 0;  ///< [s], [m]
};

/// Returns every kind but kSpeedBand once, then the ranges of speed that occur, bounded by 30, 60,
/// 90 and 130 km/h.
std::vector<CyclePart> parts_of(const DrivenCycle& cycle);

/// Energies of a part of a cycle.
struct CycleEnergy {
  /// What comes in [J]: at the pinion in drive, what the wheels take and the loss; at the wheels in
  /// coast.
  double input = 0;
  double loss = 0;  ///< [J]
};

/// `losses` are CycleLoss::energies.
CycleEnergy energy_of(const CyclePart& part, const DrivenCycle& cycle,
                      const std::vector<double>& losses);

}  // namespace tribodyn
