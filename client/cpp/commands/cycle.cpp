#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "client/cpp/commands/result_files.h"
#include "client/cpp/commands/scenario.h"
#include "client/cpp/report/cycle_report.h"
#include "client/cpp/resources/json_input.h"
#include "client/cpp/text/csv.h"
#include "client/cpp/text/text.h"
#include "client/cpp/text/units.h"
#include "core/refusal.h"
#include "core/study/loss_map.h"

namespace tribodyn::client {
namespace {

constexpr double kSlowest = 0.1 / 3.6;  // least speed of a point [m/s]; slower counts as standstill
constexpr double kDegree = std::numbers::pi / 180;  // [rad]
constexpr double kSteepest = 45;                    // slope of a point [degrees]

struct CycleFlags {
  std::vector<std::string> lubricants;
  std::string cycle = "nedc";  ///< or a file
  v1::EvaluatePointsRequest request;
  double sump_temperature_celsius = 40;
  double tolerance = 2e-3;
  bool is_point_by_point = false;
  std::string csv_path, plot_path;
};

/// Reads a CSV with the columns time_seconds, speed_kilometres_per_hour and, optionally,
/// ascent_angle_degrees. Throws Failure, naming line and column.
DriveCycle read_cycle(const std::string& path) {
  const std::vector<CsvLine> lines = read_csv(read_file(path));
  if (lines.empty()) throw Failure(kExitFailed, path + " is empty");
  const std::vector<std::string> names{"time_seconds", "speed_kilometres_per_hour",
                                       "ascent_angle_degrees"};
  std::vector<int> columns(names.size(), -1);
  const std::vector<std::string>& header = lines.front().cells;
  for (std::size_t column = 0; column < header.size(); ++column) {
    const auto name = std::find(names.begin(), names.end(), header[column]);
    if (name == names.end()) {
      throw Failure(kExitFailed, path + ": unknown column " + printable(header[column]) +
                                     "; allowed: " + joined(names, ", "));
    }
    columns[static_cast<std::size_t>(name - names.begin())] = static_cast<int>(column);
  }
  for (std::size_t k = 0; k < 2; ++k) {
    if (columns[k] < 0)
      throw Failure(kExitFailed, path + ": the column " + names[k] + " is missing");
  }
  DriveCycle out{path, {}};
  for (std::size_t i = 1; i < lines.size(); ++i) {
    double values[3] = {0, 0, 0};
    for (std::size_t k = 0; k < names.size(); ++k) {
      if (columns[k] < 0) continue;
      const std::size_t column = static_cast<std::size_t>(columns[k]);
      const std::string cell = column < lines[i].cells.size() ? lines[i].cells[column] : "";
      char* end = nullptr;
      values[k] = std::strtod(cell.c_str(), &end);
      if (cell.empty() || *end != 0 || !std::isfinite(values[k])) {
        throw Failure(kExitFailed, path + ", line " + std::to_string(lines[i].number) + ", " +
                                       names[k] + ": '" + printable(cell) + "' is not a number");
      }
    }
    out.places.push_back({values[0], values[1] / 3.6, values[2] * kDegree});
  }
  return out;
}

Vehicle core_vehicle(const v1::Vehicle& vehicle) {
  return {vehicle.mass_kilograms(),
          vehicle.rolling_resistance_coefficient(),
          vehicle.drag_coefficient(),
          vehicle.frontal_area_square_metres(),
          vehicle.air_density_kilograms_per_cubic_metre(),
          vehicle.wheel_radius_metres(),
          vehicle.gravity_metres_per_second_squared()};
}

/// The points of one lubricant on the server.
class CyclePoints {
 public:
  CyclePoints(v1::EvaluatePointsRequest request, const Vehicle& vehicle, Connection& connection)
      : request_(std::move(request)), vehicle_(vehicle), connection_(connection) {}

