#include "client/cpp/report/screening_decisions.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include "client/cpp/failure.h"
#include "client/cpp/report/candidate_decisions.h"
#include "client/cpp/text/nearest.h"
#include "client/cpp/text/table.h"
#include "client/cpp/text/text.h"
#include "client/cpp/text/units.h"
#include "core/decisions/pareto_front.h"

namespace tribodyn::client {
namespace {

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
  out.draws = answer.draws();
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
  if (std::none_of(out.of.begin(), out.of.end(),
                   [](const auto& each) { return each.has_value(); })) {
    out.of.clear();
    out.is_not_stated = answer.compared() > 0;
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

void set_warnings(const std::vector<std::size_t>& candidates,
                  const v1::RankCandidatesResponse& answer, Screening& screening) {
  screening.warnings = ranking_warnings(answer);
  for (const v1::CandidateWarning& each : answer.warnings()) {
    for (const int candidate : each.candidates()) {
      screening.warnings_of[candidates.at(static_cast<std::size_t>(candidate))].push_back(
          shown_warning(each));
    }
  }
  for (const v1::PointWarning& each : screening.base.warnings()) {
    const bool is_known =
        std::any_of(screening.warnings.begin(), screening.warnings.end(),
                    [&each](const ShownWarning& other) { return other.code == each.code(); });
    if (is_known) continue;
    screening.warnings.push_back(shown_warning(each));
    screening.warnings.back().where = "the base";
  }
}

ScreeningEffects screening_effects(const Screening& screening,
                                   const std::vector<std::size_t>& candidates,
                                   const v1::EstimateCandidateEffectsResponse& answer) {
  const CandidateTable& table = screening.table;
  const auto parameter = [&table](const std::string& path) {
    return std::find_if(table.parameters.begin(), table.parameters.end(),
                        [&path](const auto& each) { return each.path() == path; });
  };
  const auto header = [&](const std::string& path) {
    const auto found = parameter(path);
    return found != table.parameters.end() && found->column ? table.headers[*found->column] : path;
  };
  const auto typed = [&](const std::string& path, int number) {
    const auto found = parameter(path);
    const std::size_t candidate = candidates.at(static_cast<std::size_t>(number));
    if (found == table.parameters.end()) return table.names[candidate];
    const std::string cell = found->column ? table.cells[candidate][*found->column] : "";
    return cell.empty() ? significant(found->values[candidate]) : cell;
  };
  ScreeningEffects out;
  out.degrees_of_freedom = answer.degrees_of_freedom();
  out.residual_standard_deviation = answer.residual_standard_deviation_value();
  out.explained_share = answer.explained_share();
  for (const v1::CandidateEffect& each : answer.effects()) {
    ScreeningEffect& effect =
        out.effects.emplace_back(ScreeningEffect{header(each.column()),
                                                 typed(each.column(), each.from_candidate()),
                                                 typed(each.column(), each.to_candidate()),
                                                 each.effect(),
                                                 each.effect_minimum(),
                                                 each.effect_maximum(),
                                                 {}});
    for (const std::string& other : each.collinear_columns()) {
      effect.collinear.push_back(header(other));
    }
  }
  for (const v1::ColumnWithoutEffect& each : answer.left_out()) {
    out.left_out.push_back(header(each.column()) + " (" + reason_text(each.reason()) + ")");
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
               {"rank", "", Align::kRight},
               {"", "", Align::kLeft}});
  for (const std::size_t candidate : front.front) {
    const auto at = std::find_if(ranking.begin(), ranking.end(), [candidate](const auto& each) {
      return each.candidate == candidate;
    });
    table.add_row(
        {screening.table.names[candidate], fixed(at->inefficiency, effect_places(at->solver_error)),
         significant(front.values[candidate], 6), std::to_string(at - ranking.begin() + 1),
         at->is_withheld ? "verdict withheld" : ""});
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
    const bool is_clear = each.low > 0 || each.high < 0;
    table.add_row({each.column, each.from, each.to, plus_text(each.effect, places),
                   plus_text(each.low, places) + " to " + plus_text(each.high, places),
                   std::string(is_clear ? "" : "cannot be told from zero") +
                       (is_clear || each.collinear.empty() ? "" : "; ") +
                       (each.collinear.empty()
                            ? ""
                            : "cannot be separated from " + joined(each.collinear, ", "))});
  }
  Sheet note;
  note.remark("A linear model of the parameters without interactions explains " +
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
           ", \"high_percent\": " + json_number(each.high) +
           ", \"collinear_columns\": " + json_quoted(joined(each.collinear, ", ")) + "}";
  }
  return "{\"explained_share\": " + json_number(effects.explained_share) +
         ", \"residual_standard_deviation_percent\": " +
         json_number(effects.residual_standard_deviation) +
         ", \"degrees_of_freedom\": " + std::to_string(effects.degrees_of_freedom) +
         ", \"effects\": [" + out + "]}";
}

}  // namespace tribodyn::client
