#include "client/cpp/report/fluid_difference.h"

#include <google/protobuf/descriptor.h>
#include <google/protobuf/struct.pb.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "client/cpp/report/resource_report.h"
#include "client/cpp/resources/edits.h"
#include "client/cpp/text/csv.h"
#include "client/cpp/text/inputs.h"
#include "client/cpp/text/table.h"
#include "client/cpp/text/text.h"
#include "client/cpp/text/units.h"

namespace tribodyn::client {
namespace {

using google::protobuf::FieldDescriptor;

struct Row {
  std::string label;  ///< shown to the user
  std::string field;  ///< of Lubricant or its characterisation
  std::string unit;
  std::string a, b;  ///< formatted values; empty: unknown
  std::string a_origin, b_origin;
  std::optional<double> relative_difference;
  bool differs = false;
};

std::string provenance_word_of(const v1::Lubricant& lubricant, const std::string& field) {
  const auto* provenance = provenance_of(lubricant, field);
  return provenance == nullptr ? "" : provenance_word(provenance->provenance());
}

void set_values(Row& row, std::optional<double> a, std::optional<double> b, bool full) {
  const auto text = [&](double value) { return full ? shortest(value) : significant(value); };
  if (a) row.a = text(*a);
  if (b) row.b = text(*b);
  row.differs = a != b;
  if (a && b && *a != 0 && row.differs) row.relative_difference = (*b - *a) / std::abs(*a);
}

std::optional<double> known_number(const v1::Lubricant& lubricant, const FieldDescriptor& field) {
  if (!lubricant.GetReflection()->HasField(lubricant, &field)) return std::nullopt;
  return lubricant.GetReflection()->GetDouble(lubricant, &field);
}

std::vector<Row> parameter_rows(const v1::Lubricant& a, const v1::Lubricant& b, bool full) {
  std::vector<Row> rows;
  const auto* type = v1::Lubricant::descriptor();
  for (int i = 0; i < type->field_count(); ++i) {
    const FieldDescriptor& field = *type->field(i);
    if (field.is_repeated() || field.cpp_type() != FieldDescriptor::CPPTYPE_DOUBLE) continue;
    Row row;
    row.label = label_of_field(field.name());
    row.field = field.name();
    const auto in_a = known_number(a, field);
    const auto in_b = known_number(b, field);
    const bool temperature = trade_unit_of_field(field.name()) == "C";
    row.unit = full ? unit_of_field(field.name()) : trade_unit_of_field(field.name());
    const auto shown = [&](const std::optional<double>& value) {
      return value && !full ? std::optional(in_trade_unit(field.name(), *value)) : value;
    };
    set_values(row, shown(in_a), shown(in_b), full);
    row.differs = in_a != in_b;
    // A relative difference in degrees Celsius has no meaning.
    row.relative_difference = std::nullopt;
    if (row.differs && in_a && in_b && *in_a != 0 && !temperature) {
      row.relative_difference = (*in_b - *in_a) / std::abs(*in_a);
    }
    row.a_origin = provenance_word_of(a, field.name());
    row.b_origin = provenance_word_of(b, field.name());
    rows.push_back(std::move(row));
  }
  return rows;
}

std::vector<Row> figure_rows(const v1::Lubricant& lubricant_a, const v1::Lubricant& lubricant_b,
                             bool full) {
  std::vector<Row> rows;
  if (!lubricant_a.has_characterisation() || !lubricant_b.has_characterisation()) return rows;
  const auto& a = lubricant_a.characterisation();
  const auto& b = lubricant_b.characterisation();
  const auto add = [&](const char* label, const char* field, const char* unit,
                       std::optional<double> in_a, std::optional<double> in_b) {
    Row& row = rows.emplace_back();
    row.label = label;
    row.field = field;
    row.unit = unit;
    set_values(row, in_a, in_b, full);
  };
  add("KV40", "kinematic_viscosity_40_celsius_square_millimetres_per_second", "mm2/s",
      a.kinematic_viscosity_40_celsius_square_millimetres_per_second(),
      b.kinematic_viscosity_40_celsius_square_millimetres_per_second());
  add("KV100", "kinematic_viscosity_100_celsius_square_millimetres_per_second", "mm2/s",
      a.kinematic_viscosity_100_celsius_square_millimetres_per_second(),
      b.kinematic_viscosity_100_celsius_square_millimetres_per_second());
  const auto index = [](const auto& fluid) {
    return fluid.has_viscosity_index() ? std::optional(fluid.viscosity_index()) : std::nullopt;
  };
  add("viscosity index", "viscosity_index", "", index(a), index(b));
  add("density at 15 C", "density_15_celsius_kilograms_per_cubic_metre", "kg/m3",
      a.density_15_celsius_kilograms_per_cubic_metre(),
      b.density_15_celsius_kilograms_per_cubic_metre());
  Row& grade = rows.emplace_back();
  grade.label = "SAE J306 grade";
  grade.field = "sae_j306_grade";
  grade.a = a.sae_j306_grade();
  grade.b = b.sae_j306_grade();
  grade.differs = grade.a != grade.b;
  return rows;
}

/// The rows of boundary friction by temperature: one for each temperature of either table.
std::vector<Row> friction_rows(const v1::Lubricant& a, const v1::Lubricant& b, bool full) {
  const char* name = "asperity_friction_by_temperature";
  std::map<double, std::pair<std::optional<double>, std::optional<double>>> values;
  for (const auto& each : a.asperity_friction_by_temperature()) {
    values[each.temperature_celsius()].first = each.asperity_friction_coefficient();
  }
  for (const auto& each : b.asperity_friction_by_temperature()) {
    values[each.temperature_celsius()].second = each.asperity_friction_coefficient();
  }
  std::vector<Row> rows;
  for (const auto& [celsius, value] : values) {
    Row& row = rows.emplace_back();
    row.label = "asperity friction coefficient at " + significant(celsius) + " C";
    row.field = std::string(name) + "[" + shortest(celsius) + " C]";
    set_values(row, value.first, value.second, full);
    row.a_origin = provenance_word_of(a, name);
    row.b_origin = provenance_word_of(b, name);
  }
  return rows;
}

std::vector<Row> class_rows(const v1::Lubricant& a, const v1::Lubricant& b) {
  std::vector<Row> rows;
  for (const char* name : {"base_oil_class", "condition"}) {
    const auto* field = v1::Lubricant::descriptor()->FindFieldByName(name);
    const auto word = [&](const v1::Lubricant& lubricant) {
      const auto* value = lubricant.GetReflection()->GetEnum(lubricant, field);
      return value->number() == 0 ? "" : enum_word(*value);
    };
    Row& row = rows.emplace_back();
    row.label = label_of_field(name);
    row.field = name;
    row.a = word(a);
    row.b = word(b);
    row.differs = row.a != row.b;
  }
  return rows;
}

std::string table_text(const std::vector<Row>& rows, const v1::Lubricant& a,
                       const v1::Lubricant& b) {
  Table table({{"", "", Table::Align::kLeft},
               {resource_id(a.name()), ""},
               {resource_id(b.name()), ""},
               {"Unit", "", Table::Align::kLeft},
               {"(B-A)/|A|", "%"},
               {"Origin", "", Table::Align::kLeft}});
  for (const Row& row : rows) {
    std::string known = row.a_origin;
    if (row.b_origin != row.a_origin) {
      known = (row.a_origin.empty() ? "not stated" : row.a_origin) + " / " +
              (row.b_origin.empty() ? "not stated" : row.b_origin);
    }
    std::string difference = row.differs ? "" : "=";
    if (row.relative_difference) {
      difference = fixed(100 * *row.relative_difference, 2);
      if (difference[0] != '-') difference.insert(0, "+");
    }
    table.add_row({row.label, row.a.empty() ? "-" : row.a, row.b.empty() ? "-" : row.b, row.unit,
                   difference, known});
  }
  return table.text();
}

std::string csv_text_of(const std::vector<Row>& rows) {
  std::vector<CsvRow> lines;
  for (const Row& row : rows) {
    lines.push_back(
        {{"field", row.field},
         {"unit", row.unit},
         {"a", row.a},
         {"b", row.b},
         {"relative_difference", row.relative_difference ? shortest(*row.relative_difference) : ""},
         {"differs", row.differs ? "true" : "false"},
         {"a_provenance", row.a_origin},
         {"b_provenance", row.b_origin}});
  }
  return csv_text(lines);
}

std::string json_text_of(const std::vector<Row>& rows, const v1::Lubricant& a,
                         const v1::Lubricant& b) {
  google::protobuf::Struct object;
  (*object.mutable_fields())["a"].set_string_value(a.name());
  (*object.mutable_fields())["b"].set_string_value(b.name());
  auto& list = *(*object.mutable_fields())["differences"].mutable_list_value();
  for (const Row& row : rows) {
    auto& fields = *list.add_values()->mutable_struct_value()->mutable_fields();
    for (const auto& [key, text] :
         {std::pair("field", &row.field), std::pair("unit", &row.unit), std::pair("a", &row.a),
          std::pair("b", &row.b), std::pair("a_provenance", &row.a_origin),
          std::pair("b_provenance", &row.b_origin)}) {
      fields[key].set_string_value(*text);
    }
    if (row.relative_difference) {
      fields["relative_difference"].set_number_value(*row.relative_difference);
    }
    fields["differs"].set_bool_value(row.differs);
  }
  return json_text(object);
}

}  // namespace

FluidDifference fluid_difference(const v1::Lubricant& a, const v1::Lubricant& b, bool shows_equal,
                                 OutputFormat format) {
  const bool full = format != OutputFormat::kTable;
  std::vector<Row> rows = figure_rows(a, b, full);
  for (auto&& more : {class_rows(a, b), parameter_rows(a, b, full), friction_rows(a, b, full)}) {
    rows.insert(rows.end(), more.begin(), more.end());
  }
  const auto equal =
      std::stable_partition(rows.begin(), rows.end(), [](const Row& row) { return row.differs; });
  FluidDifference result;
  result.differs = equal != rows.begin();
  if (!shows_equal) rows.erase(equal, rows.end());
  switch (format) {
    case OutputFormat::kCsv:
      result.text = csv_text_of(rows);
      break;
    case OutputFormat::kJson:
      result.text = json_text_of(rows, a, b);
      break;
    case OutputFormat::kTable:
      if (!result.differs) result.text = "The two fluids do not differ.\n";
      if (!rows.empty()) result.text += table_text(rows, a, b);
  }
  return result;
}

}  // namespace tribodyn::client
