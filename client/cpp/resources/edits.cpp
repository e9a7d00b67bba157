#include "client/cpp/resources/edits.h"

#include <google/protobuf/descriptor.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <numeric>

#include "client/cpp/resources/row_columns.h"
#include "client/cpp/text/nearest.h"
#include "client/cpp/text/text.h"
#include "client/cpp/text/units.h"
#include "proto/enum_names.h"

namespace tribodyn::client {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;

/// The help text of a field and its data-sheet names. A number without unit that is given under
/// such a name is in `bare_unit`.
struct Wording {
  const char* names = "";
  const char* bare_unit = "";
  const char* description = "";
};

const std::map<std::string, Wording>& wordings() {
  static const std::map<std::string, Wording> kWordings = {
      {"kinematic_viscosity_40_celsius_square_millimetres_per_second",
       {"--kv40", "mm2/s", "Kinematic viscosity at 40 C (KV40), mm2/s = cSt"}},
      {"kinematic_viscosity_100_celsius_square_millimetres_per_second",
       {"--kv100", "mm2/s", "Kinematic viscosity at 100 C (KV100), mm2/s = cSt"}},
      {"sheared_kinematic_viscosity_100_celsius_square_millimetres_per_second",
       {"--kv100-sheared", "mm2/s",
        "KV100 after the 20 h KRL shear test (CEC L-45-A-99); decides the SAE J306 grade"}},
      {"density_15_celsius_kilograms_per_cubic_metre",
       {"--density15", "kg/m3", "Density at 15 C, e.g. 870 or 0.87 g/cm3"}},
      {"pressure_viscosity_coefficient_per_pascal",
       {"--pressure-viscosity,--alpha", "",
        "Reciprocal asymptotic pressure-viscosity coefficient alpha*, e.g. 20/GPa"}},
      {"pressure_viscosity_temperature_kelvin",
       {"", "", "Temperature at which alpha* was measured, e.g. 40C"}},
      {"vogel_viscosity_prefactor_pascal_seconds",
       {"", "", "eta_ref of Vogel's law, e.g. 0.155 mPa s"}},
      {"vogel_temperature_coefficient_kelvin", {"", "", "A_1 of Vogel's law, e.g. 944.8 K"}},
      {"vogel_reference_temperature_kelvin", {"", "", "T_0 of Vogel's law, e.g. 159 K"}},
      {"glass_viscosity_pascal_seconds",
       {"", "", "eta_g of the improved Yasutomi law, by convention 1e12 Pa s"}},
      {"glass_temperature_rise_kelvin", {"", "", "A_1 of the improved Yasutomi law, e.g. 210.6 K"}},
      {"glass_pressure_factor_per_pascal",
       {"", "", "A_2 of the improved Yasutomi law, e.g. 0.455/GPa"}},
      {"expansivity_pressure_factor_per_pascal",
       {"", "", "b_1 of the improved Yasutomi law, e.g. 7.606/GPa"}},
      {"expansivity_exponent", {"", "", "b_2 of the improved Yasutomi law, e.g. -0.4193"}},
      {"relaxation_time_seconds", {"", "", "lambda of shear thinning, e.g. 450 ns"}},
      {"havriliak_negami_alpha", {"", "", "Exponent alpha of shear thinning"}},
      {"havriliak_negami_beta", {"", "", "Exponent beta of shear thinning; 0 is Newtonian"}},
      {"rheology_reference_temperature_kelvin",
       {"", "", "Temperature at which the relaxation time holds, e.g. 70C"}},
      {"limiting_shear_stress_at_zero_pressure_pascals", {"", "", "tau_L0, e.g. 4 MPa"}},
      {"limiting_shear_stress_coefficient",
       {"", "", "gamma_L: limiting shear stress over pressure, e.g. 0.029"}},
      {"thermal_conductivity_watts_per_metre_kelvin", {"", "", "k_f, e.g. 0.14 W/mK"}},
      {"density_at_zero_kelvin_kilograms_per_cubic_metre",
       {"", "", "Density extrapolated to 0 K, e.g. 1016 kg/m3"}},
      {"density_slope_kilograms_per_cubic_metre_kelvin",
       {"", "", "Change of density with temperature, e.g. -0.63 kg/(m3 K)"}},
      {"base_oil_class", {"", "", "API group or chemistry; used to estimate missing parameters"}},
      {"condition", {"", "", "Fresh, sheared in a test, or used"}},
      {"flash_point_celsius", {"", "", "Flash point, open cup (ASTM D92), e.g. 210 C"}},
      {"pour_point_celsius",
       {"", "", "Pour point (ASTM D97), e.g. -45 C; a sump below it is refused"}},
      {"asperity_friction_coefficient",
       {"", "",
        "Coefficient zeta of boundary friction, e.g. 0.11; of a lubricant in place of that of the "
        "surface"}},
      {"tribofilm_shear_strength_pascals",
       {"", "",
        "Shear strength of the tribofilm, e.g. 2 MPa; of a lubricant in place of that of the "
        "surface"}},
      {"display_name", {"--title", "", "Title"}},
      {"derived_from", {"", "", "The sample it came from, e.g. the fresh oil of a used one"}},
      {"external_sample_id", {"--sample-id", "", "Sample id of the laboratory"}},
      {"lims_id", {"", "", "Sample id in the laboratory information management system"}},
      {"composite_rms_height_metres",
       {"", "",
        "sigma_G, e.g. 0.4um: RMS heights (Rq, Sq) of both flanks, the root of the sum of their "
        "squares. A mean height (Ra, Sa) is a fifth smaller: Sq = 1.25 Sa of Gaussian heights"}},
      {"asperity_density_per_square_metre", {"", "", "eta_G, e.g. 2500/mm2"}},
      {"asperity_radius_metres", {"", "", "beta_G, e.g. 40um"}},
      {"half_backlash_metres", {"", "", "b, e.g. 60um"}},
  };
  return kWordings;
}

Wording wording_of(const FieldDescriptor& field) {
  const auto found = wordings().find(field.name());
  return found != wordings().end() ? found->second : Wording{};
}

/// A number at the top level of a resource or in one of its nested messages.
struct Leaf {
  const FieldDescriptor* block;  ///< null: at the top level
  const FieldDescriptor* field;

