#include "client/cpp/commands/rig_machine.h"

namespace tribodyn::client {

void add_rig_setting_flags(FlagList& list, const RigSettingTexts& texts, RigSettings& given) {
  // `field`: of RigGrid, so that errors about it name the flag.
  const auto add = [&](const char* names, const NumberText& text, const char* description,
                       const char* field, std::vector<double> RigSettings::*values) {
    list.numbers(names, text, description,
                 [&given, values](double value) { (given.*values).push_back(value); })
        .field = field;
  };
  add("--load-newtons,--load", {"N", "1e-6 to 1e6", texts.load}, "Normal loads", "loads_newtons",
      &RigSettings::loads);
  add("--mean-pressure-pascals,--pressure", {"Pa", "1e4 to 1e11", "none"},
      "Mean pressures of the dry contact by Hertz, in place of loads, e.g. 0.8GPa",
      "mean_pressures_pascals", &RigSettings::mean_pressures);
  add(texts.speed_names, {"m/s", "1e-6 to 1e3", texts.speeds}, "Mean speeds of both surfaces",
      "entrainment_speeds_metres_per_second", &RigSettings::speeds);
  add("--slide-roll-ratio-percent,--slide-roll-ratio,--srr",
      {"%", "-200 to 200", texts.slide_roll_ratios},
      "Differences of the speeds over their mean, positive where the ball is faster",
      "slide_roll_ratios_percent", &RigSettings::slide_roll_ratios);
  add("--supply-temperature-celsius,--temperature", {"C", "-70 to 200", texts.temperature},
      "Temperatures of the oil at the inlet", "supply_temperatures_celsius",
      &RigSettings::temperatures);
}

v1::RigGrid grid_of(const RigSettings& settings) {
  v1::RigGrid grid;
  const auto set = [](const std::vector<double>& values, auto& list) {
    list = {values.begin(), values.end()};
  };
  set(settings.temperatures, *grid.mutable_supply_temperatures_celsius());
  set(settings.loads, *grid.mutable_loads_newtons());
  set(settings.mean_pressures, *grid.mutable_mean_pressures_pascals());
  set(settings.speeds, *grid.mutable_entrainment_speeds_metres_per_second());
  set(settings.slide_roll_ratios, *grid.mutable_slide_roll_ratios_percent());
  return grid;
}

}  // namespace tribodyn::client
