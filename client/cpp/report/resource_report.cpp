#include "client/cpp/report/resource_report.h"

#include <google/protobuf/descriptor.h>
#include <google/protobuf/util/json_util.h>
#include <google/protobuf/util/time_util.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "client/cpp/failure.h"
#include "client/cpp/resources/edits.h"
#include "client/cpp/text/colour.h"
#include "client/cpp/text/csv.h"
#include "client/cpp/text/inputs.h"
#include "client/cpp/text/table.h"
#include "client/cpp/text/text.h"
#include "client/cpp/text/units.h"

namespace tribodyn::client {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;
using google::protobuf::Timestamp;
using google::protobuf::util::TimeUtil;

std::string time_text(const Message& resource, const char* name) {
  const auto* field = resource.GetDescriptor()->FindFieldByName(name);
  if (field == nullptr || !resource.GetReflection()->HasField(resource, field)) return "";
  const auto& time =
      dynamic_cast<const Timestamp&>(resource.GetReflection()->GetMessage(resource, field));
  return TimeUtil::ToString(TimeUtil::SecondsToTimestamp(time.seconds()));
}

int revision_of(const Message& resource) {
  return resource.GetReflection()->GetInt32(resource,
                                            resource.GetDescriptor()->FindFieldByName("revision"));
}

/// Returns the value of a text or an enum; empty if it is unset or of another type.
std::string word_of(const Message& resource, const FieldDescriptor& field) {
  if (field.cpp_type() == FieldDescriptor::CPPTYPE_STRING) {
    return resource.GetReflection()->GetString(resource, &field);
  }
  if (field.cpp_type() != FieldDescriptor::CPPTYPE_ENUM) return "";
  const auto* value = resource.GetReflection()->GetEnum(resource, &field);
  return value->number() == 0 ? "" : enum_word(*value);
}

std::string labels_text(const Message& resource) {
  std::string text;
  for (const v1::Label& label : labels_of(resource)) {
    text += (text.empty() ? "" : ", ") + label.key() + "=" + label.value();
  }
  return text;
}

/// A number of the resource that the model uses.
struct Parameter {
  const FieldDescriptor* field;
  const Message* parent;
  std::string provenance_field;
};

void collect_parameters(const Message& message, const std::string& block,
                        std::vector<Parameter>& parameters) {
  const auto* type = message.GetDescriptor();
  const auto& reflection = *message.GetReflection();
  for (int i = 0; i < type->field_count(); ++i) {
    const FieldDescriptor& field = *type->field(i);
    if (field.is_repeated() || is_output_only(field) || is_documentary(field)) continue;
    if (field.cpp_type() == FieldDescriptor::CPPTYPE_DOUBLE ||
        field.cpp_type() == FieldDescriptor::CPPTYPE_INT32) {
      parameters.push_back({&field, &message, block.empty() ? field.name() : block});
    } else if (field.cpp_type() == FieldDescriptor::CPPTYPE_MESSAGE &&
               (field.message_type() == v1::DrivelineDynamics::descriptor() ||
                field.message_type() == v1::ImprovedYasutomi::descriptor()) &&
               reflection.HasField(message, &field)) {
      collect_parameters(reflection.GetMessage(message, &field), field.name(), parameters);
    }
  }
}

double number_of(const Parameter& parameter) {
  const auto& reflection = *parameter.parent->GetReflection();
  return parameter.field->cpp_type() == FieldDescriptor::CPPTYPE_INT32
             ? reflection.GetInt32(*parameter.parent, parameter.field)
             : reflection.GetDouble(*parameter.parent, parameter.field);
}

bool is_known(const Parameter& parameter) {
  return !parameter.field->has_presence() ||
         parameter.parent->GetReflection()->HasField(*parameter.parent, parameter.field);
}

/// Notes shared by several lines, numbered in order of first use.
class Notes {
 public:
  std::string mark(const std::string& note) {
    if (note.empty()) return "";
    auto found = std::find(notes_.begin(), notes_.end(), note);
    if (found == notes_.end()) found = notes_.insert(notes_.end(), note);
    return "[" + std::to_string(found - notes_.begin() + 1) + "]";
  }
  std::string text() const {
    std::string text;
    for (std::size_t i = 0; i < notes_.size(); ++i) {
      text += wrapped("[" + std::to_string(i + 1) + "] " + printable(notes_[i]), 2);
    }
    return text;
  }

