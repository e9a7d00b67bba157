#include <iostream>
#include <memory>

#include "client/cpp/commands/condition_flags.h"
#include "client/cpp/commands/result_files.h"
#include "client/cpp/commands/scenario.h"
#include "client/cpp/report/comparison_plot.h"
#include "client/cpp/report/comparison_report.h"
#include "client/cpp/text/text.h"
#include "tribodyn/v1/points.pb.h"

namespace tribodyn::client {
namespace {

struct CompareFlags {
  v1::ComparePointsRequest request;  ///< without conditions
  ConditionFlags conditions;
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
  add_condition_flags(list, SumpCount::kSeveral, flags.conditions);
  add_hardware_flags(list, "Surface: composite roughness of the flanks.", request);
  list.choice(
          "--condition", {"fresh", "sheared"},
          "fresh: the lubricants as they are stated; sheared: as they are after the shear test, "
          "by KV100 after it. Default: fresh.",
          [&request](int index) { request.set_sheared_lubricant(index == 1); })
      .field = "sheared_lubricant";
  list.group("Uncertainty");
  add_input_uncertainty_flags(list, request);
  list.whole_number("--draws", {"draws", "19 to 1999", "199"}, "Draws of the inputs",
                    [&request](int value) { request.set_draws(value); });
  add_point_tolerance_flag(list, "0.001", request);
  add_model_flags(list, *request.mutable_model_options());
  list.group("Output");
  add_plot_flag(list, "Also draw the lubricants and their differences over speed as SVG.",
                flags.plot_path);
}

int run_compare(CompareFlags& flags, const CommonOptions& options) {
  v1::ComparePointsRequest& request = flags.request;
  set_conditions(flags.conditions, request);
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
    check_condition_flags(flags->conditions, complaints);
  };
  command.main_flags = {"--speed",   "--weights",      "--ascent",
                        "--sump",    "--sump-weights", "--gear-set",
                        "--surface", "--vehicle",      "--estimate-correlation",
                        "--plot"};
  command.run = [flags](const CommonOptions& options) { return run_compare(*flags, options); };
  return command;
}

}  // namespace tribodyn::client
