#include <algorithm>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "client/cpp/commands/result_files.h"
#include "client/cpp/commands/rig_machine.h"
#include "client/cpp/commands/rig_map.h"
#include "client/cpp/commands/scenario.h"
#include "client/cpp/report/rig_rows.h"
#include "client/cpp/resources/json_input.h"
#include "client/cpp/text/text.h"

namespace tribodyn::client {
namespace {

struct RigFlags {
  std::vector<std::string> fluids;
  v1::EvaluateRigRequest request;
  RigSettings given;  ///< empty lists: the command's
  std::string plot_path, measured_path;
  std::vector<std::string> map;  ///< words of the settings across and up; empty: no map
  std::optional<int> draws;      ///< of the inputs; empty: kRigDraws, of a map 0
};

/// The 95 % interval ends at the fifth draw from either end.
constexpr int kRigDraws = 199;

/// A rig command: what it shows, and what its machine is and does by default.
struct RigCommand {
  RigView view;
  const char* summary;
  const char* about;
  std::vector<std::string> examples;
  double radius;  ///< of the ball [m]
  bool has_glass_disc;
  const char* surface;  ///< empty: smooth specimens
  double roughness;     ///< [m]; 0: that of the surface
  RigSettings settings;
  const char *speeds_text, *slides_text;  ///< the default lists in words
};

RigMachine machine_of(const RigCommand& rig) {
  RigMachine out{{}, rig.settings};
  out.request.set_radius_x_metres(rig.radius);
  if (rig.has_glass_disc) set_disc("glass", out.request);
  if (*rig.surface != 0) out.request.set_surface(resource_name("surfaces", rig.surface));
  out.request.set_composite_rms_height_metres(rig.roughness);
  return out;
}

void add_rig_flags(FlagList& list, RigFlags& flags, const RigCommand& rig) {
  list.group("Arguments");
  list.texts("fluid", "FLUID", "Lubricants, e.g. paper-fluid-1, or revisions, e.g. my-oil@2.",
             [&flags](const std::string& name) {
               flags.fluids.push_back(resource_name("lubricants", name));
             })
      .collection = "lubricants";
  list.group("Rig (lists: every combination is a condition)");
  add_rig_setting_flags(
      list,
      {"--entrainment-speed-metres-per-second,--speed", significant(rig.settings.loads.front(), 4),
       rig.speeds_text, rig.slides_text, "40"},
      flags.given);
  v1::EvaluateRigRequest& request = flags.request;
  request = machine_of(rig).request;
  list.number("--radius-x-metres,--radius", {"m", "1e-5 to 1e4", significant(rig.radius, 5)},
              "Radius of the ball, e.g. 12.7mm; of a ring: along the motion",
              [&request](double value) { request.set_radius_x_metres(value); });
  list.number("--radius-y-metres", {"m", "1e-5 to 1e4", "0"},
              "Radius across the motion; 0: that along the motion",
              [&request](double value) { request.set_radius_y_metres(value); });
  list.choice("--disc", {"steel", "glass"},
              std::string("Material of the disc; the ball is of steel. Default: ") +
                  (rig.has_glass_disc ? "glass." : "steel."),
              [&request](int index) { set_disc(index == 0 ? "steel" : "glass", request); });
  list.text("--surface", "NAME",
            std::string("Roughness and boundary friction of the specimens; smooth: none. "
                        "Default: ") +
                (*rig.surface != 0 ? rig.surface : "smooth") + ".",
            [&request](const std::string& name) {
              request.set_composite_rms_height_metres(0);
              request.set_surface(name == "smooth" ? "" : resource_name("surfaces", name));
            })
      .collection = "surfaces";
  list.number(
      "--composite-rms-height-metres,--roughness",
      {"m", "1e-10 to 0.01", rig.roughness != 0 ? significant(rig.roughness, 3) : "0"},
      "Height sigma_G of the specimens in place of that of the surface, e.g. 20nm; 0: that of "
      "the surface",
      [&request](double value) { request.set_composite_rms_height_metres(value); });
  list.group("Map");
  list.texts("--map", "X,Y",
             "Map over two of slide-roll-ratio, temperature, speed, load and pressure, whose flags "
             "may list their values; each other setting has its first value.",
             [&flags](const std::string& word) { flags.map.push_back(word); })
      .field = "grid";
  list.group("Uncertainty");
  list.whole_number("--draws", {"-", "0, or 19 to 1999", "199; of a map 0"},
                    "Draws of the parameters of lubricant and surface for the uncertainties of the "
                    "figures; 0: none",
                    [&flags](int value) { flags.draws = value; });
  list.group("Files");
  list.text("--measured", "FILE",
            std::string("CSV with columns ") + rig.view.x + " and " + rig.view.y +
                ", optionally load_newtons and other settings of the rig: measured points, shown "
                "beside the computed ones with residuals in percent.",
            [&flags](const std::string& path) { flags.measured_path = path; });
  add_plot_flag(list, "Also draw the curves as SVG.", flags.plot_path);
  add_model_flags(list, *request.mutable_model_options());
}

RigSettings settings_of(const RigFlags& flags, const RigCommand& rig) {
  RigSettings out = rig.settings;
  for (const RigAxis& axis : rig_axes()) {
    std::vector<double>& values = out.*axis.values;
    if (!(flags.given.*axis.values).empty()) values = flags.given.*axis.values;
    if (flags.map.empty()) continue;
    if (std::find(flags.map.begin(), flags.map.end(), axis.word) == flags.map.end()) {
      values.resize(std::min<std::size_t>(values.size(), 1));
    } else if (values.size() < 2 || (flags.given.*axis.values).empty()) {
      values = axis.standard;
    } else {
      std::sort(values.begin(), values.end());
    }
  }
  if (!out.mean_pressures.empty()) out.loads.clear();
  return out;
}

v1::RigCondition rig_condition(double load, double speed, double slide, double temperature) {
  v1::RigCondition out;
  out.set_load_newtons(load);
  out.set_entrainment_speed_metres_per_second(speed);
  out.set_slide_roll_ratio_percent(slide);
  out.set_supply_temperature_celsius(temperature);
  return out;
}

/// Evaluates every combination of the settings, and lists the conditions in the request.
v1::EvaluateRigResponse evaluate_grid(const RigSettings& settings, Connection& connection,
                                      v1::EvaluateRigRequest& request) {
  *request.mutable_grid() = grid_of(settings);
  request.clear_conditions();
  v1::EvaluateRigResponse answer = connection.evaluate_rig(request);
  const std::size_t loads = settings.loads.size() + settings.mean_pressures.size();
  for (const double temperature : settings.temperatures) {
    for (std::size_t i = 0; i < loads; ++i) {
      for (const double speed : settings.speeds) {
        for (const double slide : settings.slide_roll_ratios) {
          const double load = answer.load_newtons(request.conditions_size());
          *request.add_conditions() = rig_condition(load, speed, slide, temperature);
        }
      }
    }
  }
  request.clear_grid();
  return answer;
}

int run_rig(const RigFlags& flags, const RigCommand& rig, const CommonOptions& options) {
  const RigSettings settings = settings_of(flags, rig);
  std::vector<MeasuredPoint> points;
  if (!flags.measured_path.empty()) {
    const v1::RigCondition usual =
        rig_condition(settings.loads.empty() ? 0 : settings.loads.front(), settings.speeds.front(),
                      settings.slide_roll_ratios.front(), settings.temperatures.front());
    points = read_measured(read_file(flags.measured_path), flags.measured_path, rig.view, usual);
  }
  // Isothermal figures stand beside the thermal ones.
  v1::EvaluateRigRequest request = flags.request;
  std::vector<bool> models{false};
  if (request.model_options().isothermal()) models.push_back(true);
  request.set_draws(flags.draws.value_or(flags.map.empty() ? kRigDraws : 0));
  Connection connection = options.connect();
  std::vector<RigRow> rows;
  RigDraws draws{request.draws(), {}};
  std::string version;
  const auto add = [&](const v1::EvaluateRigResponse& answer,
                       const std::vector<std::optional<double>>& measured) {
    for (RigRow& row : rig_rows(request, answer, measured)) rows.push_back(std::move(row));
    version = answer.model_version();
    draws.exact_inputs[answer.lubricant_revision()] = {answer.inputs_without_uncertainty().begin(),
                                                       answer.inputs_without_uncertainty().end()};
  };
  for (const std::string& fluid : flags.fluids) {
    for (const bool is_isothermal : models) {
      request.set_lubricant(fluid);
      request.mutable_model_options()->set_isothermal(is_isothermal);
      add(evaluate_grid(settings, connection, request), {});
      if (points.empty()) continue;
      request.clear_conditions();
      std::vector<std::optional<double>> measured;
      for (const MeasuredPoint& point : points) {
        *request.add_conditions() = point.condition;
        measured.emplace_back(point.value);
      }
      add(connection.evaluate_rig(request), measured);
    }
  }
  if (flags.map.empty()) {
    std::cout << rig_text(rows, rig.view, options.output_format, draws);
    if (!flags.plot_path.empty()) write_file(flags.plot_path, rig_plot(rows, rig.view, version));
    return kExitOk;
  }
  const MapPicture picture =
      map_of(rows, rig.view, *rig_axis(flags.map[0]), *rig_axis(flags.map[1]), settings, version);
  std::cout << (options.output_format == OutputFormat::kTable
                    ? map_table(picture) + warnings_text(rig_warnings(rows, rig.view))
                    : rig_text(rows, rig.view, options.output_format, draws));
  if (!flags.plot_path.empty()) write_file(flags.plot_path, map_plot(picture));
  return kExitOk;
}

void check_map(const RigFlags& flags, Complaints& complaints) {
  if (flags.map.empty()) return;
  std::vector<std::string> words;
  for (const RigAxis& axis : rig_axes()) words.emplace_back(axis.word);
  for (const std::string& word : flags.map) {
    if (rig_axis(word) == nullptr) {
      complaints.push_back("--map: unknown setting '" + printable(word) + "'; allowed: two of " +
                           joined(words, ", "));
    }
  }
  const bool are_two = flags.map.size() == 2 && flags.map[0] != flags.map[1];
  const auto has = [&flags](const char* word) {
    return std::find(flags.map.begin(), flags.map.end(), word) != flags.map.end();
  };
  if (!are_two || (has("load") && has("pressure"))) {
    complaints.push_back("--map: " + joined(flags.map, ",") +
                         "; allowed: two different settings, not load and pressure together");
  }
  if (has("load") && !flags.given.mean_pressures.empty()) {
    complaints.emplace_back("--map over load and --pressure exclude each other");
  }
  if (!flags.measured_path.empty()) {
    complaints.emplace_back("--map and --measured exclude each other");
  }
}

Command rig_command(const RigCommand& rig) {
  const auto flags = std::make_shared<RigFlags>();
  Command command{rig.view.command, rig.summary, rig.about, rig.examples, {}, {}, {}};
  add_rig_flags(command.flags, *flags, rig);
  command.check = [flags, name = std::string(rig.view.command)](Complaints& complaints) {
    check_map(*flags, complaints);
    if (!flags->given.loads.empty() && !flags->given.mean_pressures.empty()) {
      complaints.emplace_back("--load and --pressure exclude each other");
    }
    if (flags->fluids.empty()) {
      complaints.push_back("give a lubricant: tribodyn " + name + " paper-fluid-1");
    }
  };
  command.main_flags = {"fluid",         "--load",     "--speed", "--srr",
                        "--temperature", "--radius",   "--disc",  "--roughness",
                        "--map",         "--measured", "--plot"};
  command.run = [flags, rig](const CommonOptions& options) {
    return run_rig(*flags, rig, options);
  };
  return command;
}

constexpr char kSpeedField[] = "entrainment_speed_metres_per_second";
constexpr char kSlideField[] = "slide_roll_ratio_percent";

RigCommand rig_of_traction() {
  return {
      {"traction", "Traction of a ball on a disc", kSlideField, "traction_coefficient",
       "Slide-roll ratio, % of the mean speed", "Traction coefficient", 1, false},
      "traction of a ball on a disc against the slide-roll ratio",
      "Computes traction curves of a ball on a disc by the contact of the axle: friction over "
      "load, films, pressures, temperatures and shares. Nothing is stored. --isothermal shows the "
      "isothermal figures beside the thermal ones. Default: a smooth 19.05 mm ball of steel on "
      "steel.",
      {"tribodyn traction paper-fluid-1 paper-fluid-2 --load 35.2 --speed 2.5 --plot traction.svg",
       "tribodyn traction shell-t9 --radius 12.7mm --load 38,154 --speed 2 --temperature 25 "
       "--isothermal"},
      0.009525,
      false,
      "",
      0,
      {{35}, {2}, {0, 0.5, 1, 2, 3, 5, 7, 10, 15, 20, 30, 50}, {40}},
      "2",
      "0 to 50"};
}

RigCommand rig_of_film() {
  return {{"film", "Film of a ball on a disc", kSpeedField, "central_film_thickness_metres",
           "Entrainment speed, m/s", "Central film thickness, nm", 1e9, true},
          "film of a ball on a disc against speed",
          "Computes films of a ball on a disc, as optical interferometry measures them, by the "
          "contact "
          "of the axle. Nothing is stored. "
          "Default: a smooth 19.05 mm ball of steel that rolls on glass.",
          {"tribodyn film paper-fluid-1 paper-fluid-2 paper-fluid-3 --plot film.svg",
           "tribodyn film paper-fluid-1 --temperature 40,100 --measured "
           "film.csv"},
          0.009525,
          true,
          "",
          0,
          {{20}, powers(0.03, 3, 6), {0}, {40}},
          "0.03 to 3",
          "0"};
}

RigCommand rig_of_stribeck() {
  return {{"stribeck", "Stribeck curve of a ball on a disc", kSpeedField, "traction_coefficient",
           "Entrainment speed, m/s", "Friction coefficient", 1, true},
          "friction of a rough ball on a disc against speed",
          "Computes Stribeck curves of a rough ball on a disc by the contact of the axle, from "
          "boundary friction to full films. Nothing is stored. --isothermal shows the isothermal "
          "figures beside the thermal ones. Default: a 19.05 mm ball of steel on steel, with the "
          "boundary friction of run-in flanks and a height of 20 nm.",
          {"tribodyn stribeck paper-fluid-1 --temperature 40,100 --plot stribeck.svg",
           "tribodyn stribeck paper-fluid-1 --roughness 50nm --load 10,35 --output csv"},
          0.009525,
          false,
          "run-in",
          20e-9,
          {{35}, powers(0.003, 3, 6), {50}, {40}},
          "0.003 to 3",
          "50"};
}

}  // namespace

void set_disc(const std::string& material, v1::EvaluateRigRequest& request) {
  request.clear_body_2();
  if (material != "glass") return;
  v1::RigBody& disc = *request.mutable_body_2();
  disc.set_youngs_modulus_pascals(75e9);
  disc.set_poissons_ratio(0.22);
  disc.set_thermal_conductivity_watts_per_metre_kelvin(1.1);
  disc.set_density_kilograms_per_cubic_metre(2500);
  disc.set_specific_heat_capacity_joules_per_kilogram_kelvin(840);
}

RigMachine rig_machine(const std::string& command) {
  if (command == "film") return machine_of(rig_of_film());
  return machine_of(command == "stribeck" ? rig_of_stribeck() : rig_of_traction());
}

Command traction_command() { return rig_command(rig_of_traction()); }
Command film_command() { return rig_command(rig_of_film()); }
Command stribeck_command() { return rig_command(rig_of_stribeck()); }

}  // namespace tribodyn::client
