#include <algorithm>
#include <iostream>
#include <memory>
#include <utility>

#include "client/cpp/commands/result_files.h"
#include "client/cpp/commands/scenario.h"
#include "client/cpp/commands/uncertainty.h"
#include "client/cpp/report/report_page.h"
#include "client/cpp/text/text.h"

namespace tribodyn::client {
namespace {

/// Most lubricants of one comparison.
constexpr std::size_t kMostReported = 8;
/// Points of one comparison and of one explanation, and combinations of an explanation.
constexpr int kComparedPoints = 10'000, kReportExplainedPoints = 64'000, kReportCombinations = 64;
constexpr int kComparisonDraws = 199, kReportExplanationDraws = 99, kFewestReportDraws = 19;

struct ReportFlags {
  v1::InefficiencyCurveStudy study;
  Scenario scenario;
  std::string html_path;
};

/// Returns the draws with which `points` times (draws + 1) is at most `most`.
int draws_for(int points, int most, int wanted) {
  return std::clamp(most / std::max(1, points) - 1, kFewestReportDraws, wanted);
}

/// Sets what comparison and explanation have in common with the curves.
template <class Request>
void set_scene(const v1::Simulation& simulation, Request& request) {
  request.set_gear_set(simulation.gear_set_revision());
  request.set_surface(simulation.surface_revision());
  request.set_vehicle(simulation.vehicle_revision());
  request.set_sheared_lubricant(simulation.sheared_lubricant());
  *request.mutable_model_options() = simulation.model_options();
  for (const v1::CurvePoint& point : simulation.result().points()) {
    v1::PointCondition& condition = *request.add_conditions();
    condition.set_speed_kilometres_per_hour(point.speed_kilometres_per_hour());
    condition.set_ascent_angle_degrees(simulation.inefficiency_curve().ascent_angle_degrees());
    if (simulation.has_sump_temperature_celsius()) {
      condition.set_sump_temperature_celsius(simulation.sump_temperature_celsius());
    }
    if (simulation.has_inlet_temperature_rise_kelvin()) {
      condition.set_inlet_temperature_rise_kelvin(simulation.inlet_temperature_rise_kelvin());
    }
  }
}

ReportContents contents_of(std::vector<v1::Simulation> curves, Connection& connection) {
  ReportContents out;
  out.curves = std::move(curves);
  const v1::Simulation& first = out.curves.front();
  out.titles = lubricant_titles(out.curves, connection);
  out.uncertainties = curve_uncertainties(out.curves, connection);
  set_scene(first, out.comparison_request);
  out.comparison_request.set_tolerance(first.solver_options().tolerance());
  for (const v1::Simulation& curve : out.curves) {
    out.comparison_request.add_lubricants(curve.lubricant_revision());
    out.lubricants.push_back(connection.get<v1::Lubricant>(curve.lubricant_revision()));
  }
  const int speeds = out.comparison_request.conditions_size();
  out.comparison_request.set_draws(
      draws_for(speeds * static_cast<int>(out.curves.size()), kComparedPoints, kComparisonDraws));
  out.comparison = connection.compare_points(out.comparison_request);
  for (std::size_t i = 1; i < out.curves.size(); ++i) {
    v1::ExplainPointsRequest request;
    set_scene(first, request);
    request.set_lubricant(first.lubricant_revision());
    request.set_other_lubricant(out.curves[i].lubricant_revision());
    request.set_other_sheared_lubricant(first.sheared_lubricant());
    request.set_draws(
        draws_for(speeds * kReportCombinations, kReportExplainedPoints, kReportExplanationDraws));
    out.explanations.push_back({request, connection.explain_points(request)});
  }
  return out;
}

/// Returns the command line that makes the report again, with the revisions of the lubricants.
std::string command_text(const ReportContents& contents) {
  const v1::Simulation& first = contents.curves.front();
  std::string out = "tribodyn report";
  for (const v1::Simulation& curve : contents.curves) {
    out += " " + resource_id(curve.lubricant_revision());
  }
  std::vector<std::string> speeds;
  for (const v1::CurvePoint& point : first.result().points()) {
    speeds.push_back(shortest(point.speed_kilometres_per_hour()));
  }
  out += " --speeds " + joined(speeds, ",");
  const double ascent = first.inefficiency_curve().ascent_angle_degrees();
  if (ascent != 0) out += " --ascent " + shortest(ascent);
  if (first.has_sump_temperature_celsius()) {
    out += " --sump " + shortest(first.sump_temperature_celsius());
  }
  if (first.sheared_lubricant()) out += " --condition sheared";
  const v1::StatedLimits& limits = first.stated_limits();
  for (const auto& [flag, value] :
       {std::pair{" --minimum-film-ratio ", limits.minimum_film_ratio()},
        std::pair{" --pressure-limit ", limits.pressure_limit_pascals()},
        std::pair{" --contact-temperature-limit ", limits.contact_temperature_limit_celsius()},
        std::pair{" --flash-temperature-limit ", limits.flash_temperature_rise_limit_kelvin()}}) {
    if (value != 0) out += flag + shortest(value);
  }
  return out + " --gear-set " + resource_id(first.gear_set_revision()) + " --surface " +
         resource_id(first.surface_revision()) + " --vehicle " +
         resource_id(first.vehicle_revision()) + " --html FILE.html";
}

int run_report(ReportFlags& flags, const CommonOptions& options) {
  if (flags.study.speeds_kilometres_per_hour().empty()) {
    flags.study.set_first_speed_kilometres_per_hour(20);
    flags.study.set_last_speed_kilometres_per_hour(140);
    flags.study.set_speed_step_kilometres_per_hour(5);
  }
  *flags.scenario.simulation.mutable_inefficiency_curve() = flags.study;
  Connection connection = options.connect();
  const auto ended = run_scenario(flags.scenario, connection, options);
  if (ended.empty()) return kExitOk;
  const int code = report_failures(ended);
  if (code != kExitOk) return code;
  ReportContents contents = contents_of(ended, connection);
  contents.command = command_text(contents);
  write_file(flags.html_path, report_page(contents));
  std::cout << flags.html_path << "\n";
  return kExitOk;
}

}  // namespace

Command report_command() {
  const auto flags = std::make_shared<ReportFlags>();
  Command command{
      "report",
      "one HTML page about lubricants: curves, comparison, reasons, assumptions",
      "Computes inefficiency curves, compares the other lubricants with the first, explains the "
      "differences, and writes all of it to one HTML page that needs no other file: plots, tables, "
      "uncertainties, warnings, assumptions, revisions and hashes.",
      {"tribodyn report my-oil their-oil --html report.html",
       "tribodyn report my-oil --speeds 30,60,120 --sump 90 --html my-oil.html"},
      {},
      {},
      {}};
  command.flags.group("Arguments");
  command.flags
      .texts("lubricants", "NAME", "Lubricants, at most 8. The others are compared with the first.",
             [flags](const std::string& name) { flags->scenario.lubricants.push_back(name); })
      .collection = "lubricants";
  command.flags.group("Curve");
  command.flags.numbers(
      "--speeds-kilometres-per-hour,--speeds,--speed", {"km/h", "0.1 to 400", "20 to 140 by 5"},
      "Vehicle speeds separated by commas",
      [flags](double value) { flags->study.add_speeds_kilometres_per_hour(value); });
  command.flags.number("--ascent-angle-degrees,--ascent", {"degrees", "-45 to 45", "0"},
                       "Road slope, also in percent: 6%",
                       [flags](double value) { flags->study.set_ascent_angle_degrees(value); });
  command.flags.group("Files");
  add_result_file_flag(command.flags, "--html", "FILE.html", "The page to write.",
                       flags->html_path);
  add_scenario_flags(command.flags, flags->scenario);
  command.check = [flags](Complaints& complaints) {
    check_scenario(flags->scenario, true, complaints);
    if (flags->html_path.empty()) {
      complaints.emplace_back("give the page to write: --html FILE.html");
    }
    if (flags->scenario.lubricants.size() > kMostReported) {
      complaints.push_back(std::to_string(flags->scenario.lubricants.size()) +
                           " lubricants; allowed: at most " + std::to_string(kMostReported));
    }
    if (flags->scenario.sumps.size() > 1) {
      complaints.emplace_back("--sump: one temperature only; write a report for each");
    }
  };
  command.main_flags = {"--html",     "--speeds",  "--ascent", "--sump",
                        "--gear-set", "--surface", "--vehicle"};
  command.run = [flags](const CommonOptions& options) { return run_report(*flags, options); };
  return command;
}

}  // namespace tribodyn::client
