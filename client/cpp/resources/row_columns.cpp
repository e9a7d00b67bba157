#include "client/cpp/resources/row_columns.h"

#include <google/protobuf/descriptor.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <map>
#include <set>

#include "client/cpp/resources/edits.h"
#include "client/cpp/resources/measurement_cells.h"
#include "client/cpp/text/flags.h"
#include "client/cpp/text/inputs.h"
#include "client/cpp/text/nearest.h"
#include "client/cpp/text/text.h"
#include "client/cpp/text/units.h"
#include "proto/enum_names.h"

namespace tribodyn::client {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;
using Kind = RowColumn::Kind;
using Part = RowColumn::Part;

constexpr std::string_view kLabel = "labels.";
/// The source that the server sets for a parameter that a client sent without one.
constexpr char kUnstated[] = "stated without a source";

constexpr std::pair<Part, const char*> kParts[] = {
    {Part::kProvenance, "provenance"},
    {Part::kSource, "source"},
    {Part::kStandardUncertainty, "standard_uncertainty"},
    {Part::kWarning, "warning"}};

bool is_number_field(const FieldDescriptor& field) {
  return field.cpp_type() == FieldDescriptor::CPPTYPE_DOUBLE ||
         field.cpp_type() == FieldDescriptor::CPPTYPE_INT32;
}

const Message& parent_of(const RowColumn& column, const Message& resource) {
  return column.block == nullptr ? resource
                                 : resource.GetReflection()->GetMessage(resource, column.block);
}

Message& mutable_parent_of(const RowColumn& column, Message& resource) {
  return column.block == nullptr
             ? resource
             : *resource.GetReflection()->MutableMessage(&resource, column.block);
}

RowColumn plain_column(const FieldDescriptor* block, const FieldDescriptor* field) {
  RowColumn column;
  column.block = block;
  column.field = field;
  if (is_number_field(*field)) {
    column.kind = Kind::kNumber;
    column.bare_unit = unit_of_field(field->name());
  } else if (field->cpp_type() == FieldDescriptor::CPPTYPE_ENUM) {
    column.kind = Kind::kClass;
  }
  return column;
}

/// A form of a column's header and the unit of bare numbers below it.
struct HeaderForm {
  std::string word;
  std::string bare_unit;
};

/// Headers that data sheets have besides the names of flags, as plain_word() writes them, by field.
const std::multimap<std::string, std::string>& sheet_headers() {
  static const std::multimap<std::string, std::string> kAll = [] {
    std::multimap<std::string, std::string> out = {{"base_oil_class", "base_oil"},
                                                   {"base_oil_class", "base_oil_type"},
                                                   {"base_oil_class", "base_stock"}};
    const auto add = [&out](const char* field, const std::vector<std::string>& quantities,
                            const std::vector<std::string>& temperatures) {
      for (const std::string& quantity : quantities) {
        for (const std::string& temperature : temperatures) {
          for (const char* end : {"", "_c", "_celsius"}) {
            out.emplace(field, quantity + temperature + end);
            out.emplace(field, quantity + "_" + temperature + end);
            out.emplace(field, quantity + "_at_" + temperature + end);
          }
        }
      }
    };
    const std::vector<std::string> viscosities = {"kv", "kinematic_viscosity"};
    add("kinematic_viscosity_40_celsius_square_millimetres_per_second", viscosities, {"40"});
    add("kinematic_viscosity_100_celsius_square_millimetres_per_second", viscosities, {"100"});
    add("density_15_celsius_kilograms_per_cubic_metre", {"density"}, {"15"});
    for (const char* header : {"kv100_after_shear", "kv_100_after_shear", "kv_100_sheared",
                               "kv100_after_shear_test", "kv100_sheared"}) {
      out.emplace("sheared_kinematic_viscosity_100_celsius_square_millimetres_per_second", header);
    }
    return out;
  }();
  return kAll;
}

std::vector<HeaderForm> forms_of(const RowColumn& column) {
  std::vector<HeaderForm> forms = {{plain_word(header_of(column)), column.bare_unit}};
  if (column.kind == Kind::kMeasurements || column.kind == Kind::kProvenance) return forms;
  const std::string& name = column.field->name();
  if (column.kind == Kind::kNumber && !column.bare_unit.empty()) {
    forms.push_back({plain_word(label_of_field(name)), column.bare_unit == "C" ? "C" : ""});
  }
  for (const TradeName& trade : trade_names(*column.field)) {
    forms.push_back({plain_word(trade.word), trade.bare_unit});
  }
  const std::string bare_unit =
      trade_names(*column.field).empty() ? "" : trade_names(*column.field).front().bare_unit;
  const auto [begin, end] = sheet_headers().equal_range(name);
  for (auto at = begin; at != end; ++at) forms.push_back({at->second, bare_unit});
  return forms;
}

/// The parts of "Density15 (g/cm3)": "Density15" and "g/cm3".
struct Header {
  std::string word;
  std::string unit;
};

Header split_header(const std::string& text) {
  const char close = text.empty() ? '\0' : text.back();
  if (close != ')' && close != ']') return {plain_word(text), ""};
  const std::size_t open = text.rfind(close == ')' ? '(' : '[');
  if (open == std::string::npos || open == 0) return {plain_word(text), ""};
  return {plain_word(text.substr(0, open)), text.substr(open + 1, text.size() - open - 2)};
}

/// Returns the temperature in "Brookfield -40 C" or "brookfield_viscosity_-26"; nullopt for other
/// headers.
std::optional<double> cold_temperature_of(const std::string& header) {
  std::string text = header;
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  const std::size_t digits = text.find_first_of("0123456789");
  if (!text.starts_with("brookfield") || digits == std::string::npos) return std::nullopt;
  const std::string words = plain_word(text.substr(0, digits));
  if (words != "brookfield" && words != "brookfield_at" && words != "brookfield_viscosity" &&
      words != "brookfield_viscosity_at") {
    return std::nullopt;
  }
  const std::size_t start = text[digits - 1] == '-' ? digits - 1 : digits;
  double value = 0;
  const auto [end, error] = std::from_chars(text.data() + start, text.data() + text.size(), value);
  if (error != std::errc()) return std::nullopt;
  const std::string unit = plain_word(text.substr(static_cast<std::size_t>(end - text.data())));
  for (const char* each : {"", "c", "\u00b0c", "celsius"}) {
    if (unit == each) return value;
  }
  return std::nullopt;
}

std::optional<RowColumn> find_provenance_column(const ResourceKind& kind,
                                                const std::string& header) {
  const std::size_t dot = header.rfind('.');
  if (dot == std::string::npos || dot == 0) return std::nullopt;
  const std::string suffix = plain_word(header.substr(dot + 1));
  for (const auto& [part, word] : kParts) {
    if (suffix != word) continue;
    RowColumn column;
    column.kind = Kind::kProvenance;
    column.part = part;
    column.key = header.substr(0, dot);
    std::string wrong;
    if (const FieldDescriptor* field = find_parameter(kind, column.key, wrong)) {
      column.key = field->name();
      column.field = field;
    }
    return column;  // the server rejects columns that are not parameters
  }
  return std::nullopt;
}

bool set_number(const RowColumn& column, double value, Message& resource) {
  Message& parent = mutable_parent_of(column, resource);
  const auto& reflection = *parent.GetReflection();
  if (column.field->cpp_type() == FieldDescriptor::CPPTYPE_INT32) {
    if (!(std::abs(value) < 1e9) || value != std::floor(value)) return false;
    reflection.SetInt32(&parent, column.field, static_cast<int>(value));
    return true;
  }
  const bool changed = !column.field->has_presence() ||
                       !reflection.HasField(parent, column.field) ||
                       reflection.GetDouble(parent, column.field) != value;
  reflection.SetDouble(&parent, column.field, value);
  // A new value makes the former provenance invalid; the server sets the provenance of a number
  // without one.
  if (changed && column.block == nullptr) drop_provenance(resource, column.field->name());
  return true;
}

std::string read_number(const RowColumn& column, const std::string& text, Message& resource) {
  const std::string& name = column.field->name();
  const std::string unit = unit_of_field(name);
  std::string wrong;
  const auto value = read_quantity(text, unit, unit.empty() ? "" : column.bare_unit,
                                   is_temperature_field(name), wrong);
  if (!value) return wrong;
  return set_number(column, *value, resource) ? "" : "is not a whole number";
}

bool set_class(const RowColumn& column, const std::string& text, Message& resource) {
  const auto* type = column.field->enum_type();
  const google::protobuf::EnumValueDescriptor* value = nullptr;
  if (type == v1::Lubricant::BaseOilClass_descriptor()) value = find_base_oil_class(text);
  for (int i = 0; i < type->value_count() && value == nullptr; ++i) {
    const std::string& name = type->value(i)->name();
    const bool is_named = plain_word(text) == plain_word(name) ||
                          plain_word(text) == plain_word(short_name(*type->value(i)));
    if (is_named) value = type->value(i);
  }
  if (value == nullptr) return false;
  resource.GetReflection()->SetEnum(&resource, column.field, value);
  return true;
}

std::string set_provenance(const RowColumn& column, const std::string& text, Message& resource) {
  if (column.part == Part::kStandardUncertainty) {
    std::string wrong;
    const std::string unit = column.field == nullptr ? "" : unit_of_field(column.field->name());
    const auto value = read_quantity(text, unit, unit, false, wrong);
    if (!value) return wrong;
    auto& entry = provenance_entry(resource, column.key);
    entry.set_standard_uncertainty(*value);
    entry.set_computed(false);
    return "";
  }
  if (column.part == Part::kProvenance) {
    const auto* type = v1::Provenance_descriptor();
    std::vector<std::string> words;
    for (int i = 1; i < type->value_count(); ++i) {
      const auto value = static_cast<v1::Provenance>(type->value(i)->number());
      words.push_back(provenance_word(value));
      if (plain_word(text) != plain_word(words.back())) continue;
      auto& entry = provenance_entry(resource, column.key);
      entry.set_provenance(value);
      entry.set_computed(false);
      return "";
    }
    return "must be one of " + joined(words, ", ");
  }
  auto& entry = provenance_entry(resource, column.key);
  entry.set_computed(false);
  if (column.part == Part::kSource) {
    entry.set_source(text);
  } else {
    entry.set_warning(text);
  }
  return "";
}

/// Whether the server computes all parameters of the resource from the table: those of a lubricant
/// always, those of a surface only from profiles.
bool provenance_is_recomputed(const Message& resource) {
  return resource.GetDescriptor() == v1::Lubricant::descriptor();
}

bool is_computed(const Message& resource, const RowColumn& column) {
  if (column.block != nullptr || !provenance_is_recomputed(resource)) return false;
  const ProvenanceEntries& entries = provenance_entries_of(resource);
  return std::any_of(entries.begin(), entries.end(), [&](const auto& entry) {
    return entry.computed() && entry.field() == column.field->name();
  });
}

std::string provenance_cell(const RowColumn& column, const Message& resource) {
  for (const v1::ParameterProvenance& entry : provenance_entries_of(resource)) {
    if (entry.field() != column.key) continue;
    if (entry.computed() && provenance_is_recomputed(resource)) return "";
    const bool is_unstated = entry.provenance() == v1::PROVENANCE_USER &&
                             entry.source() == kUnstated && entry.warning().empty() &&
                             entry.standard_uncertainty() == 0;
    if (is_unstated) return "";
    switch (column.part) {
      case Part::kProvenance:
        return entry.provenance() == v1::PROVENANCE_UNSPECIFIED
                   ? ""
                   : provenance_word(entry.provenance());
      case Part::kSource:
        return entry.source();
      case Part::kStandardUncertainty:
        return entry.standard_uncertainty() == 0 ? "" : shortest(entry.standard_uncertainty());
      case Part::kWarning:
        return entry.warning();
    }
  }
  return "";
}

std::string field_cell(const RowColumn& column, const Message& resource) {
  const Message& parent = parent_of(column, resource);
  const auto& reflection = *parent.GetReflection();
  if (column.field->has_presence() && !reflection.HasField(parent, column.field)) return "";
  switch (column.field->cpp_type()) {
    case FieldDescriptor::CPPTYPE_DOUBLE: {
      const double value = reflection.GetDouble(parent, column.field);
      return value == 0 && !column.field->has_presence() ? "" : shortest(value);
    }
    case FieldDescriptor::CPPTYPE_INT32:
      return std::to_string(reflection.GetInt32(parent, column.field));
    case FieldDescriptor::CPPTYPE_ENUM: {
      const auto* value = reflection.GetEnum(parent, column.field);
      return value->number() == 0 ? "" : enum_word(*value);
    }
    default:
      return reflection.GetString(parent, column.field);
  }
}

}  // namespace