  /// Whether the number has a provenance of its own.
  bool is_parameter() const { return block == nullptr && !is_documentary(*field); }
  std::string top() const { return block != nullptr ? block->name() : field->name(); }
  Message& parent(Message& resource) const {
    return block == nullptr ? resource
                            : *resource.GetReflection()->MutableMessage(&resource, block);
  }
};

bool is_single_number(const FieldDescriptor& field) {
  return !field.is_repeated() && (field.cpp_type() == FieldDescriptor::CPPTYPE_DOUBLE ||
                                  field.cpp_type() == FieldDescriptor::CPPTYPE_INT32);
}

void set_number(const Leaf& leaf, Message& resource, double value) {
  Message& parent = leaf.parent(resource);
  if (leaf.field->cpp_type() == FieldDescriptor::CPPTYPE_INT32) {
    parent.GetReflection()->SetInt32(&parent, leaf.field, static_cast<int>(value));
  } else {
    parent.GetReflection()->SetDouble(&parent, leaf.field, value);
  }
  if (leaf.is_parameter()) set_user_provenance(resource, leaf.field->name());
}

/// Returns the help text, or the field's name in words.
std::string sentence(const std::string& wording, std::string label) {
  if (!wording.empty()) return wording + ".";
  label[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(label[0])));
  return label + ".";
}

std::string lower_kebab(std::string word) {
  std::transform(word.begin(), word.end(), word.begin(), [](unsigned char c) {
    return c == '_' || c == ' ' ? '-' : static_cast<char>(std::tolower(c));
  });
  return word;
}

/// Returns e.g. "thermal-conductivity" for thermal_conductivity_watts_per_metre_kelvin.
std::string parameter_word(const FieldDescriptor& field) {
  return lower_kebab(label_of_field(field.name()));
}

/// Returns the unit of a number without one: that of its data-sheet names, else the usual unit of
/// data sheets.
std::string bare_unit_of(const FieldDescriptor& field) {
  const Wording wording = wording_of(field);
  return *wording.bare_unit != '\0' ? wording.bare_unit : trade_unit_of_field(field.name());
}

