#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "client/cpp/commands/result_files.h"
#include "client/cpp/commands/scenario.h"
#include "client/cpp/report/cycle_report.h"
#include "client/cpp/resources/json_input.h"
#include "client/cpp/text/csv.h"
#include "client/cpp/text/nearest.h"
#include "client/cpp/text/text.h"
#include "client/cpp/text/units.h"
#include "tribodyn/client/error.h"
#include "tribodyn/v1/limits.pb.h"

namespace tribodyn::client {
namespace {

struct CycleFlags {
  std::string cycle = "nedc";  ///< or a file
  v1::EvaluateCycleRequest request;
  std::optional<double> map_tolerance;
  std::string csv_path, plot_path;
};

/// Columns of the file of a cycle; the first two must be there.
const std::vector<std::string> kPlaceColumns{"time_seconds", "speed_kilometres_per_hour",
                                             "ascent_angle_degrees", "sump_temperature_celsius"};

/// Returns the column that a header resembles, e.g. "time" or "speed (km/h)"; empty if none.
std::string meant_column(const std::string& header) {
  std::string word = header.substr(0, header.find_first_of(" (["));
  std::transform(word.begin(), word.end(), word.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  for (const std::string& each : kPlaceColumns) {
    if (!word.empty() && each.starts_with(word)) return each;
  }
  return nearest(word, kPlaceColumns);
}

/// Returns the columns of kPlaceColumns in a header; -1: missing. Throws Failure.
std::vector<int> place_columns(const std::string& path, const std::vector<std::string>& header) {
  std::vector<int> out(kPlaceColumns.size(), -1);
  for (std::size_t column = 0; column < header.size(); ++column) {
    const auto name = std::find(kPlaceColumns.begin(), kPlaceColumns.end(), header[column]);
    if (name == kPlaceColumns.end()) {
      const std::string meant = meant_column(header[column]);
      throw Failure(kExitFailed, path + ": unknown column " + printable(header[column]) +
                                     (meant.empty() ? "" : " (is " + meant + " meant?)") +
                                     "; allowed: " + joined(kPlaceColumns, ", "));
    }
    out[static_cast<std::size_t>(name - kPlaceColumns.begin())] = static_cast<int>(column);
  }
  for (std::size_t k = 0; k < 2; ++k) {
    if (out[k] < 0) {
      throw Failure(kExitFailed, path + ": the column " + kPlaceColumns[k] + " is missing");
    }
  }
  return out;
}

/// Adds the places of a CSV file to the request and returns the line of each. Throws Failure,
/// naming line and column.
std::vector<int> read_places(const std::string& path, v1::EvaluateCycleRequest& request) {
  const std::vector<CsvLine> lines = read_csv(read_file(path));
  if (lines.empty()) throw Failure(kExitFailed, path + " is empty");
  const std::vector<int> columns = place_columns(path, lines.front().cells);
  const int most =
      v1::EvaluateCycleRequest::descriptor()->FindFieldByName("places")->options().GetExtension(
          v1::max_items);
  const std::size_t rows = lines.size() - 1;
  if (rows > static_cast<std::size_t>(most)) {
    throw Failure(kExitFailed, path + " has " + std::to_string(rows) + " rows; allowed: at most " +
                                   std::to_string(most));
  }
  std::vector<int> out;
  for (std::size_t i = 1; i < lines.size(); ++i) {
    double values[4] = {};
    for (std::size_t k = 0; k < kPlaceColumns.size(); ++k) {
      if (columns[k] < 0) continue;
      const std::size_t column = static_cast<std::size_t>(columns[k]);
      const std::string cell = column < lines[i].cells.size() ? lines[i].cells[column] : "";
      char* end = nullptr;
      values[k] = std::strtod(cell.c_str(), &end);
      if (cell.empty() || *end != 0 || !std::isfinite(values[k])) {
        throw Failure(kExitFailed, path + ", line " + std::to_string(lines[i].number) + ", " +
                                       kPlaceColumns[k] + ": '" + printable(cell) +
                                       "' is not a number");
      }
    }
    v1::CyclePlace& place = *request.add_places();
    place.set_time_seconds(values[0]);
    place.set_speed_kilometres_per_hour(values[1]);
    place.set_ascent_angle_degrees(values[2]);
    if (columns[3] >= 0) place.set_sump_temperature_celsius(values[3]);
    out.push_back(lines[i].number);
  }
  return out;
}

/// Returns `text` with "FILE, line 3, " in place of "places[1].", and the file in place of
/// "places".
std::string with_lines(std::string text, const std::string& path, const std::vector<int>& lines) {
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const std::string field = "places[" + std::to_string(i) + "].";
    for (std::size_t at = text.find(field); at != std::string::npos; at = text.find(field, at)) {
      text.replace(at, field.size(), path + ", line " + std::to_string(lines[i]) + ", ");
    }
  }
  const std::string whole = "\n  places: ";
  for (std::size_t at = text.find(whole); at != std::string::npos; at = text.find(whole, at)) {
    text.replace(at, whole.size(), "\n  " + path + ": ");
  }
  return text;
}

v1::EvaluateCycleResponse evaluated(const CycleFlags& flags, Connection& connection) {
  v1::EvaluateCycleRequest request = flags.request;
  if (flags.map_tolerance) request.set_map_tolerance(*flags.map_tolerance);
  if (flags.cycle == "nedc") {
    request.set_named_cycle(v1::NAMED_CYCLE_NEDC);
    return connection.evaluate_cycle(request);
  }
  const std::vector<int> lines = read_places(flags.cycle, request);
  try {
    return connection.evaluate_cycle(request);
  } catch (const ServiceError& error) {
    if (error.violations().empty()) throw;
    std::vector<FieldViolation> violations = error.violations();
    for (FieldViolation& each : violations) {
      each.field = with_lines(each.field, printable(flags.cycle), lines);
    }
    throw ServiceError(with_lines(error.what(), printable(flags.cycle), lines), error.status_code(),
                       error.reason(), violations, error.retry_delay_seconds());
  }
}

int run_cycle(const CycleFlags& flags, const CommonOptions& options) {
  Connection connection = options.connect();
  const CycleRun run{flags.cycle == "nedc" ? "NEDC" : flags.cycle, evaluated(flags, connection)};
  std::cout << cycle_text(run, options.output_format);
  if (!flags.csv_path.empty()) write_file(flags.csv_path, cycle_pieces_csv(run));
  if (!flags.plot_path.empty()) write_file(flags.plot_path, cycle_plot(run));
  const std::string refused = cycle_refusals(run);
  if (refused.empty()) return kExitOk;
  std::cerr << refused;
  return kExitFailed;
}

}  // namespace

Command cycle_command() {
  const auto flags = std::make_shared<CycleFlags>();
  Command command{
      "cycle",
      "mesh loss over a drive cycle: energy, inefficiency, where it arises",
      "Computes the mesh loss of lubricants over a drive cycle as a sequence of steady points, "
      "each with the torque of speed, acceleration and slope. Solves the pieces themselves if few "
      "are distinct, and otherwise an adaptive map whose error is stated. The NEDC is built in; "
      "others are CSV files with the columns time_seconds, "
      "speed_kilometres_per_hour and, optionally, ascent_angle_degrees and "
      "sump_temperature_celsius. Nothing is stored.",
      {"tribodyn cycle paper-fluid-1 paper-fluid-2 --plot cycle.svg",
       "tribodyn cycle my-oil --cycle wltc.csv --sump 60 --csv pieces.csv"},
      {},
      {},
      {}};
  FlagList& list = command.flags;
  list.group("Arguments");
  list.texts("lubricants", "NAME",
             "One to eight lubricants; the others are compared with the first.",
             [flags](const std::string& text) {
               flags->request.add_lubricants(resource_name("lubricants", text));
             })
      .collection = "lubricants";
  list.group("Cycle");
  list.text("--cycle", "FILE|nedc", "A CSV file, or nedc. Default: nedc.",
            [flags](const std::string& text) { flags->cycle = text; });
  list.number("--sump-temperature-celsius,--sump", {"C", "-70 to 200", "40"},
              "Temperature of the oil bath",
              [flags](double value) { flags->request.set_sump_temperature_celsius(value); });
  list.number("--inlet-temperature-rise-kelvin", {"K", "0 to 300", "20"},
              "Rise from the oil bath to the contact inlet",
              [flags](double value) { flags->request.set_inlet_temperature_rise_kelvin(value); });
  list.choice("--condition", {"fresh", "sheared"},
              "fresh: the lubricants as they are stated; sheared: as they are after the shear "
              "test, by KV100 after it. Default: fresh.",
              [flags](int index) { flags->request.set_sheared_lubricant(index == 1); })
      .field = "sheared_lubricant";
  list.text("--gear-set", "NAME", "Gear set with its driveline. Default: reference-axle.",
            [flags](const std::string& text) {
              flags->request.set_gear_set(resource_name("gearSets", text));
            })
      .collection = "gearSets";
  list.text("--surface", "NAME", "Surface with its boundary film. Default: run-in.",
            [flags](const std::string& text) {
              flags->request.set_surface(resource_name("surfaces", text));
            })
      .collection = "surfaces";
  list.text("--vehicle", "NAME", "Vehicle: road load. Default: passenger-car.",
            [flags](const std::string& text) {
              flags->request.set_vehicle(resource_name("vehicles", text));
            })
      .collection = "vehicles";
  list.number("--map-tolerance", {"-", "1e-5 to 0.1", "0.002"},
              "Wanted error of the energy lost by the interpolation of the map, relative",
              [flags](double value) { flags->map_tolerance = value; });
  list.number("--tolerance", {"-", "1e-8 to 0.01", "0.001"},
              "Wanted relative error of each point by the solver",
              [flags](double value) { flags->request.set_tolerance(value); });
  list.toggle("--point-by-point", "Solve every piece of the cycle instead of making a map.",
              [flags] { flags->request.set_point_by_point(true); });
  list.group("Files");
  add_result_file_flag(list, "--csv", "FILE", "Also write every piece of the cycle as CSV.",
                       flags->csv_path);
  add_plot_flag(list, "Also draw speed and loss over time as SVG.", flags->plot_path);
  add_model_flags(list, *flags->request.mutable_model_options());
  command.check = [flags](Complaints& complaints) {
    if (flags->request.lubricants().empty()) {
      complaints.emplace_back("give a lubricant: tribodyn cycle paper-fluid-1");
    }
    const std::optional<double>& tolerance = flags->map_tolerance;
    if (tolerance && !(*tolerance >= 1e-5 && *tolerance <= 0.1)) {
      complaints.push_back("--map-tolerance: " + significant(*tolerance) +
                           "; allowed: 1e-5 to 0.1");
    }
  };
  command.main_flags = {"lubricants", "--cycle",          "--sump", "--vehicle", "--gear-set",
                        "--surface",  "--point-by-point", "--csv",  "--plot"};
  command.run = [flags](const CommonOptions& options) { return run_cycle(*flags, options); };
  return command;
}

}  // namespace tribodyn::client
