#include "proto/enum_names.h"

#include <cctype>

namespace tribodyn {

using google::protobuf::EnumDescriptor;
using google::protobuf::EnumValueDescriptor;

std::string value_prefix(const EnumDescriptor& type) {
  std::string prefix;
  for (const char c : type.name()) {
    const auto letter = static_cast<unsigned char>(c);
    if (std::isupper(letter) != 0 && !prefix.empty()) prefix += '_';
    prefix += static_cast<char>(std::toupper(letter));
  }
  return prefix + '_';
}

std::string short_name(const EnumValueDescriptor& value) {
  const std::string prefix = value_prefix(*value.type());
  if (value.number() == 0 || !value.name().starts_with(prefix)) return value.name();
  return value.name().substr(prefix.size());
}

std::string short_name(const EnumDescriptor& type, int number) {
  const EnumValueDescriptor* value = type.FindValueByNumber(number);
  return value == nullptr ? std::to_string(number) : short_name(*value);
}

const EnumValueDescriptor* find_value(const EnumDescriptor& type, std::string_view name) {
  for (int i = 0; i < type.value_count(); ++i) {
    const EnumValueDescriptor& value = *type.value(i);
    if (value.name() == name || short_name(value) == name) return &value;
  }
  return nullptr;
}

}  // namespace tribodyn