std::string plain_word(std::string_view text) {
  std::string out;
  for (const char c : text) {
    const bool is_gap = c == ' ' || c == '_' || c == '-' || c == '\t';
    if (!is_gap) {
      out += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    } else if (!out.empty() && out.back() != '_') {
      out += '_';
    }
  }
  while (!out.empty() && out.back() == '_') out.pop_back();
  return out;
}

const google::protobuf::EnumValueDescriptor* find_base_oil_class(const std::string& text) {
  std::string word;
  for (const char c : text) {
    if (std::isalnum(static_cast<unsigned char>(c)) != 0) {
      word += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    }
  }
  for (const char* prefix : {"api", "group", "gruppe", "gr"}) {
    if (word.starts_with(prefix)) word = word.substr(std::string_view(prefix).size());
  }
  static const std::map<std::string, v1::Lubricant::BaseOilClass> kWords = {
      {"i", v1::Lubricant::BASE_OIL_CLASS_GROUP_I},
      {"1", v1::Lubricant::BASE_OIL_CLASS_GROUP_I},
      {"ii", v1::Lubricant::BASE_OIL_CLASS_GROUP_II},
      {"2", v1::Lubricant::BASE_OIL_CLASS_GROUP_II},
      {"iii", v1::Lubricant::BASE_OIL_CLASS_GROUP_III},
      {"3", v1::Lubricant::BASE_OIL_CLASS_GROUP_III},
      {"iv", v1::Lubricant::BASE_OIL_CLASS_POLYALPHAOLEFIN},
      {"4", v1::Lubricant::BASE_OIL_CLASS_POLYALPHAOLEFIN},
      {"pao", v1::Lubricant::BASE_OIL_CLASS_POLYALPHAOLEFIN},
      {"polyalphaolefin", v1::Lubricant::BASE_OIL_CLASS_POLYALPHAOLEFIN},
      {"polyalphaolefine", v1::Lubricant::BASE_OIL_CLASS_POLYALPHAOLEFIN},
      {"ester", v1::Lubricant::BASE_OIL_CLASS_ESTER},
      {"pag", v1::Lubricant::BASE_OIL_CLASS_POLYALKYLENE_GLYCOL},
      {"polyalkyleneglycol", v1::Lubricant::BASE_OIL_CLASS_POLYALKYLENE_GLYCOL},
      {"polyglycol", v1::Lubricant::BASE_OIL_CLASS_POLYALKYLENE_GLYCOL},
      {"polyglykol", v1::Lubricant::BASE_OIL_CLASS_POLYALKYLENE_GLYCOL},
      {"naphthenic", v1::Lubricant::BASE_OIL_CLASS_NAPHTHENIC},
      {"naphthenisch", v1::Lubricant::BASE_OIL_CLASS_NAPHTHENIC}};
  const auto found = kWords.find(word);
  return found == kWords.end()
             ? nullptr
             : v1::Lubricant::BaseOilClass_descriptor()->FindValueByNumber(found->second);
}

