#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "client/cpp/report/screening_report.h"

namespace tribodyn::client {

/// Returns how sure the ranking is. `answer`: the comparisons of its first candidates by the
/// service; its numbers are positions in `candidates`, the indices of the candidates in the table.
RankingConfidence ranking_confidence(const std::vector<CandidateFigures>& ranking,
                                     const std::vector<std::size_t>& candidates,
                                     const v1::RankCandidatesResponse& answer, double confidence);

/// The front of least inefficiency and least or most of a column.
struct ScreeningFront {
  std::string column;              ///< as typed in the table, or a contact figure
  bool wants_most = false;         ///< more of the column is better
  std::vector<double> values;      ///< by candidate; NaN without a number
  std::vector<std::size_t> front;  ///< candidates, by ascending inefficiency
};

/// Throws Failure (kExitUsage), naming --pareto, if the column is neither one of the table nor a
/// contact figure of the screening.
void check_front_column(const Screening& screening, const std::string& column);

/// Returns the front. Throws as check_front_column(), and if the column has no numbers.
ScreeningFront screening_front(const Screening& screening,
                               const std::vector<CandidateFigures>& ranking,
                               const std::string& column, bool wants_most);

/// Sets the warnings of a screening. The numbers of `answer`, a ranking by the service, are
/// positions in `candidates`, the indices of the candidates in the table.
void set_warnings(const std::vector<std::size_t>& candidates,
                  const v1::RankCandidatesResponse& answer, Screening& screening);

/// Effect of one parameter on the mean inefficiency.
struct ScreeningEffect {
  std::string column, from, to;  ///< as typed: lowest and highest value
  double effect, low, high;      ///< change of the mean inefficiency and its 95 % interval [%]
  std::vector<std::string> collinear;  ///< columns from which it cannot be separated
};

struct ScreeningEffects {
  std::vector<ScreeningEffect> effects;  ///< largest first
  std::vector<std::string> left_out;     ///< columns without an effect, each with the reason
  int degrees_of_freedom = 0;
  double residual_standard_deviation = 0;  ///< of the mean inefficiency about the model [%]
  double explained_share = 0;              ///< of its variance, 0 to 1
};

/// Returns the main effects of parameters as the service states them; its numbers are positions in
/// `candidates`.
ScreeningEffects screening_effects(const Screening& screening,
                                   const std::vector<std::size_t>& candidates,
                                   const v1::EstimateCandidateEffectsResponse& answer);

std::string front_report(const Screening& screening, const std::vector<CandidateFigures>& ranking,
                         const ScreeningFront& front);
std::string effects_report(const ScreeningEffects& effects);

// The same as JSON objects.
std::string front_json(const Screening& screening, const ScreeningFront& front);
std::string effects_json(const ScreeningEffects& effects);

}  // namespace tribodyn::client
