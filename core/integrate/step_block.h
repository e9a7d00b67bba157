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
  const GearPairSystem& system;  ///< its torques and constants
  const MeshGrid& grid;
  int side;  ///< on which the flanks stay together, whatever the force
  bool solve_wheel_torque;
  const CycleFriction& friction;
};

/// Unknowns of a step: the states but time, then the torque.
inline constexpr int kStepUnknowns = 8;

/// One classical Runge-Kutta step from every start of `response` (time is not read): states
/// at their ends, kTime their durations, to `end`. Unless null, to `derivatives` those of duration
/// and states at a step's end (rows) by states at its start and the torque (columns), row after
/// row. False where the grid's series do not reach that far or a number means nothing.
bool take_steps(InstructionSet instruction_set, const StepBlock& block,
                const CycleResponse& response, Columns& end, Columns* derivatives);

/// Fills rates and mechanics of the starts, the middles (by the cubic through both
/// ends) and their mechanics. Times and states at the starts are given. False as above.
bool fill_response(InstructionSet instruction_set, const StepBlock& block, CycleResponse& response);

/// How the states at the steps' starts, and the steps' durations, follow the section state and the
/// unknown torque. Square matrices in columns: states and the duration of the step before, by
/// states and the torque.
struct CycleDerivatives {
  /// Numbers of one.
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

/// From the derivatives of take_steps().
void compose_steps(InstructionSet instruction_set, const Columns& derivatives,
                   CycleDerivatives& out);

/// What the steps' residuals (their ends less the next starts) alone do to the starts and
/// durations: kStepUnknowns numbers for each start and the end of the cycle.
void follow_residuals(InstructionSet instruction_set, const CycleDerivatives& derivatives,
                      const CycleResponse& response, const Columns& end, double* particular);

/// Adds to each of `particular` what a change of the section's unknowns does. Returns the largest
/// change of a state, each over its scale (the last number 0: not the duration).
double add_section_change(InstructionSet instruction_set, const CycleDerivatives& derivatives,
                          const double* section, const double* per_scale, double* particular);

/// Rows of what contacts see in a response.
enum SeenRow {
  kSeenLoad,
  kSeenPinionX,
  kSeenPinionY,
  kSeenGearX,
  kSeenGearY,
  kSeenSlidingSpeed,
  kSeenPinionArm,
  kSeenGearArm,
  kSeenRows
};

/// Fills `seen`, which has a lane for each of the grid's contacts.
void see_contacts(InstructionSet instruction_set, const StepBlock& block,
                  const GridContacts& contacts, const CycleResponse& response, Columns& seen);

}  // namespace tribodyn
