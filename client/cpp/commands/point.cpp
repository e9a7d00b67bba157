#include <iostream>
#include <memory>

#include "client/cpp/commands/operating_point.h"
#include "client/cpp/commands/scenario.h"
#include "client/cpp/commands/show_results.h"
#include "client/cpp/commands/uncertainty.h"
#include "client/cpp/report/sensitivity_report.h"
#include "client/cpp/text/warnings.h"

namespace tribodyn::client {
namespace {

struct PointFlags {
  OperatingPointFlags point;
  Scenario scenario;
};

int run_point(PointFlags& flags, const CommonOptions& options) {
  *flags.scenario.simulation.mutable_operating_point() = operating_point_study(flags.point);
  Connection connection = options.connect();
  const auto ended = run_scenario(flags.scenario, connection, options);
  std::cout << shown_results(ended, connection, options, true, flags.scenario.details);
  for (const v1::Simulation& simulation : ended) {
    if (options.output_format != OutputFormat::kTable) continue;
    const std::string uncertainty = point_uncertainty(simulation, connection);
    if (!uncertainty.empty()) std::cout << "\n" << uncertainty;
    if (simulation.state() == v1::Simulation::SUCCEEDED &&
        simulation.operating_point().sensitivities()) {
      std::cout << "\n" << sensitivity_report(simulation.result().points(0).result());
    }
  }
  return report_failures(ended);
}

int run_sensitivities(PointFlags& flags, const CommonOptions& options) {
  flags.point.study.set_sensitivities(true);
  *flags.scenario.simulation.mutable_operating_point() = operating_point_study(flags.point);
  Connection connection = options.connect();
  const auto ended = run_scenario(flags.scenario, connection, options);
  for (const v1::Simulation& simulation : ended) {
    if (simulation.state() != v1::Simulation::SUCCEEDED) continue;
    switch (options.output_format) {
      case OutputFormat::kTable: {
        Sheet warnings;
        add_warnings(simulation, warnings);
        std::cout << sensitivity_report(simulation.result().points(0).result()) << "\n"
                  << warnings.text();
        break;
      }
      case OutputFormat::kCsv:
        std::cout << sensitivity_csv(simulation.result().points(0).result());
        break;
      case OutputFormat::kJson:
        std::cout << json_text(simulation);
    }
  }
  return report_failures(ended);
}

}  // namespace

Command point_command() {
  const auto flags = std::make_shared<PointFlags>();
  Command command{
      "point",
      "one operating point, in full",
      "Submits one operating point, watches it and prints inefficiencies, losses, film, "
      "temperatures, contact loss and the number of assumptions; of a cruise "
      "also the uncertainty that the stated uncertainties of the inputs make.",
      {"tribodyn point --lubricant paper-fluid-1 --speed-kilometres-per-hour 72.5",
       "tribodyn point --lubricant paper-fluid-2 --speed 100 --sump-temperature-celsius 90 "
       "--isothermal",
       "tribodyn point --lubricant paper-fluid-1 --pinion-torque-newton-metres 60 "
       "--pinion-speed-radians-per-second 200 --output json"},
      {},
      {},
      {}};
  add_operating_point_flags(command.flags, flags->point);
  command.flags.toggle(
      "--sensitivities",
      "Also differentiate the figures by every parameter and print the elasticities. `tribodyn "
      "sensitivities` prints them alone.",
      [flags] { flags->point.study.set_sensitivities(true); });
  command.flags.toggle("--solver-details", kSolverDetailsHelp,
                       [flags] { flags->scenario.details.solver = true; });
  add_scenario_flags(command.flags, flags->scenario);
  command.check = [flags](Complaints& complaints) {
    check_operating_point(flags->point, complaints);
    check_scenario(flags->scenario, false, complaints);
  };
  command.main_flags = {"--lubricant",    "--speed",   "--torque",      "--pinion-speed",
                        "--acceleration", "--ascent",  "--sump",        "--gear-set",
                        "--surface",      "--vehicle", "--assumptions", "--sensitivities"};
  command.run = [flags](const CommonOptions& options) { return run_point(*flags, options); };
  return command;
}

Command sensitivities_command() {
  const auto flags = std::make_shared<PointFlags>();
  Command command{
      "sensitivities",
      "which parameter moves the inefficiency of an operating point, and how far",
      "Submits one operating point, watches it and prints the elasticities of its figures by every "
      "scalar parameter of lubricant, surface, solids, temperatures, speed and load: exact "
      "derivatives, largest first, with bars.",
      {"tribodyn sensitivities my-oil --speed 60",
       "tribodyn sensitivities my-oil --speed 100 --sump 90 --output csv"},
      {},
      {},
      {}};
  command.flags.group("Arguments");
  command.flags
      .text("lubricant", "LUBRICANT", "A lubricant, e.g. my-oil or my-oil@2.",
            [flags](const std::string& name) { flags->scenario.lubricants.push_back(name); })
      .collection = "lubricants";
  add_operating_point_flags(command.flags, flags->point);
  add_scenario_flags(command.flags, flags->scenario);
  command.check = [flags](Complaints& complaints) {
    check_operating_point(flags->point, complaints);
    check_scenario(flags->scenario, false, complaints);
  };
  command.main_flags = {"--speed", "--torque",   "--pinion-speed", "--ascent",
                        "--sump",  "--gear-set", "--surface",      "--vehicle"};
  command.run = [flags](const CommonOptions& options) {
    return run_sensitivities(*flags, options);
  };
  return command;
}

}  // namespace tribodyn::client
