#include <iostream>
#include <memory>

#include "client/cpp/commands/operating_point.h"
#include "client/cpp/commands/scenario.h"
#include "client/cpp/commands/show_results.h"
#include "client/cpp/report/comparison_report.h"
#include "client/cpp/report/sensitivity_report.h"
#include "client/cpp/text/text.h"

namespace tribodyn::client {
namespace {

struct PointFlags {
  OperatingPointFlags point;
  Scenario scenario;
};

/// Whether the uncertainty of a simulation's inputs can be found by screened points: a cruise that
/// starts as they do.
bool can_be_screened(const v1::Simulation& simulation) {
  const v1::OperatingPointStudy& point = simulation.operating_point();
  const auto method = simulation.solver_options().method();
  return simulation.state() == v1::Simulation::SUCCEEDED && point.has_cruise() &&
         point.start() != v1::POINT_START_LARGE_VIBRATION &&
         point.model() != v1::POINT_MODEL_QUASI_STATIC && method != v1::STEADY_STATE_METHOD_MARCH;
}

/// Returns the figures of the simulation with the uncertainty of its inputs, or why there are none.
std::string uncertainty_of(const v1::Simulation& simulation, Connection& connection) {
  v1::ComparePointsRequest request;
  request.add_lubricants(simulation.lubricant_revision());
  request.set_gear_set(simulation.gear_set_revision());
  request.set_surface(simulation.surface_revision());
  request.set_vehicle(simulation.vehicle_revision());
  *request.mutable_model_options() = simulation.model_options();
  request.set_tolerance(simulation.solver_options().tolerance());
  v1::PointCondition& condition = *request.add_conditions();
  const v1::Cruise& cruise = simulation.operating_point().cruise();
  condition.set_speed_kilometres_per_hour(cruise.speed_kilometres_per_hour());
  condition.set_ascent_angle_degrees(cruise.ascent_angle_degrees());
  if (simulation.has_sump_temperature_celsius()) {
    condition.set_sump_temperature_celsius(simulation.sump_temperature_celsius());
  }
  if (simulation.has_inlet_temperature_rise_kelvin()) {
    condition.set_inlet_temperature_rise_kelvin(simulation.inlet_temperature_rise_kelvin());
  }
  try {
    return uncertainty_report(connection.compare_points(request));
  } catch (const ServiceError& error) {  // the result stands without it
    return wrapped("The uncertainty of the inputs was not computed: " + printable(error.what()), 2);
  }
}

int run_point(PointFlags& flags, const CommonOptions& options) {
  *flags.scenario.simulation.mutable_operating_point() = operating_point_study(flags.point);
  Connection connection = options.connect();
  const auto ended = run_scenario(flags.scenario, connection, options);
  std::cout << shown_results(ended, connection, options, true, flags.scenario.shows_assumptions);
  for (const v1::Simulation& simulation : ended) {
    if (options.output_format != OutputFormat::kTable) continue;
    if (can_be_screened(simulation)) {
      std::cout << "\n" << uncertainty_of(simulation, connection);
    }
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
      case OutputFormat::kTable:
        std::cout << sensitivity_report(simulation.result().points(0).result());
        break;
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
      "temperatures, contact loss, solver statistics and the number of assumptions; of a cruise "
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