 private:
  std::vector<std::string> notes_;
};

/// Formats an uncertainty with two digits.
std::string uncertainty_text(double uncertainty) {
  if (uncertainty <= 0) return "";
  return uncertainty >= 10 ? fixed(uncertainty, 0) : significant(uncertainty, 2);
}

/// Whether the report shows the warning elsewhere: all its sentences are among the fluid's
/// warnings, or below the profiles of a surface.
bool is_shown_elsewhere(const Message& resource, const v1::ParameterProvenance& known) {
  if (dynamic_cast<const v1::Surface*>(&resource) != nullptr) return known.computed();
  const auto* lubricant = dynamic_cast<const v1::Lubricant*>(&resource);
  if (lubricant == nullptr) return false;
  std::string rest = known.warning();
  for (const auto& warning : lubricant->characterisation().warnings()) {
    const std::size_t at = rest.find(warning.sentence());
    if (at != std::string::npos) rest.erase(at, warning.sentence().size());
  }
  return rest.find_first_not_of(' ') == std::string::npos;
}

std::string parameter_table(const Message& resource) {
  std::vector<Parameter> parameters;
  collect_parameters(resource, "", parameters);
  Table table({{"Parameter", "", Table::Align::kLeft},
               {"Value", ""},
               {"Unit", "", Table::Align::kLeft},
               {"std. uncertainty", ""},
               {"Origin", "", Table::Align::kLeft},
               {"Source", "", Table::Align::kLeft}});
  Notes notes;
  for (const Parameter& parameter : parameters) {
    const std::string& name = parameter.field->name();
    if (!is_known(parameter)) {
      table.add_row({label_of_field(name), "-", unit_of_field(name), "", "not stated"});
      continue;
    }
    const double value = number_of(parameter);
    const std::string unit = trade_unit_of_field(name);
    const std::string shown = significant(in_trade_unit(name, value));
    const auto* known = provenance_of(resource, parameter.provenance_field);
    if (known == nullptr) {
      table.add_row({label_of_field(name), shown, unit});
      continue;
    }
    const double uncertainty = difference_in_trade_unit(name, known->standard_uncertainty());
    std::string note = known->source();
    if (!known->warning().empty() && !is_shown_elsewhere(resource, *known)) {
      note += (note.empty() ? "" : ". ") + known->warning();
    }
    table.add_row({label_of_field(name), shown, unit, uncertainty_text(uncertainty),
                   provenance_word(known->provenance()), notes.mark(note)});
  }
  return table.text() + "\n" + notes.text();
}

/// Returns the number of parameters by origin, and the command that lists them.
std::string parameter_summary(const v1::Lubricant& lubricant) {
  std::vector<Parameter> parameters;
  collect_parameters(lubricant, "", parameters);
  std::vector<std::pair<std::string, int>> origins;  // in order of first use
  for (const Parameter& parameter : parameters) {
    const auto* known = provenance_of(lubricant, parameter.provenance_field);
    const std::string origin = !is_known(parameter) ? "not stated"
                               : known == nullptr   ? "of no stated origin"
                                                    : provenance_word(known->provenance());
    const auto found = std::find_if(origins.begin(), origins.end(),
                                    [&](const auto& each) { return each.first == origin; });
    if (found == origins.end()) {
      origins.emplace_back(origin, 1);
    } else {
      ++found->second;
    }
  }
  std::string text = std::to_string(parameters.size()) + " parameters: ";
  for (std::size_t i = 0; i < origins.size(); ++i) {
    text += (i == 0 ? "" : ", ") + std::to_string(origins[i].second) + " " + origins[i].first;
  }
  return wrapped(text, 0) + "Their values, uncertainties and sources:  tribodyn lubricants get " +
         printable(resource_id(lubricant.name())) + "\n";
}

void add_identity(const Message& resource, Sheet& sheet) {
  sheet.heading(text_field(resource, "name") + (text_field(resource, "display_name").empty()
                                                    ? ""
                                                    : ": " + text_field(resource, "display_name")));
  if (const std::string text = text_field(resource, "description"); !text.empty()) {
    sheet.remark(text);
  }
  const auto line = [&](const std::string& label, const std::string& value) {
    if (!value.empty()) sheet.line(label, value);
  };
  // Every other text, enum and number beside the parameters that clients set, so that a new field
  // is shown without a line here.
  static const std::set<std::string> kInHeading = {"name", "display_name", "description"};
  static const std::map<std::string, const char*> kLabels = {
      {"base_oil_class", "base oil"}, {"external_sample_id", "sample"}, {"lims_id", "LIMS id"}};
  const auto& type = *resource.GetDescriptor();
  for (int i = 0; i < type.field_count(); ++i) {
    const FieldDescriptor& field = *type.field(i);
    if (field.is_repeated() || is_output_only(field) || kInHeading.contains(field.name())) continue;
    if (is_documentary(field)) {
      const Parameter number{&field, &resource, ""};
      if (!is_known(number)) continue;
      sheet.line(label_of_field(field.name()),
                 significant(in_trade_unit(field.name(), number_of(number))),
                 trade_unit_of_field(field.name()));
      continue;
    }
    const auto label = kLabels.find(field.name());
    line(label == kLabels.end() ? label_of_field(field.name()) : label->second,
         word_of(resource, field));
  }
  if (const auto* lubricant = dynamic_cast<const v1::Lubricant*>(&resource)) {
    for (const auto& each : lubricant->asperity_friction_by_temperature()) {
      sheet.line(
          "asperity friction coefficient at " + significant(each.temperature_celsius()) + " C",
          significant(each.asperity_friction_coefficient()));
    }
  }
  line("labels", labels_text(resource));
  const int revision = revision_of(resource);
  if (revision > 0) {
    const std::string time = time_text(resource, "revision_create_time");
    line("revision", std::to_string(revision) + (time.empty() ? "" : ", " + time));
  }
  line("deleted", time_text(resource, "delete_time"));
}

std::string gear_set_tables_text(const v1::GearSet& gear_set) {
  Sheet sheet;
  sheet.heading("Tooth contact data");
  if (gear_set.pinion_teeth() > 0) {
    const double ratio = static_cast<double>(gear_set.gear_teeth()) / gear_set.pinion_teeth();
    sheet.line("ratio", significant(ratio, 5));
  }
  const int samples =
      gear_set.flank_slots_size() > 0 ? gear_set.flank_slots(0).load_share_size() : 0;
  sheet.line("flank slots", std::to_string(gear_set.flank_slots_size()) + " of " +
                                std::to_string(samples) + " samples");
  sheet.line("mesh harmonics",
             std::to_string(gear_set.series().mesh_stiffness_newtons_per_metre().cosine_size()));
  sheet.line("pinion torques of series", std::to_string(gear_set.series_by_torque_size()));
  sheet.line("pinion torques of load shares", std::to_string(gear_set.load_share_by_torque_size()));
  return sheet.text();
}

std::string profiles_text(const v1::Surface& surface) {
  if (surface.measurements().empty()) return "";
  Table table({{"Profile of", "", Table::Align::kLeft},
               {"along", "", Table::Align::kLeft},
               {"samples", ""},
               {"spacing", "um"},
               {"lambda_s", "um"},
               {"lambda_c", "um"},
               {"RMS height", "um"},
               {"RMS slope", "-"},
               {"RMS curvature", "1/um"}});
  const auto cut_off = [](double metres) {
    return metres == 0 ? std::string("-") : significant(1e6 * metres);
  };
  for (const auto& profile : surface.measurements()) {
    table.add_row(
        {profile.member() == 0
             ? "both flanks"
             : enum_word(*v1::FlankMember_descriptor()->FindValueByNumber(profile.member())),
         profile.direction() == 0 ? "-"
                                  : enum_word(*v1::ProfileDirection_descriptor()->FindValueByNumber(
                                        profile.direction())),
         std::to_string(profile.samples()), significant(1e6 * profile.spacing_metres()),
         cut_off(profile.short_wave_cut_off_metres()), cut_off(profile.long_wave_cut_off_metres()),
         significant(1e6 * std::sqrt(profile.mean_square_height_square_metres()), 4),
         significant(std::sqrt(profile.mean_square_slope()), 4),
         significant(1e-6 * std::sqrt(profile.mean_square_curvature_per_square_metre()), 4)});
  }
  std::set<std::string> warnings;
  for (const v1::ParameterProvenance& entry : surface.provenance()) {
    if (entry.computed() && !entry.warning().empty()) warnings.insert(entry.warning());
  }
  std::string text = "\n" + table.text();
  for (const std::string& warning : warnings) {
    text += caution(wrapped("! " + printable(warning) + ".", 2));
  }
  return text;
}

/// A column of a kind's table besides name and title: a number or a text, possibly in a nested
/// message.
struct ListColumn {
  const char* header;
  const char* block;  ///< null: at the top level
  const char* field;
  int digits = 5;
};

constexpr char kComputed[] = "characterisation";

std::vector<ListColumn> list_columns(const ResourceKind& kind) {
  static const std::map<std::string, std::vector<ListColumn>> kColumns = {
      {"lubricants",
       {{"KV40", kComputed, "kinematic_viscosity_40_celsius_square_millimetres_per_second"},
        {"KV100", kComputed, "kinematic_viscosity_100_celsius_square_millimetres_per_second"},
        {"VI", kComputed, "viscosity_index", 3},
        {"density 15 C", kComputed, "density_15_celsius_kilograms_per_cubic_metre", 4},
        {"SAE J306", kComputed, "sae_j306_grade"},
        {"alpha*", nullptr, "pressure_viscosity_coefficient_per_pascal", 3}}},
      {"gear-sets",
       {{"pinion teeth", nullptr, "pinion_teeth"}, {"gear teeth", nullptr, "gear_teeth"}}},
      {"surfaces",
       {{"RMS height", nullptr, "composite_rms_height_metres"},
        {"asperity friction", nullptr, "asperity_friction_coefficient"}}},
      {"vehicles",
       {{"mass", nullptr, "mass_kilograms"},
        {"drag", nullptr, "drag_coefficient"},
        {"wheel radius", nullptr, "wheel_radius_metres"}}},
  };
  const auto found = kColumns.find(kind.word);
  return found == kColumns.end() ? std::vector<ListColumn>() : found->second;
}

/// Returns the cell of a column; "-" if the value is not set.
std::string list_cell(const Message& resource, const ListColumn& column) {
  const Message* parent = &resource;
  if (column.block != nullptr) {
    parent = &resource.GetReflection()->GetMessage(
        resource, resource.GetDescriptor()->FindFieldByName(column.block));
  }
  const Parameter parameter{parent->GetDescriptor()->FindFieldByName(column.field), parent, ""};
  if (parameter.field->cpp_type() == FieldDescriptor::CPPTYPE_STRING) {
    const std::string text = text_field(*parent, column.field);
    return text.empty() ? "-" : text;
  }
  const double value = number_of(parameter);
  const bool stated = parameter.field->has_presence() ? is_known(parameter) : value != 0;
  return stated ? significant(in_trade_unit(column.field, value), column.digits) : "-";
}

std::string list_json(const ResourceKind& kind, const std::vector<ResourcePointer>& resources) {
  std::string text = "{\n \"" + kind.list_field + "\": [";
  for (std::size_t i = 0; i < resources.size(); ++i) {
    std::string part = json_text(*resources[i]);
    part.erase(part.find_last_not_of('\n') + 1);
    text += (i == 0 ? "\n" : ",\n") + part;
  }
  return text + (resources.empty() ? "]\n}\n" : "\n ]\n}\n");
}

/// Returns exact JSON that import reads, without unset fields.
std::string import_json(const Message& resource) {
  google::protobuf::util::JsonPrintOptions options;
  options.add_whitespace = true;
  options.preserve_proto_field_names = true;
  std::string text;
  const auto status = google::protobuf::util::MessageToJsonString(resource, &text, options);
  if (!status.ok()) throw Failure(kExitFailed, "cannot write JSON: " + status.ToString());
  return text;
}

}  // namespace

