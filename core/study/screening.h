#pragma once

#include <optional>
#include <vector>

#include "core/study/contact_summary.h"
#include "core/study/point_result.h"
#include "core/study/prepared_scene.h"

namespace tribodyn {

/// The figures of a point to which PointOptions::tolerance applies, and others on request.
struct PointFigures {
  double pinion_torque = 0;                        ///< T_s [N m]
  double wheel_torque = 0;                         ///< T_w [N m]
  std::optional<double> inefficiency_rms;          ///< as in PointResult [%]
  std::optional<double> inefficiency_energy_mean;  ///< [%]
  double mesh_loss_power = 0;                      ///< mean [W]
  double dte_minimum = 0, dte_maximum = 0;         ///< x [m]
  bool contact_loss = false;
  bool settled = false;
  int period_in_mesh_cycles = 0;                   ///< 0: none found
  std::optional<double> estimated_relative_error;  ///< absent: not estimated
  long contact_solutions = 0;
  PointModel model = PointModel::kFull;  ///< used
  std::vector<RangeWarning> warnings;    ///< as in PointResult
  /// By PointOptions::contact_summary. Absent where no flank carries a load.
  std::optional<ContactSummary> contact;
  /// By PointOptions::sensitivities, on the grid of the figures.
  std::optional<PointSensitivities> sensitivities;
};

/// Whether another response was found at the point: the warning RESPONSES_COEXIST.
bool responses_coexist(const PointFigures& figures);

/// The main figures of a result, with its contact summary and sensitivities.
PointFigures main_figures(const PointResult& result);

/// The figures of solve_prepared_point() from PointOptions::start, to within the tolerance, but
/// faster. Computes no histories and no coexisting responses; ignores a carried state. Throws as
/// solve_prepared_point does.
PointFigures solve_point_figures(PreparedScene& prepared, const OperatingCondition& condition,
                                 const PointOptions& options);

/// The same for one of many lubricants on one prepared gear set, all at the same few speeds and
/// loads. The orbit under Coulomb's friction is solved for once for all of them (CoulombOrbits);
/// each lubricant starts from it and is solved for on one grid, whose error that orbit gives. A
/// result is the same bits whichever lubricants came before. Points after the first at a speed and
/// load take half the time where twelve steps a mesh cycle are enough, and little less than alone
/// where many are needed; the first takes up to twice. Some hundred speeds and loads are kept; more
/// in turn gain nothing.
PointFigures screen_point(PreparedScene& prepared, const OperatingCondition& condition,
                          const PointOptions& options);

}  // namespace tribodyn
