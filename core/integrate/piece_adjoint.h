#pragma once

#include <array>
#include <span>

#include "core/driveline/motion.h"
#include "core/numerics/instruction_set.h"

namespace tribodyn {

// Derivatives backwards through the pieces of an orbit (adjoint or reverse mode; A. Griewank and
// A. Walther, Evaluating Derivatives, 2nd ed., 2008, chapter 3): for many parameters and few
// figures they cost as much as the figures are, not the parameters.

/// Figures that are differentiated together: what fits side by side.
inline constexpr int kAdjointLanes = 8;

/// One number for each of them.
using AdjointRow = std::array<double, kAdjointLanes>;

/// Derivatives of the figures by time and the seven states, in the order of MarchComponent.
using StateAdjoint = std::array<AdjointRow, 8>;

/// What the rates at one instant depend on.
struct StageSlopes : MotionSlopes {
  double load;  ///< what friction arms act on [N]
};

/// Derivatives of a friction arm (torque over load) by mesh force, speeds of pinion and gear.
using ArmSlopes = std::array<double, 3>;

/// A piece of an orbit: a classical Runge-Kutta step whose friction arms at start, middle and end
/// follow the states there, the middle by the cubic through both ends.
struct PieceSlopes {
  double length;                             ///< [cycles]
  std::array<const StageSlopes*, 4> stages;  ///< of the step
  /// At start, middle and end. Of the middle only what the mesh force depends on is read.
  std::array<const StageSlopes*, 3> parts;
  std::array<std::array<ArmSlopes, 2>, 3> arm;  ///< there, of pinion and gear
};

/// What a change of friction arms and torques during a piece does to the figures.
struct PieceAdjoint {
  std::array<std::array<AdjointRow, 2>, 3> arm;  ///< at start, middle, end; of pinion and gear
  AdjointRow pinion_torque, wheel_torque;        ///< T_s, T_w
};

/// Takes the adjoints of groups of figures from the end of a piece to its start. `direct`:
/// derivatives by the states at start, middle and end of what the piece itself adds to the figures
/// of the last group; null: nothing. `out`: one for each group.
void pass_back(InstructionSet instruction_set, const MotionConstants& constants,
               const PieceSlopes& piece, const std::array<StateAdjoint, 3>* direct,
               std::span<StateAdjoint> groups, PieceAdjoint* out);

/// sum[l] += sum over the contacts of slope row l times their weights; `slopes` are `rows` arrays,
/// `stride` numbers apart.
void add_weighted_slopes(InstructionSet instruction_set, int count, const AdjointRow* weights,
                         const double* slopes, std::size_t stride, int rows, AdjointRow* sum);

}  // namespace tribodyn
