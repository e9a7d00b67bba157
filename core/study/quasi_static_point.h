#pragma once

#include <optional>

#include "core/reduced/quasi_static.h"
#include "core/study/operating_target.h"

namespace tribodyn {

/// The problem on the grid of the quasi-static model: to half of the tolerance, the rest is the
/// model's.
PeriodicProblem quasi_static_problem(const PointProblem& problem);

/// The quasi-static solution, whatever its error; `estimated_error` is that of model and grid, as
/// PointResult::estimated_relative_error means it, infinite if it cannot be estimated. Returns
/// nullopt if a contact is refused (the tally has the reason) or the iteration does not converge.
std::optional<PeriodicOrbit> solve_quasi_static_with_error(const PointProblem& problem);

/// Whether a cheaper model may stand in for the full one. It may not where a branch has to be kept
/// or looked for, nor for histories: the cheaper models leave their ripple out.
bool may_choose(const PointOptions& options, const std::optional<CarriedState>& from);

/// Returns the quasi-static solution if its error is within the tolerance. Otherwise returns
/// nullopt. Contacts are solved only if the mechanics alone leave the error room.
std::optional<PeriodicOrbit> choose_quasi_static(const PointProblem& problem);

/// The point of a solution, with the history of the options. Throws Cancelled.
PointResult quasi_static_result(const PointProblem& problem, PeriodicOrbit& solution);

/// The point at the caller's choice of the model, whatever its error. Throws the refusal of a
/// contact, or NO_QUASI_STATIC_EQUILIBRIUM.
PointResult solve_quasi_static_point(const PointProblem& problem);

}  // namespace tribodyn
