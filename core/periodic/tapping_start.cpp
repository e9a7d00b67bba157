#include "core/periodic/tapping_start.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "core/integrate/mesh_cycle_march.h"
#include "core/integrate/rk4_with_events.h"

namespace tribodyn {
namespace {

/// The transmission error at constant speeds, but for a constant [m].
struct Swing {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  double stiffest = 0;  ///< [N/m]
};

Swing swing_of(const MeshData& mesh) {
  constexpr int kPhases = 32;
  Swing out;
  for (int n = 0; n < kPhases; ++n) {
    const MeshFunctions f = mesh.functions(mesh.at_phase(2 * std::numbers::pi * n / kPhases), 0);
    const double error = f.radius_integral - f.static_transmission_error;
    out.low = std::min(out.low, error);
    out.high = std::max(out.high, error);
    out.stiffest = std::max(out.stiffest, f.mesh_stiffness);
  }
  return out;
}

/// Overlap of the flanks of one side, and the stiffness, at places of a cycle in which the gears
/// float, their mesh approach moved by `shift` [m].
struct Overlaps {
  std::vector<double> length, stiffness;

  Overlaps(const GearPairSystem& system, const std::vector<OrbitPiece>& pieces, double side,
           double shift) {
    // A tap under 1e-4 N m lasts for 1 % of a mesh cycle.
    const int places = 1 + 768 / static_cast<int>(pieces.size());
    Mechanics at;
    for (const OrbitPiece& p : pieces) {
      for (int i = 0; i < places; ++i) {
        // What the float leaves of the mesh approach is smooth: by the parabola.
        const double t = static_cast<double>(i) / places;
        MarchState y = p.start;
        y[kMeshApproach] = shift + (1 - t) * (1 - 2 * t) * p.start[kMeshApproach] +
                           4 * t * (1 - t) * p.middle[kMeshApproach] +
                           t * (2 * t - 1) * p.end[kMeshApproach];
        system.kinematics(p.phase + t * p.length, p.regime, y.data(), at);
        length.push_back(side * at.transmission_error - system.dynamics().half_backlash);
        stiffness.push_back(at.mesh.mesh_stiffness);
      }
    }
  }

