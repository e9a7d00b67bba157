#pragma once

#include <string>
#include <vector>

#include "client/cpp/report/screening_decisions.h"

namespace tribodyn::client {

/// Returns the picture (SVG) of a Pareto front among all candidates, of main effects, or of both
/// one below the other; at least one is not null.
std::string screening_plot(const Screening& screening, const std::vector<CandidateFigures>& ranking,
                           const ScreeningFront* front, const ScreeningEffects* effects);

}  // namespace tribodyn::client
