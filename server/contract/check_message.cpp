#include "server/contract/check_message.h"

#include <fmt/format.h>
#include <google/protobuf/reflection.h>

#include <algorithm>
#include <cmath>

#include "server/contract/constraints.h"
#include "server/contract/output_only.h"
#include "tribodyn/v1/limits.pb.h"
#include "tribodyn/v1/lubricants.pb.h"

namespace tribodyn::server {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;
using google::protobuf::Reflection;

/// One field of one message, with the arguments of its check.
struct FieldCheck {
  const FieldDescriptor& field;
  std::string path;
  Violations& violations;
  Missing missing;
};

void check_number(const FieldCheck& check, double value) {
  const Constraint* row = find_constraint(check.field);
  if (row == nullptr) {
    if (!std::isfinite(value)) {
      check.violations.add(check.path, "{} = {}; must be finite", check.field.name(), value);
    }
    return;
  }
  if (value == 0 && row->zero == Zero::kUnset && !check.field.has_presence()) return;
  if (row->allows(value)) return;
  std::string text = out_of_range_text(*row, value);
  if (value == 0 && !check.field.has_presence() && !check.field.is_repeated()) {
    text += "; 0 also means not set";
  }
  check.violations.add(check.path, std::move(text));
}

void check_enum(const FieldCheck& check, int value) {
  if (check.field.enum_type()->FindValueByNumber(value) != nullptr) return;
  std::string names;
  for (int i = 0; i < check.field.enum_type()->value_count(); ++i) {
    names += (i == 0 ? "" : ", ") + check.field.enum_type()->value(i)->name();
  }
  check.violations.add(check.path, "{} = {}; allowed: {}", check.field.name(), value, names);
}

void check_text(const FieldCheck& check, const std::string& value) {
  const std::string& name = check.field.name();
  const auto& options = check.field.options();
  const int longest = options.HasExtension(v1::max_bytes) ? options.GetExtension(v1::max_bytes)
                                                          : kMaximumTextLength;
  if (value.size() <= static_cast<std::size_t>(longest)) return;
  check.violations.add(check.path, "{} has {} bytes; allowed: at most {}", name, value.size(),
                       longest);
}

/// Returns true for alpha* and its temperature in a lubricant with a pressure-viscosity law, which
/// determines both.
bool is_determined(const Message& message, const FieldDescriptor& field) {
  if (message.GetDescriptor() != v1::Lubricant::descriptor()) return false;
  return (field.number() == v1::Lubricant::kPressureViscosityCoefficientPerPascalFieldNumber ||
          field.number() == v1::Lubricant::kPressureViscosityTemperatureKelvinFieldNumber) &&
         message.GetReflection()->HasOneof(
             message, v1::Lubricant::descriptor()->FindOneofByName("pressure_viscosity_law"));
}

/// Adds a violation if an unset field is required.
void check_missing(const Message& message, const FieldCheck& check) {
  const Constraint* row = find_constraint(check.field);
  if (row == nullptr || !is_required(*row) || is_determined(message, check.field)) return;
  check.violations.add(check.path, not_set_text(*row));
}

/// Returns true for the tables of a gear set, which gear_set_checks.h checks by row and column.
bool is_table(const FieldDescriptor& field) {
  if (field.cpp_type() != FieldDescriptor::CPPTYPE_MESSAGE) return false;
  const std::string& type = field.message_type()->name();
  return type == "MeshSeries" || type == "FlankSlot" || type == "LoadShareAtTorque";
}

/// Checks the value of a field or, if the field is a list, its element `index`.
void check_value(const Message& message, const FieldCheck& check, int index = 0) {
  const Reflection& reflection = *message.GetReflection();
  const FieldDescriptor* field = &check.field;
  const bool is_list = field->is_repeated();
  switch (field->cpp_type()) {
    case FieldDescriptor::CPPTYPE_DOUBLE:
      return check_number(check, is_list ? reflection.GetRepeatedDouble(message, field, index)
                                         : reflection.GetDouble(message, field));
    case FieldDescriptor::CPPTYPE_INT32:
      if (!is_list) check_number(check, reflection.GetInt32(message, field));
      return;
    case FieldDescriptor::CPPTYPE_ENUM:
      if (!is_list) check_enum(check, reflection.GetEnumValue(message, field));
      return;
    case FieldDescriptor::CPPTYPE_STRING:
      return check_text(check, is_list ? reflection.GetRepeatedString(message, field, index)
                                       : reflection.GetString(message, field));
    case FieldDescriptor::CPPTYPE_MESSAGE:
      return check_message(is_list ? reflection.GetRepeatedMessage(message, field, index)
                                   : reflection.GetMessage(message, field),
                           check.path, check.violations, check.missing);
    default:
      return;
  }
}

/// Returns true if all elements are numbers that satisfy their row: lists of a million numbers need
/// no path for each.
bool are_valid_numbers(const Message& message, const Reflection& reflection,
                       const FieldDescriptor& field) {
  if (field.cpp_type() != FieldDescriptor::CPPTYPE_DOUBLE) return false;
  const Constraint* row = find_constraint(field);
  const auto& values = reflection.GetRepeatedFieldRef<double>(message, &field);
  return std::all_of(values.begin(), values.end(), [row](double value) {
    return row == nullptr ? std::isfinite(value) : row->allows(value);
  });
}

/// Checks the elements of a list, and adds at most kMaximumReportedElements violations.
void check_repeated(const Message& message, const Reflection& reflection, const FieldCheck& check) {
  const FieldDescriptor& field = check.field;
  if (are_valid_numbers(message, reflection, field)) return;
  const std::string& path = check.path;
  Violations& violations = check.violations;
  const int count = reflection.FieldSize(message, &field);
  Violations found;
  for (int i = 0; i < count; ++i) {
    check_value(message, {field, fmt::format("{}[{}]", path, i), found, check.missing}, i);
  }
  const std::size_t reported =
      std::min(found.size(), static_cast<std::size_t>(kMaximumReportedElements));
  for (std::size_t i = 0; i < reported; ++i) violations.push_back(found[i]);
  if (found.size() > reported) {
    violations.add(path, "{} more of its elements are invalid", found.size() - reported);
  }
}

bool may_be_infinite(std::string_view field) {
  return field == "shear_rate_per_second" || field == "pinion_specific_sliding" ||
         field == "gear_specific_sliding" || field == "pinion_thermal_resistance_kelvin_per_watt" ||
         field == "gear_thermal_resistance_kelvin_per_watt";
}

bool is_finite(double value, bool infinity_allowed, const FieldDescriptor& field) {
  if (std::isfinite(value)) return true;
  return std::isinf(value) && value > 0 && (infinity_allowed || may_be_infinite(field.name()));
}

std::string first_not_finite(const Message& message, bool infinity_allowed) {
  const Reflection& reflection = *message.GetReflection();
  const auto& descriptor = *message.GetDescriptor();
  for (int f = 0; f < descriptor.field_count(); ++f) {
    const FieldDescriptor& field = *descriptor.field(f);
    if (field.cpp_type() == FieldDescriptor::CPPTYPE_DOUBLE) {
      const int count = field.is_repeated() ? reflection.FieldSize(message, &field) : 1;
      for (int i = 0; i < count; ++i) {
        const double value = field.is_repeated() ? reflection.GetRepeatedDouble(message, &field, i)
                                                 : reflection.GetDouble(message, &field);
        if (!is_finite(value, infinity_allowed, field)) return field.name();
      }
    } else if (field.cpp_type() == FieldDescriptor::CPPTYPE_MESSAGE) {
      const bool allowed = infinity_allowed || may_be_infinite(field.name());
      const int count = field.is_repeated()
                            ? reflection.FieldSize(message, &field)
                            : static_cast<int>(reflection.HasField(message, &field));
      for (int i = 0; i < count; ++i) {
        const Message& inner = field.is_repeated()
                                   ? reflection.GetRepeatedMessage(message, &field, i)
                                   : reflection.GetMessage(message, &field);
        const std::string path = first_not_finite(inner, allowed);
        if (!path.empty()) return field.name() + "." + path;
      }
    }
  }
  return {};
}

}  // namespace

