#include "client/cpp/report/candidate_decisions.h"

#include <vector>

#include "client/cpp/text/csv.h"
#include "client/cpp/text/table.h"
#include "client/cpp/text/text.h"

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

std::string reason_text(v1::ColumnWithoutEffect::Reason reason) {
  switch (reason) {
    case v1::ColumnWithoutEffect::CONSTANT:
      return "the same for all";
    case v1::ColumnWithoutEffect::TOO_MANY_TEXTS:
      return "too many different texts";
    default:
      return "follows from the columns before it";
  }
}

/// Returns what became of the candidates that are not in the table.
template <class Response>
std::string others_text(const Response& answer) {
  std::vector<std::string> out;
  const auto add = [&out](int count, const std::string& what) {
    if (count > 0) out.push_back(std::to_string(count) + " " + what);
  };
  add(answer.excluded(), "violate a constraint");
  add(answer.refused(), "have no such figure");
  add(answer.missing(), "are not computed yet");
  return out.empty() ? "" : "Of the other candidates " + joined(out, ", ") + ".";
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
  std::vector<Table::Column> columns = {
      {"rank", ""},
      {"candidate", ""},
      {"name", "", Align::kLeft},
      {figure_text(request.objective().figure()), "", Align::kDecimal},
      {"+/- inputs", "", Align::kDecimal},
      {"worse than the best", "%", Align::kDecimal},
      {"", "", Align::kLeft}};
  for (const v1::CandidateConstraint& each : request.constraints()) {
    columns.push_back({figure_text(each.figure()), "", Align::kDecimal});
  }
  Table table(columns);
  for (int i = 0; i < answer.candidates_size(); ++i) {
    const v1::RankedCandidate& each = answer.candidates(i);
    const v1::CandidateComparison& comparison = each.comparison();
    std::vector<std::string> cells = {std::to_string(i + 1), std::to_string(each.candidate()),
                                      each.label(), significant(each.value(), 6)};
    if (each.has_comparison()) {
      cells.insert(cells.end(), {significant(comparison.standard_uncertainty(), 2),
                                 fixed(100 * comparison.worse_probability(), 1),
                                 i == 0              ? "best"
                                 : comparison.tied() ? "tie"
                                                     : "worse"});
    } else {
      cells.insert(cells.end(), {"", "", ""});
    }
    for (const double value : each.constraint_values()) cells.push_back(significant(value, 5));
    table.add_row(std::move(cells));
  }
  std::vector<std::string> own(answer.own_uncertain_parameters().begin(),
                               answer.own_uncertain_parameters().end());
  std::vector<std::string> shared(answer.shared_uncertain_parameters().begin(),
                                  answer.shared_uncertain_parameters().end());
  return table.text() +
         remarks_text(
             {std::to_string(answer.candidates_size()) + " of " + std::to_string(answer.ranked()) +
                  " candidates.",
              others_text(answer),
              own.empty() && shared.empty()
                  ? "No parameter has an uncertainty: only the solver's errors make ties. "
                    "--uncertainty "
                    "PARAMETER=VALUE states one."
                  : (own.empty() ? ""
                                 : "Errors of each candidate alone: " + joined(own, ", ") + ". ") +
                        (shared.empty()
                             ? ""
                             : "Errors that all have in common: " + joined(shared, ", ") + ".")});
}

}  // namespace

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
      }
      return csv_text(rows);
    }
    case OutputFormat::kJson:
      break;
  }
  return json_text(answer);
}

std::string front_answer_text(const v1::FindParetoCandidatesRequest& request,
                              const v1::FindParetoCandidatesResponse& answer, OutputFormat format) {
  switch (format) {
    case OutputFormat::kTable: {
      using Align = Table::Align;
      Table table({{"candidate", ""},
                   {"name", "", Align::kLeft},
                   {figure_text(request.first().figure()), "", Align::kDecimal},
                   {figure_text(request.second().figure()), "", Align::kDecimal}});
      for (const v1::ParetoCandidate& each : answer.candidates()) {
        table.add_row({std::to_string(each.candidate()), each.label(),
                       significant(each.first_value(), 6), significant(each.second_value(), 6)});
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
      }
      return csv_text(rows);
    }
    case OutputFormat::kJson:
      break;
  }
  return json_text(answer);
}

std::string effects_answer_text(const v1::EstimateCandidateEffectsRequest& request,
                                const v1::EstimateCandidateEffectsResponse& answer,
                                OutputFormat format) {
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
             is_certain ? "" : "cannot be told from zero"});
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
      for (const v1::CandidateEffect& each : answer.effects()) {
        CsvRow& row = rows.emplace_back();
        append_fields(each, "", row);
      }
      return csv_text(rows);
    }
    case OutputFormat::kJson:
      break;
  }
  return json_text(answer);
}

}  // namespace tribodyn::client