std::vector<RowColumn> columns_of(const ResourceKind& kind) {
  std::vector<RowColumn> texts;
  std::vector<RowColumn> numbers;
  const auto* type = kind.prototype->GetDescriptor();
  for (int i = 0; i < type->field_count(); ++i) {
    const FieldDescriptor* field = type->field(i);
    if (is_output_only(*field) || field->is_repeated()) continue;
    if (field->cpp_type() != FieldDescriptor::CPPTYPE_MESSAGE) {
      (is_number_field(*field) ? numbers : texts).push_back(plain_column(nullptr, field));
      continue;
    }
    for (int k = 0; k < field->message_type()->field_count(); ++k) {
      const FieldDescriptor* inner = field->message_type()->field(k);
      if (!inner->is_repeated() && is_number_field(*inner)) {
        texts.push_back(plain_column(field, inner));
      } else if (is_measurement_list(*inner)) {
        RowColumn column;
        column.kind = Kind::kMeasurements;
        column.block = field;
        column.field = inner;
        texts.push_back(column);
      }
    }
  }
  texts.insert(texts.end(), numbers.begin(), numbers.end());
  return texts;
}

std::vector<RowColumn> provenance_columns(const std::vector<ResourcePointer>& resources) {
  std::vector<RowColumn> out;
  std::set<std::string> seen;
  for (const ResourcePointer& resource : resources) {
    for (const v1::ParameterProvenance& entry : provenance_entries_of(*resource)) {
      if (!seen.insert(entry.field()).second) continue;
      for (const auto& [part, word] : kParts) {
        RowColumn column;
        column.kind = Kind::kProvenance;
        column.part = part;
        column.key = entry.field();
        const bool tells = std::any_of(resources.begin(), resources.end(),
                                       [&, &as_column = column](const auto& each) {
                                         return !cell_of(as_column, *each).empty();
                                       });
        if (tells) out.push_back(column);
      }
    }
  }
  return out;
}