const v1::ParameterProvenance* provenance_of(const Message& resource, const std::string& field) {
  const v1::ParameterProvenance* of_all = nullptr;
  for (const v1::ParameterProvenance& entry : provenance_entries_of(resource)) {
    if (entry.field() == field) return &entry;
    if (entry.field() == "*") of_all = &entry;
  }
  return of_all;
}

std::string resource_sheet(const Message& resource, ResourceDetail detail) {
  Sheet sheet;
  add_identity(resource, sheet);
  std::string text = sheet.text();
  if (const auto* lubricant = dynamic_cast<const v1::Lubricant*>(&resource)) {
    text += characterisation_sheet(*lubricant);
    if (detail == ResourceDetail::kSummary) return text + "\n" + parameter_summary(*lubricant);
  }
  text += "\n" + parameter_table(resource);
  if (const auto* gear_set = dynamic_cast<const v1::GearSet*>(&resource)) {
    text += "\n" + gear_set_tables_text(*gear_set);
  }
  if (const auto* surface = dynamic_cast<const v1::Surface*>(&resource)) {
    text += profiles_text(*surface);
  }
  return text;
}

std::string resource_table(const ResourceKind& kind, const std::vector<ResourcePointer>& resources,
                           bool as_revisions) {
  std::vector<Table::Column> columns = {
      {"Name", "", Table::Align::kLeft}, {"rev.", ""}, {"Changed", "UTC", Table::Align::kLeft}};
  for (const ListColumn& column : list_columns(kind)) {
    columns.push_back({column.header, trade_unit_of_field(column.field)});
  }
  columns.push_back({"Title", "", Table::Align::kLeft});
  Table table(columns);
  for (const ResourcePointer& resource : resources) {
    const std::string deleted =
        time_text(*resource, "delete_time").empty() || as_revisions ? "" : " (deleted)";
    std::vector<std::string> cells = {resource_id(text_field(*resource, "name")) + deleted,
                                      std::to_string(revision_of(*resource)),
                                      time_text(*resource, "revision_create_time")};
    for (const ListColumn& column : list_columns(kind)) {
      cells.push_back(list_cell(*resource, column));
    }
    cells.push_back(text_field(*resource, "display_name"));
    table.add_row(std::move(cells));
  }
  return table.text();
}

