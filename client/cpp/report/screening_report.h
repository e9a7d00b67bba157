#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "client/cpp/report/screening.h"
#include "client/cpp/text/output.h"

namespace tribodyn::client {

/// Figures of one candidate, or of the base, over all conditions.
struct CandidateFigures {
  std::size_t candidate = 0;  ///< index in the table
  double inefficiency = 0;    ///< weighted mean of inefficiency_energy_mean [%]
  double solver_error = 0;    ///< of that mean [%]
  double loss_power = 0;      ///< weighted mean of mesh_loss_power [W]
  bool contact_loss = false;  ///< at one condition or more
  std::string refusal;        ///< why there are no figures; empty if there are
};

/// Returns the figures of a candidate.
CandidateFigures candidate_figures(const Screening& screening, std::size_t candidate);
CandidateFigures base_figures(const Screening& screening);

/// Returns the figures of all candidates by ascending inefficiency, those without figures last in
/// the order of the table.
std::vector<CandidateFigures> ranked(const Screening& screening);

/// Returns the ranking: as a table the `top` best and what was refused, else all candidates.
std::string screening_report(const Screening& screening,
                             const std::vector<CandidateFigures>& ranking, std::size_t top,
                             OutputFormat format);

}  // namespace tribodyn::client
