#include <algorithm>
#include <iostream>
#include <memory>

#include "client/cpp/commands/condition_flags.h"
#include "client/cpp/commands/result_files.h"
#include "client/cpp/commands/scenario.h"
#include "client/cpp/report/explanation_plot.h"
#include "client/cpp/report/explanation_report.h"
#include "client/cpp/text/text.h"
#include "tribodyn/v1/points.pb.h"

namespace tribodyn::client {
namespace {

/// Draws by default, and the fewest that the server takes.
constexpr int kExplanationDraws = 99, kFewestDraws = 19;
/// Points of one request, and combinations of the six groups.
constexpr int kExplainedPoints = 64'000, kGroupCombinations = 64;

struct ExplainFlags {
  v1::ExplainPointsRequest request;  ///< without conditions
  ConditionFlags conditions;
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
  add_condition_flags(list, SumpCount::kOne, flags.conditions);
  add_hardware_flags(list, "Surface with its boundary film.", request);
  list.text("--other-surface", "NAME",
            "Surface with the boundary film that B makes. Default: that of --surface.",
            [&request](const std::string& name) {
              request.set_other_surface(resource_name("surfaces", name));
            })
      .collection = "surfaces";
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
  add_input_uncertainty_flags(list, request);
  list.whole_number("--draws",
                    {"draws", "19 to 1999", "99, from 11 speeds on as many as one request takes"},
                    "Draws of the inputs", [&request](int value) { request.set_draws(value); });
  add_point_tolerance_flag(list, "0.0001", request);
  add_model_flags(list, *request.mutable_model_options());
  list.group("Output");
  add_plot_flag(list, "Also draw the shares as SVG.", flags.plot_path);
}

int run_explain(ExplainFlags& flags, const CommonOptions& options) {
  v1::ExplainPointsRequest& request = flags.request;
  set_conditions(flags.conditions, request);
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
    check_condition_flags(flags->conditions, complaints);
  };
  command.main_flags = {"--speed",   "--weights",       "--ascent",  "--sump", "--gear-set",
                        "--surface", "--other-surface", "--vehicle", "--plot"};
  command.run = [flags](const CommonOptions& options) { return run_explain(*flags, options); };
  return command;
}

}  // namespace tribodyn::client
