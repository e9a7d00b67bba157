#include "client/cpp/text/inputs.h"

#include <google/protobuf/descriptor.h>
#include <google/protobuf/util/time_util.h>

#include <algorithm>
#include <cctype>
#include <map>

#include "client/cpp/text/text.h"
#include "client/cpp/text/units.h"
#include "client/cpp/text/warnings.h"
#include "proto/enum_names.h"

namespace tribodyn::client {
namespace {

constexpr double kDefaultSumpTemperatureCelsius = 40;
constexpr double kDefaultInletTemperatureRiseKelvin = 20;

/// Returns the stated name; without one, the name of the accepted revision; without that, the
/// default.
std::string stated_or_accepted(const std::string& name, const std::string& revision,
                               const char* standard) {
  if (!name.empty()) return name;
  return revision.empty() ? standard : revision.substr(0, revision.find('@'));
}

void append_switches(const google::protobuf::Message& message, const std::string& prefix,
                     std::string& text) {
  const auto* descriptor = message.GetDescriptor();
  for (int i = 0; i < descriptor->field_count(); ++i) {
    const auto& field = *descriptor->field(i);
    if (field.cpp_type() != google::protobuf::FieldDescriptor::CPPTYPE_BOOL) continue;
    const bool is_on = message.GetReflection()->GetBool(message, &field);
    // A switch that a preset decides may be set to false.
    if (!is_on && !(field.has_presence() && message.GetReflection()->HasField(message, &field))) {
      continue;
    }
    text += (text.empty() ? "" : ", ") + prefix + (is_on ? "" : "without ") + field.name();
  }
}

std::string ascent_text(double degrees) {
  return degrees == 0 ? "" : ", ascent " + significant(degrees) + " degrees";
}

std::string point_text(const v1::OperatingPointStudy& study) {
  switch (study.condition_case()) {
    case v1::OperatingPointStudy::kCruise:
      return "cruise at " + significant(study.cruise().speed_kilometres_per_hour()) + " km/h" +
             ascent_text(study.cruise().ascent_angle_degrees());
    case v1::OperatingPointStudy::kDriveCycleSnapshot: {
      const auto& snapshot = study.drive_cycle_snapshot();
      return significant(snapshot.speed_kilometres_per_hour()) + " km/h accelerating at " +
             significant(snapshot.acceleration_metres_per_second_squared()) + " m/s2" +
             ascent_text(snapshot.ascent_angle_degrees());
    }
    case v1::OperatingPointStudy::kPrescribedTorque:
      return "pinion torque " +
             significant(study.prescribed_torque().pinion_torque_newton_metres()) + " N m at " +
             significant(study.prescribed_torque().pinion_speed_radians_per_second()) + " rad/s";
    default:
      return "operating point";
  }
}

std::string curve_text(const v1::InefficiencyCurveStudy& study) {
  const std::string direction = ", " + sweep_text(study);
  const std::string ascent = ascent_text(study.ascent_angle_degrees());
  if (study.speeds_kilometres_per_hour_size() > 0) {
    const auto& speeds = study.speeds_kilometres_per_hour();
    const auto [least, largest] = std::minmax_element(speeds.begin(), speeds.end());
    return "inefficiency curve from " + significant(*least) + " to " + significant(*largest) +
           " km/h, " + std::to_string(speeds.size()) + " speeds" + direction + ascent;
  }
  return "inefficiency curve from " + significant(study.first_speed_kilometres_per_hour()) +
         " to " + significant(study.last_speed_kilometres_per_hour()) + " km/h by " +
         significant(study.speed_step_kilometres_per_hour()) + direction + ascent;
}

/// Returns e.g. "20.525 1/GPa" for "2.0525e-08 1/Pa"; a text without a number unchanged.
std::string in_trade_unit_text(const v1::Assumption& assumption) {
  const std::string& field = assumption.field();
  const std::string unit = unit_of_field(field);
  std::string wrong;
  const auto value =
      read_quantity(assumption.value(), unit, unit, is_temperature_field(field), wrong);
  if (!value) return assumption.value();
  const std::string trade = trade_unit_of_field(field);
  return significant(in_trade_unit(field, *value)) + (trade.empty() ? "" : " " + trade);
}

/// Adds the assumed parameters of the lubricant, which affect a comparison of fluids most. They are
/// always shown.
void add_assumed_of_lubricant(const v1::SimulationResult& result, Sheet& sheet) {
  std::string text;
  for (const auto& assumption : result.assumptions()) {
    if (assumption.provenance() != v1::PROVENANCE_ASSUMED ||
        assumption.resource().rfind("lubricants/", 0) != 0) {
      continue;
    }
    text += (text.empty() ? "" : "; ") + label_of_field(assumption.field()) + " " +
            in_trade_unit_text(assumption);
  }
  if (text.empty()) return;
  sheet.heading("Parameters of the lubricant that are assumed, not measured");
  sheet.remark(text);
}

}  // namespace

Inputs inputs_of(const v1::Simulation& simulation) {
  return {
      simulation.lubricant(),
      stated_or_accepted(simulation.gear_set(), simulation.gear_set_revision(),
                         "gearSets/reference-axle"),
      stated_or_accepted(simulation.surface(), simulation.surface_revision(), "surfaces/run-in"),
      stated_or_accepted(simulation.vehicle(), simulation.vehicle_revision(),
                         "vehicles/passenger-car"),
      simulation.has_sump_temperature_celsius() ? simulation.sump_temperature_celsius()
                                                : kDefaultSumpTemperatureCelsius,
      simulation.has_inlet_temperature_rise_kelvin() ? simulation.inlet_temperature_rise_kelvin()
                                                     : kDefaultInletTemperatureRiseKelvin};
}

std::string inputs_text(const v1::Simulation& simulation, const char* celsius,
                        const Differences& differences) {
  const Inputs inputs = inputs_of(simulation);
  return "gear set " + resource_id(inputs.gear_set) +
         (differences.surfaces ? "" : ", surface " + resource_id(inputs.surface)) + ", vehicle " +
         resource_id(inputs.vehicle) + "; " +
         (differences.sumps
              ? ""
              : "sump " + significant(inputs.sump_temperature_celsius) + " " + celsius + ", ") +
         "inlet rise " + significant(inputs.inlet_temperature_rise_kelvin) + " K" +
         (simulation.sheared_lubricant() ? "; lubricant after the shear test" : "");
}

Differences differences_of(const std::vector<v1::Simulation>& simulations) {
  Differences out;
  for (const v1::Simulation& each : simulations) {
    const v1::Simulation& first = simulations.front();
    const Inputs inputs = inputs_of(each), firsts = inputs_of(first);
    out.sumps |= inputs.sump_temperature_celsius != firsts.sump_temperature_celsius;
    out.surfaces |= inputs.surface != firsts.surface;
    out.models |=
        model_options_text(each.model_options()) != model_options_text(first.model_options());
    out.sweeps |= sweep_text(each.inefficiency_curve()) != sweep_text(first.inefficiency_curve());
  }
  return out;
}

std::string distinction(const v1::Simulation& simulation, const Differences& differences,
                        const char* celsius) {
  const Inputs inputs = inputs_of(simulation);
  std::string out;
  const auto add = [&](bool differs, const std::string& text) {
    if (differs) out += (out.empty() ? "" : ", ") + text;
  };
  add(differences.sumps, "sump " + significant(inputs.sump_temperature_celsius) + " " + celsius);
  add(differences.surfaces, "surface " + resource_id(inputs.surface));
  add(differences.models, model_options_text(simulation.model_options()));
  add(differences.sweeps, sweep_text(simulation.inefficiency_curve()));
  return out;
}

std::string model_options_text(const v1::ModelOptions& options) {
  const bool is_paper = options.preset() == v1::ModelOptions::PAPER;
  std::string text;
  append_switches(options, "", text);
  if (options.pressure_viscosity_index() == v1::ModelOptions::PRESSURE_VISCOSITY_INDEX_HOUPERT) {
    text += text.empty() ? "Houpert's Z" : ", Houpert's Z";
  }
  append_switches(options.as_published(), "as published ", text);
  if (text.empty()) return is_paper ? "paper as corrected" : "recommended";
  return is_paper ? "paper, " + text : text;
}

std::string study_text(const v1::Simulation& simulation) {
  switch (simulation.study_case()) {
    case v1::Simulation::kOperatingPoint:
      return point_text(simulation.operating_point());
    case v1::Simulation::kInefficiencyCurve:
      return curve_text(simulation.inefficiency_curve());
    default:
      return "no study";
  }
}

std::string sweep_text(const v1::InefficiencyCurveStudy& study) {
  if (study.independent_points()) return "independent points";
  return study.direction() == v1::SWEEP_DIRECTION_DOWN ? "down-sweep" : "up-sweep";
}

std::string provenance_word(v1::Provenance provenance) {
  std::string word = short_name(*v1::Provenance_descriptor(), provenance);
  std::transform(word.begin(), word.end(), word.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return word;
}

void add_provenance(const v1::SimulationResult& result, bool shows_all, Sheet& sheet) {
  sheet.heading("Provenance");
  sheet.line("model version", result.model_version());
  sheet.line("input hash", result.input_hash());
  if (!shows_all) {
    std::map<int, int> counts;
    for (const auto& assumption : result.assumptions()) ++counts[assumption.provenance()];
    std::string text;
    for (const auto& [provenance, count] : counts) {
      text += (text.empty() ? "" : ", ") + std::to_string(count) + " " +
              provenance_word(static_cast<v1::Provenance>(provenance));
    }
    sheet.line("parameters",
               text.empty() ? "none stated" : text + " (list them with --assumptions)");
    add_assumed_of_lubricant(result, sheet);
    return;
  }
  std::map<int, std::vector<const v1::Assumption*>> groups;
  for (const auto& assumption : result.assumptions()) {
    groups[assumption.provenance()].push_back(&assumption);
  }
  for (const auto& [provenance, group] : groups) {
    sheet.heading("Parameters, " + provenance_word(static_cast<v1::Provenance>(provenance)));
    for (const v1::Assumption* assumption : group) {
      sheet.remark(assumption->resource() + " " + assumption->field() + " = " +
                   assumption->value() +
                   (assumption->source().empty() ? "" : " (" + assumption->source() + ")"));
    }
  }
}

void add_input_warnings(const InputWarnings& warnings, Sheet& sheet) {
  if (!warnings.empty()) sheet.heading("Notes on lubricant and surface");
  for (const v1::RangeWarning& warning : warnings) {
    sheet.remark(note_sentence(shown_warning(warning)));
  }
}

double run_seconds(const v1::Simulation& simulation) {
  if (!simulation.has_start_time() || !simulation.has_end_time()) return -1;
  using google::protobuf::util::TimeUtil;
  return 1e-6 * static_cast<double>(TimeUtil::DurationToMicroseconds(simulation.end_time() -
                                                                     simulation.start_time()));
}

}  // namespace tribodyn::client
