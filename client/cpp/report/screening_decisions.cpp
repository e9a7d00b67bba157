#include "client/cpp/report/screening_decisions.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <set>

#include "client/cpp/failure.h"
#include "client/cpp/text/nearest.h"
#include "client/cpp/text/table.h"
#include "client/cpp/text/text.h"
#include "client/cpp/text/units.h"
#include "core/decisions/factor_effects.h"
#include "core/decisions/pareto_front.h"

namespace tribodyn::client {
namespace {

constexpr double kEffectCoverage = 0.95;
constexpr double kNoValue = std::numeric_limits<double>::quiet_NaN();

double number_or_nan(const std::string& text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool is_number = error == std::errc() && end == text.data() + text.size();
  return is_number && std::isfinite(value) ? value : kNoValue;
}

/// Returns the numbers of a column by candidate: of a parameter its values, else the cells; NaN
/// where there is none.
std::vector<double> numbers_of_column(const CandidateTable& table, std::size_t column) {
  for (const CandidateParameter& each : table.parameters) {
    if (each.column == column) return each.values;
  }
  std::vector<double> out;
  for (const auto& cells : table.cells) out.push_back(number_or_nan(cells[column]));
  return out;
}

/// The factors of the linear model, and the columns that they are.
struct EffectFactors {
  std::vector<std::size_t> columns;
  std::vector<Factor> factors;
};

/// Returns a factor for each column but those of uncertainties: of numbers if all candidates have
/// one.
EffectFactors effect_factors(const CandidateTable& table,
                             const std::vector<std::size_t>& candidates) {
  EffectFactors out;
  for (std::size_t k = 0; k < table.headers.size(); ++k) {
    const bool is_uncertainty = std::any_of(table.uncertainties.begin(), table.uncertainties.end(),
                                            [k](const auto& each) { return each.column == k; });
    if (is_uncertainty) continue;
    const std::vector<double> numbers = numbers_of_column(table, k);
    const bool all_are_numbers = std::all_of(candidates.begin(), candidates.end(), [&](auto each) {
      return std::isfinite(numbers[each]);
    });
    out.columns.push_back(k);
    Factor& factor = out.factors.emplace_back();
    for (const std::size_t each : candidates) {
      if (all_are_numbers) {
        factor.numbers.push_back(numbers[each]);
      } else {
        factor.words.push_back(table.cells[each][k]);
      }
    }
  }
  return out;
}

/// Returns a column without an effect, and why it has none.
std::string left_out_text(const std::string& header, const Factor& factor, NoEffect reason) {
  switch (reason) {
    case NoEffect::kConstant:
      return header + " (the same for all)";
    case NoEffect::kTooManyWords:
      return header + " (" +
             std::to_string(std::set(factor.words.begin(), factor.words.end()).size()) +
             " different texts)";
    case NoEffect::kFollowsFromOthers:
      break;
  }
  return header + " (follows from the columns before it)";
}

/// Returns what people call a parameter, "lubricant.relaxation_time_seconds" for one.
std::string parameter_label(const std::string& path) {
  return label_of_field(path.substr(path.find('.') + 1));
}

int effect_places(double error) {
  if (!(error > 0)) return 4;
  return std::clamp(1 - static_cast<int>(std::floor(std::log10(error))), 0, 9);
}

std::string plus_text(double value, int places) {
  return (value > 0 ? "+" : "") + fixed(value, places);
}

/// Returns the numbers of a column of the table, or else of a contact figure, by candidate.
std::vector<double> front_values(const Screening& screening,
                                 const std::vector<CandidateFigures>& ranking,
                                 const std::string& column) {
  check_front_column(screening, column);
  const CandidateTable& table = screening.table;
  const auto found = std::find(table.headers.begin(), table.headers.end(), column);
  if (found != table.headers.end()) {
    return numbers_of_column(table, static_cast<std::size_t>(found - table.headers.begin()));
  }
  const auto& figures = contact_figures_of_points();
  const auto figure =
      static_cast<std::size_t>(std::find(figures.begin(), figures.end(), column) - figures.begin());
  std::vector<double> out(table.size(), kNoValue);
  for (const CandidateFigures& each : ranking) {
    if (each.refusal.empty()) out[each.candidate] = each.contact[figure];
  }
  return out;
}

}  // namespace

RankingConfidence ranking_confidence(const std::vector<CandidateFigures>& ranking,
                                     const std::vector<std::size_t>& candidates,
                                     const v1::RankCandidatesResponse& answer, double confidence) {
  RankingConfidence out;
  out.confidence = confidence;
  for (const std::string& path : answer.own_uncertain_parameters()) {
    out.own.push_back(parameter_label(path));
  }
  for (const std::string& path : answer.shared_uncertain_parameters()) {
    out.shared.push_back(parameter_label(path));
  }
  out.has_no_inputs = out.own.empty() && out.shared.empty();
  if (out.has_no_inputs) return out;
  out.of.resize(std::min(ranking.size(), static_cast<std::size_t>(answer.compared())));
  for (const v1::RankedCandidate& each : answer.candidates()) {
    const std::size_t candidate = candidates.at(static_cast<std::size_t>(each.candidate()));
    const auto at = std::find_if(ranking.begin(), ranking.end(), [candidate](const auto& ranked) {
      return ranked.candidate == candidate;
    });
    const auto position = static_cast<std::size_t>(at - ranking.begin());
    if (position >= out.of.size() || !each.has_comparison()) continue;
    const v1::CandidateComparison& comparison = each.comparison();
    out.of[position] = {comparison.standard_uncertainty(), comparison.worse_probability(),
                        comparison.tied()};
  }
  return out;
}

void check_front_column(const Screening& screening, const std::string& column) {
  std::vector<std::string> names = screening.table.headers;
  if (screening.has_contact_figures()) {
    names.insert(names.end(), contact_figures_of_points().begin(),
                 contact_figures_of_points().end());
  }
  if (std::find(names.begin(), names.end(), column) != names.end()) return;
  const auto& figures = contact_figures_of_points();
  const bool is_figure = std::find(figures.begin(), figures.end(), column) != figures.end();
  const std::string meant = nearest(column, names);
  throw Failure(kExitUsage,
                "--pareto: the table has no column '" + printable(column) + "'" +
                    (is_figure       ? "; --contact-figures computes it"
                     : meant.empty() ? "; it has " + joined(screening.table.headers, ", ")
                                     : " (is " + meant + " meant?)"));
}

ScreeningFront screening_front(const Screening& screening,
                               const std::vector<CandidateFigures>& ranking,
                               const std::string& column, bool wants_most) {
  ScreeningFront out;
  out.column = column;
  out.wants_most = wants_most;
  out.values = front_values(screening, ranking, column);
  std::vector<double> inefficiencies, values;
  for (const CandidateFigures& each : ranking) {
    const double value = each.refusal.empty() ? out.values[each.candidate] : kNoValue;
    inefficiencies.push_back(each.inefficiency);
    values.push_back(wants_most ? -value : value);
  }
  for (const std::size_t position : pareto_front(inefficiencies, values)) {
    out.front.push_back(ranking[position].candidate);
  }
  if (out.front.empty()) {
    throw Failure(kExitUsage, "--pareto: column '" + printable(column) +
                                  "' has no numbers of ranked candidates");
  }
  return out;
}

std::optional<ScreeningEffects> screening_effects(const Screening& screening,
                                                  const std::vector<CandidateFigures>& ranking) {
  std::vector<std::size_t> candidates;
  std::vector<double> responses;
  for (const CandidateFigures& each : ranking) {
    if (!each.refusal.empty()) continue;
    candidates.push_back(each.candidate);
    responses.push_back(each.inefficiency);
  }
  if (candidates.empty()) return std::nullopt;
  const EffectFactors factors = effect_factors(screening.table, candidates);
  const auto found = factor_effects(factors.factors, responses, kEffectCoverage);
  if (!found) return std::nullopt;
  ScreeningEffects out;
  out.degrees_of_freedom = found->degrees_of_freedom;
  out.residual_standard_deviation = found->residual_standard_deviation;
  out.explained_share = found->explained_share;
  const auto header = [&](std::size_t factor) {
    return screening.table.headers[factors.columns[factor]];
  };
  for (const FactorEffect& each : found->effects) {
    const auto typed = [&](std::size_t position) {
      const std::string& cell =
          screening.table.cells[candidates[position]][factors.columns[each.factor]];
      if (!cell.empty()) return cell;
      return std::string(factors.factors[each.factor].words.empty() ? "base" : "(empty)");
    };
    out.effects.push_back(
        {header(each.factor), typed(each.from), typed(each.to), each.effect, each.low, each.high});
  }
  for (const auto& [factor, reason] : found->left_out) {
    out.left_out.push_back(left_out_text(header(factor), factors.factors[factor], reason));
  }
  return out;
}

std::string front_report(const Screening& screening, const std::vector<CandidateFigures>& ranking,
                         const ScreeningFront& front) {
  using Align = Table::Align;
  Sheet title;
  title.heading("Pareto front: least inefficiency and " +
                std::string(front.wants_most ? "most " : "least ") + front.column);
  Table table({{"candidate", "", Align::kLeft},
               {"inefficiency", "%", Align::kDecimal},
               {front.column, "", Align::kDecimal},
               {"rank", "", Align::kRight}});
  for (const std::size_t candidate : front.front) {
    const auto at = std::find_if(ranking.begin(), ranking.end(), [candidate](const auto& each) {
      return each.candidate == candidate;
    });
    table.add_row(
        {screening.table.names[candidate], fixed(at->inefficiency, effect_places(at->solver_error)),
         significant(front.values[candidate], 6), std::to_string(at - ranking.begin() + 1)});
  }
  Sheet note;
  note.remark("No other candidate has both a lower inefficiency and " +
              std::string(front.wants_most ? "more " : "less ") + front.column + ".");
  return title.text() + table.text() + note.text();
}

std::string effects_report(const ScreeningEffects& effects) {
  using Align = Table::Align;
  Sheet title;
  title.heading("Main effects on the mean inefficiency");
  Table table({{"column", "", Align::kLeft},
               {"from", "", Align::kDecimal},
               {"to", "", Align::kDecimal},
               {"effect", "%", Align::kDecimal},
               {"95 % interval", "%", Align::kRight},
               {"", "", Align::kLeft}});
  for (const ScreeningEffect& each : effects.effects) {
    const int places = effect_places(0.5 * (each.high - each.low));
    table.add_row({each.column, each.from, each.to, plus_text(each.effect, places),
                   plus_text(each.low, places) + " to " + plus_text(each.high, places),
                   each.low > 0 || each.high < 0 ? "" : "cannot be told from zero"});
  }
  Sheet note;
  note.remark("A linear model of all columns without interactions explains " +
              fixed(100 * effects.explained_share, 1) +
              " % of the variance; the rest scatters by " +
              significant(effects.residual_standard_deviation, 2) + " % (standard deviation, " +
              std::to_string(effects.degrees_of_freedom) +
              " degrees of freedom), and the intervals follow from that scatter by Student's t "
              "distribution.");
  if (!effects.left_out.empty()) {
    note.remark("Without an effect: " + joined(effects.left_out, ", ") + ".");
  }
  return title.text() + table.text() + note.text();
}

std::string front_json(const Screening& screening, const ScreeningFront& front) {
  std::string out;
  for (const std::size_t candidate : front.front) {
    out += std::string(out.empty() ? "" : ", ") +
           "{\"candidate\": " + json_quoted(screening.table.names[candidate]) +
           ", \"value\": " + json_number(front.values[candidate]) + "}";
  }
  return "{\"column\": " + json_quoted(front.column) +
         ", \"wants_most\": " + (front.wants_most ? "true" : "false") + ", \"candidates\": [" +
         out + "]}";
}

std::string effects_json(const ScreeningEffects& effects) {
  std::string out;
  for (const ScreeningEffect& each : effects.effects) {
    out += std::string(out.empty() ? "" : ",") +
           "\n      {\"column\": " + json_quoted(each.column) +
           ", \"from\": " + json_quoted(each.from) + ", \"to\": " + json_quoted(each.to) +
           ", \"effect_percent\": " + json_number(each.effect) +
           ", \"low_percent\": " + json_number(each.low) +
           ", \"high_percent\": " + json_number(each.high) + "}";
  }
  return "{\"explained_share\": " + json_number(effects.explained_share) +
         ", \"residual_standard_deviation_percent\": " +
         json_number(effects.residual_standard_deviation) +
         ", \"degrees_of_freedom\": " + std::to_string(effects.degrees_of_freedom) +
         ", \"effects\": [" + out + "]}";
}

}  // namespace tribodyn::client
