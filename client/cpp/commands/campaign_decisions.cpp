#include <iostream>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

#include "client/cpp/commands/campaign_command.h"
#include "client/cpp/commands/candidate_flags.h"
#include "client/cpp/commands/flag_errors.h"
#include "client/cpp/report/candidate_decisions.h"
#include "client/cpp/service/screening_campaign.h"
#include "client/cpp/text/text.h"

namespace tribodyn::client {
namespace {

/// An objective with the flag that states it.
struct TypedObjective {
  v1::CandidateObjective objective;
  TypedFlag flag;
};

/// What the decisions between candidates have in common.
template <class Request>
struct DecisionFlags {
  Request request;  ///< all but the name of the campaign and the objectives
  std::string campaign;
  std::vector<TypedObjective> objectives;  ///< --least and --most, as given
};

/// Adds --where and --weights.
template <class Request>
void add_selection_flags(FlagList& list, Request& request) {
  Flag& where = list.raw("--where", "FIGURE>=VALUE",
                         "What a candidate must keep, e.g. film_ratio_minimum:min>=0.8 or cost<=3, "
                         "in the unit of the column; repeatable.");
  where.is_repeatable = true;
  where.field = "constraints";
  where.read = [&request](const std::vector<std::string>& texts, Complaints& complaints) {
    std::vector<v1::CandidateConstraint> constraints;
    for (const std::string& text : texts) {
      read_candidate_constraint("--where", text, constraints, complaints);
    }
    *request.mutable_constraints() = {constraints.begin(), constraints.end()};
  };
  list.numbers("--weights", {"-", "above 0", "those of the campaign"},
               "Weights of the conditions in means, one for each",
               [&request](double value) { request.add_condition_weights(value); })
      .field = "condition_weights";
}

/// Adds --least and --most.
void add_objective_flags(FlagList& list, std::vector<TypedObjective>& objectives) {
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
    flag.field = "objective";
    flag.read = [&objectives, wants_most, name](const std::vector<std::string>& texts,
                                                Complaints& complaints) {
      for (const std::string& text : texts) {
        TypedObjective& added = objectives.emplace_back();
        added.flag = {name, {text}, ""};
        added.objective.set_wants_most(wants_most);
        read_candidate_figure(name, text, *added.objective.mutable_figure(), complaints);
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

/// A decision of the server: the figures of its request, the call, and the text of its answer,
/// which has the warnings of a ranking.
template <class Request, class Response>
struct Decision {
  std::vector<v1::CandidateFigure*> (*figures)(Request&);
  Response (Connection::*decide)(const Request&);
  std::string (*text)(const Request&, const Response&, const v1::RankCandidatesResponse&,
                      OutputFormat);
};

/// Makes the call and prints the answer, which it returns.
template <class Request, class Response>
Response decided(const Decision<Request, Response>& decision, const std::string& campaign,
                 Request& request, const CommonOptions& options) {
  request.set_name(campaign);
  Connection connection = options.connect();
  for (v1::CandidateFigure* figure : decision.figures(request)) {
    name_figure_column(connection, campaign, *figure);
  }
  Response answer = (connection.*decision.decide)(request);
  v1::RankCandidatesResponse ranking;
  if constexpr (!std::is_same_v<Response, v1::RankCandidatesResponse>) {
    v1::RankCandidatesRequest wanted;
    wanted.set_name(campaign);
    *wanted.mutable_objective()->mutable_figure() = *decision.figures(request).front();
    *wanted.mutable_constraints() = request.constraints();
    *wanted.mutable_condition_weights() = request.condition_weights();
    ranking = figures_ranking(connection, wanted);
  }
  std::cout << decision.text(request, answer, ranking, options.output_format);
  const bool has_notes = ranking.ranked() > 0 && options.output_format == OutputFormat::kTable;
  if (has_notes) std::cout << ranking_notes(ranking);
  return answer;
}

Command rank_command() {
  using Request = v1::RankCandidatesRequest;
  const auto flags = std::make_shared<DecisionFlags<Request>>();
  Command command = one_campaign_command(
      {"campaigns rank", "rank the candidates of a campaign",
       "Prints the best candidates of a campaign, finished or not, and which of them cannot be "
       "told apart from the best one, by the stated uncertainties of parameters and the solver's "
       "errors. Without --least or --most the mean inefficiency counts, of a rig the traction "
       "coefficient.",
       "tribodyn campaigns rank 12 --where film_ratio_minimum:min>=0.8 --uncertainty "
       "pressure-viscosity=3%"},
      flags->campaign);
  command.flags.group("Options");
  Request& request = flags->request;
  request.set_count(20);
  request.set_confidence(0.95);
  add_objective_flags(command.flags, flags->objectives);
  add_selection_flags(command.flags, request);
  command.flags.whole_number(
      "--count,-n", {"candidates", "0 to 100000", "20"}, "Candidates that are listed; 0 = all",
      [&request](int value) { request.set_count(value == 0 ? kMostCandidates : value); });
  const auto uncertainties = std::make_shared<std::vector<v1::ParameterUncertainty>>();
  add_uncertainty_flag(command.flags, *uncertainties);
  command.flags.number("--confidence", {"-", "0.5 to 0.9999", "0.95"},
                       "Candidates are tied with the best one if this interval of the difference "
                       "holds 0",
                       [&request](double value) { request.set_confidence(value); });
  command.flags.toggle("--no-stated-uncertainty",
                       "Leave out the uncertainties that lubricant and surface state.",
                       [&request] { request.set_ignore_stated_uncertainties(true); });
  add_check(command, [flags](Complaints& complaints) {
    const int count = flags->request.count();
    if (count < 1 || count > kMostCandidates) {
      complaints.push_back("--count = " + std::to_string(count) + "; allowed: 0 to 100000");
    }
    if (flags->objectives.size() > 1) {
      complaints.emplace_back("give one --least or --most; `campaigns pareto` takes two");
    }
  });
  command.run = [flags, uncertainties](const CommonOptions& options) {
    static constexpr Decision<Request, v1::RankCandidatesResponse> kDecision{
        [](Request& wanted) { return std::vector{wanted.mutable_objective()->mutable_figure()}; },
        &Connection::rank_candidates,
        [](const Request& asked, const v1::RankCandidatesResponse& answer,
           const v1::RankCandidatesResponse&,
           OutputFormat format) { return ranking_answer_text(asked, answer, format); }};
    Request& wanted = flags->request;
    *wanted.mutable_uncertainties() = {uncertainties->begin(), uncertainties->end()};
    if (!flags->objectives.empty()) {
      *wanted.mutable_objective() = flags->objectives.front().objective;
    }
    const auto answer = decided(kDecision, flags->campaign, wanted, options);
    return answer.candidates().empty() ? kExitFailed : kExitOk;
  };
  return command;
}

Command pareto_command() {
  using Request = v1::FindParetoCandidatesRequest;
  const auto flags = std::make_shared<DecisionFlags<Request>>();
  Command command = one_campaign_command(
      {"campaigns pareto", "find the candidates that no other one beats in two figures",
       "Prints the Pareto front of a campaign, finished or not. One figure alone stands beside the "
       "mean inefficiency, of a rig beside the traction coefficient, of which less is better.",
       "tribodyn campaigns pareto 12 --most film_ratio_minimum:min"},
      flags->campaign);
  command.flags.group("Options");
  add_objective_flags(command.flags, flags->objectives);
  add_selection_flags(command.flags, flags->request);
  add_check(command, [flags](Complaints& complaints) {
    if (flags->objectives.empty() || flags->objectives.size() > 2) {
      complaints.emplace_back("give one or two of --least FIGURE and --most FIGURE");
    }
  });
  command.run = [flags](const CommonOptions& options) {
    static constexpr Decision<Request, v1::FindParetoCandidatesResponse> kDecision{
        [](Request& wanted) {
          return std::vector{wanted.mutable_first()->mutable_figure(),
                             wanted.mutable_second()->mutable_figure()};
        },
        &Connection::find_pareto_candidates, front_answer_text};
    Request& wanted = flags->request;
    // Either flag may state either objective: the fields have no flag of their own.
    TypedFlags typed;
    const auto state = [&typed](const TypedObjective& stated, const std::string& field,
                                v1::CandidateObjective& objective) {
      objective = stated.objective;
      typed[field] = stated.flag;
    };
    state(flags->objectives.back(), "second", *wanted.mutable_second());
    if (flags->objectives.size() == 2) {
      state(flags->objectives.front(), "first", *wanted.mutable_first());
    }
    try {
      const auto answer = decided(kDecision, flags->campaign, wanted, options);
      return answer.candidates().empty() ? kExitFailed : kExitOk;
    } catch (const ServiceError& error) {
      throw with_flag_names(error, typed);
    }
  };
  return command;
}

Command effects_command() {
  using Request = v1::EstimateCandidateEffectsRequest;
  const auto flags = std::make_shared<DecisionFlags<Request>>();
  Command command = one_campaign_command(
      {"campaigns effects", "estimate what columns of the candidates do to a figure",
       "Prints the main effects of parameters, or of --columns that ride along, such as the "
       "concentration of an additive, on a figure, with their intervals: from the lowest value to "
       "the highest one, or from the most frequent text to another one. The effect of a column "
       "that "
       "rides along need not be a cause.",
       "tribodyn campaigns effects 12"},
      flags->campaign);
  command.examples.emplace_back(
      "tribodyn campaigns effects 12 --figure film_ratio_minimum:min --columns concentration");
  command.flags.group("Options");
  Request& request = flags->request;
  request.set_coverage(0.95);
  Flag& figure =
      command.flags.raw("--figure", "FIGURE",
                        "The figure. Default: the mean inefficiency, of a rig the traction "
                        "coefficient.");
  figure.read = [&request](const std::vector<std::string>& texts, Complaints& complaints) {
    read_candidate_figure("--figure", texts.back(), *request.mutable_figure(), complaints);
  };
  command.flags.texts("--columns", "NAME",
                      "Columns of the candidates, separated by commas. Default: the parameters of "
                      "the model in which they differ.",
                      [&request](const std::string& name) { request.add_columns(name); });
  add_selection_flags(command.flags, request);
  command.flags.number("--coverage", {"-", "0.5 to 0.9999", "0.95"}, "Probability of the intervals",
                       [&request](double value) { request.set_coverage(value); });
  command.run = [flags](const CommonOptions& options) {
    static constexpr Decision<Request, v1::EstimateCandidateEffectsResponse> kDecision{
        [](Request& wanted) { return std::vector{wanted.mutable_figure()}; },
        &Connection::estimate_candidate_effects, effects_answer_text};
    decided(kDecision, flags->campaign, flags->request, options);
    return kExitOk;
  };
  return command;
}

/// A candidate to promote.
struct PromotionFlags {
  v1::PromoteCandidateRequest request;
  std::string campaign;
  bool has_candidate = false;
};

int run_promote(PromotionFlags& flags, const CommonOptions& options) {
  flags.request.set_name(flags.campaign);
  const v1::PromoteCandidateResponse answer = options.connect().promote_candidate(flags.request);
  if (options.output_format == OutputFormat::kJson) {
    std::cout << json_text(answer);
    return kExitOk;
  }
  const char* verb = flags.request.validate_only() ? "would create " : "created ";
  if (answer.has_lubricant()) std::cout << verb << printable(answer.lubricant().name()) << "\n";
  if (answer.has_surface()) std::cout << verb << printable(answer.surface().name()) << "\n";
  return kExitOk;
}

Command promote_command() {
  const auto flags = std::make_shared<PromotionFlags>();
  Command command = one_campaign_command(
      {"campaigns promote", "make a candidate a lubricant",
       "Makes a candidate of a campaign a lubricant, and a surface where candidates have surface "
       "parameters of their own. They have the numbers with which the campaign computed; their "
       "provenance names campaign, candidate and base.",
       "tribodyn campaigns promote 12 --candidate 3 --lubricant best-oil --surface best-film"},
      flags->campaign);
  command.flags.group("Options");
  command.flags.whole_number("--candidate", {"-", "0 to the last one"},
                             "Number of the candidate, as `campaigns rank` prints it",
                             [flags](int value) {
                               flags->request.set_candidate(value);
                               flags->has_candidate = true;
                             });
  command.flags.text("--lubricant", "ID", "Id of the new lubricant.",
                     [flags](const std::string& id) { flags->request.set_lubricant_id(id); });
  command.flags.text("--surface", "ID",
                     "Id of the new surface, where candidates have surface parameters.",
                     [flags](const std::string& id) { flags->request.set_surface_id(id); });
  command.flags.text("--title", "TEXT", "Name for people. Default: that of the candidate.",
                     [flags](const std::string& text) { flags->request.set_display_name(text); });
  command.flags.toggle("--validate-only", "Check everything and show the outcome; write nothing.",
                       [flags] { flags->request.set_validate_only(true); });
  add_check(command, [flags](Complaints& complaints) {
    if (!flags->has_candidate) complaints.emplace_back("--candidate is missing");
  });
  command.run = [flags](const CommonOptions& options) { return run_promote(*flags, options); };
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
