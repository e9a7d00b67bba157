#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "client/cpp/commands/candidate_flags.h"
#include "client/cpp/commands/command.h"
#include "client/cpp/text/csv.h"
#include "client/cpp/text/table.h"
#include "client/cpp/text/text.h"

namespace tribodyn::client {
namespace {

constexpr char kUsualColumn[] = "inefficiency_energy_mean_percent";

struct DecisionFlags {
  std::string campaign;
  std::vector<v1::CandidateObjective> objectives;
  v1::CandidateFigure figure;
  std::vector<v1::CandidateConstraint> constraints;
  std::vector<v1::ParameterUncertainty> uncertainties;
  std::vector<double> weights;
  std::vector<std::string> columns;
  int count = 20;
  double confidence = 0.95;
  bool leaves_out_stated = false;
  v1::PromoteCandidateRequest promotion;
  bool has_candidate = false;
};

using Flags = std::shared_ptr<DecisionFlags>;

Command decision_command(const char* path, const char* summary, const char* about,
                         const char* example, int (*run)(DecisionFlags&, const CommonOptions&),
                         const Flags& flags) {
  Command command{path, summary, about, {example}, {}, {}, {}};
  command.flags.group("Arguments");
  command.flags
      .text(
          "name", "NAME", "The campaign, e.g. 12 or campaigns/12 (`tribodyn campaigns list`).",
          [flags](const std::string& name) { flags->campaign = resource_name("campaigns", name); })
      .collection = "campaigns";
  command.check = [flags](Complaints& complaints) {
    if (flags->campaign.empty()) {
      complaints.emplace_back("NAME is missing; `tribodyn campaigns list` shows the campaigns");
    }
  };
  command.run = [flags, run](const CommonOptions& options) { return run(*flags, options); };
  return command;
}

/// Adds --where and --weights.
void add_selection_flags(FlagList& list, const Flags& flags) {
  Flag& where = list.raw("--where", "FIGURE>=VALUE",
                         "What a candidate must keep, e.g. film_ratio_minimum:min>=0.8 or cost<=3, "
                         "in the unit of the column; repeatable.");
  where.is_repeatable = true;
  where.read = [flags](const std::vector<std::string>& texts, Complaints& complaints) {
    for (const std::string& text : texts) {
      read_candidate_constraint("--where", text, flags->constraints, complaints);
    }
  };
  list.numbers("--weights", {"-", "above 0", "those of the campaign"},
               "Weights of the conditions in means, one for each",
               [flags](double value) { flags->weights.push_back(value); });
}

/// Adds --least and --most.
void add_objective_flags(FlagList& list, const Flags& flags) {
  for (const bool wants_most : {false, true}) {
    const std::string name = wants_most ? "--most" : "--least";
    Flag& flag = list.raw(
        name, "FIGURE",
        wants_most ? "A figure of which more is better."
                   : "A figure of which less is better: a column of `campaigns columns`, alone or "
                     "with :mean, :min or :max over the conditions, e.g. film_ratio_minimum:min.");
    flag.is_repeatable = true;
    flag.read = [flags, wants_most, name](const std::vector<std::string>& texts,
                                          Complaints& complaints) {
      for (const std::string& text : texts) {
        v1::CandidateObjective& objective = flags->objectives.emplace_back();
        objective.set_wants_most(wants_most);
        read_candidate_figure(name, text, *objective.mutable_figure(), complaints);
      }
    };
  }
}

template <class Request>
void set_selection(const DecisionFlags& flags, Request& request) {
  request.set_name(flags.campaign);
  *request.mutable_constraints() = {flags.constraints.begin(), flags.constraints.end()};
  *request.mutable_condition_weights() = {flags.weights.begin(), flags.weights.end()};
}

std::string figure_text(const v1::CandidateFigure& figure) {
  std::string column = figure.column().empty() ? kUsualColumn : figure.column();
  switch (figure.aggregate()) {
    case v1::CandidateFigure::MINIMUM:
      return "least " + column;
    case v1::CandidateFigure::MAXIMUM:
      return "largest " + column;
    default:
      return column;
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

void print_sheet(const std::vector<std::string>& remarks) {
  Sheet sheet;
  for (const std::string& each : remarks) {
    if (!each.empty()) sheet.remark(each);
  }
  const std::string text = sheet.text();
  if (!text.empty()) std::cout << "\n" << text;
}

void print_ranking(const v1::RankCandidatesRequest& request,
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
  std::cout << table.text();
  std::vector<std::string> own(answer.own_uncertain_parameters().begin(),
                               answer.own_uncertain_parameters().end());
  std::vector<std::string> shared(answer.shared_uncertain_parameters().begin(),
                                  answer.shared_uncertain_parameters().end());
  print_sheet(
      {std::to_string(answer.candidates_size()) + " of " + std::to_string(answer.ranked()) +
           " candidates.",
       others_text(answer),
       own.empty() && shared.empty()
           ? "No parameter has an uncertainty: only the solver's errors make ties. --uncertainty "
             "PARAMETER=VALUE states one."
           : (own.empty() ? "" : "Errors of each candidate alone: " + joined(own, ", ") + ". ") +
                 (shared.empty()
                      ? ""
                      : "Errors that all have in common: " + joined(shared, ", ") + ".")});
}

int run_rank(DecisionFlags& flags, const CommonOptions& options) {
  v1::RankCandidatesRequest request;
  set_selection(flags, request);
  if (!flags.objectives.empty()) *request.mutable_objective() = flags.objectives.front();
  request.set_count(flags.count);
  request.set_confidence(flags.confidence);
  request.set_ignore_stated_uncertainties(flags.leaves_out_stated);
  *request.mutable_uncertainties() = {flags.uncertainties.begin(), flags.uncertainties.end()};
  const v1::RankCandidatesResponse answer = options.connect().rank_candidates(request);
  switch (options.output_format) {
    case OutputFormat::kTable:
      print_ranking(request, answer);
      break;
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
      std::cout << csv_text(rows);
      break;
    }
    case OutputFormat::kJson:
      std::cout << json_text(answer);
  }
  return answer.candidates().empty() ? kExitFailed : kExitOk;
}

int run_pareto(DecisionFlags& flags, const CommonOptions& options) {
  v1::FindParetoCandidatesRequest request;
  set_selection(flags, request);
  *request.mutable_second() = flags.objectives.back();
  if (flags.objectives.size() == 2) *request.mutable_first() = flags.objectives.front();
  const v1::FindParetoCandidatesResponse answer = options.connect().find_pareto_candidates(request);
  switch (options.output_format) {
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
      std::cout << table.text();
      print_sheet({"No other candidate is better in both: these beat " +
                       std::to_string(answer.beaten()) + " others.",
                   others_text(answer)});
      break;
    }
    case OutputFormat::kCsv: {
      std::vector<CsvRow> rows;
      for (const v1::ParetoCandidate& each : answer.candidates()) {
        rows.push_back({{"candidate", std::to_string(each.candidate())},
                        {"label", each.label()},
                        {"first_value", shortest(each.first_value())},
                        {"second_value", shortest(each.second_value())}});
      }
      std::cout << csv_text(rows);
      break;
    }
    case OutputFormat::kJson:
      std::cout << json_text(answer);
  }
  return answer.candidates().empty() ? kExitFailed : kExitOk;
}

int run_effects(DecisionFlags& flags, const CommonOptions& options) {
  v1::EstimateCandidateEffectsRequest request;
  set_selection(flags, request);
  *request.mutable_figure() = flags.figure;
  *request.mutable_columns() = {flags.columns.begin(), flags.columns.end()};
  request.set_coverage(flags.confidence);
  const v1::EstimateCandidateEffectsResponse answer =
      options.connect().estimate_candidate_effects(request);
  switch (options.output_format) {
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
      std::cout << table.text();
      std::vector<std::string> left_out;
      for (const v1::ColumnWithoutEffect& each : answer.left_out()) {
        left_out.push_back(each.column() + " (" +
                           v1::ColumnWithoutEffect::Reason_Name(each.reason()) + ")");
      }
      print_sheet({"Effects on " + figure_text(request.figure()) + " over " +
                       std::to_string(answer.candidates()) +
                       " candidates. A linear model without interactions explains " +
                       fixed(100 * answer.explained_share(), 1) + " % of the variance.",
                   left_out.empty() ? "" : "Without an effect: " + joined(left_out, ", ") + ".",
                   others_text(answer)});
      break;
    }
    case OutputFormat::kCsv: {
      std::vector<CsvRow> rows;
      for (const v1::CandidateEffect& each : answer.effects()) {
        CsvRow& row = rows.emplace_back();
        append_fields(each, "", row);
      }
      std::cout << csv_text(rows);
      break;
    }
    case OutputFormat::kJson:
      std::cout << json_text(answer);
  }
  return kExitOk;
}

int run_promote(DecisionFlags& flags, const CommonOptions& options) {
  flags.promotion.set_name(flags.campaign);
  const v1::PromoteCandidateResponse answer = options.connect().promote_candidate(flags.promotion);
  if (options.output_format == OutputFormat::kJson) {
    std::cout << json_text(answer);
    return kExitOk;
  }
  const char* verb = flags.promotion.validate_only() ? "would create " : "created ";
  if (answer.has_lubricant()) std::cout << verb << printable(answer.lubricant().name()) << "\n";
  if (answer.has_surface()) std::cout << verb << printable(answer.surface().name()) << "\n";
  return kExitOk;
}

Command rank_command() {
  const auto flags = std::make_shared<DecisionFlags>();
  Command command = decision_command(
      "campaigns rank", "rank the candidates of a campaign",
      "Prints the best candidates of a campaign, finished or not, and which of them cannot be told "
      "apart from the best one, by the stated uncertainties of parameters and the solver's errors. "
      "Without --least or --most the mean inefficiency counts.",
      "tribodyn campaigns rank 12 --where film_ratio_minimum:min>=0.8 --uncertainty "
      "pressure-viscosity=3%",
      run_rank, flags);
  command.flags.group("Options");
  add_objective_flags(command.flags, flags);
  add_selection_flags(command.flags, flags);
  command.flags.whole_number("--count,-n", {"candidates", "1 to 1000", "20"},
                             "Candidates that are listed",
                             [flags](int value) { flags->count = value; });
  add_uncertainty_flag(command.flags, flags->uncertainties);
  command.flags.number("--confidence", {"-", "0.5 to 0.9999", "0.95"},
                       "Probability from which on a candidate is worse than the best one; others "
                       "are ties",
                       [flags](double value) { flags->confidence = value; });
  command.flags.toggle("--no-stated-uncertainty",
                       "Leave out the uncertainties that lubricant and surface state.",
                       [flags] { flags->leaves_out_stated = true; });
  const auto check = command.check;
  command.check = [flags, check](Complaints& complaints) {
    check(complaints);
    if (flags->objectives.size() > 1) {
      complaints.emplace_back("give one --least or --most; `campaigns pareto` takes two");
    }
  };
  return command;
}

Command pareto_command() {
  const auto flags = std::make_shared<DecisionFlags>();
  Command command = decision_command(
      "campaigns pareto", "find the candidates that no other one beats in two figures",
      "Prints the Pareto front of a campaign, finished or not. One figure alone stands beside the "
      "mean inefficiency, of which less is better.",
      "tribodyn campaigns pareto 12 --most film_ratio_minimum:min", run_pareto, flags);
  command.flags.group("Options");
  add_objective_flags(command.flags, flags);
  add_selection_flags(command.flags, flags);
  const auto check = command.check;
  command.check = [flags, check](Complaints& complaints) {
    check(complaints);
    if (flags->objectives.empty() || flags->objectives.size() > 2) {
      complaints.emplace_back("give one or two of --least FIGURE and --most FIGURE");
    }
  };
  return command;
}

Command effects_command() {
  const auto flags = std::make_shared<DecisionFlags>();
  Command command = decision_command(
      "campaigns effects", "estimate what columns of the candidates do to a figure",
      "Prints the main effects of parameters and of columns that ride along, such as the "
      "concentration of an additive, on a figure, with their intervals: from the lowest value to "
      "the highest one, or from the most frequent text to another one.",
      "tribodyn campaigns effects 12", run_effects, flags);
  command.examples.emplace_back(
      "tribodyn campaigns effects 12 --figure film_ratio_minimum:min --columns concentration");
  command.flags.group("Options");
  Flag& figure =
      command.flags.raw("--figure", "FIGURE", "The figure. Default: the mean inefficiency.");
  figure.read = [flags](const std::vector<std::string>& texts, Complaints& complaints) {
    read_candidate_figure("--figure", texts.back(), flags->figure, complaints);
  };
  command.flags.texts("--columns", "NAME",
                      "Columns of the candidates, separated by commas. Default: all.",
                      [flags](const std::string& name) { flags->columns.push_back(name); });
  add_selection_flags(command.flags, flags);
  command.flags.number("--coverage", {"-", "0.5 to 0.9999", "0.95"}, "Probability of the intervals",
                       [flags](double value) { flags->confidence = value; });
  return command;
}

Command promote_command() {
  const auto flags = std::make_shared<DecisionFlags>();
  Command command = decision_command(
      "campaigns promote", "make a candidate a lubricant",
      "Makes a candidate of a campaign a lubricant, and a surface where candidates have surface "
      "parameters of their own. They have the numbers with which the campaign computed; their "
      "provenance names campaign, candidate and base.",
      "tribodyn campaigns promote 12 --candidate 3 --lubricant best-oil --surface best-film",
      run_promote, flags);
  command.flags.group("Options");
  command.flags.whole_number("--candidate", {"-", "0 to the last one"},
                             "Number of the candidate, as `campaigns rank` prints it",
                             [flags](int value) {
                               flags->promotion.set_candidate(value);
                               flags->has_candidate = true;
                             });
  command.flags.text("--lubricant", "ID", "Id of the new lubricant.",
                     [flags](const std::string& id) { flags->promotion.set_lubricant_id(id); });
  command.flags.text("--surface", "ID",
                     "Id of the new surface, where candidates have surface parameters.",
                     [flags](const std::string& id) { flags->promotion.set_surface_id(id); });
  command.flags.text("--title", "TEXT", "Name for people. Default: that of the candidate.",
                     [flags](const std::string& text) { flags->promotion.set_display_name(text); });
  command.flags.toggle("--validate-only", "Check everything and show the outcome; write nothing.",
                       [flags] { flags->promotion.set_validate_only(true); });
  const auto check = command.check;
  command.check = [flags, check](Complaints& complaints) {
    check(complaints);
    if (!flags->has_candidate) complaints.emplace_back("--candidate is missing");
  };
  return command;
}

}  // namespace

std::vector<Command> campaign_decision_commands() {
  std::vector<Command> out;
  out.push_back(rank_command());
  out.push_back(pareto_command());
  out.push_back(effects_command());
  out.push_back(promote_command());
  return out;
}

}  // namespace tribodyn::client