/// Adds a flag with short names, whose bare numbers are in the unit of data sheets, and a hidden
/// flag with the full name, which states the unit.
void add_number_flags(FlagList& flags, const Leaf& leaf, ResourceEdits& edits) {
  const FieldDescriptor& field = *leaf.field;
  const std::string unit = unit_of_field(field.name());
  const std::string bare_unit = bare_unit_of(field);
  const Wording wording = wording_of(field);
  const std::string full_name = flag_of_field(field.name());
  std::string names = wording.names;
  if (names.empty() || *wording.bare_unit == '\0') {
    names = "--" + parameter_word(field) + (names.empty() ? "" : "," + names);
  }
  const auto read = [leaf, unit, &edits](const std::string& name, const std::string& bare,
                                         const std::vector<std::string>& texts,
                                         Complaints& complaints) {
    for (const std::string& text : texts) {
      std::string wrong;
      const auto value =
          read_quantity(text, unit, bare, is_temperature_field(leaf.field->name()), wrong);
      const bool whole = leaf.field->cpp_type() != FieldDescriptor::CPPTYPE_INT32 ||
                         (value && *value == static_cast<int>(*value));
      if (!value || !whole) {
        complaints.push_back(name + ": '" + printable(text) + "' " +
                             (value ? "is not a whole number" : wrong));
      } else if (!edits.add_once(leaf.field->name(), leaf.top(), [leaf, value](Message& resource) {
                   set_number(leaf, resource, *value);
                 })) {
        complaints.push_back(name + " may be given only once");
      } else if (leaf.is_parameter()) {
        edits.touch("provenance");
      }
    }
  };
  Flag& flag = flags.raw(names, bare_unit.empty() ? "NUMBER" : bare_unit,
                         sentence(wording.description, label_of_field(field.name())));
  flag.read = [read, name = flag.first_name(), bare_unit](const auto& texts,
                                                          Complaints& complaints) {
    read(name, bare_unit, texts, complaints);
  };
  flag.field = field.name();
  flag.bare_unit = bare_unit;
  flag.constraint_message = field.containing_type()->name();
  flag.constraint_field = field.name();
  if ((names + ",").find(full_name + ",") != std::string::npos) return;
  Flag& full = flags.raw(full_name, unit, "In " + unit + ".");
  full.is_hidden = true;
  full.bare_unit = unit;
  full.read = [read, full_name, unit](const auto& texts, Complaints& complaints) {
    read(full_name, unit, texts, complaints);
  };
}

void add_text_flag(FlagList& flags, const ResourceKind& kind, const FieldDescriptor& field,
                   ResourceEdits& edits) {
  const Wording wording = wording_of(field);
  const bool names_resource = field.name() == "derived_from";
  std::string names = flag_of_field(field.name());
  if (*wording.names != '\0') names += std::string(",") + wording.names;
  Flag& flag = flags.text(
      names, names_resource ? "NAME" : "TEXT",
      sentence(wording.description, label_of_field(field.name())),
      [&edits, &field, &kind, names_resource](const std::string& text) {
        edits.add(field.name(),
                  [&field, value = names_resource ? kind.name_of(text) : text](Message& resource) {
                    resource.GetReflection()->SetString(&resource, &field, value);
                  });
      });
  if (names_resource) flag.collection = kind.collection;
}

void add_class_flag(FlagList& flags, const FieldDescriptor& field, ResourceEdits& edits) {
  std::vector<std::string> words = enum_words(*field.enum_type());
  std::vector<int> values(words.size());
  std::iota(values.begin(), values.end(), 1);
  const bool is_base_oil = field.enum_type() == v1::Lubricant::BaseOilClass_descriptor();
  if (is_base_oil) {
    words.insert(words.end(), {"pao", "pag"});
    values.insert(values.end(), {v1::Lubricant::BASE_OIL_CLASS_POLYALPHAOLEFIN,
                                 v1::Lubricant::BASE_OIL_CLASS_POLYALKYLENE_GLYCOL});
  }
  const auto set = [&edits, &field](int value) {
    edits.add(field.name(), [&field, value](Message& resource) {
      resource.GetReflection()->SetEnum(&resource, &field,
                                        field.enum_type()->FindValueByNumber(value));
    });
  };
  Flag& flag = flags.choice(flag_of_field(field.name()), words,
                            sentence(wording_of(field).description, label_of_field(field.name())),
                            [set, values](int index) { set(values[index]); });
  if (!is_base_oil) return;
  flag.read = [set, read = flag.read](const std::vector<std::string>& texts,
                                      Complaints& complaints) {
    const auto* value = find_base_oil_class(texts.front());
    if (texts.size() > 1 || value == nullptr) {
      read(texts, complaints);
    } else {
      set(value->number());
    }
  };
}