std::string header_of(const RowColumn& column) {
  if (column.kind == Kind::kLabel) return std::string(kLabel) + column.key;
  if (column.kind != Kind::kProvenance) return column.field->name();
  for (const auto& [part, word] : kParts) {
    if (part == column.part) return column.key + "." + word;
  }
  return "";
}

std::optional<RowColumn> find_column(const ResourceKind& kind, const std::string& header,
                                     std::string& wrong) {
  if (header.rfind(kLabel, 0) == 0 && header.size() > kLabel.size()) {
    RowColumn column;
    column.kind = Kind::kLabel;
    column.key = header.substr(kLabel.size());
    return column;
  }
  const Header split = split_header(header);
  std::vector<std::string> known;
  for (RowColumn& column : columns_of(kind)) {
    known.push_back(column.field->name());
    for (const HeaderForm& form : forms_of(column)) {
      if (form.word != split.word && form.word != plain_word(header)) continue;
      column.bare_unit = form.bare_unit;
      if (form.word == plain_word(header) || split.unit.empty()) return column;
      const std::string unit = unit_of_field(column.field->name());
      std::string text;
      if (!column.is_number() ||
          !read_quantity("1", unit, split.unit, is_temperature_field(column.field->name()), text)) {
        wrong = "has the unit " + printable(split.unit) +
                (unit.empty() ? ", but takes none" : "; allowed: multiples of " + unit);
        return std::nullopt;
      }
      column.bare_unit = split.unit;
      return column;
    }
  }
  if (auto provenance = find_provenance_column(kind, header)) return provenance;
  const auto* measurements = kind.prototype->GetDescriptor()->FindFieldByName("measurements");
  if (measurements != nullptr &&
      measurements->message_type() == v1::LubricantMeasurements::descriptor()) {
    const std::string without_unit = header.substr(0, header.find_first_of("(["));
    if (const auto celsius = cold_temperature_of(without_unit)) {
      RowColumn column;
      column.kind = Kind::kColdViscosity;
      column.block = measurements;
      column.field = measurements->message_type()->FindFieldByName("brookfield_viscosities");
      column.temperature_celsius = *celsius;
      column.bare_unit = split.unit.empty() ? "mPa s" : split.unit;
      return column;
    }
  }
  const FieldDescriptor* table = kind.prototype->GetDescriptor()->FindFieldByName(split.word);
  const bool is_table = table != nullptr && table->is_repeated() && !is_output_only(*table) &&
                        table->name() != "labels" && table->name() != "provenance";
  if (is_table) {
    wrong = kNotAColumn;
    wrong += "; use JSON";
    if (table->number() == v1::Lubricant::kAsperityFrictionByTemperatureFieldNumber &&
        table->containing_type() == v1::Lubricant::descriptor()) {
      wrong += ", or " + flag_of_field(table->name()) + " of `tribodyn lubricants create`";
    }
    return std::nullopt;
  }
  const std::string meant = nearest(split.word, known);
  wrong = "is unknown" + (meant.empty() ? std::string("; `tribodyn help files` lists the columns")
                                        : " (is " + meant + " meant?)");
  return std::nullopt;
}