  /// Returns the loss forces [N] at the places. Throws Failure if the model refuses one.
  std::vector<double> loss_forces(const std::vector<MapPlace>& places) {
    std::vector<double> out;
    for (std::size_t first = 0; first < places.size(); first += kMostPointsOfACall) {
      const std::size_t last =
          std::min(places.size(), first + static_cast<std::size_t>(kMostPointsOfACall));
      request_.clear_conditions();
      for (std::size_t i = first; i < last; ++i) *request_.add_conditions() = condition(places[i]);
      const v1::EvaluatePointsResponse answer = connection_.evaluate_points(request_);
      lubricant_ = answer.lubricant_revision();
      model_version_ = answer.model_version();
      for (std::size_t i = first; i < last; ++i) {
        const int row = static_cast<int>(i - first);
        if (answer.refusal_numbers(row) > 0) {
          throw Failure(kExitFailed,
                        "no steady state at " + significant(3.6 * places[i][0], 4) + " km/h and " +
                            significant(places[i][1], 4) + " N m at the ring gear: " +
                            answer.refusals(answer.refusal_numbers(row) - 1).message());
        }
        out.push_back(answer.mesh_loss_power_watts(row) / places[i][0]);
      }
    }
    points_ += static_cast<int>(places.size());
    return out;
  }

  CycleLosses losses() const { return {lubricant_, {}, 0, points_, model_version_}; }

 private:
  /// An instant of a cycle is the cruise point at the slope that gives its torque.
  v1::PointCondition condition(const MapPlace& place) const {
    const auto ascent = ascent_for_torque(vehicle_, place[0], place[1]);
    if (!ascent || std::abs(*ascent) > kSteepest * kDegree) {
      throw Failure(kExitFailed, "a torque of " + significant(place[1], 4) + " N m at " +
                                     significant(3.6 * place[0], 4) +
                                     " km/h is more than a slope of 45 degrees makes");
    }
    v1::PointCondition out;
    out.set_speed_kilometres_per_hour(3.6 * place[0]);
    out.set_ascent_angle_degrees(*ascent / kDegree);
    out.set_sump_temperature_celsius(place[2] - kZeroCelsius);
    return out;
  }

