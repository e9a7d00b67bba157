#include <algorithm>
#include <iostream>
#include <memory>

#include "client/cpp/commands/result_files.h"
#include "client/cpp/commands/scenario.h"
#include "client/cpp/plot/comparison_plot.h"
#include "client/cpp/report/comparison_report.h"
#include "client/cpp/text/text.h"
#include "tribodyn/v1/points.pb.h"

namespace tribodyn::client {
namespace {

/// The request, and what all of its conditions have in common.
struct CompareFlags {
  v1::ComparePointsRequest request;
  std::vector<double> speeds, sumps;
  std::vector<double> speed_weights, sump_weights;
  v1::PointCondition common;
  std::string plot_path;
};

void add_compare_flags(FlagList& list, CompareFlags& flags) {
  v1::ComparePointsRequest& request = flags.request;
  list.group("Arguments");
  list.texts("lubricant", "NAME",
             "Lubricants, at most 8; NAME@REVISION is an older revision. The others are compared "
             "with the first; a single one gets its uncertainty alone.",
             [&request](const std::string& name) {
               request.add_lubricants(resource_name("lubricants", name));
             })
      .collection = "lubricants";
  list.group("Conditions (every speed at every sump temperature)");
  list.numbers("--speed-kilometres-per-hour,--speed,--speeds", {"km/h", "0.1 to 400", "60"},
               "Vehicle speeds separated by commas",
               [&flags](double value) { flags.speeds.push_back(value); });
  list.numbers("--condition-weights,--weights", {"-", "1e-9 to 1e9", "equal"},
               "Weights of the speeds in the mean, one for each",
               [&flags](double value) { flags.speed_weights.push_back(value); });
  list.number("--ascent-angle-degrees,--ascent", {"degrees", "-45 to 45", "0"},
              "Road slope, also in percent: 6%",
              [&flags](double value) { flags.common.set_ascent_angle_degrees(value); });
  list.numbers("--sump-temperature-celsius,--sump,--sumps", {"C", "-70 to 200", "40"},
               "Temperatures of the oil bath separated by commas",
               [&flags](double value) { flags.sumps.push_back(value); });
  list.numbers("--sump-weights", {"-", "1e-9 to 1e9", "equal"},
               "Weights of the temperatures of the oil bath in the mean, one for each",
               [&flags](double value) { flags.sump_weights.push_back(value); });
  list.number("--inlet-temperature-rise-kelvin", {"K", "0 to 300", "20"},
              "Temperature rise from the oil bath to the inlet of the contact (eq 14)",
              [&flags](double value) { flags.common.set_inlet_temperature_rise_kelvin(value); });
  list.text("--gear-set", "NAME", "Gear set with its driveline. Default: reference-axle.",
            [&request](const std::string& name) {
              request.set_gear_set(resource_name("gearSets", name));
            })
      .collection = "gearSets";
  list.text("--surface", "NAME", "Surface: composite roughness of the flanks. Default: run-in.",
            [&request](const std::string& name) {
              request.set_surface(resource_name("surfaces", name));
            })
      .collection = "surfaces";
  list.text("--vehicle", "NAME", "Vehicle: road load. Default: passenger-car.",
            [&request](const std::string& name) {
              request.set_vehicle(resource_name("vehicles", name));
            })
      .collection = "vehicles";
  list.choice(
          "--condition", {"fresh", "sheared"},
          "fresh: the lubricants as they are stated; sheared: as they are after the shear test, "
          "by KV100 after it. Default: fresh.",
          [&request](int index) { request.set_sheared_lubricant(index == 1); })
      .field = "sheared_lubricant";
  list.group("Uncertainty");
  list.number("--sump-temperature-uncertainty-kelvin,--sump-uncertainty", {"K", "0 to 100", "0"},
              "Standard uncertainty of the temperature of the oil bath",
              [&request](double value) { request.set_sump_temperature_uncertainty_kelvin(value); });
  list.number(
      "--inlet-temperature-rise-uncertainty-kelvin", {"K", "0 to 100", "0"},
      "Standard uncertainty of the temperature rise to the inlet",
      [&request](double value) { request.set_inlet_temperature_rise_uncertainty_kelvin(value); });
  list.number("--estimate-correlation", {"-", "0 to 1", "0.5"},
              "Correlation of the errors of estimates that one estimator made for lubricants of "
              "one class of base oil",
              [&request](double value) { request.set_estimate_correlation(value); });
  list.whole_number("--draws", {"draws", "19 to 1999", "199"}, "Draws of the inputs",
                    [&request](int value) { request.set_draws(value); });
  list.number("--tolerance", {"-", "1e-8 to 0.01", "0.001"},
              "Target of the relative solver error of every point",
              [&request](double value) { request.set_tolerance(value); });
  add_model_flags(list, *request.mutable_model_options());
  list.group("Output");
  add_plot_flag(list, "Also draw the lubricants and their differences over speed as SVG.",
                flags.plot_path);
}

/// Sets every speed at every sump temperature, and the products of their weights.
void set_compared_conditions(const CompareFlags& flags, v1::ComparePointsRequest& request) {
  const std::vector<double> speeds = flags.speeds.empty() ? std::vector{60.0} : flags.speeds;
  const bool has_weights = !flags.speed_weights.empty() || !flags.sump_weights.empty();
  const std::size_t sumps = std::max<std::size_t>(flags.sumps.size(), 1);
  for (std::size_t j = 0; j < sumps; ++j) {
    for (std::size_t i = 0; i < speeds.size(); ++i) {
      v1::PointCondition& condition = *request.add_conditions();
      condition = flags.common;
      condition.set_speed_kilometres_per_hour(speeds[i]);
      if (!flags.sumps.empty()) condition.set_sump_temperature_celsius(flags.sumps[j]);
      if (!has_weights) continue;
      request.add_condition_weights((flags.speed_weights.empty() ? 1 : flags.speed_weights[i]) *
                                    (flags.sump_weights.empty() ? 1 : flags.sump_weights[j]));
    }
  }
}

int run_compare(CompareFlags& flags, const CommonOptions& options) {
  v1::ComparePointsRequest& request = flags.request;
  set_compared_conditions(flags, request);
  const v1::ComparePointsResponse response = options.connect().compare_points(request);
  switch (options.output_format) {
    case OutputFormat::kTable:
      std::cout << comparison_report(request, response);
      break;
    case OutputFormat::kCsv:
      std::cout << comparison_csv(request, response);
      break;
    case OutputFormat::kJson:
      std::cout << json_text(response);
  }
  if (!flags.plot_path.empty()) {
    write_file(flags.plot_path, comparison_plot(request, response));
  }
  return kExitOk;
}

}  // namespace

Command compare_command() {
  const auto flags = std::make_shared<CompareFlags>();
  Command command{
      "compare",
      "which of two lubricants loses less, and how sure that is",
      "Computes lubricants at the same speeds and sump temperatures with the uncertainty of their "
      "inputs and prints them side by side: inefficiency with the errors of inputs and solver, the "
      "difference with its "
      "95 % interval, the probability that it is real, and what to measure to know better. Nothing "
      "is stored.",
      {"tribodyn compare paper-fluid-1 my-oil --speed 20,60,100 --sump 90",
       "tribodyn compare my-oil --speed 60",
       "tribodyn compare oil-a oil-b oil-c --speed 20,60,100,140 --plot compared.svg",
       "tribodyn compare oil-a oil-b --speed 30,60 --estimate-correlation 0.8 --output csv",
       "tribodyn compare oil-a oil-b --speed 30,60,120 --weights 1,2,1",
       "tribodyn compare oil-a oil-b --speed 30,60,120 --sumps 40,90 --sump-weights 1,3"},
      {},
      {},
      {}};
  add_compare_flags(command.flags, *flags);
  command.check = [flags](Complaints& complaints) {
    if (flags->request.lubricants().empty()) {
      complaints.emplace_back("give lubricants: tribodyn compare A B");
    }
    const auto check_weights = [&complaints](const char* flag, std::size_t weights,
                                             std::size_t values, const std::string& noun) {
      values = std::max<std::size_t>(values, 1);  // the default
      if (weights == 0 || weights == values) return;
      complaints.push_back(std::string(flag) + ": " + std::to_string(weights) + " weights of " +
                           std::to_string(values) + " " + noun + "s; give one for each " + noun);
    };
    check_weights("--weights", flags->speed_weights.size(), flags->speeds.size(), "speed");
    check_weights("--sump-weights", flags->sump_weights.size(), flags->sumps.size(),
                  "sump temperature");
  };
  command.main_flags = {"--speed",   "--weights",      "--ascent",
                        "--sump",    "--sump-weights", "--gear-set",
                        "--surface", "--vehicle",      "--estimate-correlation",
                        "--plot"};
  command.run = [flags](const CommonOptions& options) { return run_compare(*flags, options); };
  return command;
}

}  // namespace tribodyn::client
