#include <google/protobuf/descriptor.h>

#include <algorithm>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "client/cpp/commands/scenario.h"

namespace tribodyn::client {
namespace {

using google::protobuf::FieldDescriptor;

/// Returns the help texts of the switches of ModelOptions. A switch without a text still gets its
/// flag.
const std::map<std::string, std::string>& switch_descriptions() {
  static const std::map<std::string, std::string> kDescriptions = {
      {"isothermal",
       "Set the contact temperature to the inlet temperature: no thermal network (eqs 35-39)."},
      {"newtonian", "No shear thinning (eq 23)."},
      {"no_limiting_shear_stress", "No limiting shear stress."},
      {"no_boundary_friction", "No friction of asperities (eq 40); they still carry load."},
      {"damping_in_contact_only", "Mesh damping acts only while the flanks touch."},
      {"energy_consistent", "Add the parametric torques that eq 2 leaves out."},
      {"subtract_contact_point_motion",
       "Measure the entrainment speed relative to the moving contact point."},
      {"load_dependent_mesh_data",
       "Use mesh stiffness, transmission error and load shares at the actual torque."},
      {"tabulated_friction_arms",
       "Take the lever arms of friction from the tables of the gear set, not from the actual "
       "sliding."},
      {"inlet_shear_heating",
       "Thin the film by the shear heating of the inlet (Gupta and others 1992), which eq 12 "
       "leaves "
       "out; =false does not. Default: by the preset."},
      {"closed_load_sharing",
       "The film carries no more load than its thickness supports, so that friction tends to "
       "boundary friction where the film vanishes; =false as in eq 41. Default: by the preset."},
      {"exact_hertz", "Use elliptic integrals instead of the fits of eqs 21 and 22."},
      {"hertz_from_total_load",
       "Compute the contact ellipse from the total load instead of the load on the film."},
  };
  return kDescriptions;
}

/// Returns the words of --as-published and the field that each sets. eq46 is not among them: it
/// applies where profiles become a surface and is a flag of that import.
const std::vector<std::pair<std::string, std::string>>& misprints() {
  static const std::vector<std::pair<std::string, std::string>> kMisprints = {
      {"eq17", "eq17_atan"},           {"eq20", "eq20_semi_major"},
      {"eq22", "eq22_inverted_ratio"}, {"eq31", "eq31_32_logarithm"},
      {"eq43", "eq43_44_polynomials"},
  };
  return kMisprints;
}

void set_switch(google::protobuf::Message& message, const std::string& field, bool is_on = true) {
  message.GetReflection()->SetBool(&message, message.GetDescriptor()->FindFieldByName(field),
                                   is_on);
}

constexpr std::pair<const char*, v1::ModelOptions::Preset> kPresets[] = {
    {"recommended", v1::ModelOptions::RECOMMENDED}, {"paper", v1::ModelOptions::PAPER}};

std::string misprint_words() {
  std::string words;
  for (const auto& [word, field] : misprints()) words += (words.empty() ? "" : "|") + word;
  return words;
}

void add_as_published_flag(FlagList& flags, v1::ModelOptions& options) {
  Flag& flag = flags.choices(
      "--as-published", misprint_words(),
      "Compute with a misprint of the paper, to see its effect: " + misprint_words() +
          "; separate several by commas (eq31 means eqs 31 and 32, eq43 means 43 and 44). "
          "Default: all corrected.",
      [&options](const std::string& given) {
        for (const auto& [word, field] : misprints()) {
          if (given == word || given == field) {
            set_switch(*options.mutable_as_published(), field);
            return true;
          }
        }
        return false;
      });
  flag.read = [read = flag.read](const std::vector<std::string>& given, Complaints& complaints) {
    const std::size_t before = complaints.size();
    read(given, complaints);
    if (complaints.size() == before) return;
    const bool names_eq46 = std::any_of(given.begin(), given.end(), [](const std::string& text) {
      return text.find("eq46") != std::string::npos;
    });
    if (names_eq46) {
      complaints.emplace_back(
          "--as-published eq46 applies where measured profiles become a surface: tribodyn surfaces "
          "import --profile ... --as-published eq46");
    }
  };
}

/// A value of --compare and the options that it sets.
struct SwitchWord {
  std::string word, field;
  bool is_on = true;
};

/// Returns the switches of ModelOptions as words of --compare, e.g. "no-boundary-friction". One
/// that a preset decides has two words: "no-inlet-shear-heating" sets it to false.
std::vector<SwitchWord> switch_words() {
  std::vector<SwitchWord> out;
  const auto* descriptor = v1::ModelOptions::descriptor();
  for (int i = 0; i < descriptor->field_count(); ++i) {
    const FieldDescriptor& field = *descriptor->field(i);
    if (field.cpp_type() != FieldDescriptor::CPPTYPE_BOOL) continue;
    const std::string word = flag_of_field(field.name()).substr(2);
    out.push_back({word, field.name()});
    if (field.has_presence()) out.push_back({"no-" + word, field.name(), false});
  }
  return out;
}

}  // namespace

std::string compared_words() {
  std::string out;
  for (const SwitchWord& each : switch_words()) out += each.word + "|";
  for (const auto& [word, preset] : kPresets) out += std::string(word) + "|";
  return out + "houpert|" + misprint_words() + "|up|down";
}

bool apply_variant(const std::string& word, v1::Simulation& simulation) {
  for (const auto& [name, field, is_on] : switch_words()) {
    // "no-boundary" is short for "no-boundary-friction".
    if (word != name && (word != "no-boundary" || name != "no-boundary-friction")) continue;
    set_switch(*simulation.mutable_model_options(), field, is_on);
    return true;
  }
  for (const auto& [name, preset] : kPresets) {
    if (word != name) continue;
    simulation.mutable_model_options()->set_preset(preset);
    return true;
  }
  for (const auto& [name, field] : misprints()) {
    if (word != name) continue;
    set_switch(*simulation.mutable_model_options()->mutable_as_published(), field);
    return true;
  }
  if (word == "houpert") {
    simulation.mutable_model_options()->set_pressure_viscosity_index(
        v1::ModelOptions::PRESSURE_VISCOSITY_INDEX_HOUPERT);
    return true;
  }
  if (word != "up" && word != "down") return false;
  simulation.mutable_inefficiency_curve()->set_direction(word == "up" ? v1::SWEEP_DIRECTION_UP
                                                                      : v1::SWEEP_DIRECTION_DOWN);
  return true;
}

void add_model_flags(FlagList& flags, v1::ModelOptions& options) {
  flags.group("Model (`tribodyn help models` says what each choice is worth)");
  std::vector<std::string> presets;
  for (const auto& [word, preset] : kPresets) presets.emplace_back(word);
  flags
      .choice("--model-preset", presets,
              "recommended: the paper's model with its misprints corrected, with shear heating of "
              "the inlet and closed load sharing; paper: without these two. Default: recommended.",
              [&options](int index) { options.set_preset(kPresets[index].second); })
      .field = "preset";
  const auto* descriptor = v1::ModelOptions::descriptor();
  for (int i = 0; i < descriptor->field_count(); ++i) {
    const FieldDescriptor& field = *descriptor->field(i);
    if (field.cpp_type() != FieldDescriptor::CPPTYPE_BOOL) continue;
    const auto found = switch_descriptions().find(field.name());
    const std::string flag = flag_of_field(field.name());
    const std::string text =
        found != switch_descriptions().end() ? found->second : "See ModelOptions.";
    const auto set = [&options, name = field.name()](bool is_on) {
      set_switch(options, name, is_on);
    };
    if (field.has_presence()) {
      flags.truth(flag, text, set);
    } else {
      flags.toggle(flag, text, [set] { set(true); });
    }
  }
  flags.choice("--pressure-viscosity-index", {"reciprocal-asymptotic", "houpert"},
               "Roelands index Z: solved from eq 33 for the measured coefficient, or from eq 32. "
               "Default: reciprocal-asymptotic.",
               [&options](int index) {
                 options.set_pressure_viscosity_index(
                     index == 0 ? v1::ModelOptions::PRESSURE_VISCOSITY_INDEX_RECIPROCAL_ASYMPTOTIC
                                : v1::ModelOptions::PRESSURE_VISCOSITY_INDEX_HOUPERT);
               });
  add_as_published_flag(flags, options);
}

}  // namespace tribodyn::client
