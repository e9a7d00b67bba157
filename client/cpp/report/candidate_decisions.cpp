#include "client/cpp/report/candidate_decisions.h"

#include <algorithm>
#include <map>
#include <vector>

#include "client/cpp/text/csv.h"
#include "client/cpp/text/table.h"
#include "client/cpp/text/text.h"
#include "client/cpp/text/warnings.h"

namespace tribodyn::client {
namespace {

std::string figure_text(const v1::CandidateFigure& figure) {
  std::string column =
      figure.column() + (figure.campaign().empty() ? "" : " of " + figure.campaign());
  switch (figure.aggregate()) {
    case v1::CandidateFigure::MINIMUM:
      return "least " + column;
    case v1::CandidateFigure::MAXIMUM:
      return "largest " + column;
    default:
      return column;
  }
}

/// Returns "a, b, c, d and 12 more", or "all candidates".
std::string names_text(std::vector<std::string> names, int all) {
  constexpr std::size_t kListed = 4;
  const std::size_t count = names.size();
  if (all > 1 && count == static_cast<std::size_t>(all)) return "all candidates";
  if (count > kListed) names.resize(kListed);
  return joined(names, ", ") +
         (count > kListed ? " and " + std::to_string(count - kListed) + " more" : "");
}

std::string name_or_number(const std::string& label, int candidate) {
  return label.empty() ? std::to_string(candidate) : label;
}

std::vector<v1::CandidateWarning> warnings_of_candidate(const v1::RankCandidatesResponse& answer,
                                                        int candidate) {
  std::vector<v1::CandidateWarning> out;
  for (const v1::CandidateWarning& each : answer.warnings()) {
    const auto& concerned = each.candidates();
    if (std::find(concerned.begin(), concerned.end(), candidate) != concerned.end()) {
      out.push_back(each);
    }
  }
  return out;
}

/// Returns "loses more" of a loss of which less is better, else "worse".
const char* worse_word(const v1::CandidateObjective& objective) {
  const std::string& column = objective.figure().column();
  const bool is_loss = column.starts_with("inefficiency") || column.starts_with("mesh_loss");
  return is_loss && !objective.wants_most() ? "loses more" : "worse";
}

/// Returns the verdict on a candidate: "the best", "cannot be told apart", `worse`, or why there is
/// no verdict.
std::string verdict_of(const v1::RankCandidatesResponse& answer, int place,
                       const std::string& worse) {
  const v1::RankedCandidate& each = answer.candidates(place);
  if (each.verdict_withheld()) {
    return withheld_text(withheld_by(warnings_of_candidate(answer, each.candidate())));
  }
  if (!each.has_comparison()) {
    return place < answer.compared() || answer.draws() == 0 ? "uncertainty not stated" : "";
  }
  if (place == 0) return "the best";
  return each.comparison().tied() ? "cannot be told apart" : worse;
}

/// Returns why candidates have no figure, those with the same reason together.
std::vector<std::string> refusal_remarks(const v1::RankCandidatesResponse& answer) {
  std::map<std::string, std::vector<std::string>> names;
  for (const v1::RefusedCandidate& each : answer.refused_candidates()) {
    names[each.refusal().message() + " [" + each.refusal().reason() + "]"].push_back(
        name_or_number(each.label(), each.candidate()));
  }
  std::vector<std::string> out;
  for (const auto& [why, whose] : names) {
    out.push_back("Without a figure: " + names_text(whose, 0) + ": " + why);
  }
  return out;
}

/// Adds cells with the warnings of a candidate that the ranking states.
void add_warning_cells(const v1::RankCandidatesResponse& ranking, int candidate, CsvRow& row) {
  const std::vector<v1::CandidateWarning> warnings = warnings_of_candidate(ranking, candidate);
  row.emplace_back("verdict_withheld", withheld_by(warnings).empty() ? "false" : "true");
  row.emplace_back("warnings", codes_of(warnings));
}

std::string collinear_text(const v1::CandidateEffect& effect) {
  return joined({effect.collinear_columns().begin(), effect.collinear_columns().end()}, ", ");
}

/// Returns what became of the candidates that are not in the table.
template <class Response>
std::string others_text(const Response& answer) {
  std::vector<std::string> out;
  const auto add = [&out](int count, const char* one, const char* several) {
    if (count > 0) out.push_back(std::to_string(count) + " " + (count == 1 ? one : several));
  };
  add(answer.excluded(), "violates a constraint", "violate a constraint");
  add(answer.refused(), "has no such figure", "have no such figure");
  add(answer.missing(), "is not computed yet", "are not computed yet");
  return out.empty() ? "" : "Of the other candidates, " + joined(out, ", ") + ".";
}

std::string remarks_text(const std::vector<std::string>& remarks) {
  Sheet sheet;
  for (const std::string& each : remarks) {
    if (!each.empty()) sheet.remark(each);
  }
  const std::string text = sheet.text();
  return text.empty() ? text : "\n" + text;
}

std::string ranking_answer_table(const v1::RankCandidatesRequest& request,
                                 const v1::RankCandidatesResponse& answer) {
  using Align = Table::Align;
  const std::string worse = worse_word(request.objective());
  std::vector<Table::Column> columns = {
      {"rank", ""},
      {"candidate", ""},
      {"name", "", Align::kLeft},
      {figure_text(request.objective().figure()), "", Align::kDecimal},
      {"std. uncertainty", "", Align::kDecimal},
      {"P(" + worse + ")", "%", Align::kDecimal},
      {"against the best", "", Align::kLeft}};
  for (const v1::CandidateConstraint& each : request.constraints()) {
    columns.push_back({figure_text(each.figure()), "", Align::kDecimal});
  }
  Table table(columns);
  for (int i = 0; i < answer.candidates_size(); ++i) {
    const v1::RankedCandidate& each = answer.candidates(i);
    const v1::CandidateComparison& comparison = each.comparison();
    std::vector<std::string> cells = {std::to_string(i + 1), std::to_string(each.candidate()),
                                      each.label(), significant(each.value(), 6)};
    const bool is_compared = each.has_comparison();
    cells.insert(cells.end(),
                 {is_compared ? significant(comparison.standard_uncertainty(), 2) : "",
                  is_compared && i > 0 ? fixed(100 * comparison.worse_probability(), 1) : "",
                  verdict_of(answer, i, worse)});
    for (const double value : each.constraint_values()) cells.push_back(significant(value, 5));
    table.add_row(std::move(cells));
  }
  std::vector<std::string> own(answer.own_uncertain_parameters().begin(),
                               answer.own_uncertain_parameters().end());
  std::vector<std::string> shared(answer.shared_uncertain_parameters().begin(),
                                  answer.shared_uncertain_parameters().end());
  std::vector<std::string> remarks = {
      "Shown: " +
          best_of_text(static_cast<std::size_t>(answer.candidates_size()),
                       static_cast<std::size_t>(answer.ranked()), " best") +
          ".",
      others_text(answer)};
  const bool is_all_withheld = answer.withheld() == answer.ranked();
  if (is_all_withheld && answer.ranked() > 0) {
    remarks.emplace_back("Every verdict is withheld.");
  } else if (answer.withheld() > 0) {
    remarks.push_back("Of those ranked, " + std::to_string(answer.withheld()) +
                      (answer.withheld() == 1 ? " has no verdict, because a warning withholds it; "
                                                "it stands last."
                                              : " have no verdict, because a warning withholds it; "
                                                "they stand last."));
  }
  for (std::string& each : refusal_remarks(answer)) remarks.push_back(std::move(each));
  remarks.push_back(own.empty() && shared.empty() && !is_all_withheld
                        ? "No parameter has an uncertainty: only the solver's errors make ties. "
                          "--uncertainty PARAMETER=VALUE states one."
                        : "");
  if (!own.empty()) remarks.push_back("Errors of each candidate alone: " + joined(own, ", ") + ".");
  if (!shared.empty()) {
    remarks.push_back("Errors that all have in common: " + joined(shared, ", ") + ".");
  }
  return table.text() + remarks_text(remarks) + ranking_notes(answer);
}

}  // namespace

const char* reason_text(v1::ColumnWithoutEffect::Reason reason) {
  switch (reason) {
    case v1::ColumnWithoutEffect::CONSTANT:
      return "the same for all";
    case v1::ColumnWithoutEffect::TOO_MANY_TEXTS:
      return "too many different texts";
    default:
      return "follows from the columns before it";
  }
}

std::string best_of_text(std::size_t shown, std::size_t all, const char* best) {
  const std::string count = std::to_string(all);
  if (all == 1) return count + " candidate";
  return shown == all ? "all " + count + " candidates"
                      : std::to_string(shown) + best + " of " + count + " candidates";
}

std::vector<ShownWarning> ranking_warnings(const v1::RankCandidatesResponse& answer) {
  std::map<int, std::string> names;
  for (const v1::RankedCandidate& each : answer.candidates()) {
    names[each.candidate()] = name_or_number(each.label(), each.candidate());
  }
  std::vector<ShownWarning> out;
  for (const v1::CandidateWarning& each : answer.warnings()) {
    std::vector<std::string> concerned;
    for (const int candidate : each.candidates()) {
      const auto known = names.find(candidate);
      concerned.push_back(known == names.end() ? std::to_string(candidate) : known->second);
    }
    out.push_back(shown_warning(each));
    out.back().where = names_text(concerned, answer.candidates_size()) +
                       (each.where().empty() ? "" : " " + each.where());
  }
  std::stable_sort(out.begin(), out.end(),
                   [](const auto& a, const auto& b) { return a.level > b.level; });
  return out;
}

std::string ranking_notes(const v1::RankCandidatesResponse& answer) {
  Sheet sheet;
  if (!answer.not_included().empty()) sheet.remark(answer.not_included());
  add_warnings(ranking_warnings(answer), sheet);
  return "\n" + sheet.text();
}

const char* usual_column(const v1::Campaign& campaign) {
  return campaign.has_rig() ? "traction_coefficient" : "inefficiency_energy_mean_percent";
}

std::string ranking_answer_text(const v1::RankCandidatesRequest& request,
                                const v1::RankCandidatesResponse& answer, OutputFormat format) {
  switch (format) {
    case OutputFormat::kTable:
      return ranking_answer_table(request, answer);
    case OutputFormat::kCsv: {
      std::vector<CsvRow> rows;
      for (const v1::RankedCandidate& each : answer.candidates()) {
        const bool is_compared = each.has_comparison();
        const v1::CandidateComparison& comparison = each.comparison();
        rows.push_back(
            {{"candidate", std::to_string(each.candidate())},
             {"label", each.label()},
             {"value", shortest(each.value())},
             {"solver_error", each.has_solver_error() ? shortest(each.solver_error()) : ""},
             {"standard_uncertainty",
              is_compared ? shortest(comparison.standard_uncertainty()) : ""},
             {"worse_probability", is_compared ? shortest(comparison.worse_probability()) : ""},
             {"tied", !is_compared        ? ""
                      : comparison.tied() ? "true"
                                          : "false"}});
        add_warning_cells(answer, each.candidate(), rows.back());
        rows.back().emplace_back("refusal", "");
      }
      for (const v1::RefusedCandidate& each : answer.refused_candidates()) {
        CsvRow& row = rows.emplace_back(
            CsvRow{{"candidate", std::to_string(each.candidate())}, {"label", each.label()}});
        for (const char* column : {"value", "solver_error", "standard_uncertainty",
                                   "worse_probability", "tied", "verdict_withheld", "warnings"}) {
          row.emplace_back(column, "");
        }
        row.emplace_back("refusal", each.refusal().reason() + ": " + each.refusal().message());
      }
      return csv_text(rows);
    }
    case OutputFormat::kJson:
      break;
  }
  return json_text(answer);
}

std::string front_answer_text(const v1::FindParetoCandidatesRequest& request,
                              const v1::FindParetoCandidatesResponse& answer,
                              const v1::RankCandidatesResponse& ranking, OutputFormat format) {
  switch (format) {
    case OutputFormat::kTable: {
      using Align = Table::Align;
      Table table({{"candidate", ""},
                   {"name", "", Align::kLeft},
                   {figure_text(request.first().figure()), "", Align::kDecimal},
                   {figure_text(request.second().figure()), "", Align::kDecimal},
                   {"", "", Align::kLeft}});
      for (const v1::ParetoCandidate& each : answer.candidates()) {
        const std::string withheld = withheld_by(warnings_of_candidate(ranking, each.candidate()));
        table.add_row({std::to_string(each.candidate()), each.label(),
                       significant(each.first_value(), 6), significant(each.second_value(), 6),
                       withheld.empty() ? "" : withheld_text(withheld)});
      }
      return table.text() + remarks_text({"No other candidate is better in both: these beat " +
                                              std::to_string(answer.beaten()) + " others.",
                                          others_text(answer)});
    }
    case OutputFormat::kCsv: {
      std::vector<CsvRow> rows;
      for (const v1::ParetoCandidate& each : answer.candidates()) {
        rows.push_back({{"candidate", std::to_string(each.candidate())},
                        {"label", each.label()},
                        {"first_value", shortest(each.first_value())},
                        {"second_value", shortest(each.second_value())}});
        add_warning_cells(ranking, each.candidate(), rows.back());
      }
      return csv_text(rows);
    }
    case OutputFormat::kJson:
      break;
  }
  return json_with(json_text(answer), "warnings", warnings_json(ranking_warnings(ranking)));
}

std::string effects_answer_text(const v1::EstimateCandidateEffectsRequest& request,
                                const v1::EstimateCandidateEffectsResponse& answer,
                                const v1::RankCandidatesResponse& ranking, OutputFormat format) {
  switch (format) {
    case OutputFormat::kTable: {
      using Align = Table::Align;
      Table table({{"column", "", Align::kLeft},
                   {"from candidate", ""},
                   {"to candidate", ""},
                   {"effect", "", Align::kDecimal},
                   {"interval", "", Align::kRight},
                   {"", "", Align::kLeft}});
      for (const v1::CandidateEffect& each : answer.effects()) {
        const bool is_certain = each.effect_minimum() > 0 || each.effect_maximum() < 0;
        table.add_row(
            {each.column(), std::to_string(each.from_candidate()),
             std::to_string(each.to_candidate()), significant(each.effect(), 4),
             significant(each.effect_minimum(), 3) + " to " + significant(each.effect_maximum(), 3),
             std::string(is_certain ? "" : "cannot be told from zero") +
                 (is_certain || each.collinear_columns().empty() ? "" : "; ") +
                 (each.collinear_columns().empty()
                      ? ""
                      : "cannot be separated from " + collinear_text(each))});
      }
      std::vector<std::string> left_out;
      for (const v1::ColumnWithoutEffect& each : answer.left_out()) {
        left_out.push_back(each.column() + " (" + reason_text(each.reason()) + ")");
      }
      return table.text() +
             remarks_text(
                 {"Effects on " + figure_text(request.figure()) + " over " +
                      std::to_string(answer.candidates()) +
                      " candidates. A linear model without interactions explains " +
                      fixed(100 * answer.explained_share(), 1) + " % of the variance.",
                  left_out.empty() ? "" : "Without an effect: " + joined(left_out, ", ") + ".",
                  others_text(answer)});
    }
    case OutputFormat::kCsv: {
      std::vector<CsvRow> rows;
      for (v1::CandidateEffect each : answer.effects()) {
        const std::string collinear = collinear_text(each);
        each.clear_collinear_columns();
        CsvRow& row = rows.emplace_back();
        append_fields(each, "", row);
        row.back() = {"collinear_columns", collinear};
        row.emplace_back("warnings", codes_of(ranking.warnings()));
      }
      return csv_text(rows);
    }
    case OutputFormat::kJson:
      break;
  }
  return json_with(json_text(answer), "warnings", warnings_json(ranking_warnings(ranking)));
}

}  // namespace tribodyn::client
