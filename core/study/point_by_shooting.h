#pragma once

#include <optional>

#include "core/periodic/find_orbit.h"
#include "core/study/operating_target.h"

namespace tribodyn {

/// Fills a result with everything that follows from an orbit. Returns the orbit's pieces with their
/// contacts.
SolvedPieces fill_from_orbit(const PointProblem& problem, const PeriodicOrbit& orbit,
                             PointResult& out);

/// Where shooting starts: from the carried state, or else from the static one. Returns nullopt if
/// shooting cannot find the response: no pinion torque holds the flanks together, or the neighbour
/// has no period.
std::optional<OrbitSearch> search_from(const PointProblem& problem, PointStart start,
                                       const std::optional<CarriedState>& from);

/// The derivatives of an orbit. Returns nullopt if they do not exist, or if the mesh data depend on
/// the torque, whose change is not differentiated.
std::optional<OrbitSensitivity> sensitivity_of(const PointProblem& problem,
                                               const PeriodicOrbit& orbit);

/// What shooting finds, with derivatives if the options include them.
struct ShotPoint {
  PointResult result;
  std::optional<OrbitSensitivity> sensitivity;
};

/// Returns nullopt if a march must decide; `aperiodic` then says where from, if all responses that
/// were found repel.
std::optional<ShotPoint> solve_by_shooting(const PointProblem& problem, PointStart start,
                                           const std::optional<CarriedState>& from,
                                           const HistoryRequest& history,
                                           std::optional<SectionPoint>& aperiodic);

/// Throws Refusal NOT_FOUND_BY_SHOOTING, or what a march would throw at its start: the refusal of a
/// contact.
[[noreturn]] void refuse_shooting(const PointProblem& problem);

}  // namespace tribodyn
