#include <iostream>
#include <memory>

#include "client/cpp/commands/result_files.h"
#include "client/cpp/commands/scenario.h"
#include "client/cpp/report/viscosity_report.h"
#include "client/cpp/text/text.h"

namespace tribodyn::client {
namespace {

struct ViscosityFlags {
  std::vector<std::string> fluids;
  v1::EvaluateViscosityRequest request;
  std::string plot_path;
};

int run_viscosity(const ViscosityFlags& flags, const CommonOptions& options) {
  v1::EvaluateViscosityRequest request = flags.request;
  if (request.temperatures_celsius().empty()) {
    for (int celsius = 0; celsius <= 140; celsius += 10) request.add_temperatures_celsius(celsius);
  }
  if (request.pressures_pascals().empty()) {
    for (const double pressure : {0.0, 0.5e9, 1e9}) request.add_pressures_pascals(pressure);
  }
  Connection connection = options.connect();
  std::vector<ViscosityAnswer> answers;
  for (const std::string& fluid : flags.fluids) {
    request.set_lubricant(fluid);
    answers.push_back({request, connection.evaluate_viscosity(request)});
  }
  std::cout << viscosity_text(answers, options.output_format);
  if (!flags.plot_path.empty()) write_file(flags.plot_path, viscosity_plot(answers));
  return kExitOk;
}

}  // namespace

Command viscosity_command() {
  const auto flags = std::make_shared<ViscosityFlags>();
  Command command{
      "viscosity",
      "viscosity of lubricants over temperature and pressure",
      "Evaluates the laws of lubricants: density, kinematic and dynamic viscosity and alpha* at "
      "ambient pressure, and dynamic viscosity under pressure. Nothing is stored.",
      {"tribodyn viscosity paper-fluid-1 paper-fluid-2 --plot viscosity.svg",
       "tribodyn viscosity my-oil --temperature 40,100 --pressure 0,1GPa --output csv"},
      {},
      {},
      {}};
  FlagList& list = command.flags;
  list.group("Arguments");
  list.texts("fluid", "FLUID", "Lubricants, e.g. paper-fluid-1, or revisions, e.g. my-oil@2.",
             [flags](const std::string& name) {
               flags->fluids.push_back(resource_name("lubricants", name));
             })
      .collection = "lubricants";
  list.group("Grid");
  list.numbers("--temperatures-celsius,--temperature", {"C", "-100 to 400", "0 to 140"},
               "Temperatures",
               [flags](double value) { flags->request.add_temperatures_celsius(value); });
  list.numbers("--pressures-pascals,--pressure", {"Pa", "0 to 1e10", "0, 0.5 and 1 GPa"},
               "Pressures above ambient, e.g. 0.8GPa",
               [flags](double value) { flags->request.add_pressures_pascals(value); });
  list.group("Files");
  add_plot_flag(list, "Also draw the viscosities as SVG.", flags->plot_path);
  add_model_flags(list, *flags->request.mutable_model_options());
  command.check = [flags](Complaints& complaints) {
    if (flags->fluids.empty()) {
      complaints.emplace_back("give a lubricant: tribodyn viscosity paper-fluid-1");
    }
  };
  command.main_flags = {"fluid", "--temperature", "--pressure", "--plot"};
  command.run = [flags](const CommonOptions& options) { return run_viscosity(*flags, options); };
  return command;
}

}  // namespace tribodyn::client