  v1::EvaluatePointsRequest request_;
  Vehicle vehicle_;
  Connection& connection_;
  std::string lubricant_, model_version_;
  int points_ = 0;
};

CycleLosses losses_of(const CycleRun& run, const CycleFlags& flags, CyclePoints& points) {
  std::vector<MapReading> readings;
  std::vector<std::size_t> pieces;  // of the readings
  for (std::size_t i = 0; i < run.pieces.size(); ++i) {
    if (run.wheel_energies[i] == 0) continue;
    const CyclePiece& piece = run.pieces[i];
    readings.push_back(
        {{piece.speed, run.wheel_torques[i], run.sump_temperature_celsius + kZeroCelsius},
         piece.speed * piece.duration});
    pieces.push_back(i);
  }
  std::vector<double> loss_joules(run.pieces.size());
  double error = 0;
  const auto forces_at = [&points](const std::vector<MapPlace>& places) {
    return points.loss_forces(places);
  };
  if (flags.is_point_by_point) {
    std::vector<MapPlace> places;
    for (const MapReading& reading : readings) places.push_back(reading.place);
    const std::vector<double> forces = forces_at(places);
    for (std::size_t k = 0; k < pieces.size(); ++k) {
      loss_joules[pieces[k]] = forces[k] * readings[k].distance;
    }
  } else {
    LossMapOptions options;
    options.tolerance = flags.tolerance;
    const LossMap map(readings, forces_at, options);
    for (std::size_t k = 0; k < pieces.size(); ++k) {
      loss_joules[pieces[k]] = map.at(k) * readings[k].distance;
    }
    error = map.estimated_error();
  }
  CycleLosses out = points.losses();
  out.loss_joules = std::move(loss_joules);
  out.estimated_error_joules = error;
  return out;
}

int run_cycle(const CycleFlags& flags, const CommonOptions& options) try {
  Connection connection = options.connect();
  const std::string name =
      flags.request.vehicle().empty() ? "vehicles/passenger-car" : flags.request.vehicle();
  const Vehicle vehicle = core_vehicle(connection.get<v1::Vehicle>(name));
  CycleRun run;
  const DriveCycle cycle = flags.cycle == "nedc" ? nedc() : read_cycle(flags.cycle);
  run.name = cycle.name;
  run.pieces = pieces_of(cycle);
  run.sump_temperature_celsius = flags.sump_temperature_celsius;
  for (const CyclePiece& piece : run.pieces) {
    const bool moves = piece.speed >= kSlowest;
    const double torque =
        moves ? wheel_torque(vehicle, piece.speed, piece.ascent_angle, piece.acceleration) : 0;
    run.wheel_torques.push_back(torque);
    run.wheel_energies.push_back(torque / vehicle.wheel_radius * piece.speed * piece.duration);
  }
  for (const std::string& lubricant : flags.lubricants) {
    v1::EvaluatePointsRequest request = flags.request;
    request.set_lubricant(lubricant);
    CyclePoints points(request, vehicle, connection);
    run.fluids.push_back(losses_of(run, flags, points));
  }
  std::cout << cycle_text(run, options.output_format);
  if (!flags.csv_path.empty()) write_file(flags.csv_path, cycle_pieces_csv(run));
  if (!flags.plot_path.empty()) write_file(flags.plot_path, cycle_plot(run));
  return kExitOk;
} catch (const Refusal& refusal) {
  throw Failure(kExitFailed, refusal.what());
}

}  // namespace

Command cycle_command() {
  const auto flags = std::make_shared<CycleFlags>();
  Command command{
      "cycle",
      "mesh loss over a drive cycle: energy, inefficiency, where it arises",
      "Computes the mesh loss of lubricants over a drive cycle as a sequence of steady points, "
      "each "
      "with the torque of speed, acceleration and slope, from an adaptive map whose error is "
      "stated. The NEDC is built in; others are CSV files with the columns time_seconds, "
      "speed_kilometres_per_hour and, optionally, ascent_angle_degrees. Nothing is stored.",
      {"tribodyn cycle paper-fluid-1 paper-fluid-2 --plot cycle.svg",
       "tribodyn cycle my-oil --cycle wltc.csv --sump 60 --csv pieces.csv"},
      {},
      {},
      {}};
  FlagList& list = command.flags;
  list.group("Arguments");
  list.texts("lubricants", "NAME", "Lubricants; the others are compared with the first.",
             [flags](const std::string& text) {
               flags->lubricants.push_back(resource_name("lubricants", text));
             })
      .collection = "lubricants";
  list.group("Cycle");
  list.text("--cycle", "FILE|nedc", "A CSV file, or nedc. Default: nedc.",
            [flags](const std::string& text) { flags->cycle = text; });
  list.number("--sump-temperature-celsius,--sump", {"C", "-70 to 200", "40"},
              "Temperature of the oil bath",
              [flags](double value) { flags->sump_temperature_celsius = value; });
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
              [flags](double value) { flags->tolerance = value; });
  list.toggle("--point-by-point", "Solve every piece of the cycle instead of making a map.",
              [flags] { flags->is_point_by_point = true; });
  list.group("Files");
  add_result_file_flag(list, "--csv", "FILE", "Also write every piece of the cycle as CSV.",
                       flags->csv_path);
  add_plot_flag(list, "Also draw speed and loss over time as SVG.", flags->plot_path);
  add_model_flags(list, *flags->request.mutable_model_options());
  command.check = [flags](Complaints& complaints) {
    if (flags->lubricants.empty()) {
      complaints.emplace_back("give a lubricant: tribodyn cycle paper-fluid-1");
    }
    if (!(flags->tolerance >= 1e-5 && flags->tolerance <= 0.1)) {
      complaints.push_back("--map-tolerance: " + significant(flags->tolerance) +
                           "; allowed: 1e-5 to 0.1");
    }
  };
  command.main_flags = {"lubricants", "--cycle",          "--sump", "--vehicle", "--gear-set",
                        "--surface",  "--point-by-point", "--csv",  "--plot"};
  command.run = [flags](const CommonOptions& options) { return run_cycle(*flags, options); };
  return command;
}

}  // namespace tribodyn::client