void add_label_flag(FlagList& flags, ResourceEdits& edits) {
  Flag& flag = flags.raw("--label", "KEY=VALUE", "A label; repeatable.");
  flag.is_repeatable = true;
  flag.read = [&edits](const std::vector<std::string>& texts, Complaints& complaints) {
    for (const std::string& text : texts) {
      const std::size_t mark = text.find('=');
      if (mark == std::string::npos || mark == 0) {
        complaints.push_back("--label: '" + printable(text) + "' is not KEY=VALUE");
        continue;
      }
      edits.add("labels", [key = text.substr(0, mark), value = text.substr(mark + 1)](
                              Message& resource) { set_label(resource, key, &value); });
    }
  };
}

std::vector<const FieldDescriptor*> numbers_of(const google::protobuf::Descriptor& type) {
  std::vector<const FieldDescriptor*> numbers;
  for (int i = 0; i < type.field_count(); ++i) {
    const FieldDescriptor* field = type.field(i);
    if (is_single_number(*field) && !is_output_only(*field)) numbers.push_back(field);
  }
  return numbers;
}

/// Returns the number with this name, as field, flag or name of data sheets; null if there is none.
const FieldDescriptor* find_number(const ResourceKind& kind, const std::string& word) {
  const std::string kebab = lower_kebab(word);
  for (const FieldDescriptor* field : numbers_of(*kind.prototype->GetDescriptor())) {
    const std::string trade = std::string(",") + wording_of(*field).names + ",";
    if (flag_of_field(field->name()) == "--" + kebab || parameter_word(*field) == kebab ||
        trade.find(",--" + kebab + ",") != std::string::npos) {
      return field;
    }
  }
  return nullptr;
}

/// Whether flags set the fields of a nested message: measurements, a law, the driveline.
bool is_flag_block(const FieldDescriptor& field) {
  return !field.is_repeated() && field.cpp_type() == FieldDescriptor::CPPTYPE_MESSAGE &&
         (field.message_type() == v1::LubricantMeasurements::descriptor() ||
          field.message_type() == v1::ImprovedYasutomi::descriptor() ||
          field.message_type() == v1::DrivelineDynamics::descriptor());
}

const char* group_of(const FieldDescriptor& block) {
  if (block.message_type() == v1::LubricantMeasurements::descriptor()) return "Measured";
  if (block.message_type() == v1::ImprovedYasutomi::descriptor()) {
    return "Improved Yasutomi law of viscosity under pressure (all five, in place of alpha*)";
  }
  return "Driveline";
}

}  // namespace

void ResourceEdits::add(const std::string& field, Edit edit) {
  fields_.insert(field);
  edits_.push_back(std::move(edit));
}

void ResourceEdits::add_removal(const std::string& field, Edit edit) {
  fields_.insert(field);
  removals_.push_back(std::move(edit));
}

bool ResourceEdits::add_once(const std::string& key, const std::string& field, Edit edit) {
  if (!keys_.insert(key).second) return false;
  add(field, std::move(edit));
  return true;
}

void ResourceEdits::apply(Message& resource) const {
  for (const Edit& edit : removals_) edit(resource);
  for (const Edit& edit : edits_) edit(resource);
}

void set_label(Message& resource, const std::string& key, const std::string* value) {
  Labels& labels = labels_of(resource);
  const auto found = std::find_if(labels.begin(), labels.end(),
                                  [&](const v1::Label& label) { return label.key() == key; });
  if (value == nullptr) {
    if (found != labels.end()) labels.erase(found);
    return;
  }
  v1::Label& label = found != labels.end() ? *found : *labels.Add();
  label.set_key(key);
  label.set_value(*value);
}

