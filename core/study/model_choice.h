#pragma once

#include <optional>

#include "core/study/operating_target.h"
#include "core/study/quasi_static.h"

namespace tribodyn {

/// The quasi-static answer and the error that is estimated of it: of model and grid, relative, as
/// PointResult::estimated_relative_error means it. Infinite: it cannot be told.
struct QuasiStaticAnswer {
  QuasiStatic solution;
  double estimated_error;
};

/// `options` must outlive the request.
QuasiStaticRequest quasi_static_request(const OperatingTarget& target, const PointOptions& options);

/// Whatever its error. Nothing where a contact is refused (the system tells why) or sweeps do not
/// converge.
std::optional<QuasiStaticAnswer> answer_quasi_statically(GearPairSystem& system,
                                                         const FlankContactBatch& contacts,
                                                         MeshGrids& grids,
                                                         const OperatingTarget& target,
                                                         const PointOptions& options);

/// Whether a cheaper model may stand in for the full one. Not where a branch has to be kept or
/// looked for, nor for histories: their ripple is what the cheaper models leave out.
bool may_choose(const PointOptions& options, const std::optional<CarriedState>& from);

/// The quasi-static answer where it is within the tolerance; else nothing, and the system as it was
/// but for the regime and the count of contacts. It is tried where the mechanics alone leave hope.
std::optional<QuasiStaticAnswer> choose_quasi_static(GearPairSystem& system,
                                                     const FlankContactBatch& contacts,
                                                     PreparedGearSet& gear_set,
                                                     const OperatingTarget& target,
                                                     const PointOptions& options);

}  // namespace tribodyn