std::string resource_text(const Message& resource, OutputFormat format, ResourceDetail detail) {
  switch (format) {
    case OutputFormat::kJson:
      return json_text(resource);
    case OutputFormat::kCsv: {
      CsvRow row;
      append_fields(resource, "", row);
      return csv_text({row});
    }
    case OutputFormat::kTable:
      break;
  }
  return resource_sheet(resource, detail);
}

std::string resources_text(const ResourceKind& kind, const std::vector<ResourcePointer>& resources,
                           OutputFormat format, bool as_revisions) {
  switch (format) {
    case OutputFormat::kJson:
      return list_json(kind, resources);
    case OutputFormat::kCsv: {
      std::vector<CsvRow> rows;
      for (const ResourcePointer& resource : resources)
        append_fields(*resource, "", rows.emplace_back());
      return csv_text(rows);
    }
    case OutputFormat::kTable:
      break;
  }
  return resource_table(kind, resources, as_revisions);
}

std::string export_text(const ResourceKind& kind, const std::vector<ResourcePointer>& resources) {
  std::vector<std::string> parts;
  for (const ResourcePointer& resource : resources) {
    const ResourcePointer copy(resource->New());
    copy->CopyFrom(*resource);
    clear_output_only(*copy);
    parts.push_back(import_json(*copy));
    parts.back().erase(parts.back().find_last_not_of('\n') + 1);
  }
  if (parts.size() == 1) return parts.front() + "\n";
  return "{\n\"" + kind.list_field + "\": [\n" + joined(parts, ",\n") + "\n]\n}\n";
}

}  // namespace tribodyn::client