std::string nearest_column(const ResourceKind& kind, const std::string& header) {
  std::vector<std::string> known;
  for (const RowColumn& column : columns_of(kind)) {
    for (const HeaderForm& form : forms_of(column)) known.push_back(form.word);
  }
  return nearest(split_header(header).word, known);
}

std::string set_cell(const RowColumn& column, const std::string& text, Message& resource) {
  const std::string quoted = "'" + printable(text.substr(0, 60)) + "' ";
  std::string wrong;
  switch (column.kind) {
    case Kind::kText:
      resource.GetReflection()->SetString(&resource, column.field, text);
      return "";
    case Kind::kClass:
      if (set_class(column, text, resource)) return "";
      return quoted + "must be one of " + joined(enum_words(*column.field->enum_type()), ", ");
    case Kind::kNumber:
      wrong = read_number(column, text, resource);
      break;
    case Kind::kMeasurements:
      wrong = read_measurement_cell(*column.field, text, mutable_parent_of(column, resource));
      break;
    case Kind::kColdViscosity:
      wrong = add_cold_viscosity(column.temperature_celsius, text, column.bare_unit,
                                 mutable_parent_of(column, resource));
      break;
    case Kind::kProvenance:
      wrong = set_provenance(column, text, resource);
      break;
    case Kind::kLabel:
      set_label(resource, column.key, &text);
      return "";
  }
  return wrong.empty() ? "" : quoted + wrong;
}

