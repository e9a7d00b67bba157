#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <optional>
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
  /// By ScreenedPoint::ContactFigure: extremes over the conditions of the figures that are
  /// extremes, and weighted means of the others.
  std::array<double, ScreenedPoint::kContactFigures> contact = {};
  std::string refusal;       ///< why there are no figures; empty if there are
  bool is_withheld = false;  ///< a warning at one condition or more withholds the verdict
};

/// Returns the figures of a candidate.
CandidateFigures candidate_figures(const Screening& screening, std::size_t candidate);
CandidateFigures base_figures(const Screening& screening);

/// Returns the figures of all candidates by ascending inefficiency, then those whose verdict is
/// withheld, and last those without figures in the order of the table.
std::vector<CandidateFigures> ranked(const Screening& screening);

/// What the errors of the inputs make of a candidate.
struct CandidateConfidence {
  double standard_uncertainty;  ///< of its mean inefficiency [%]
  double higher_probability;    ///< that it loses more than the best one
  bool is_tied;                 ///< cannot be told apart from the best one
};

/// How sure a ranking is.
struct RankingConfidence {
  bool is_not_stated = false;  ///< nobody states an uncertainty of what the candidates differ in
  int draws = 0;               ///< of the inputs
  double confidence = 0.95;    ///< of the interval of a difference; ties: it holds 0
  /// By position in the ranking, of its first candidates alone; nullopt: not known.
  std::vector<std::optional<CandidateConfidence>> of;
  std::vector<std::string> own;     ///< inputs with errors that are independent between candidates
  std::vector<std::string> shared;  ///< inputs with errors that all candidates have in common
};

/// Returns the ranking: as a table the `top` best and what was refused, else all candidates. A
/// confidence without candidates leaves its columns out of the table. JSON gets `members` too:
/// values by their names.
std::string screening_report(const Screening& screening,
                             const std::vector<CandidateFigures>& ranking,
                             const RankingConfidence& confidence, std::size_t top,
                             OutputFormat format,
                             const std::map<std::string, std::string>& members = {});

}  // namespace tribodyn::client
