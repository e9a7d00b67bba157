#include <algorithm>
#include <iostream>
#include <memory>

#include "client/cpp/commands/operating_point.h"
#include "client/cpp/commands/result_files.h"
#include "client/cpp/commands/scenario.h"
#include "client/cpp/report/history_file.h"
#include "client/cpp/report/history_plot.h"
#include "client/cpp/report/history_report.h"
#include "client/cpp/text/inputs.h"
#include "client/cpp/text/text.h"
#include "client/cpp/text/warnings.h"

namespace tribodyn::client {
namespace {

constexpr int kPlottedPoints = 4000;
struct HistoryFlags {
  OperatingPointFlags point;
  Scenario scenario;
  v1::HistoryRequest history;
  std::string simulation;
  std::string csv_path;
  std::string numpy_path;
  int maximum_points = 0;
  std::string plot_path;
};

void add_history_flags(FlagList& list, HistoryFlags& flags) {
  list.group("History");
  list.texts("--columns", "NAMES",
             "Columns to record, separated by commas; each name ends in its unit. Others: "
             "pinion_speed_..., "
             "gear_friction_torque_newton_metres, flank_load_newtons (three flank slots), ...; the "
             "error of an unknown name suggests a similar one or lists all. Time is always "
             "recorded. Default: "
             "dynamic_transmission_error_metres,mesh_force_newtons,mesh_loss_power_watts.",
             [&](const std::string& column) { flags.history.add_columns(column); });
  list.whole_number("--mesh-cycles", {"mesh cycles", "1 to 1000", "1"},
                    "Recorded mesh cycles of the steady state",
                    [&](int count) { flags.history.set_mesh_cycles(count); });
  list.whole_number("--samples-per-mesh-cycle", {"samples", "2 to 100000", "192"},
                    "Samples of a mesh cycle, equidistant in mesh phase",
                    [&](int count) { flags.history.set_samples_per_mesh_cycle(count); });
  list.text("--simulation", "NAME",
            "Read the history of this finished simulation instead of computing one.",
            [&](const std::string& name) { flags.simulation = name; });
  list.group("Files");
  list.whole_number("--max-points", {"samples", "4 to 1000000", "all"},
                    "Print an overview if there are more: the minimum and the maximum of each run "
                    "of samples, one after the other",
                    [&](int count) { flags.maximum_points = count; });
  add_result_file_flag(list, "--csv", "FILE",
                       "Also write all samples as CSV. Resumes an interrupted download.",
                       flags.csv_path);
  add_result_file_flag(
      list, "--npy", "FILE.npy",
      "Also write all samples for NumPy: numpy.load(\"FILE.npy\")[\"mesh_force_newtons\"].",
      flags.numpy_path);
  add_plot_flag(list, "Also draw every column against time, as SVG.", flags.plot_path);
}

v1::Simulation computed(HistoryFlags& flags, Connection& connection, const CommonOptions& options) {
  v1::HistoryRequest& history = flags.history;
  if (history.columns_size() == 0) {
    history.add_columns("dynamic_transmission_error_metres");
    history.add_columns("mesh_force_newtons");
    history.add_columns("mesh_loss_power_watts");
  }
  if (std::find(history.columns().begin(), history.columns().end(), kTimeColumn) ==
      history.columns().end()) {
    history.add_columns(kTimeColumn);
    std::rotate(history.mutable_columns()->begin(), history.mutable_columns()->end() - 1,
                history.mutable_columns()->end());
  }
  auto& study = *flags.scenario.simulation.mutable_operating_point();
  study = operating_point_study(flags.point);
  *study.mutable_history() = history;
  const auto ended = run_scenario(flags.scenario, connection, options);
  return ended.empty() ? v1::Simulation() : ended.front();
}

int run_history(HistoryFlags& flags, const CommonOptions& options) {
  Connection connection = options.connect();
  const v1::Simulation simulation =
      flags.simulation.empty()
          ? computed(flags, connection, options)
          : connection.get_simulation(resource_name("simulations", flags.simulation));
  if (simulation.name().empty()) return kExitOk;  // --detach or --validate-only: no result to show
  if (simulation.state() != v1::Simulation::SUCCEEDED) return report_failures({simulation});
  HistoryOptions read;
  read.maximum_points = flags.maximum_points;
  const v1::History history = connection.read_history(simulation.name(), read);
  const std::vector<CurveWarning> found = curve_warnings({simulation});
  const std::vector<ShownWarning> warnings(found.begin(), found.end());
  switch (options.output_format) {
    case OutputFormat::kTable: {
      Sheet notes;
      add_input_warnings(history.input_warnings(), notes);
      add_warnings(warnings, notes);
      std::cout << printable(simulation.name()) << ": " << study_text(simulation) << ", "
                << printable(simulation.lubricant()) << ", " << inputs_text(simulation) << "\n\n"
                << history_summary(history) << notes.text()
                << "\nFor the samples use --output csv, --csv FILE or --npy FILE; for a plot "
                   "--plot FILE.svg.\n";
      break;
    }
    case OutputFormat::kCsv:
      std::cout << history_csv(history, codes_of(warnings));
      break;
    case OutputFormat::kJson:
      std::cout << json_with(json_text(history), "warnings", warnings_json(warnings));
  }
  if (!flags.csv_path.empty()) {
    download_history(connection, simulation, flags.csv_path, HistoryFile::Format::kCsv);
  }
  if (!flags.numpy_path.empty()) {
    download_history(connection, simulation, flags.numpy_path, HistoryFile::Format::kNumpy);
  }
  if (!flags.plot_path.empty()) {
    read.maximum_points = kPlottedPoints;
    const v1::History plotted = connection.read_history(simulation.name(), read);
    const auto titles = lubricant_titles({simulation}, connection);
    const auto title = titles.find(simulation.lubricant());
    write_file(flags.plot_path,
               history_plot(simulation, plotted, title == titles.end() ? "" : title->second));
  }
  return kExitOk;
}

}  // namespace

Command history_command() {
  const auto flags = std::make_shared<HistoryFlags>();
  Command command{
      "history",
      "quantities over the mesh cycle, against time",
      "Computes an operating point with time histories of its steady state and reads them.",
      {"tribodyn history --lubricant paper-fluid-1 --speed-kilometres-per-hour 72.5 --mesh-cycles "
       "2 "
       "--plot history.svg",
       "tribodyn history --lubricant paper-fluid-1 --speed 72.5 --columns "
       "flank_load_newtons,flank_contact_temperature_kelvin --output csv"},
      {},
      {},
      {}};
  add_operating_point_flags(command.flags, flags->point);
  add_history_flags(command.flags, *flags);
  add_scenario_flags(command.flags, flags->scenario);
  command.check = [flags](Complaints& complaints) {
    if (!flags->simulation.empty()) return;
    check_operating_point(flags->point, complaints);
    check_scenario(flags->scenario, false, complaints);
  };
  command.main_flags = {"--lubricant",  "--speed",   "--sump", "--columns", "--mesh-cycles",
                        "--simulation", "--surface", "--csv",  "--npy",     "--plot"};
  command.run = [flags](const CommonOptions& options) { return run_history(*flags, options); };
  return command;
}

}  // namespace tribodyn::client