void check_message(const Message& message, const std::string& path, Violations& violations,
                   Missing missing) {
  const Reflection& reflection = *message.GetReflection();
  const auto& descriptor = *message.GetDescriptor();
  for (int i = 0; i < descriptor.field_count(); ++i) {
    const FieldDescriptor& field = *descriptor.field(i);
    if (is_output_only(field) || is_table(field)) continue;
    const FieldCheck check{field, join_path(path, field.name()), violations, missing};
    if (field.is_repeated()) {
      check_repeated(message, reflection, check);
    } else if (!field.has_presence() || reflection.HasField(message, &field)) {
      check_value(message, check);
    } else if (missing == Missing::kViolation) {
      check_missing(message, check);
    }
  }
}

void check_size(const Message& request, const std::string& list, Violations& violations) {
  const auto& descriptor = *request.GetDescriptor();
  const int size = request.GetReflection()->FieldSize(request, descriptor.FindFieldByName(list));
  const Constraint& row = *find_constraint(descriptor.name(), list);
  if (row.allows(size)) return;
  violations.add(list, out_of_range_text(row, size));
}

void check_choice(const Message& request, const std::string& field, Violations& violations) {
  const FieldDescriptor& choice = *request.GetDescriptor()->FindFieldByName(field);
  check_enum({choice, field, violations, Missing::kAllowed},
             request.GetReflection()->GetEnumValue(request, &choice));
}

std::string first_not_finite(const Message& message) { return first_not_finite(message, false); }

}  // namespace tribodyn::server
