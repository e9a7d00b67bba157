#pragma once

#include <memory>

#include "core/contact/flank_contact_batch.h"
#include "core/driveline/gear_pair_system.h"
#include "core/integrate/mesh_grid.h"
#include "core/numerics/columns.h"

namespace tribodyn {

/// Rows of a response at many phases: the components of MarchComponent up to kWheelSpeed, then
enum ResponseRow {
  kMeshForceRow = kWheelSpeed + 1,
  kTransmissionErrorRow,
  kTransmissionVelocityRow,
  kResponseRows
};

/// A response over one mesh cycle whose flanks stay together, at the nodes of a grid: one lane for
/// each step. Starts have one lane more, the end of the cycle.
struct CycleResponse {
  Columns start, middle;  ///< kResponseRows
  Columns rate;           ///< of time and states at the starts, by phase
};

/// Friction torques per newton of load [m] at the same nodes.
enum FrictionRow { kPinionFrictionRow, kGearFrictionRow, kFrictionRows };
struct CycleFriction {
  Columns start, middle;  ///< kFrictionRows
};

/// The steps of a mesh cycle side by side: each starts from a state of its own.
struct StepBlock {
  const GearPairSystem& system;
  const Torques& torques;
  const MeshGrid& grid;
  int side;  ///< on which the flanks stay together, whatever the force
  bool solve_wheel_torque;
  const CycleFriction& friction;
};

/// Unknowns of a step: the states but time, then the torque.
inline constexpr int kStepUnknowns = 8;

/// Takes one classical Runge-Kutta step from every start of `response`: lane s is step s.
///
/// | columns | row | in lane s, in units of MarchComponent |
/// |---|---|---|
/// | response.start | kTime | not read |
/// | response.start | i = 1 ... 7 | state i at the start of the step |
/// | end | kTime | duration of the step |
/// | end | i = 1 ... 7 | state i at the end of the step |
/// | derivatives | 8 i + j, j = 0 ... 6 | d(row i of end)/d(state j + 1 at the start) |
/// | derivatives | 8 i + 7 | d(row i of end)/d(unknown torque) |
///
/// `derivatives` may be null: they are then not computed. Returns false beyond the reach of the
/// grid's series, or if a number is not finite.
bool rk4_steps(InstructionSet instruction_set, const StepBlock& block,
               const CycleResponse& response, Columns& end, Columns* derivatives);

/// Computes rates and mechanics of the starts, the states at the middles (by the cubic through both
/// ends) and their mechanics. Requires times and states at the starts. Returns false as
/// rk4_steps().
bool complete_midpoints(InstructionSet instruction_set, const StepBlock& block,
                        CycleResponse& response);

/// Derivatives of the states at the starts of the steps, and of the durations of the steps, by the
/// section state and the unknown torque. 8 x 8 matrices in columns: states and the duration of the
/// step before, by states and the torque.
struct CycleDerivatives {
  /// Elements of one matrix.
  static constexpr std::size_t kMatrix = std::size_t{kStepUnknowns} * kStepUnknowns;

  explicit CycleDerivatives(int count)
      : steps(count),
        step(std::make_unique_for_overwrite<double[]>(kMatrix * count)),
        from_section(std::make_unique_for_overwrite<double[]>(kMatrix * (count + 1))) {}
  int steps;
  std::unique_ptr<double[]> step;  ///< of each step, by its start
  std::unique_ptr<double[]>
      from_section;  ///< of each start and the end of the cycle, by the section
};

/// Multiplies the Jacobians of rk4_steps() along the cycle.
void compose_derivatives(InstructionSet instruction_set, const Columns& derivatives,
                         CycleDerivatives& out);

/// Forward elimination of condensed multiple shooting: propagates the residuals of the steps (their
/// ends less the next starts) from a section that does not move. kStepUnknowns numbers for each
/// start and the end of the cycle.
void condense_residuals(InstructionSet instruction_set, const CycleDerivatives& derivatives,
                        const CycleResponse& response, const Columns& end, double* particular);

/// Back substitution: adds to each of `particular` the effect of a change of the section's
/// unknowns. Returns the largest change of a state, each over its scale (the last number 0: not the
/// duration).
double expand_section_update(InstructionSet instruction_set, const CycleDerivatives& derivatives,
                             const double* section, const double* per_scale, double* particular);

/// Rows of the conditions of the contacts of a response.
enum GatheredRow {
  kGatheredLoad,
  kGatheredPinionX,
  kGatheredPinionY,
  kGatheredGearX,
  kGatheredGearY,
  kGatheredSlidingSpeed,
  kGatheredPinionArm,
  kGatheredGearArm,
  kGatheredRows
};

/// Gathers the conditions of the grid's contacts, one lane each.
void gather_contact_conditions(InstructionSet instruction_set, const StepBlock& block,
                               const GridContacts& contacts, const CycleResponse& response,
                               Columns& conditions);

}  // namespace tribodyn