void clear_cell(const RowColumn& column, Message& resource) {
  if (column.kind == Kind::kLabel) return set_label(resource, column.key, nullptr);
  if (column.kind == Kind::kProvenance) return;  // is cleared with the value
  if (column.kind == Kind::kColdViscosity) {
    return remove_cold_viscosity(column.temperature_celsius, mutable_parent_of(column, resource));
  }
  const auto& reflection = *resource.GetReflection();
  if (column.block != nullptr && !reflection.HasField(resource, column.block)) return;
  Message& parent = mutable_parent_of(column, resource);
  parent.GetReflection()->ClearField(&parent, column.field);
  if (column.block != nullptr && parent.ByteSizeLong() == 0) {
    reflection.ClearField(&resource, column.block);
  }
  if (column.block == nullptr && column.kind == Kind::kNumber) {
    drop_provenance(resource, column.field->name());
  }
}

std::string cell_of(const RowColumn& column, const Message& resource) {
  if (column.kind == Kind::kProvenance) return provenance_cell(column, resource);
  if (column.kind == Kind::kMeasurements) {
    return measurement_cell(*column.field, parent_of(column, resource));
  }
  if (column.kind == Kind::kLabel) {
    for (const v1::Label& label : labels_of(resource)) {
      if (label.key() == column.key) return label.value();
    }
    return "";
  }
  return is_computed(resource, column) ? "" : field_cell(column, resource);
}

std::string mask_of(const RowColumn& column) {
  if (column.kind == Kind::kLabel) return "labels";
  if (column.kind == Kind::kProvenance) return "provenance";
  if (column.field->name() == "name") return "";
  return column.block == nullptr ? column.field->name()
                                 : column.block->name() + "." + column.field->name();
}

}  // namespace tribodyn::client
