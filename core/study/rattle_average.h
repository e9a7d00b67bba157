#pragma once

#include <functional>
#include <optional>

#include "core/integrate/work_limit.h"
#include "core/study/operating_target.h"
#include "core/study/response_record.h"

namespace tribodyn {

// The average of a response that does not repeat, and its error:
//  1. Blocks of six mesh cycles, which hold whole periods of one to three cycles, are marched and
//     recorded at constant torques. A block's balance of momentum gives the unknown torque that it
//     would have needed to end as fast as it began. The next block has the mean of these torques
//     over the second half of the blocks so far, and the mean speed is restored, by a shift of the
//     speeds of the whole train: single cycles scatter too much to correct the torque by.
//  2. The first blocks are discarded while the transient lasts: the largest number that MSER finds
//     for the mean square of the loss share, the loss and the torque (initial_transient).
//  3. The error is the half-width of the 95 % interval by batch means of the blocks that are left
//     (half_width_of_mean), the largest of both inefficiencies and the unknown torque. Each
//     figure's relative deviations are linear combinations of its blocks' integrals (the delta
//     method).
//  4. More blocks are marched until the error is within the tolerance, or a limit is reached.
// Extremes are those of the blocks that are left: they grow with the record and have no error.

/// The probability with which a mean over a long record lies within the error of a short one.
inline constexpr double kRattleCoverage = 0.95;

struct RattleOptions {
  MarchOptions march;
  double tolerance = 1e-3;               ///< wanted of the error, relative
  int least_mesh_cycles = 0;             ///< that are averaged
  int most_mesh_cycles = 0;              ///< that are marched; at least 1
  std::function<bool(double)> progress;  ///< with the share of the limits; false: throws Cancelled
};

struct RattleAverage {
  ResponseRecord record;
  int mesh_cycles = 0;  ///< averaged
  /// With the mean of what the blocks needed in place of the unknown torque.
  Torques torques{};
  /// Of both inefficiencies and the unknown torque; absent if the blocks are too few or still
  /// drift.
  std::optional<double> relative_error{};
  double input = 0, output = 0, stored = 0;  ///< works of the record, as of PowerBalance [J]
  SectionPoint end{};
};

/// Averages the response from a point of the section, which need not be on it yet. Ends before the
/// tolerance is met where a limit ends it. Adds to `work`. Throws Refusal("WORK_LIMIT") if `limit`
/// ends the first block, and as march_mesh_cycle does.
RattleAverage average_rattle(const PointProblem& problem, ContactSolver& contacts,
                             const SectionPoint& start, const RattleOptions& options,
                             const WorkLimit& limit, SolverWork& work);

}  // namespace tribodyn
