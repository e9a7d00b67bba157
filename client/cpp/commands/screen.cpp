#include <algorithm>
#include <cmath>
#include <iostream>
#include <map>
#include <memory>
#include <numeric>
#include <optional>
#include <utility>

#include "client/cpp/commands/candidate_flags.h"
#include "client/cpp/commands/design_flags.h"
#include "client/cpp/commands/resource_writes.h"
#include "client/cpp/commands/result_files.h"
#include "client/cpp/commands/scenario.h"
#include "client/cpp/commands/screen_rig.h"
#include "client/cpp/plot/screening_plot.h"
#include "client/cpp/report/candidate_decisions.h"
#include "client/cpp/report/screening.h"
#include "client/cpp/report/screening_decisions.h"
#include "client/cpp/report/screening_report.h"
#include "client/cpp/resources/edits.h"
#include "client/cpp/resources/json_input.h"
#include "client/cpp/resources/table_files.h"
#include "client/cpp/service/campaign_run.h"
#include "client/cpp/service/follow.h"
#include "client/cpp/service/screening_campaign.h"
#include "client/cpp/text/csv.h"
#include "client/cpp/text/table.h"
#include "client/cpp/text/text.h"
#include "client/cpp/text/units.h"

namespace tribodyn::client {
namespace {

/// Candidates that are compared with the best one, from the best on: at least and at most. It takes
/// two points for each input and condition, and the server compares as many as 20,000 points allow.
constexpr int kLeastCompared = 30, kMostCompared = 200;

constexpr int kMostPointsOfACampaign = 20'000'000;  // that the server takes
constexpr int kMostCandidates = 100'000;            // likewise

struct ScreenFlags {
  std::string path;
  std::string campaign;  ///< name of a campaign in place of a table
  // Candidates that the server makes or finds, in place of a table.
  DesignFlags design;
  std::vector<std::string> lubricants;
  std::string lubricant_filter;
  std::optional<v1::CampaignBudget> budget;
  v1::EvaluatePointsRequest request;  ///< without conditions
  ScreenRigFlags rig;
  std::vector<double> speeds, sumps;
  std::vector<double> speed_weights, sump_weights;
  v1::PointCondition common;
  std::vector<std::string> carried;
  int top = 20;
  std::string csv_path, json_lines_path, plot_path;
  std::vector<v1::ParameterUncertainty> uncertainties;
  double confidence = 0.95;
  bool leaves_out_uncertainty = false;
  std::string pareto_column;
  bool wants_most = false;
  bool wants_effects = false;
};

bool has_design(const ScreenFlags& flags) {
  return flags.design.has_ranges || flags.design.has_method;
}
bool has_lubricants(const ScreenFlags& flags) {
  return !flags.lubricants.empty() || !flags.lubricant_filter.empty();
}

v1::CampaignBudget& budget_of(ScreenFlags& flags) {
  if (!flags.budget) flags.budget.emplace();
  return *flags.budget;
}

void add_screen_flags(FlagList& list, ScreenFlags& flags) {
  v1::EvaluatePointsRequest& request = flags.request;
  list.group("Arguments");
  list.text("table", "FILE.csv",
            "Table of candidates, one a row; - is standard input. `tribodyn help screening` "
            "describes its columns.",
            [&flags](const std::string& path) { flags.path = path; });
  Flag& like = list.text("--like", "LUBRICANT",
                         "The base: what a candidate does not state is as in this lubricant.",
                         [&request](const std::string& name) {
                           request.set_lubricant(resource_name("lubricants", name));
                         });
  like.collection = "lubricants";
  like.field = "lubricant";
  list.texts("--carry", "COLUMN",
             "Columns that are carried along although their names resemble those of parameters",
             [&flags](const std::string& name) { flags.carried.push_back(name); });
  list.text(
          "--campaign", "NAME",
          "Continues and ranks a campaign, e.g. 12 or campaigns/12 (`tribodyn campaigns list`), "
          "in place of a table and its conditions.",
          [&flags](const std::string& name) { flags.campaign = resource_name("campaigns", name); })
      .collection = "campaigns";
  list.group("Candidates without a table");
  list.texts("--lubricants", "NAME",
             "Lubricants that are the candidates, separated by commas; --like then defaults to the "
             "first one.",
             [&flags](const std::string& name) {
               flags.lubricants.push_back(resource_name("lubricants", name));
             })
      .collection = "lubricants";
  list.text("--lubricant-filter", "FILTER",
            "Candidates are the lubricants that satisfy it, as of `tribodyn lubricants list "
            "--filter`.",
            [&flags](const std::string& text) { flags.lubricant_filter = text; });
  add_range_flags(list, flags.design);
  add_method_flags(list, kMostCandidates, flags.design);
  list.group("Conditions (every speed at every sump temperature)");
  list.numbers("--speed-kilometres-per-hour,--speeds,--speed", {"km/h", "0.1 to 400", "60"},
               "Vehicle speeds separated by commas",
               [&flags](double value) { flags.speeds.push_back(value); });
  list.numbers("--sump-temperature-celsius,--sumps,--sump", {"C", "-70 to 200", "40"},
               "Temperatures of the oil bath separated by commas",
               [&flags](double value) { flags.sumps.push_back(value); });
  list.numbers("--weights", {"-", "above 0", "equal"},
               "Weights of the speeds in the mean, one for each",
               [&flags](double value) { flags.speed_weights.push_back(value); });
  list.numbers("--sump-weights", {"-", "above 0", "equal"},
               "Weights of the sump temperatures in the mean, one for each",
               [&flags](double value) { flags.sump_weights.push_back(value); });
  list.number("--ascent-angle-degrees,--ascent", {"degrees", "-45 to 45", "0"},
              "Road slope, also in percent: 6%",
              [&flags](double value) { flags.common.set_ascent_angle_degrees(value); });
  list.number("--inlet-temperature-rise-kelvin", {"K", "0 to 300", "20"},
              "Temperature rise from the oil bath to the inlet of the contact (eq 14)",
              [&flags](double value) { flags.common.set_inlet_temperature_rise_kelvin(value); });
  list.text("--gear-set", "NAME", "Gear set with its driveline. Default: reference-axle.",
            [&request](const std::string& name) {
              request.set_gear_set(resource_name("gearSets", name));
            })
      .collection = "gearSets";
  list.text("--surface", "NAME",
            "Surface of all candidates where they state no roughness or boundary friction of their "
            "own. Default: run-in.",
            [&request](const std::string& name) {
              request.set_surface(resource_name("surfaces", name));
            })
      .collection = "surfaces";
  list.text("--vehicle", "NAME", "Vehicle: road load. Default: passenger-car.",
            [&request](const std::string& name) {
              request.set_vehicle(resource_name("vehicles", name));
            })
      .collection = "vehicles";
  add_screen_rig_flags(list, flags.rig);
  list.group("Decisions");
  add_uncertainty_flag(list, flags.uncertainties);
  list.number("--confidence", {"-", "0.5 to 0.9999", "0.95"},
              "Probability from which on two candidates can be told apart; others are ties",
              [&flags](double value) { flags.confidence = value; });
  list.toggle("--no-uncertainty", "Leave out the uncertainty of the inputs.",
              [&flags] { flags.leaves_out_uncertainty = true; });
  list.text("--pareto", "COLUMN",
            "Also print the Pareto front of least inefficiency and least COLUMN, a column of the "
            "table, e.g. cost, or of --contact-figures, e.g. film_ratio_minimum. Of a rig: of its "
            "ranking and COLUMN, as the figures of `campaigns pareto`, e.g. "
            "12/inefficiency_energy_mean_percent of campaign 12.",
            [&flags](const std::string& column) { flags.pareto_column = column; });
  list.toggle("--pareto-most", "In the Pareto front more of the column is better.",
              [&flags] { flags.wants_most = true; });
  list.toggle("--effects",
              "Also print the main effects of all columns on the mean inefficiency, with their "
              "intervals.",
              [&flags] { flags.wants_effects = true; });
  add_plot_flag(list, "Also draw what --pareto and --effects compute, as SVG.", flags.plot_path);
  list.group("Results");
  list.toggle("--contact-figures",
              "Also compute film ratio, pressure and temperatures of the contacts, viscous and "
              "boundary loss and the friction coefficient; takes two fifths longer.",
              [&request] { request.set_contact_figures(true); });
  list.whole_number("--top", {"candidates", "1 to 1000000", "20"},
                    "Candidates that the table shows, the best first; --output csv and json have "
                    "all of them",
                    [&flags](int value) { flags.top = value; });
  add_result_file_flag(list, "--csv", "FILE",
                       "Also write every candidate at every condition as CSV.", flags.csv_path);
  add_result_file_flag(list, "--jsonl", "FILE", "The same as JSON, one object a line.",
                       flags.json_lines_path);
  list.group("Budget");
  list.number("--budget-processor-seconds", {"s", "0 to 1e9", "no limit"},
              "Processor time after which the campaign pauses, counted from its start; 0: no limit",
              [&flags](double value) { budget_of(flags).set_processor_seconds(value); });
  list.whole_number("--budget-points", {"points", "0 to 20000000", "no limit"},
                    "Points after which the campaign pauses, counted from its start; 0: no limit",
                    [&flags](int value) { budget_of(flags).set_points(value); });
  list.group("Solver");
  list.number("--tolerance", {"-", "1e-8 to 0.01", "0.001"},
              "Target of the relative solver error of every point",
              [&request](double value) { request.set_tolerance(value); });
  add_model_flags(list, *request.mutable_model_options());
}

void check_weights(const char* flag, std::size_t weights, std::size_t values, const char* what,
                   Complaints& complaints) {
  if (weights == 0 || weights == std::max<std::size_t>(values, 1)) return;
  complaints.push_back(std::string(flag) + ": " + std::to_string(weights) + " weights of " +
                       std::to_string(std::max<std::size_t>(values, 1)) + " " + what +
                       "; give one for each");
}

/// Returns each flag that describes how the axle runs, and whether it is given.
std::vector<std::pair<const char*, bool>> axle_flags(const ScreenFlags& flags) {
  const v1::EvaluatePointsRequest& request = flags.request;
  return {{"--speeds", !flags.speeds.empty()},
          {"--sumps", !flags.sumps.empty()},
          {"--ascent", flags.common.ascent_angle_degrees() != 0},
          {"--inlet-temperature-rise-kelvin", flags.common.has_inlet_temperature_rise_kelvin()},
          {"--gear-set", !request.gear_set().empty()},
          {"--vehicle", !request.vehicle().empty()},
          {"--tolerance", request.tolerance() != 0},
          {"--contact-figures", request.contact_figures()}};
}

/// Checks that nothing concerns the axle alone.
void check_rig_screen(const ScreenFlags& flags, Complaints& complaints) {
  std::vector<std::pair<const char*, bool>> given = axle_flags(flags);
  given.insert(given.end(), {{"--weights", !flags.speed_weights.empty()},
                             {"--sump-weights", !flags.sump_weights.empty()},
                             {"--jsonl", !flags.json_lines_path.empty()},
                             {"--plot", !flags.plot_path.empty()}});
  for (const auto& [flag, is_given] : given) {
    if (!is_given) continue;
    complaints.push_back(std::string(flag) + " and --rig: a rig has no such thing; leave out one");
  }
}

/// Checks what a campaign has of its own.
void check_campaign_flags(const ScreenFlags& flags, Complaints& complaints) {
  const v1::EvaluatePointsRequest& request = flags.request;
  std::vector<std::pair<const char*, bool>> given = {
      {"a table", !flags.path.empty()},
      {"--like", !request.lubricant().empty()},
      {"--lubricants", !flags.lubricants.empty()},
      {"--lubricant-filter", !flags.lubricant_filter.empty()},
      {"a design", has_design(flags)},
      {"--carry", !flags.carried.empty()},
      {"--surface", !request.surface().empty()},
      {"options of the model", request.model_options().ByteSizeLong() > 0}};
  for (const auto& each : axle_flags(flags)) given.push_back(each);
  for (const auto& each : flags.rig.stated()) given.push_back(each);
  for (const auto& [flag, is_given] : given) {
    if (!is_given) continue;
    complaints.push_back(std::string(flag) + " and --campaign: the campaign has its own; give one");
  }
}

/// Checks which candidates there are.
void check_candidate_flags(const ScreenFlags& flags, Complaints& complaints) {
  std::vector<std::string> given;
  if (!flags.path.empty()) given.emplace_back("a table");
  if (!flags.lubricants.empty()) given.emplace_back("--lubricants");
  if (!flags.lubricant_filter.empty()) given.emplace_back("--lubricant-filter");
  if (has_design(flags)) given.emplace_back("a design (--range, --method, --count)");
  if (given.empty()) {
    complaints.emplace_back(
        "give a table: tribodyn screen candidates.csv --like LUBRICANT; or --lubricants, "
        "--lubricant-filter, or ranges of a design (--range)");
  } else if (given.size() > 1) {
    complaints.push_back(joined(given, " and ") + ": give one; each states the candidates");
  }
  if (flags.request.lubricant().empty() && !has_lubricants(flags)) {
    complaints.emplace_back("--like is missing");
  }
  if (flags.path.empty() && !flags.carried.empty()) {
    complaints.emplace_back("--carry names columns of a table, which is missing");
  }
  if (!has_design(flags)) return;
  check_design_flags(flags.design, kMostCandidates, complaints);
  if (flags.design.method == DesignMethod::kGrid && !flags.design.has_ranges) {
    complaints.emplace_back("--method grid needs --range PARAMETER=LOW:HIGH");
  }
}

void check_screen_flags(const ScreenFlags& flags, Complaints& complaints) {
  if (!flags.campaign.empty()) {
    check_campaign_flags(flags, complaints);
  } else {
    check_screen_rig_flags(flags.rig, complaints);
    if (!flags.rig.machine.empty()) {
      check_rig_screen(flags, complaints);
    } else if (!flags.rig.objectives.empty()) {
      complaints.emplace_back(
          "--least and --most apply to --rig; the axle is ranked by its inefficiency, and "
          "`campaigns rank` by any figure");
    }
    check_candidate_flags(flags, complaints);
    check_weights("--weights", flags.speed_weights.size(), flags.speeds.size(), "speeds",
                  complaints);
    check_weights("--sump-weights", flags.sump_weights.size(), flags.sumps.size(),
                  "sump temperatures", complaints);
  }
  if (flags.budget) {
    const v1::CampaignBudget& budget = *flags.budget;
    if (!(budget.processor_seconds() >= 0 && budget.processor_seconds() <= 1e9)) {
      complaints.push_back("--budget-processor-seconds = " +
                           significant(budget.processor_seconds()) + " s; allowed: 0 to 1e9 s");
    }
    if (budget.points() < 0 || budget.points() > kMostPointsOfACampaign) {
      complaints.push_back("--budget-points = " + std::to_string(budget.points()) +
                           "; allowed: 0 to " + std::to_string(kMostPointsOfACampaign));
    }
  }
  for (const auto* weights : {&flags.speed_weights, &flags.sump_weights}) {
    for (const double weight : *weights) {
      if (weight > 0) continue;
      complaints.push_back(
          std::string(weights == &flags.speed_weights ? "--weights" : "--sump-weights") + " = " +
          significant(weight) + "; allowed: above 0");
    }
  }
  const std::size_t conditions =
      std::max<std::size_t>(flags.speeds.size(), 1) * std::max<std::size_t>(flags.sumps.size(), 1);
  if (conditions > kMostPointsOfACall) {
    complaints.push_back(std::to_string(conditions) +
                         " conditions of --speeds and --sumps; allowed: at most " +
                         std::to_string(kMostPointsOfACall));
  }
  if (flags.top < 1) complaints.emplace_back("--top must be at least 1");
  if (!flags.csv_path.empty() && !flags.json_lines_path.empty()) {
    complaints.emplace_back("give either --csv or --jsonl");
  }
  if (!(flags.confidence >= 0.5 && flags.confidence <= 0.9999)) {
    complaints.push_back("--confidence = " + significant(flags.confidence) +
                         "; allowed: 0.5 to 0.9999");
  }
  if (flags.wants_most && flags.pareto_column.empty()) {
    complaints.emplace_back("--pareto-most applies to --pareto, which is missing");
  }
  if (!flags.plot_path.empty() && flags.pareto_column.empty() && !flags.wants_effects) {
    complaints.emplace_back("--plot draws what --pareto COLUMN and --effects compute; give one");
  }
}

/// Sets the conditions and their weights.
void set_conditions(ScreenFlags& flags, Screening& screening) {
  if (flags.speeds.empty()) flags.speeds.push_back(60);
  if (flags.sumps.empty()) flags.sumps.push_back(40);
  for (std::size_t j = 0; j < flags.sumps.size(); ++j) {
    for (std::size_t i = 0; i < flags.speeds.size(); ++i) {
      v1::PointCondition& condition = *screening.request.add_conditions();
      condition = flags.common;
      if (!condition.has_inlet_temperature_rise_kelvin()) {
        condition.set_inlet_temperature_rise_kelvin(20);
      }
      condition.set_sump_temperature_celsius(flags.sumps[j]);
      condition.set_speed_kilometres_per_hour(flags.speeds[i]);
      screening.weights.push_back((flags.speed_weights.empty() ? 1 : flags.speed_weights[i]) *
                                  (flags.sump_weights.empty() ? 1 : flags.sump_weights[j]));
    }
  }
  const double sum = std::accumulate(screening.weights.begin(), screening.weights.end(), 0.0);
  for (double& weight : screening.weights) weight /= sum;
}

/// Evaluates the base and reads the table. Everything that is wrong with the command shows here.
Screening prepared_screening(ScreenFlags& flags, const v1::Schema& schema, Connection& connection) {
  // A table that cannot be read needs no server.
  const std::string text = read_table_file(flags.path, kLargestFile);
  Screening out;
  out.request = flags.request;
  set_conditions(flags, out);
  out.base = connection.evaluate_points(out.request);
  out.request.set_lubricant(out.base.lubricant_revision());
  out.request.set_surface(out.base.surface_revision());
  out.request.set_gear_set(out.base.gear_set_revision());
  out.request.set_vehicle(out.base.vehicle_revision());
  CandidateBase& base = out.bases;
  base.lubricant = connection.get<v1::Lubricant>(out.request.lubricant());
  base.surface = connection.get<v1::Surface>(out.request.surface());
  const ResourcePointer stated =
      base_of_rows(connection, kind_of(*v1::Lubricant::descriptor()), out.request.lubricant());
  base.stated = dynamic_cast<const v1::Lubricant&>(*stated);
  out.table = read_candidates(text, flags.path, base, flags.carried);
  if (!flags.pareto_column.empty()) check_front_column(out, flags.pareto_column);
  if (!out.table.note.empty()) std::cerr << "tribodyn: " << printable(out.table.note) << "\n";
  characterise_candidates(connection, base, out.table);
  check_candidate_ranges(schema, out.table);
  return out;
}

/// Returns the place of a value among those that were given before it, in their order.
std::size_t place_among(double value, std::vector<double>& values) {
  const auto found = std::find(values.begin(), values.end(), value);
  const auto place = static_cast<std::size_t>(found - values.begin());
  if (found == values.end()) values.push_back(value);
  return place;
}

/// Sets weights of a campaign's conditions that the command line states.
void set_weights(const ScreenFlags& flags, Screening& screening) {
  if (flags.speed_weights.empty() && flags.sump_weights.empty()) return;
  std::vector<double> speeds, sumps;
  std::vector<std::pair<std::size_t, std::size_t>> places;
  for (const v1::PointCondition& each : screening.request.conditions()) {
    places.emplace_back(place_among(each.speed_kilometres_per_hour(), speeds),
                        place_among(each.sump_temperature_celsius(), sumps));
  }
  Complaints complaints;
  check_weights("--weights", flags.speed_weights.size(), speeds.size(), "speeds", complaints);
  check_weights("--sump-weights", flags.sump_weights.size(), sumps.size(), "sump temperatures",
                complaints);
  if (!complaints.empty()) throw Failure(kExitUsage, joined(complaints, "\n"));
  double sum = 0;
  for (std::size_t k = 0; k < places.size(); ++k) {
    screening.weights[k] =
        (flags.speed_weights.empty() ? 1 : flags.speed_weights[places[k].first]) *
        (flags.sump_weights.empty() ? 1 : flags.sump_weights[places[k].second]);
    sum += screening.weights[k];
  }
  for (double& weight : screening.weights) weight /= sum;
}

/// Returns the revisions of the lubricants that are candidates, in their order.
std::vector<std::string> candidate_lubricants(const ScreenFlags& flags, Connection& connection) {
  std::vector<v1::Lubricant> found;
  for (const std::string& name : flags.lubricants) {
    found.push_back(connection.get<v1::Lubricant>(name));
  }
  if (!flags.lubricant_filter.empty()) {
    ListOptions list;
    list.filter = flags.lubricant_filter;
    found = connection.list<v1::Lubricant>(list).resources;
    if (found.empty()) {
      throw Failure(kExitUsage, "--lubricant-filter: no lubricant satisfies it");
    }
  }
  std::vector<std::string> out;
  for (const v1::Lubricant& each : found) {
    const std::string name = each.name().substr(0, each.name().find('@'));
    out.push_back(name + "@" + std::to_string(each.revision()));
  }
  return out;
}

/// Creates the campaign whose candidates the server makes or finds, or finds the one that the same
/// command made.
v1::Campaign made_campaign(ScreenFlags& flags, Connection& connection) {
  Screening screening;
  screening.request = flags.request;
  set_conditions(flags, screening);
  const std::vector<std::string> lubricants = candidate_lubricants(flags, connection);
  if (screening.request.lubricant().empty()) screening.request.set_lubricant(lubricants.front());
  screening.base = connection.evaluate_points(screening.request);
  screening.request.set_lubricant(screening.base.lubricant_revision());
  screening.request.set_surface(screening.base.surface_revision());
  screening.request.set_gear_set(screening.base.gear_set_revision());
  screening.request.set_vehicle(screening.base.vehicle_revision());
  v1::Campaign request = campaign_without_candidates(
      screening, lubricants.empty() ? "design" : std::to_string(lubricants.size()) + " lubricants");
  if (has_design(flags)) *request.mutable_candidate_design() = design_message(flags.design);
  *request.mutable_candidate_lubricants() = {lubricants.begin(), lubricants.end()};
  CreateCampaignOptions create;
  create.request_id = screening_request_id(request, screening.base.model_version());
  return connection.create_campaign(request, create);
}

/// Returns the campaign that the command line describes, and writes its candidates and conditions
/// to `screening`.
v1::Campaign campaign_to_follow(ScreenFlags& flags, const v1::Schema& schema,
                                Connection& connection, Screening& screening) {
  if (!flags.campaign.empty() || has_design(flags) || has_lubricants(flags)) {
    const std::string name =
        flags.campaign.empty() ? made_campaign(flags, connection).name() : flags.campaign;
    v1::Campaign campaign = connection.get_campaign(name, v1::CAMPAIGN_VIEW_FULL);
    screening = screening_of(connection, campaign);
    set_weights(flags, screening);
    return campaign;
  }
  screening = prepared_screening(flags, schema, connection);
  const auto& refusals = screening.table.refusals;
  const bool is_any_accepted = std::any_of(refusals.begin(), refusals.end(),
                                           [](const std::string& each) { return each.empty(); });
  if (!is_any_accepted) return {};
  const v1::Campaign request =
      campaign_of(screening, flags.path == "-" ? "" : flags.path.substr(flags.path.rfind('/') + 1));
  CreateCampaignOptions create;
  create.request_id = screening_request_id(request, screening.base.model_version());
  return connection.create_campaign(request, create);
}

/// Sets the budget that the command line states, and resumes a campaign that is paused; without a
/// budget on the command line it has none from then on.
void go_on(const ScreenFlags& flags, const v1::Campaign& campaign, Connection& connection) {
  const bool is_paused = campaign.state() == v1::Campaign::PAUSED;
  if (has_ended(campaign.state()) || (!is_paused && !flags.budget)) return;
  try {
    connection.resume_campaign(campaign.name(), flags.budget.value_or(v1::CampaignBudget()));
  } catch (const ServiceError& error) {
    if (error.reason() != "ENDED") throw;  // since it was created or read
  }
}

/// Says why a campaign has points that are not computed, and how to go on.
void report_stop(const v1::Campaign& campaign, const Connection& connection) {
  const std::string program = program_of(connection), id = resource_id(campaign.name());
  std::cerr << "tribodyn: " << campaign.name() << " is " << state_text(campaign.state())
            << " after " << points_text(campaign);
  if (campaign.has_stop()) std::cerr << ": " << printable(campaign.stop().message());
  std::cerr << "\n"
            << (campaign.state() == v1::Campaign::PAUSED
                    ? "  Go on: the same command, with a larger budget or none, or " + program +
                          " campaigns resume " + id
                    : "  To compute it again, delete it first: " + program + " campaigns delete " +
                          id)
            << "\n";
}

/// Computes the points of a screening. Returns whether there are all of them.
bool compute(ScreenFlags& flags, const v1::Schema& schema, Connection& connection,
             const CommonOptions& options, Screening& screening) {
  const v1::Campaign started = campaign_to_follow(flags, schema, connection, screening);
  screening.program = program_of(connection);
  screening.campaign = started.name();
  screening.input_hash = started.input_hash();
  ScreenedPoint none{};
  none.figures.fill(std::nan(""));
  screening.points.assign(screening.table.size() * screening.conditions(), none);
  if (started.name().empty()) return true;
  if (started.points_done() > 0 && !has_ended(started.state())) {
    std::cerr << "tribodyn: resumes " << started.name() << " after " << points_text(started)
              << "\n";
  }
  go_on(flags, started, connection);
  const v1::Campaign campaign = follow_to_end(connection, started.name(), options.progress_form());
  read_points(connection, campaign, screening);
  if (campaign.model_version() != screening.base.model_version()) {
    std::cerr << "tribodyn: " << campaign.name() << " was computed by "
              << printable(campaign.model_version()) << ", its base now by "
              << printable(screening.base.model_version()) << "\n";
  }
  const bool is_complete = campaign.state() == v1::Campaign::SUCCEEDED;
  if (!is_complete) report_stop(campaign, connection);
  return is_complete;
}

/// Writes all points to the files that the command line names.
void write_point_files(const ScreenFlags& flags, const Screening& screening) {
  if (!flags.csv_path.empty()) {
    write_file(flags.csv_path, [&](std::ostream& file) { write_screening_csv(screening, file); });
  }
  if (!flags.json_lines_path.empty()) {
    write_file(flags.json_lines_path,
               [&](std::ostream& file) { write_screening_json_lines(screening, file); });
  }
}

/// Returns how sure the ranking is, by the service. Where all compared candidates are ties, more
/// are compared.
RankingConfidence confidence_of(const ScreenFlags& flags, const Screening& screening,
                                const std::vector<CandidateFigures>& ranking,
                                Connection& connection) {
  if (screening.campaign.empty() || !ranking.front().refusal.empty()) return {};
  v1::RankCandidatesRequest request;
  request.set_name(screening.campaign);
  *request.mutable_condition_weights() = {screening.weights.begin(), screening.weights.end()};
  request.set_confidence(flags.confidence);
  *request.mutable_uncertainties() = {flags.uncertainties.begin(), flags.uncertainties.end()};
  const std::vector<std::size_t> candidates = accepted_candidates(screening.table);
  RankingConfidence out;
  for (const int count : {std::clamp(flags.top, kLeastCompared, kMostCompared), kMostCompared}) {
    request.set_count(count);
    const v1::RankCandidatesResponse answer = connection.rank_candidates(request);
    out = ranking_confidence(ranking, candidates, answer, flags.confidence);
    const bool has_all = answer.compared() < count || answer.ranked() <= count;
    if (out.of.empty() || has_all || !out.of.back() || !out.of.back()->is_tied) break;
  }
  return out;
}

/// The Pareto front and the main effects, each if the command line requests it.
struct Decisions {
  std::optional<ScreeningFront> front;
  std::optional<ScreeningEffects> effects;
};

Decisions decisions_of(const ScreenFlags& flags, const Screening& screening,
                       const std::vector<CandidateFigures>& ranking) {
  Decisions out;
  if (!ranking.front().refusal.empty()) return out;
  if (!flags.pareto_column.empty()) {
    out.front = screening_front(screening, ranking, flags.pareto_column, flags.wants_most);
  }
  if (flags.wants_effects) {
    out.effects = screening_effects(screening, ranking);
    if (!out.effects) {
      throw Failure(kExitUsage,
                    "--effects: too few candidates for as many columns; give at least two more "
                    "candidates with figures than columns that differ");
    }
  }
  return out;
}

/// Returns the campaign of a rig that the command line describes. Says which rows of the table
/// cannot be computed.
v1::Campaign rig_campaign_request(const ScreenFlags& flags, Connection& connection,
                                  std::string& model_version) {
  constexpr std::size_t kMostNamed = 8;  // rows that cannot be computed
  const std::string text =
      flags.path.empty() ? std::string() : read_table_file(flags.path, kLargestFile);
  const std::vector<std::string> lubricants = candidate_lubricants(flags, connection);
  v1::EvaluateRigRequest rig = rig_of_screen(flags.rig, flags.request);
  if (rig.lubricant().empty()) rig.set_lubricant(lubricants.front());
  const v1::EvaluateRigResponse base = connection.evaluate_rig(rig);
  model_version = base.model_version();
  Screening screening;
  screening.request.set_lubricant(base.lubricant_revision());
  screening.request.set_surface(base.surface_revision());
  *screening.request.mutable_model_options() = flags.request.model_options();
  if (flags.path.empty()) {
    v1::Campaign out = campaign_without_candidates(
        screening,
        lubricants.empty() ? "design" : std::to_string(lubricants.size()) + " lubricants");
    if (has_design(flags)) *out.mutable_candidate_design() = design_message(flags.design);
    *out.mutable_candidate_lubricants() = {lubricants.begin(), lubricants.end()};
    set_rig(rig, out);
    return out;
  }
  screening.bases.lubricant = connection.get<v1::Lubricant>(base.lubricant_revision());
  if (!base.surface_revision().empty()) {
    screening.bases.surface = connection.get<v1::Surface>(base.surface_revision());
  }
  const ResourcePointer stated =
      base_of_rows(connection, kind_of(*v1::Lubricant::descriptor()), base.lubricant_revision());
  screening.bases.stated = dynamic_cast<const v1::Lubricant&>(*stated);
  CandidateTable& table = screening.table;
  table = read_candidates(text, flags.path, screening.bases, flags.carried);
  if (!table.note.empty()) std::cerr << "tribodyn: " << printable(table.note) << "\n";
  characterise_candidates(connection, screening.bases, table);
  check_candidate_ranges(connection.schema(), table);
  std::size_t refused = 0;
  for (std::size_t i = 0; i < table.size(); ++i) {
    if (table.refusals[i].empty() || ++refused > kMostNamed) continue;
    std::cerr << "tribodyn: " << printable(table.names[i])
              << " is left out: " << printable(table.refusals[i]) << "\n";
  }
  if (refused > kMostNamed) std::cerr << "... and " << refused - kMostNamed << " others\n";
  if (refused == table.size()) throw Failure(kExitFailed, "no candidate can be computed");
  v1::Campaign out =
      campaign_of(screening, flags.path == "-" ? "" : flags.path.substr(flags.path.rfind('/') + 1));
  set_rig(rig, out);
  return out;
}

/// Returns the campaign of a rig once it has ended or is paused, with its candidates.
v1::Campaign computed_rig_campaign(const ScreenFlags& flags, Connection& connection,
                                   const CommonOptions& options) {
  std::string name = flags.campaign;
  if (name.empty()) {
    std::string model_version;
    const v1::Campaign request = rig_campaign_request(flags, connection, model_version);
    CreateCampaignOptions create;
    create.request_id = screening_request_id(request, model_version);
    name = connection.create_campaign(request, create).name();
  }
  go_on(flags, connection.get_campaign(name), connection);
  follow_to_end(connection, name, options.progress_form());
  return connection.get_campaign(name, v1::CAMPAIGN_VIEW_FULL);
}

/// Ranks a campaign of a rig, and finds what else the command line requests, by the service.
int run_rig_screen(const ScreenFlags& flags, Connection& connection, const CommonOptions& options) {
  const v1::Campaign campaign = computed_rig_campaign(flags, connection, options);
  const bool is_complete = campaign.state() == v1::Campaign::SUCCEEDED;
  if (!is_complete) report_stop(campaign, connection);
  if (!flags.csv_path.empty()) {
    write_file(flags.csv_path, [&](std::ostream& file) {
      read_rig_rows(connection, campaign,
                    [&file](const std::vector<std::string>& cells) { file << csv_line(cells); });
    });
  }
  constexpr int kMostRanked = 1000;  // that the service returns
  const OutputFormat format = options.output_format;
  v1::RankCandidatesRequest ranking;
  ranking.set_name(campaign.name());
  ranking.set_count(format == OutputFormat::kTable ? std::min(flags.top, kMostRanked)
                                                   : kMostRanked);
  *ranking.mutable_objective() =
      flags.rig.objectives.empty() ? usual_objective(campaign) : flags.rig.objectives.front();
  ranking.set_confidence(flags.confidence);
  ranking.set_ignore_stated_uncertainties(flags.leaves_out_uncertainty);
  if (!flags.leaves_out_uncertainty) {
    *ranking.mutable_uncertainties() = {flags.uncertainties.begin(), flags.uncertainties.end()};
  }
  const v1::RankCandidatesResponse best = connection.rank_candidates(ranking);
  const bool is_json = format == OutputFormat::kJson;
  std::string out = ranking_answer_text(ranking, best, format);
  if (is_json) {
    out = "{\n\"campaign\": " + json_quoted(campaign.name()) + ",\n\"ranking\": " + out;
  }
  const auto add = [&](const char* member, const std::string& text) {
    out += is_json ? std::string(",\n\"") + member + "\": " + text : "\n" + text;
  };
  if (!flags.pareto_column.empty()) {
    v1::FindParetoCandidatesRequest request;
    request.set_name(campaign.name());
    *request.mutable_first() = ranking.objective();
    request.mutable_second()->set_wants_most(flags.wants_most);
    Complaints complaints;
    read_candidate_figure("--pareto", flags.pareto_column,
                          *request.mutable_second()->mutable_figure(), complaints);
    if (!complaints.empty()) throw Failure(kExitUsage, joined(complaints, "\n"));
    add("pareto_front",
        front_answer_text(request, connection.find_pareto_candidates(request), format));
  }
  if (flags.wants_effects) {
    v1::EstimateCandidateEffectsRequest request;
    request.set_name(campaign.name());
    *request.mutable_figure() = ranking.objective().figure();
    add("main_effects",
        effects_answer_text(request, connection.estimate_candidate_effects(request), format));
  }
  if (format == OutputFormat::kTable) {
    const std::string program = program_of(connection), id = resource_id(campaign.name());
    Sheet sheet;
    sheet.remark("The server keeps the figures as " + campaign.name() + ": `" + program +
                 " screen --campaign " + id + "` ranks them again, `" + program +
                 " campaigns columns " + id + "` prints them, `" + program + " campaigns delete " +
                 id + "` deletes them.");
    out += "\n" + sheet.text();
  }
  std::cout << out << (is_json ? "}\n" : "");
  return is_complete && !best.candidates().empty() ? kExitOk : kExitFailed;
}

int run_screen(ScreenFlags& flags, const CommonOptions& options) {
  const bool has_decisions = !flags.pareto_column.empty() || flags.wants_effects;
  if (options.output_format == OutputFormat::kCsv && has_decisions && flags.plot_path.empty()) {
    throw Failure(
        kExitUsage,
        "--output csv is the ranking alone; use --output json for --pareto and --effects, "
        "or draw them with --plot");
  }
  Connection connection = options.connect();
  if (!flags.campaign.empty() && connection.get_campaign(flags.campaign).has_rig()) {
    Complaints complaints;
    check_rig_screen(flags, complaints);
    if (!complaints.empty()) throw Failure(kExitUsage, joined(complaints, "\n"));
    return run_rig_screen(flags, connection, options);
  }
  if (!flags.rig.machine.empty()) return run_rig_screen(flags, connection, options);
  if (!flags.rig.objectives.empty()) {
    throw Failure(kExitUsage, "--least and --most: " + flags.campaign +
                                  " is of the axle, which is ranked by "
                                  "its inefficiency; `campaigns rank` ranks by any figure");
  }
  const v1::Schema schema = connection.schema();
  Screening screening;
  const bool is_complete = compute(flags, schema, connection, options, screening);
  write_point_files(flags, screening);
  const std::vector<CandidateFigures> ranking = ranked(screening);
  const RankingConfidence confidence = flags.leaves_out_uncertainty
                                           ? RankingConfidence()
                                           : confidence_of(flags, screening, ranking, connection);
  const auto [front, effects] = decisions_of(flags, screening, ranking);
  std::map<std::string, std::string> members;
  if (front) members["pareto_front"] = front_json(screening, *front);
  if (effects) members["main_effects"] = effects_json(*effects);
  std::cout << screening_report(screening, ranking, confidence, static_cast<std::size_t>(flags.top),
                                options.output_format, members);
  if (options.output_format == OutputFormat::kTable) {
    if (front) std::cout << "\n" << front_report(screening, ranking, *front);
    if (effects) std::cout << "\n" << effects_report(*effects);
  }
  if (!flags.plot_path.empty() && (front || effects)) {
    write_file(flags.plot_path, screening_plot(screening, ranking, front ? &*front : nullptr,
                                               effects ? &*effects : nullptr));
  }
  return is_complete && ranking.front().refusal.empty() ? kExitOk : kExitFailed;
}

}  // namespace

Command screen_command() {
  const auto flags = std::make_shared<ScreenFlags>();
  Command command{
      "screen",
      "rank candidates of a table by their inefficiency",
      "Evaluates variants of a lubricant, one a row of a table, at every speed and sump "
      "temperature "
      "and ranks them by the weighted mean of the inefficiency. Columns override parameters of the "
      "lubricant and of the surface, or hold measurements; others are carried along. The server "
      "computes the table as a campaign and keeps its figures: after an interruption of either "
      "side "
      "the same command goes on where it ended, and once it is complete reads the figures.",
      {"tribodyn screen candidates.csv --like my-oil --speeds 20,40,60 --sumps 40,90",
       "tribodyn screen candidates.csv --like my-oil --speeds 20,60 --weights 1,2 --csv all.csv",
       "tribodyn screen oils.csv --like my-oil --uncertainty pressure-viscosity=3% --pareto cost",
       "tribodyn screen oils.csv --like my-oil --effects --plot screening.svg",
       "tribodyn screen oils.csv --like my-oil --contact-figures --csv all.csv",
       "tribodyn screen candidates.csv --like my-oil --output csv",
       "tribodyn screen --lubricants my-oil,your-oil,paper-fluid-2 --speeds 20,60",
       "tribodyn screen --like my-oil --range relaxation-time=0.2us:0.6us --count 128",
       "tribodyn screen --campaign 12 --weights 2,1,1",
       "tribodyn screen candidates.csv --like my-oil --rig traction --load 35 --srr 5,20,50",
       std::string("tribodyn screen candidates.csv --like my-oil --rig stribeck --pareto ") +
           "12/inefficiency_energy_mean_percent"},
      {},
      {},
      {}};
  add_screen_flags(command.flags, *flags);
  command.check = [flags](Complaints& complaints) { check_screen_flags(*flags, complaints); };
  command.main_flags = {"table",     "--like",        "--speeds",     "--sumps",
                        "--weights", "--uncertainty", "--pareto",     "--plot",
                        "--effects", "--top",         "--csv",        "--surface",
                        "--range",   "--campaign",    "--lubricants", "--rig"};
  command.run = [flags](const CommonOptions& options) { return run_screen(*flags, options); };
  return command;
}

}  // namespace tribodyn::client