  /// What must be added to all of them so that the mean force is `force` [N].
  double common_for(double force) const {
    constexpr int kMostSteps = 60;
    const double most = *std::max_element(length.begin(), length.end());
    const double least = *std::min_element(length.begin(), length.end());
    const double softest = *std::min_element(stiffness.begin(), stiffness.end());
    // Mean force and slope rise with it: Newton's steps come down to the root.
    double common = force / softest - least;
    for (int i = 0; i < kMostSteps; ++i) {
      double excess = -force, slope = 0;
      for (std::size_t n = 0; n < length.size(); ++n) {
        if (!(length[n] + common > 0)) continue;
        excess += stiffness[n] * (length[n] + common) / static_cast<double>(length.size());
        slope += stiffness[n] / static_cast<double>(length.size());
      }
      if (!(excess > 1e-9 * force) || slope == 0) break;
      common -= excess / slope;
    }
    return std::max(common, -most);
  }
};

/// What moves a float so near to the flanks of a side that they carry `force` in the mean [m].
double shift_to_flanks(const GearPairSystem& system, const std::vector<OrbitPiece>& pieces,
                       double side, double force) {
  constexpr int kMoves = 4;  // R_g's ripple moves too: a contraction by 4e-3
  double shift = 0;
  for (int i = 0; i < kMoves; ++i) {
    shift += side * Overlaps(system, pieces, side, shift).common_for(force);
  }
  return shift;
}

/// The mesh approach at which the transmission error at constant speeds swings about 0 [m].
double middle_of_backlash(const GearPairSystem& system, const Swing& swing) {
  return -system.dynamics().half_backlash - 0.5 * (swing.low + swing.high);
}

/// A mesh cycle in which the gears float in the backlash under no torque, and repeat that. Empty if
/// flanks meet. `approach`: near that at mesh phase 0 [m].
///
/// The cycle is affine in its start, so a step or two of Newton's method find what repeats.
/// Wherever the gears float in the backlash they do so in the same way, and at any speed: of the
/// corrections that these two freedoms leave open the shortest is taken.
std::vector<OrbitPiece> float_freely(const GearPairSystem& system, const MeshGrid& grid,
                                     double approach, double mean_pinion_speed) {
  constexpr int kStates = kWheelSpeed;  // the seven of the section
  // With one the light points of core/README.md take 3 % more work.
  constexpr int kCorrections = 3;
  // Share of the largest pivot below which a direction is free: with 1e-3 the light points take the
  // same work, with 1e-9 2.7 times as much, as the freedoms are not recognised.
  constexpr double kFreedom = 1e-6;
  const MeshData& mesh = system.mesh();
  MarchState start{};
  start[kMeshApproach] = approach;
  start[kPinionShaftSpeed] = start[kPinionSpeed] = mean_pinion_speed;
  start[kGearSpeed] = start[kWheelSpeed] =
      mean_pinion_speed * mesh.mean_pinion_contact_radius() / mesh.mean_gear_contact_radius();
  const MarchScales scales = march_scales(system, {}, mean_pinion_speed);
  Rk4WithEvents march(system, scales, grid, 1, false, 1e-9, InstructionSet::kPortable);
  FrozenFriction none;
  std::vector<OrbitPiece> pieces;
  for (int i = 0;; ++i) {
    MarchState end = start;
    Sensitivity sensitivity;
    if (system.regime_of(0, start.data()).side != 0 ||
        !march.run({}, none, false, end, &sensitivity, &pieces) || march.events() > 0) {
      return {};
    }
    if (i == kCorrections) return pieces;
    Eigen::Matrix<double, kStates, kStates> jacobian;
    Eigen::Matrix<double, kStates, 1> residual;
    for (int row = 0; row < kStates; ++row) {
      const double scale = scales.of(mesh, row + 1);
      residual(row) = (end[row + 1] - start[row + 1]) / scale;
      for (int column = 0; column < kStates; ++column) {
        jacobian(row, column) =
            sensitivity[row + 1](column) * scales.of(mesh, column + 1) / scale - (row == column);
      }
    }
    Eigen::CompleteOrthogonalDecomposition<Eigen::Matrix<double, kStates, kStates>> solver;
    solver.setThreshold(kFreedom);
    const Eigen::Matrix<double, kStates, 1> step = solver.compute(jacobian).solve(-residual);
    for (int row = 0; row < kStates; ++row) start[row + 1] += step(row) * scales.of(mesh, row + 1);
  }
}

}  // namespace

bool flanks_tap(const MeshData& mesh, double pinion_torque) {
  const Swing swing = swing_of(mesh);
  return !(std::abs(pinion_torque) / mesh.mean_pinion_contact_radius() >
           swing.stiffest * (swing.high - swing.low));
}

std::optional<MarchState> floating_start(const GearPairSystem& system, const MeshGrid& grid,
                                         double mean_pinion_speed) {
  const std::vector<OrbitPiece> pieces = float_freely(
      system, grid, middle_of_backlash(system, swing_of(system.mesh())), mean_pinion_speed);
  if (pieces.empty()) return std::nullopt;
  return pieces.front().start;
}

std::optional<MarchState> tapping_start(const GearPairSystem& system, const Torques& torques,
                                        const MeshGrid& grid, double mean_pinion_speed) {
  const MeshData& mesh = system.mesh();
  const DrivelineDynamics& d = system.dynamics();
  const Swing swing = swing_of(mesh);
  const double force = std::abs(torques.pinion) / mesh.mean_pinion_contact_radius();
  if (force == 0 || !flanks_tap(mesh, torques.pinion)) return std::nullopt;
  const double side = torques.pinion > 0 ? 1 : -1;
  // R_g's ripple lies elsewhere once the gear has turned through half of the backlash: the float is
  // computed anew close to the flanks.
  // Of the swing. Not critical: with 0.05 and 0.8 the light points of core/README.md take 12 % more
  // and 4 % less work.
  constexpr double kClearance = 0.2;
  std::vector<OrbitPiece> pieces =
      float_freely(system, grid, middle_of_backlash(system, swing), mean_pinion_speed);
  if (!pieces.empty()) {
    const double shift = shift_to_flanks(system, pieces, side, force);
    const double approach =
        pieces.front().start[kMeshApproach] + shift - side * kClearance * (swing.high - swing.low);
    auto close = float_freely(system, grid, approach, mean_pinion_speed);
    if (!close.empty()) pieces = std::move(close);
  }
  if (pieces.empty()) return std::nullopt;

  MarchState out = pieces.front().start;
  out[kMeshApproach] += shift_to_flanks(system, pieces, side, force);
  out[kPinionShaftTwist] += torques.pinion / d.pinion_shaft_stiffness;
  out[kGearShaftTwist] += torques.wheel / d.gear_shaft_stiffness;
  return out;
}

}  // namespace tribodyn
