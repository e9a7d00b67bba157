#include "client/cpp/commands/screen_flags.h"

#include <algorithm>
#include <utility>

#include "client/cpp/commands/candidate_flags.h"
#include "client/cpp/commands/result_files.h"
#include "client/cpp/commands/scenario.h"
#include "client/cpp/service/screening_campaign.h"
#include "client/cpp/text/text.h"
#include "client/cpp/text/units.h"

namespace tribodyn::client {
namespace {

constexpr int kMostPointsOfACampaign = 20'000'000;  // that the server takes

v1::CampaignBudget& budget_of(ScreenFlags& flags) {
  if (!flags.budget) flags.budget.emplace();
  return *flags.budget;
}

/// Returns each flag that describes how the axle runs, and whether it is given.
std::vector<std::pair<const char*, bool>> axle_flags(const ScreenFlags& flags) {
  const v1::EvaluatePointsRequest& request = flags.request;
  return {{"--speeds", !flags.conditions.speeds.empty()},
          {"--sumps", !flags.conditions.sumps.empty()},
          {"--ascent", flags.conditions.common.ascent_angle_degrees() != 0},
          {"--inlet-temperature-rise-kelvin",
           flags.conditions.common.has_inlet_temperature_rise_kelvin()},
          {"--gear-set", !request.gear_set().empty()},
          {"--vehicle", !request.vehicle().empty()},
          {"--tolerance", request.tolerance() != 0},
          {"--contact-figures", request.contact_figures()}};
}

/// Checks what a campaign has of its own.
void check_campaign_flags(const ScreenFlags& flags, Complaints& complaints) {
  const v1::EvaluatePointsRequest& request = flags.request;
  std::vector<std::pair<const char*, bool>> given = {
      {"a table", !flags.path.empty()},
      {"--like", !request.lubricant().empty()},
      {"--lubricants", !flags.lubricants.empty()},
      {"--lubricant-filter", !flags.lubricant_filter.empty()},
      {"a design", flags.has_design()},
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
  if (flags.has_design()) given.emplace_back("a design (--range, --method, --count)");
  if (given.empty()) {
    complaints.emplace_back(
        "give a table: tribodyn screen candidates.csv --like LUBRICANT; or --lubricants, "
        "--lubricant-filter, or ranges of a design (--range)");
  } else if (given.size() > 1) {
    complaints.push_back(joined(given, " and ") + ": give one; each states the candidates");
  }
  if (flags.request.lubricant().empty() && !flags.has_lubricants()) {
    complaints.emplace_back("--like is missing");
  }
  if (flags.path.empty() && !flags.carried.empty()) {
    complaints.emplace_back("--carry names columns of a table, which is missing");
  }
  if (!flags.has_design()) return;
  check_design_flags(flags.design, kMostCandidates, complaints);
  if (flags.design.method == DesignMethod::kGrid && !flags.design.has_ranges) {
    complaints.emplace_back("--method grid needs --range PARAMETER=LOW:HIGH");
  }
}

}  // namespace

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
  add_condition_flags(list, SumpCount::kSeveral, flags.conditions);
  add_hardware_flags(list,
                     "Surface of all candidates where they state no roughness or boundary friction "
                     "of their own.",
                     request);
  add_screen_rig_flags(list, flags.rig);
  list.group("Decisions");
  add_uncertainty_flag(list, flags.uncertainties);
  list.number("--confidence", {"-", "0.5 to 0.9999", "0.95"},
              "Candidates are tied with the best one if this interval of the difference holds 0",
              [&flags](double value) { flags.confidence = value; });
  list.toggle("--no-uncertainty", "Leave out the uncertainty of the inputs.",
              [&flags] { flags.leaves_out_uncertainty = true; });
  list.text("--pareto", "COLUMN",
            "Also print the Pareto front of least inefficiency and least COLUMN, a column of the "
            "table, e.g. cost, or of --contact-figures, e.g. film_ratio_minimum. Of a rig: of its "
            "ranking and COLUMN, as the figures of `campaigns pareto`, e.g. "
            "12/inefficiency_energy_mean_percent of campaign 12.",
            [&flags](const std::string& column) { flags.pareto_column = column; })
      .field = "second";
  list.toggle("--pareto-most", "In the Pareto front more of the column is better.",
              [&flags] { flags.wants_most = true; });
  list.toggle("--effects",
              "Also print the main effects of the parameters on the mean inefficiency, with their "
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
  add_point_tolerance_flag(list, "0.001", request);
  add_model_flags(list, *request.mutable_model_options());
}

void check_rig_screen(const ScreenFlags& flags, Complaints& complaints) {
  std::vector<std::pair<const char*, bool>> given = axle_flags(flags);
  given.insert(given.end(), {{"--weights", !flags.conditions.speed_weights.empty()},
                             {"--sump-weights", !flags.conditions.sump_weights.empty()},
                             {"--jsonl", !flags.json_lines_path.empty()},
                             {"--plot", !flags.plot_path.empty()}});
  for (const auto& [flag, is_given] : given) {
    if (!is_given) continue;
    complaints.push_back(std::string(flag) + " and --rig: a rig has no such thing; leave out one");
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
    check_condition_flags(flags.conditions, complaints);
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
  for (const auto* weights : {&flags.conditions.speed_weights, &flags.conditions.sump_weights}) {
    for (const double weight : *weights) {
      if (weight > 0) continue;
      complaints.push_back(
          std::string(weights == &flags.conditions.speed_weights ? "--weights" : "--sump-weights") +
          " = " + significant(weight) + "; allowed: above 0");
    }
  }
  const std::size_t conditions = std::max<std::size_t>(flags.conditions.speeds.size(), 1) *
                                 std::max<std::size_t>(flags.conditions.sumps.size(), 1);
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

}  // namespace tribodyn::client
