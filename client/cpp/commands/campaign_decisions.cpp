#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "client/cpp/commands/candidate_flags.h"
#include "client/cpp/commands/command.h"
#include "client/cpp/report/candidate_decisions.h"
#include "client/cpp/text/text.h"

namespace tribodyn::client {
namespace {

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
                     "with :mean, :min or :max over the conditions, e.g. film_ratio_minimum:min; "
                     "of another campaign with the same candidates with its number, e.g. "
                     "13/traction_coefficient.");
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

/// Names the column of a figure without one: that of its campaign.
void name_figure_column(Connection& connection, const std::string& campaign,
                        v1::CandidateFigure& figure) {
  if (!figure.column().empty()) return;
  const std::string& name = figure.campaign().empty() ? campaign : figure.campaign();
  figure.set_column(usual_column(connection.get_campaign(name)));
}

template <class Request>
void set_selection(const DecisionFlags& flags, Request& request) {
  request.set_name(flags.campaign);
  *request.mutable_constraints() = {flags.constraints.begin(), flags.constraints.end()};
  *request.mutable_condition_weights() = {flags.weights.begin(), flags.weights.end()};
}

int run_rank(DecisionFlags& flags, const CommonOptions& options) {
  v1::RankCandidatesRequest request;
  set_selection(flags, request);
  if (!flags.objectives.empty()) *request.mutable_objective() = flags.objectives.front();
  request.set_count(flags.count);
  request.set_confidence(flags.confidence);
  request.set_ignore_stated_uncertainties(flags.leaves_out_stated);
  *request.mutable_uncertainties() = {flags.uncertainties.begin(), flags.uncertainties.end()};
  Connection connection = options.connect();
  name_figure_column(connection, request.name(), *request.mutable_objective()->mutable_figure());
  const v1::RankCandidatesResponse answer = connection.rank_candidates(request);
  std::cout << ranking_answer_text(request, answer, options.output_format);
  return answer.candidates().empty() ? kExitFailed : kExitOk;
}

int run_pareto(DecisionFlags& flags, const CommonOptions& options) {
  v1::FindParetoCandidatesRequest request;
  set_selection(flags, request);
  *request.mutable_second() = flags.objectives.back();
  if (flags.objectives.size() == 2) *request.mutable_first() = flags.objectives.front();
  Connection connection = options.connect();
  name_figure_column(connection, request.name(), *request.mutable_first()->mutable_figure());
  name_figure_column(connection, request.name(), *request.mutable_second()->mutable_figure());
  const v1::FindParetoCandidatesResponse answer = connection.find_pareto_candidates(request);
  std::cout << front_answer_text(request, answer, options.output_format);
  return answer.candidates().empty() ? kExitFailed : kExitOk;
}

int run_effects(DecisionFlags& flags, const CommonOptions& options) {
  v1::EstimateCandidateEffectsRequest request;
  set_selection(flags, request);
  *request.mutable_figure() = flags.figure;
  *request.mutable_columns() = {flags.columns.begin(), flags.columns.end()};
  request.set_coverage(flags.confidence);
  Connection connection = options.connect();
  name_figure_column(connection, request.name(), *request.mutable_figure());
  const v1::EstimateCandidateEffectsResponse answer =
      connection.estimate_candidate_effects(request);
  std::cout << effects_answer_text(request, answer, options.output_format);
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
      "Without --least or --most the mean inefficiency counts, of a rig the traction coefficient.",
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
      "mean inefficiency, of a rig beside the traction coefficient, of which less is better.",
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
      command.flags.raw("--figure", "FIGURE",
                        "The figure. Default: the mean inefficiency, of a rig the traction "
                        "coefficient.");
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
