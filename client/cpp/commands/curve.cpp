#include <iostream>
#include <map>
#include <memory>

#include "client/cpp/commands/operating_point.h"
#include "client/cpp/commands/scenario.h"
#include "client/cpp/plot/curve_plot.h"
#include "client/cpp/report/curve_report.h"
#include "client/cpp/report/results.h"

namespace tribodyn::client {
namespace {

// The paper's curve.
constexpr double kFirstSpeed = 20;
constexpr double kLastSpeed = 140;
constexpr double kSpeedStep = 5;

struct CurveFlags {
  v1::InefficiencyCurveStudy study;
  Scenario scenario;
  std::string csv_path;
  std::string plot_path;
};

void add_curve_flags(FlagList& list, CurveFlags& flags) {
  v1::InefficiencyCurveStudy& study = flags.study;
  study.set_first_speed_kilometers_per_hour(kFirstSpeed);
  study.set_last_speed_kilometers_per_hour(kLastSpeed);
  study.set_speed_step_kilometers_per_hour(kSpeedStep);
  list.group("Curve");
  list.number("--first-speed-kilometers-per-hour,--first-speed", {"km/h", "0.1 to 400", "20"},
              "Lowest vehicle speed",
              [&](double value) { study.set_first_speed_kilometers_per_hour(value); });
  list.number("--last-speed-kilometers-per-hour,--last-speed", {"km/h", "0.1 to 400", "140"},
              "Highest vehicle speed",
              [&](double value) { study.set_last_speed_kilometers_per_hour(value); });
  list.number("--speed-step-kilometers-per-hour,--speed-step", {"km/h", "0.001 to 400", "5"},
              "Between two points",
              [&](double value) { study.set_speed_step_kilometers_per_hour(value); });
  list.choice("--direction", {"up", "down"},
              "Each point starts from the steady state before it; where two responses coexist, up "
              "and down differ. Default: up.",
              [&](int index) { study.set_direction(index == 0 ? v1::UP : v1::DOWN); });
  list.number("--ascent-angle-degrees,--ascent", {"degrees", "-45 to 45", "0"}, "Road slope",
              [&](double value) { study.set_ascent_angle_degrees(value); });
  add_model_and_start_flags(list, study);
  list.group("Files");
  list.text("--csv", "FILE", "Also write every field of every point as CSV.",
            [&](const std::string& path) { flags.csv_path = path; });
  list.text("--plot", "FILE.svg", "Also draw the curves of all lubricants.",
            [&](const std::string& path) { flags.plot_path = path; });
}

/// Titles for the plot; a picture without them is still a picture, so no error ends the command.
std::map<std::string, std::string> titles_of(const std::vector<v1::Simulation>& simulations,
                                             Connection& connection) {
  std::map<std::string, std::string> titles;
  for (const v1::Simulation& simulation : simulations) {
    try {
      titles[simulation.lubricant()] =
          connection.get<v1::Lubricant>(simulation.lubricant()).display_name();
    } catch (const ServiceError&) {
      continue;
    }
  }
  return titles;
}

int run_curve(CurveFlags& flags, const CommonOptions& options) {
  *flags.scenario.simulation.mutable_inefficiency_curve() = flags.study;
  Connection connection = options.connect();
  const auto ended = run_scenario(flags.scenario, connection, options.progress_form());
  if (ended.empty()) return kExitOk;
  std::cout << results_text(ended, options.output_format, false, flags.scenario.shows_assumptions);
  std::vector<v1::Simulation> succeeded;
  for (const v1::Simulation& simulation : ended) {
    if (simulation.state() == v1::Simulation::SUCCEEDED) succeeded.push_back(simulation);
  }
  if (!flags.csv_path.empty() && !succeeded.empty()) {
    write_file(flags.csv_path, points_csv(succeeded));
  }
  if (!flags.plot_path.empty() && !succeeded.empty()) {
    write_file(flags.plot_path, curve_plot(succeeded, titles_of(succeeded, connection)));
  }
  return report_failures(ended);
}

}  // namespace

Command curve_command() {
  const auto flags = std::make_shared<CurveFlags>();
  Command command{
      "curve",
      "inefficiency against speed, for one or more lubricants",
      "Submits an inefficiency curve for each lubricant, follows them together and prints a table "
      "for each.",
      {"tribodyn curve --lubricant 1 --lubricant 2 --lubricant 3 --csv curve.csv --plot curve.svg",
       "tribodyn curve --lubricant 1 --first-speed 60 --last-speed 85 --speed-step 1 "
       "--direction down"},
      {},
      {},
      {}};
  add_curve_flags(command.flags, *flags);
  add_scenario_flags(command.flags, flags->scenario);
  command.check = [flags](Complaints& complaints) {
    check_scenario(flags->scenario, true, complaints);
  };
  command.run = [flags](const CommonOptions& options) { return run_curve(*flags, options); };
  return command;
}

}  // namespace tribodyn::client
