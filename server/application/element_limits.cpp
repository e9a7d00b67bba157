#include "server/application/element_limits.h"

#include <fmt/format.h>
#include <google/protobuf/field_mask.pb.h>

#include <vector>

#include "tribodyn/v1/limits.pb.h"

namespace tribodyn::server {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;

std::optional<int> maximum_elements(const FieldDescriptor& field) {
  if (field.containing_type() == google::protobuf::FieldMask::descriptor()) {
    return kMaximumMaskPaths;
  }
  if (!field.is_repeated() || !field.options().HasExtension(v1::max_items)) return std::nullopt;
  return field.options().GetExtension(v1::max_items);
}

std::string too_many_text(std::int64_t count, std::int64_t maximum) {
  return fmt::format("{} entries; allowed: at most {}", count, maximum);
}

void check_counts(const Message& message, const std::string& path, Violations& violations) {
  const auto& reflection = *message.GetReflection();
  std::vector<const FieldDescriptor*> fields;
  reflection.ListFields(message, &fields);
  for (const FieldDescriptor* field : fields) {
    const bool is_message = field->cpp_type() == FieldDescriptor::CPPTYPE_MESSAGE;
    const std::string here = join_path(path, field->name());
    if (!field->is_repeated()) {
      if (is_message) check_counts(reflection.GetMessage(message, field), here, violations);
      continue;
    }
    const int count = reflection.FieldSize(message, field);
    const std::optional<int> maximum = maximum_elements(*field);
    if (maximum && count > *maximum) {
      violations.add(here, too_many_text(count, *maximum));
      continue;
    }
    for (int i = 0; is_message && i < count; ++i) {
      check_counts(reflection.GetRepeatedMessage(message, field, i), fmt::format("{}[{}]", here, i),
                   violations);
    }
  }
}

}  // namespace tribodyn::server
