#include <algorithm>
#include <iostream>
#include <memory>

#include "client/cpp/commands/result_files.h"
#include "client/cpp/commands/scenario.h"
#include "client/cpp/plot/explanation_plot.h"
#include "client/cpp/report/explanation_report.h"
#include "client/cpp/text/text.h"
#include "tribodyn/v1/points.pb.h"

namespace tribodyn::client {
namespace {

/// Draws by default, and the fewest that the server takes.
constexpr int kExplanationDraws = 99, kFewestDraws = 19;
/// Points of one request, and combinations of the six groups.
constexpr int kExplainedPoints = 64'000, kGroupCombinations = 64;

/// The request, and what all of its conditions have in common.
struct ExplainFlags {
  v1::ExplainPointsRequest request;
  std::vector<double> speeds;
  v1::PointCondition common;
  std::string plot_path;
};

void add_explain_flags(FlagList& list, ExplainFlags& flags) {
  v1::ExplainPointsRequest& request = flags.request;
  list.group("Arguments");
  list.text("lubricant", "A", "A lubricant, e.g. paper-fluid-1, or a revision of it.",
            [&request](const std::string& name) {
              request.set_lubricant(resource_name("lubricants", name));
            })
      .collection = "lubricants";
  list.text("other_lubricant", "B", "The lubricant whose difference from A is explained.",
            [&request](const std::string& name) {
              request.set_other_lubricant(resource_name("lubricants", name));
            })
      .collection = "lubricants";
  list.group("Conditions");
  list.numbers("--speed-kilometres-per-hour,--speed,--speeds", {"km/h", "0.1 to 400", "60"},
               "Vehicle speeds separated by commas",
               [&flags](double value) { flags.speeds.push_back(value); });
  list.numbers("--condition-weights,--weights", {"-", "1e-9 to 1e9", "equal"},
               "Weights of the speeds in the mean, one for each",
               [&request](double value) { request.add_condition_weights(value); });
  list.number("--ascent-angle-degrees,--ascent", {"degrees", "-45 to 45", "0"},
              "Road slope, also in percent: 6%",
              [&flags](double value) { flags.common.set_ascent_angle_degrees(value); });
  list.number("--sump-temperature-celsius,--sump", {"C", "-70 to 200", "40"},
              "Temperature of the oil bath",
              [&flags](double value) { flags.common.set_sump_temperature_celsius(value); });
  list.number("--inlet-temperature-rise-kelvin", {"K", "0 to 300", "20"},
              "Temperature rise from the oil bath to the inlet of the contact (eq 14)",
              [&flags](double value) { flags.common.set_inlet_temperature_rise_kelvin(value); });
  list.text("--gear-set", "NAME", "Gear set with its driveline. Default: reference-axle.",
            [&request](const std::string& name) {
              request.set_gear_set(resource_name("gearSets", name));
            })
      .collection = "gearSets";
  list.text("--surface", "NAME", "Surface with its boundary film. Default: run-in.",
            [&request](const std::string& name) {
              request.set_surface(resource_name("surfaces", name));
            })
      .collection = "surfaces";
  list.text("--other-surface", "NAME",
            "Surface with the boundary film that B makes. Default: that of --surface.",
            [&request](const std::string& name) {
              request.set_other_surface(resource_name("surfaces", name));
            })
      .collection = "surfaces";
  list.text("--vehicle", "NAME", "Vehicle: road load. Default: passenger-car.",
            [&request](const std::string& name) {
              request.set_vehicle(resource_name("vehicles", name));
            })
      .collection = "vehicles";
  list.choice(
          "--condition", {"fresh", "sheared"},
          "fresh: A as it is stated; sheared: as it is after the shear test, by KV100 after it. "
          "Default: fresh.",
          [&request](int index) { request.set_sheared_lubricant(index == 1); })
      .field = "sheared_lubricant";
  list.choice("--other-condition", {"fresh", "sheared"}, "The same for B.",
              [&request](int index) { request.set_other_sheared_lubricant(index == 1); })
      .field = "other_sheared_lubricant";
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
  list.whole_number("--draws",
                    {"draws", "19 to 1999", "99, from 11 speeds on as many as one request takes"},
                    "Draws of the inputs", [&request](int value) { request.set_draws(value); });
  list.number("--tolerance", {"-", "1e-8 to 0.01", "0.0001"},
              "Target of the relative solver error of every point",
              [&request](double value) { request.set_tolerance(value); });
  add_model_flags(list, *request.mutable_model_options());
  list.group("Output");
  add_plot_flag(list, "Also draw the shares as SVG.", flags.plot_path);
}

int run_explain(ExplainFlags& flags, const CommonOptions& options) {
  v1::ExplainPointsRequest& request = flags.request;
  if (flags.speeds.empty()) flags.speeds.push_back(60);
  for (const double speed : flags.speeds) {
    v1::PointCondition& condition = *request.add_conditions();
    condition = flags.common;
    condition.set_speed_kilometres_per_hour(speed);
  }
  if (request.draws() == 0) {
    const int most = kExplainedPoints / kGroupCombinations / request.conditions_size() - 1;
    request.set_draws(std::clamp(most, kFewestDraws, kExplanationDraws));
  }
  const v1::ExplainPointsResponse response = options.connect().explain_points(request);
  const bool has_figures = response.mean().refusal_reason().empty();
  switch (options.output_format) {
    case OutputFormat::kTable:
      std::cout << explanation_report(request, response);
      break;
    case OutputFormat::kCsv:
      std::cout << explanation_csv(request, response);
      break;
    case OutputFormat::kJson:
      std::cout << json_text(response);
  }
  if (!flags.plot_path.empty() && has_figures) {
    write_file(flags.plot_path, explanation_plot(request, response));
  }
  return has_figures ? kExitOk : kExitFailed;
}

}  // namespace

Command explain_command() {
  const auto flags = std::make_shared<ExplainFlags>();
  Command command{
      "explain",
      "why one lubricant loses more than another",
      "Attributes the difference of two lubricants to six groups of parameters: viscosity and its "
      "temperature law, pressure response, shear thinning, limiting shear stress, thermal "
      "properties, and the boundary film of the surface. All 64 combinations of the groups of both "
      "are computed; the shares (Shapley values) sum to the difference. Nothing is stored.",
      {"tribodyn explain paper-fluid-1 paper-fluid-2 --speed 20,60,100",
       "tribodyn explain my-oil their-oil --speed 30,60,120 --weights 1,2,1 --sump 90 --plot "
       "why.svg",
       "tribodyn explain my-oil my-oil --surface run-in --other-surface phosphate-film",
       "tribodyn explain my-oil my-oil --other-condition sheared"},
      {},
      {},
      {}};
  add_explain_flags(command.flags, *flags);
  command.check = [flags](Complaints& complaints) {
    if (flags->request.other_lubricant().empty()) {
      complaints.emplace_back("give two lubricants: tribodyn explain A B");
    }
    const std::size_t weights = static_cast<std::size_t>(flags->request.condition_weights_size());
    const std::size_t speeds = flags->speeds.empty() ? 1 : flags->speeds.size();
    if (weights != 0 && weights != speeds) {
      complaints.push_back("--weights: " + std::to_string(weights) + " weights of " +
                           std::to_string(speeds) + " speeds; give one for each speed");
    }
  };
  command.main_flags = {"--speed",   "--weights",       "--ascent",  "--sump", "--gear-set",
                        "--surface", "--other-surface", "--vehicle", "--plot"};
  command.run = [flags](const CommonOptions& options) { return run_explain(*flags, options); };
  return command;
}

}  // namespace tribodyn::client
