#include "server/application/mask_paths.h"

#include <algorithm>
#include <string_view>

#include "server/application/element_limits.h"
#include "server/contract/resource_names.h"

namespace tribodyn::server {
namespace {

std::vector<std::string> names_of_fields(const google::protobuf::Descriptor& message) {
  std::vector<std::string> out;
  for (int i = 0; i < message.field_count(); ++i) out.push_back(message.field(i)->name());
  return out;
}

}  // namespace

bool names_all(const google::protobuf::FieldMask& mask) {
  return mask.paths_size() == 1 && mask.paths(0) == "*";
}

bool check_path_count(const google::protobuf::FieldMask& mask, const std::string& mask_field,
                      Violations& violations) {
  if (mask.paths_size() <= kMaximumMaskPaths) return true;
  violations.add(mask_field, too_many_text(mask.paths_size(), kMaximumMaskPaths));
  return false;
}

std::vector<const google::protobuf::FieldDescriptor*> fields_along(
    const std::string& path, const google::protobuf::Descriptor& message,
    const std::string& mask_field, Violations& violations) {
  std::vector<const google::protobuf::FieldDescriptor*> out;
  const google::protobuf::Descriptor* holder = &message;
  std::string_view rest = path;
  while (true) {
    const std::size_t dot = std::min(rest.find('.'), rest.size());
    const std::string name(rest.substr(0, dot));
    if (holder == nullptr) {
      violations.add(mask_field, "\"{}\": {} is not a message and has no field \"{}\"",
                     plain_excerpt(path), out.back()->name(), plain_excerpt(name));
      return {};
    }
    const auto* field = holder->FindFieldByName(name);
    if (field == nullptr) {
      violations.add(mask_field, "\"{}\" is not a field of {}{}", plain_excerpt(name),
                     holder->name(), meant_text(name, names_of_fields(*holder)));
      return {};
    }
    out.push_back(field);
    if (dot == rest.size()) return out;
    holder = field->message_type();
    rest.remove_prefix(dot + 1);
  }
}

}  // namespace tribodyn::server
