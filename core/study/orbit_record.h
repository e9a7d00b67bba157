#pragma once

#include "core/periodic/periodic_orbit.h"
#include "core/study/history_sampler.h"
#include "core/study/response_record.h"

namespace tribodyn {

/// Records the solved pieces of a periodic orbit: integrals by Simpson's rule over each piece
/// (turns of the shafts as the teeth say), extremes, openings of the gap.
void record_orbit(const GearPairSystem& system, const PeriodicOrbit& orbit,
                  const SolvedPieces& solved, ResponseRecord& record);

/// Samples the history: states by the cubic through the ends of a piece with their rates, friction
/// solved at each; then copies of the period.
void sample_orbit(const GearPairSystem& system, const PeriodicOrbit& orbit,
                  const SolvedPieces& solved, ContactSolver& contacts, HistorySampler& history);

}  // namespace tribodyn