void add_edit_flags(FlagList& flags, const ResourceKind& kind, ResourceEdits& edits) {
  const auto& type = *kind.prototype->GetDescriptor();
  for (int i = 0; i < type.field_count(); ++i) {
    const FieldDescriptor& block = *type.field(i);
    if (!is_flag_block(block)) continue;
    const bool measured = block.message_type() == v1::LubricantMeasurements::descriptor();
    flags.group(group_of(block));
    for (const FieldDescriptor* field : numbers_of(*block.message_type())) {
      add_number_flags(flags, {&block, field}, edits);
    }
    if (measured) add_measurement_list_flags(flags, edits);
  }
  flags.group("Description");
  for (int i = 0; i < type.field_count(); ++i) {
    const FieldDescriptor& field = *type.field(i);
    if (field.is_repeated() || is_output_only(field) || field.name() == "name") continue;
    if (field.cpp_type() == FieldDescriptor::CPPTYPE_ENUM) add_class_flag(flags, field, edits);
    if (field.cpp_type() == FieldDescriptor::CPPTYPE_STRING) {
      add_text_flag(flags, kind, field, edits);
    }
  }
  add_label_flag(flags, edits);
  const std::vector<const FieldDescriptor*> numbers = numbers_of(type);
  for (const FieldDescriptor* field : numbers) {
    if (is_documentary(*field)) add_number_flags(flags, {nullptr, field}, edits);
  }
  if (&type == v1::Lubricant::descriptor()) add_boundary_friction_flag(flags, edits);
  flags.group(&type == v1::Lubricant::descriptor()
                  ? "Parameters of the model (a missing one is fitted or estimated, and shown)"
                  : "Parameters");
  for (const FieldDescriptor* field : numbers) {
    if (!is_documentary(*field)) add_number_flags(flags, {nullptr, field}, edits);
  }
  add_provenance_flags(flags, kind, edits);
}

void add_removal_flags(FlagList& flags, const ResourceKind& kind, ResourceEdits& edits) {
  flags.group("Remove");
  Flag& unset =
      flags.raw("--unset", "FIELD",
                "Clear a field before the other flags are applied, so that a parameter is "
                "fitted or estimated again, or measurements are entered again; repeatable.");
  unset.is_repeatable = true;
  const auto& type = *kind.prototype->GetDescriptor();
  for (int i = 0; i < type.field_count(); ++i) {
    if (!is_output_only(*type.field(i)) && type.field(i)->name() != "name") {
      unset.words.push_back(flag_of_field(type.field(i)->name()).substr(2));
    }
  }
  unset.read = [&edits, &kind, words = unset.words](const std::vector<std::string>& texts,
                                                    Complaints& complaints) {
    for (const std::string& text : texts) {
      std::string name = text;
      std::replace(name.begin(), name.end(), '-', '_');
      const FieldDescriptor* field = kind.prototype->GetDescriptor()->FindFieldByName(name);
      if (field == nullptr) field = find_number(kind, text);
      if (field == nullptr || is_output_only(*field)) {
        const std::string meant = nearest(text, words);
        complaints.push_back("--unset: '" + printable(text) + "' is not a field of a " +
                             kind.singular + (meant.empty() ? "" : " (is " + meant + " meant?)"));
        continue;
      }
      edits.add_removal(field->name(), [field](Message& resource) {
        resource.GetReflection()->ClearField(&resource, field);
        drop_provenance(resource, field->name());
      });
      if (is_single_number(*field)) edits.touch("provenance");
    }
  };
  Flag& label = flags.raw("--remove-label", "KEY", "Remove a label; repeatable.");
  label.is_repeatable = true;
  label.read = [&edits](const std::vector<std::string>& texts, Complaints&) {
    for (const std::string& key : texts) {
      edits.add_removal("labels", [key](Message& resource) { set_label(resource, key, nullptr); });
    }
  };
}

const FieldDescriptor* find_parameter(const ResourceKind& kind, const std::string& word,
                                      std::string& wrong) {
  const FieldDescriptor* field = find_number(kind, word);
  if (field != nullptr && !is_documentary(*field)) return field;
  const std::string meant = nearest(lower_kebab(word), parameter_words(kind));
  wrong = "'" + printable(word) + "' is not a parameter of a " + kind.singular +
          (meant.empty() ? "" : " (is " + meant + " meant?)");
  return nullptr;
}

std::vector<TradeName> trade_names(const FieldDescriptor& field) {
  const Wording wording = wording_of(field);
  std::vector<TradeName> out;
  for (const std::string& name : split(wording.names, ',')) {
    out.push_back({name.substr(2), wording.bare_unit});
  }
  return out;
}

std::vector<std::string> parameter_words(const ResourceKind& kind) {
  std::vector<std::string> words;
  for (const FieldDescriptor* field : numbers_of(*kind.prototype->GetDescriptor())) {
    if (!is_documentary(*field)) words.push_back(parameter_word(*field));
  }
  return words;
}

std::string enum_word(const google::protobuf::EnumValueDescriptor& value) {
  return lower_kebab(short_name(value));
}

std::vector<std::string> enum_words(const google::protobuf::EnumDescriptor& type) {
  std::vector<std::string> words;
  for (int i = 1; i < type.value_count(); ++i) words.push_back(enum_word(*type.value(i)));
  return words;
}

}  // namespace tribodyn::client
