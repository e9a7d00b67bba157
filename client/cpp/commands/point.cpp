#include <iostream>
#include <memory>

#include "client/cpp/commands/operating_point.h"
#include "client/cpp/commands/scenario.h"
#include "client/cpp/commands/show_results.h"

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
  std::cout << shown_results(ended, connection, options, true, flags.scenario.shows_assumptions);
  return report_failures(ended);
}

}  // namespace

Command point_command() {
  const auto flags = std::make_shared<PointFlags>();
  Command command{
      "point",
      "one operating point, in full",
      "Submits one operating point, watches it and prints inefficiencies, losses, film, "
      "temperatures, contact loss, solver statistics and the number of assumptions.",
      {"tribodyn point --lubricant paper-fluid-1 --speed-kilometres-per-hour 72.5",
       "tribodyn point --lubricant paper-fluid-2 --speed 100 --sump-temperature-celsius 90 "
       "--isothermal",
       "tribodyn point --lubricant paper-fluid-1 --pinion-torque-newton-metres 60 "
       "--pinion-speed-radians-per-second 200 --output json"},
      {},
      {},
      {}};
  add_operating_point_flags(command.flags, flags->point);
  add_scenario_flags(command.flags, flags->scenario);
  command.check = [flags](Complaints& complaints) {
    check_operating_point(flags->point, complaints);
    check_scenario(flags->scenario, false, complaints);
  };
  command.main_flags = {"--lubricant",    "--speed",   "--torque",     "--pinion-speed",
                        "--acceleration", "--ascent",  "--sump",       "--gear-set",
                        "--surface",      "--vehicle", "--assumptions"};
  command.run = [flags](const CommonOptions& options) { return run_point(*flags, options); };
  return command;
}

}  // namespace tribodyn::client
