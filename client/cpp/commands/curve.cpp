#include <algorithm>
#include <iostream>
#include <memory>

#include "client/cpp/commands/operating_point.h"
#include "client/cpp/commands/result_files.h"
#include "client/cpp/commands/scenario.h"
#include "client/cpp/commands/show_results.h"
#include "client/cpp/commands/uncertainty.h"
#include "client/cpp/plot/panel.h"
#include "client/cpp/report/curve_plot.h"
#include "client/cpp/report/curve_report.h"
#include "client/cpp/report/variant_report.h"
#include "client/cpp/text/text.h"

namespace tribodyn::client {
namespace {

// The range of speeds in the paper [km/h].
constexpr double kFirstSpeed = 20;
constexpr double kLastSpeed = 140;
constexpr double kSpeedStep = 5;

struct CurveFlags {
  v1::InefficiencyCurveStudy study;
  bool has_range = false;  ///< a flag sets the range of speeds
  Scenario scenario;
  std::string csv_path;
  std::string plot_path;
  bool leaves_out_uncertainty = false;
  std::vector<std::string> panels;  ///< of the plot, on request
};

void add_curve_flags(FlagList& list, CurveFlags& flags) {
  v1::InefficiencyCurveStudy& study = flags.study;
  study.set_first_speed_kilometres_per_hour(kFirstSpeed);
  study.set_last_speed_kilometres_per_hour(kLastSpeed);
  study.set_speed_step_kilometres_per_hour(kSpeedStep);
  list.group("Curve");
  list.numbers("--speeds-kilometres-per-hour,--speeds,--speed",
               {"km/h", "0.1 to 400", "20 to 140 by 5"},
               "Vehicle speeds separated by commas, instead of a range",
               [&](double value) { study.add_speeds_kilometres_per_hour(value); });
  const auto range = [&](const char* names, const NumberText& text, const char* description,
                         void (v1::InefficiencyCurveStudy::*set)(double)) {
    list.number(names, text, description, [&flags, set](double value) {
      (flags.study.*set)(value);
      flags.has_range = true;
    });
  };
  range("--first-speed-kilometres-per-hour,--first-speed", {"km/h", "0.1 to 400", "20"},
        "Lowest vehicle speed", &v1::InefficiencyCurveStudy::set_first_speed_kilometres_per_hour);
  range("--last-speed-kilometres-per-hour,--last-speed", {"km/h", "0.1 to 400", "140"},
        "Highest vehicle speed", &v1::InefficiencyCurveStudy::set_last_speed_kilometres_per_hour);
  range("--speed-step-kilometres-per-hour,--speed-step", {"km/h", "0.001 to 400", "5"},
        "Step between two speeds", &v1::InefficiencyCurveStudy::set_speed_step_kilometres_per_hour);
  list.choice("--direction", {"up", "down"},
              "Each point starts from the steady state of the previous one; where two responses "
              "coexist, up and down differ. Default: up.",
              [&](int index) {
                study.set_direction(index == 0 ? v1::SWEEP_DIRECTION_UP : v1::SWEEP_DIRECTION_DOWN);
              });
  list.toggle(
      "--independent-points",
      "Solve each speed independently, as `tribodyn point` does, in about a third of the time: no "
      "branch is followed from speed to speed and no jump is searched for. For comparing "
      "many fluids.",
      [&] { study.set_independent_points(true); });
  list.number("--ascent-angle-degrees,--ascent", {"degrees", "-45 to 45", "0"},
              "Road slope, also in percent: 6%",
              [&](double value) { study.set_ascent_angle_degrees(value); });
  add_model_and_start_flags(list, study);
  list.toggle("--sensitivities",
              "Also differentiate the figures of each point by every parameter, of at most 300 "
              "points, and print the elasticities of the inefficiency; CSV and JSON have all.",
              [&] { study.set_sensitivities(true); });
  list.toggle(
      "--no-uncertainty",
      "Leave out the uncertainty of the inputs, which takes two to three times as long as the "
      "curve.",
      [&] { flags.leaves_out_uncertainty = true; });
  list.choices(
      "--compare", compared_words(),
      "Compute each curve also with a switch of the model, a misprint of the paper, or the "
      "other direction, separated by commas, and show the difference in percent: " +
          compared_words() + ". Leaves out the uncertainty of the inputs.",
      [&](const std::string& word) {
        v1::Simulation ignored;
        if (!apply_variant(word, ignored)) return false;
        flags.scenario.compared.push_back(word);
        return true;
      });
  list.group("Files");
  add_result_file_flag(list, "--csv", "FILE", "Also write every field of every point as CSV.",
                       flags.csv_path);
  add_plot_flag(list,
                "Also draw the curves of all lubricants, at most " +
                    std::to_string(kDistinctLooks) + " of them, as SVG.",
                flags.plot_path);
  list.choices("--panels", curve_panel_words(),
               "More panels of the plot, separated by commas: " + curve_panel_words() + ".",
               [&](const std::string& word) {
                 const std::vector<std::string> words = split(curve_panel_words(), '|');
                 if (std::find(words.begin(), words.end(), word) == words.end()) return false;
                 flags.panels.push_back(word);
                 return true;
               });
}

/// Returns the panels on request, with the half backlash of the gear set, which all curves share.
CurvePanels panels_of(const CurveFlags& flags, const std::vector<v1::Simulation>& curves,
                      Connection& connection) {
  CurvePanels out{flags.panels};
  if (out.names.empty()) return out;
  const v1::GearSet gear_set = connection.get<v1::GearSet>(curves.front().gear_set_revision());
  out.half_backlash_metres = gear_set.dynamics().half_backlash_metres();
  return out;
}

int run_curve(CurveFlags& flags, const CommonOptions& options) {
  if (flags.study.speeds_kilometres_per_hour_size() > 0) {
    flags.study.clear_first_speed_kilometres_per_hour();
    flags.study.clear_last_speed_kilometres_per_hour();
    flags.study.clear_speed_step_kilometres_per_hour();
  }
  *flags.scenario.simulation.mutable_inefficiency_curve() = flags.study;
  Connection connection = options.connect();
  const auto ended = run_scenario(flags.scenario, connection, options);
  if (ended.empty()) return kExitOk;
  const bool shows_uncertainty =
      !flags.leaves_out_uncertainty && flags.scenario.compared.empty() &&
      (options.output_format == OutputFormat::kTable || !flags.plot_path.empty());
  const CurveUncertainties uncertainties =
      shows_uncertainty ? curve_uncertainties(ended, connection) : CurveUncertainties();
  std::cout << shown_results(ended, connection, options, false, flags.scenario.details,
                             uncertainties);
  std::vector<v1::Simulation> succeeded;
  for (const v1::Simulation& simulation : ended) {
    if (simulation.state() == v1::Simulation::SUCCEEDED) succeeded.push_back(simulation);
  }
  if (options.output_format == OutputFormat::kTable && !flags.scenario.compared.empty()) {
    std::cout << "\n" << variant_report(succeeded);
  }
  if (!flags.csv_path.empty() && !succeeded.empty()) {
    write_file(flags.csv_path, points_csv(succeeded));
  }
  if (!flags.plot_path.empty() && !succeeded.empty()) {
    write_file(flags.plot_path, curve_plot(succeeded, lubricant_titles(succeeded, connection),
                                           uncertainties, panels_of(flags, succeeded, connection)));
  }
  return report_failures(ended);
}

}  // namespace

Command curve_command() {
  const auto flags = std::make_shared<CurveFlags>();
  Command command{
      "curve",
      "inefficiency against speed, for one or more lubricants, surfaces and sump temperatures",
      "Submits an inefficiency curve for each lubricant on each surface at each sump temperature, "
      "watches them together and prints a table for each.",
      {"tribodyn curve --lubricant paper-fluid-1 --lubricant paper-fluid-2 --lubricant "
       "paper-fluid-3 --csv curve.csv --plot curve.svg",
       "tribodyn curve --lubricant paper-fluid-1,paper-fluid-2 --speeds 20,60,100 --sumps 40,90",
       "tribodyn curve --lubricant paper-fluid-1 --compare isothermal,newtonian,no-boundary --plot "
       "models.svg",
       "tribodyn curve --lubricant paper-fluid-1 --first-speed 60 --last-speed 85 --speed-step 1 "
       "--direction down"},
      {},
      {},
      {}};
  add_curve_flags(command.flags, *flags);
  add_scenario_flags(command.flags, flags->scenario);
  command.check = [flags](Complaints& complaints) {
    check_scenario(flags->scenario, true, complaints);
    if (flags->has_range && flags->study.speeds_kilometres_per_hour_size() > 0) {
      complaints.emplace_back(
          "give either --speed with all speeds, or --first-speed, --last-speed and --speed-step");
    }
    if (!flags->panels.empty() && flags->plot_path.empty()) {
      complaints.emplace_back("--panels are those of a plot: add --plot FILE.svg");
    }
    const std::size_t count = simulations_of(flags->scenario).size();
    if (!flags->plot_path.empty() && count > kDistinctLooks) {
      complaints.push_back("--plot: " + std::to_string(count) + " curves; allowed: at most " +
                           std::to_string(kDistinctLooks) +
                           ", for which colours and dashes differ. Draw them in several pictures");
    }
    if (flags->study.independent_points() &&
        flags->study.direction() != v1::SWEEP_DIRECTION_UNSPECIFIED) {
      complaints.emplace_back(
          "give either --direction or --independent-points: independent points have no direction");
    }
  };
  command.main_flags = {"--lubricant",  "--speed", "--first-speed", "--last-speed",
                        "--speed-step", "--sump",  "--gear-set",    "--surface",
                        "--vehicle",    "--csv",   "--plot",        "--sensitivities"};
  command.run = [flags](const CommonOptions& options) { return run_curve(*flags, options); };
  return command;
}

}  // namespace tribodyn::client
