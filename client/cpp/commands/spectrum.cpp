#include <iostream>
#include <memory>

#include "client/cpp/commands/operating_point.h"
#include "client/cpp/commands/result_files.h"
#include "client/cpp/commands/scenario.h"
#include "client/cpp/report/spectrum_report.h"
#include "client/cpp/text/text.h"

namespace tribodyn::client {
namespace {

constexpr int kCyclesWithoutPeriod = 50;  // mesh cycles recorded if the response has no period

struct SpectrumFlags {
  OperatingPointFlags point;
  Scenario scenario;
  v1::HistoryRequest history;
  v1::ReadSpectrumRequest request;
  std::string simulation;
  std::string plot_path;
};

/// Returns the mesh cycles that a history of this result must hold.
int needed_cycles(const v1::Simulation& simulation) {
  if (simulation.result().points().empty()) return 1;
  const v1::PointResult& point = simulation.result().points(0).result();
  if (point.model() == v1::POINT_MODEL_QUASI_STATIC) return 1;
  const int period = point.period_in_mesh_cycles();
  return period == 0 ? kCyclesWithoutPeriod : period;
}

/// Computes the point with a history of one period. Returns no name after --detach.
v1::Simulation computed_period(SpectrumFlags& flags, Connection& connection,
                               const CommonOptions& options) {
  v1::HistoryRequest& history = flags.history;
  if (history.columns().empty()) {
    for (const char* column : {"dynamic_transmission_error_metres",
                               "pinion_friction_torque_newton_metres", "inefficiency_percent"}) {
      history.add_columns(column);
    }
  }
  auto& study = *flags.scenario.simulation.mutable_operating_point();
  study = operating_point_study(flags.point);
  for (int cycles = 1;;) {
    history.set_mesh_cycles(cycles);
    *study.mutable_history() = history;
    const auto ended = run_scenario(flags.scenario, connection, options);
    if (ended.empty()) return {};
    const v1::Simulation& simulation = ended.front();
    const int needed = needed_cycles(simulation);
    if (simulation.state() != v1::Simulation::SUCCEEDED || needed <= cycles) return simulation;
    cycles = needed;
  }
}

int run_spectrum(SpectrumFlags& flags, const CommonOptions& options) {
  Connection connection = options.connect();
  const v1::Simulation simulation =
      flags.simulation.empty()
          ? computed_period(flags, connection, options)
          : connection.get_simulation(resource_name("simulations", flags.simulation));
  if (simulation.name().empty()) return kExitOk;  // --detach or --validate-only: no result to show
  if (simulation.state() != v1::Simulation::SUCCEEDED) return report_failures({simulation});
  v1::ReadSpectrumRequest request = flags.request;
  request.set_name(simulation.name());
  if (!flags.simulation.empty()) *request.mutable_columns() = flags.history.columns();
  const v1::ReadSpectrumResponse spectrum = connection.read_spectrum(request);
  std::cout << spectrum_text(simulation, spectrum, options.output_format);
  if (!flags.plot_path.empty()) write_file(flags.plot_path, spectrum_plot(simulation, spectrum));
  return kExitOk;
}

}  // namespace

Command spectrum_command() {
  const auto flags = std::make_shared<SpectrumFlags>();
  Command command{
      "spectrum",
      "amplitudes by order of the mesh frequency",
      "Computes an operating point and the spectrum of its steady state over orders, multiples of "
      "the mesh frequency: amplitudes from zero to peak and phase angles. If the response repeats "
      "after several mesh cycles, they are computed and transformed together.",
      {"tribodyn spectrum --lubricant paper-fluid-1 --speed 72.5 --plot spectrum.svg",
       "tribodyn spectrum --simulation 12 --columns mesh_force_newtons --maximum-order 40"},
      {},
      {},
      {}};
  FlagList& list = command.flags;
  add_operating_point_flags(list, flags->point);
  list.group("Spectrum");
  list.texts("--columns", "NAMES",
             "Columns of the history, as in tribodyn history. Default: "
             "dynamic_transmission_error_metres, pinion_friction_torque_newton_metres, "
             "inefficiency_percent; of a finished simulation all.",
             [flags](const std::string& column) { flags->history.add_columns(column); });
  list.number("--maximum-order", {"-", "0.001 to 50000", "20"}, "Highest order",
              [flags](double order) { flags->request.set_maximum_order(order); });
  list.whole_number("--samples-per-mesh-cycle", {"samples", "2 to 100000", "192"},
                    "Samples of a mesh cycle; orders up to half of them exist",
                    [flags](int count) { flags->history.set_samples_per_mesh_cycle(count); });
  list.text("--simulation", "NAME",
            "Transform the history of this finished simulation instead of computing one.",
            [flags](const std::string& name) { flags->simulation = name; });
  list.group("Files");
  add_plot_flag(list, "Also draw the amplitudes of every column as SVG.", flags->plot_path);
  add_scenario_flags(list, flags->scenario);
  command.check = [flags](Complaints& complaints) {
    if (!flags->simulation.empty()) return;
    check_operating_point(flags->point, complaints);
    check_scenario(flags->scenario, false, complaints);
  };
  command.main_flags = {"--lubricant",  "--speed",         "--sump", "--columns",
                        "--simulation", "--maximum-order", "--plot"};
  command.run = [flags](const CommonOptions& options) { return run_spectrum(*flags, options); };
  return command;
}

}  // namespace tribodyn::client
