#include <cmath>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "client/cpp/commands/result_files.h"
#include "client/cpp/commands/scenario.h"
#include "client/cpp/report/rig_rows.h"
#include "client/cpp/resources/json_input.h"
#include "client/cpp/text/text.h"

namespace tribodyn::client {
namespace {

/// What the machine sets if the flags do not: lists of which every combination is a condition.
struct RigSettings {
  std::vector<double> loads, speeds, slide_roll_ratios, temperatures;
};

struct RigFlags {
  std::vector<std::string> fluids;
  v1::EvaluateRigRequest request;
  RigSettings given;  ///< empty lists: the command's
  std::string plot_path, measured_path;
};

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

std::vector<double> powers(double first, double last, int per_decade) {
  std::vector<double> out;
  const int steps = static_cast<int>(std::lround(per_decade * std::log10(last / first)));
  for (int i = 0; i <= steps; ++i) out.push_back(first * std::pow(last / first, 1.0 * i / steps));
  return out;
}

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

void add_rig_flags(FlagList& list, RigFlags& flags, const RigCommand& rig) {
  list.group("Arguments");
  list.texts("fluid", "FLUID", "Lubricants, e.g. paper-fluid-1, or revisions, e.g. my-oil@2.",
             [&flags](const std::string& name) {
               flags.fluids.push_back(resource_name("lubricants", name));
             })
      .collection = "lubricants";
  list.group("Rig (lists: every combination is a condition)");
  const auto numbers = [&](const char* names, const NumberText& text, const char* description,
                           std::vector<double> RigSettings::*values) {
    list.numbers(names, text, description,
                 [&flags, values](double value) { (flags.given.*values).push_back(value); });
  };
  const std::string load = significant(rig.settings.loads.front(), 4);
  numbers("--load-newtons,--load", {"N", "1e-6 to 1e6", load}, "Normal loads", &RigSettings::loads);
  numbers("--entrainment-speed-metres-per-second,--speed", {"m/s", "1e-6 to 1e3", rig.speeds_text},
          "Mean speeds of both surfaces", &RigSettings::speeds);
  numbers("--slide-roll-ratio-percent,--slide-roll-ratio,--srr",
          {"%", "-200 to 200", rig.slides_text},
          "Differences of the speeds over their mean, positive where the ball is faster",
          &RigSettings::slide_roll_ratios);
  numbers("--supply-temperature-celsius,--temperature", {"C", "-70 to 200", "40"},
          "Temperatures of the oil at the inlet", &RigSettings::temperatures);
  v1::EvaluateRigRequest& request = flags.request;
  request.set_radius_x_metres(rig.radius);
  list.number("--radius-x-metres,--radius", {"m", "1e-5 to 1e4", significant(rig.radius, 5)},
              "Radius of the ball, e.g. 12.7mm; of a ring: along the motion",
              [&request](double value) { request.set_radius_x_metres(value); });
  list.number("--radius-y-metres", {"m", "1e-5 to 1e4", "0"},
              "Radius across the motion; 0: that along the motion",
              [&request](double value) { request.set_radius_y_metres(value); });
  if (rig.has_glass_disc) set_disc("glass", request);
  list.choice("--disc", {"steel", "glass"},
              std::string("Material of the disc; the ball is of steel. Default: ") +
                  (rig.has_glass_disc ? "glass." : "steel."),
              [&request](int index) { set_disc(index == 0 ? "steel" : "glass", request); });
  if (*rig.surface != 0) request.set_surface(resource_name("surfaces", rig.surface));
  request.set_composite_rms_height_metres(rig.roughness);
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
  for (const auto values : {&RigSettings::loads, &RigSettings::speeds,
                            &RigSettings::slide_roll_ratios, &RigSettings::temperatures}) {
    if (!(flags.given.*values).empty()) out.*values = flags.given.*values;
  }
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

int run_rig(const RigFlags& flags, const RigCommand& rig, const CommonOptions& options) {
  v1::EvaluateRigRequest request = flags.request;
  const RigSettings settings = settings_of(flags, rig);
  for (const double temperature : settings.temperatures) {
    for (const double load : settings.loads) {
      for (const double speed : settings.speeds) {
        for (const double slide : settings.slide_roll_ratios) {
          *request.add_conditions() = rig_condition(load, speed, slide, temperature);
        }
      }
    }
  }
  std::vector<std::optional<double>> measured(static_cast<std::size_t>(request.conditions_size()));
  if (!flags.measured_path.empty()) {
    const v1::RigCondition usual =
        rig_condition(settings.loads.front(), settings.speeds.front(),
                      settings.slide_roll_ratios.front(), settings.temperatures.front());
    for (MeasuredPoint& point :
         read_measured(read_file(flags.measured_path), flags.measured_path, rig.view, usual)) {
      *request.add_conditions() = std::move(point.condition);
      measured.emplace_back(point.value);
    }
  }
  // Isothermal figures stand beside the thermal ones.
  std::vector<bool> models{false};
  if (request.model_options().isothermal()) models.push_back(true);
  Connection connection = options.connect();
  std::vector<RigRow> rows;
  std::string version;
  for (const std::string& fluid : flags.fluids) {
    for (const bool is_isothermal : models) {
      request.set_lubricant(fluid);
      request.mutable_model_options()->set_isothermal(is_isothermal);
      const v1::EvaluateRigResponse answer = connection.evaluate_rig(request);
      for (RigRow& row : rig_rows(request, answer, measured)) rows.push_back(std::move(row));
      version = answer.model_version();
    }
  }
  std::cout << rig_text(rows, rig.view, options.output_format);
  if (!flags.plot_path.empty()) write_file(flags.plot_path, rig_plot(rows, rig.view, version));
  return kExitOk;
}

Command rig_command(const RigCommand& rig) {
  const auto flags = std::make_shared<RigFlags>();
  Command command{rig.view.command, rig.summary, rig.about, rig.examples, {}, {}, {}};
  add_rig_flags(command.flags, *flags, rig);
  command.check = [flags, name = std::string(rig.view.command)](Complaints& complaints) {
    if (flags->fluids.empty()) {
      complaints.push_back("give a lubricant: tribodyn " + name + " paper-fluid-1");
    }
  };
  command.main_flags = {"fluid",    "--load", "--speed",     "--srr",      "--temperature",
                        "--radius", "--disc", "--roughness", "--measured", "--plot"};
  command.run = [flags, rig](const CommonOptions& options) {
    return run_rig(*flags, rig, options);
  };
  return command;
}

constexpr char kSpeedField[] = "entrainment_speed_metres_per_second";
constexpr char kSlideField[] = "slide_roll_ratio_percent";

}  // namespace

Command traction_command() {
  return rig_command(
      {{"traction", "Traction of a ball on a disc", kSlideField, "traction_coefficient",
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
       "0 to 50"});
}

Command film_command() {
  return rig_command(
      {{"film", "Film of a ball on a disc", kSpeedField, "central_film_thickness_metres",
        "Entrainment speed, m/s", "Central film thickness, nm", 1e9, true},
       "film of a ball on a disc against speed",
       "Computes films of a ball on a disc, as optical interferometry measures them, by the "
       "contact "
       "of the axle. Nothing is stored. Films of fast or cold oils need --inlet-shear-heating. "
       "Default: a smooth 19.05 mm ball of steel that rolls on glass.",
       {"tribodyn film paper-fluid-1 paper-fluid-2 paper-fluid-3 --plot film.svg",
        "tribodyn film paper-fluid-1 --temperature 40,100 --inlet-shear-heating --measured "
        "film.csv"},
       0.009525,
       true,
       "",
       0,
       {{20}, powers(0.03, 3, 6), {0}, {40}},
       "0.03 to 3",
       "0"});
}

Command stribeck_command() {
  return rig_command(
      {{"stribeck", "Stribeck curve of a ball on a disc", kSpeedField, "traction_coefficient",
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
       "50"});
}

}  // namespace tribodyn::client
