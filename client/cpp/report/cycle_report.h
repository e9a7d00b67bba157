#pragma once

#include <string>
#include <vector>

#include "client/cpp/text/output.h"
#include "core/vehicle/drive_cycle.h"

namespace tribodyn::client {

/// Quasi-steady losses of one lubricant over a cycle.
struct CycleLosses {
  std::string lubricant;              ///< revision, e.g. "lubricants/paper-fluid-1@1"
  std::vector<double> loss_joules;    ///< by piece
  double estimated_error_joules = 0;  ///< of the sum, by the map; 0: point by point
  int points = 0;                     ///< of the model
  std::string model_version;
};

/// A drive cycle with the road load of a vehicle.
struct CycleRun {
  std::string name;
  std::vector<CyclePiece> pieces;
  std::vector<double> wheel_torques;   ///< by piece [N m]
  std::vector<double> wheel_energies;  ///< by piece, negative where the wheels drive [J]
  double sump_temperature_celsius;
  std::vector<CycleLosses> fluids;
};

/// Returns energies, inefficiency and where the loss arises, for all lubricants side by side; the
/// others are compared with the first.
std::string cycle_text(const CycleRun& run, OutputFormat format);

/// Returns one line for each piece: time, speed, torque, and the loss of each lubricant.
std::string cycle_pieces_csv(const CycleRun& run);

/// Draws speed and loss power over time.
std::string cycle_plot(const CycleRun& run);

}  // namespace tribodyn::client
