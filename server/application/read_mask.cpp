#include "server/application/read_mask.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "server/application/element_limits.h"
#include "server/contract/resource_names.h"

namespace tribodyn::server {
namespace {

using google::protobuf::Descriptor;
using google::protobuf::FieldDescriptor;
using google::protobuf::Message;

std::vector<std::string> names_of_fields(const Descriptor& descriptor) {
  std::vector<std::string> out;
  for (int i = 0; i < descriptor.field_count(); ++i) out.push_back(descriptor.field(i)->name());
  return out;
}

/// The fields along a path from the top; empty, and a violation, if it leads to no field.
std::vector<const FieldDescriptor*> fields_along(const std::string& path, const Descriptor& answer,
                                                 Violations& violations) {
  std::vector<const FieldDescriptor*> out;
  const Descriptor* holder = &answer;
  std::string_view rest = path;
  while (true) {
    const std::size_t dot = std::min(rest.find('.'), rest.size());
    const std::string name(rest.substr(0, dot));
    if (holder == nullptr) {
      violations.push_back(
          {"read_mask", fmt::format("\"{}\": {} is no message, it has no field \"{}\"",
                                    plain_excerpt(path), out.back()->name(), plain_excerpt(name))});
      return {};
    }
    const FieldDescriptor* field = holder->FindFieldByName(name);
    if (field == nullptr) {
      violations.push_back(
          {"read_mask", fmt::format("\"{}\" is no field of {}{}", plain_excerpt(name),
                                    holder->name(), meant_text(name, names_of_fields(*holder)))});
      return {};
    }
    out.push_back(field);
    if (dot == rest.size()) return out;
    holder = field->message_type();
    rest.remove_prefix(dot + 1);
  }
}

}  // namespace

ReadMask::ReadMask(const google::protobuf::FieldMask& mask, const Descriptor& answer,
                   Violations& violations) {
  const auto& paths = mask.paths();
  if (paths.empty() || (paths.size() == 1 && paths.Get(0) == "*")) return;
  if (paths.size() > kMaximumMaskPaths) {
    violations.push_back({"read_mask", too_many_text(paths.size(), kMaximumMaskPaths)});
    return;
  }
  // In order, so that "result" comes before "result.points" and stays whole.
  std::vector<std::string> sorted(paths.begin(), paths.end());
  std::sort(sorted.begin(), sorted.end());
  for (const std::string& path : sorted) {
    Node* node = &root_;
    const auto fields = fields_along(path, answer, violations);
    for (std::size_t i = 0; i < fields.size(); ++i) {
      const auto [at, is_new] = node->parts.try_emplace(fields[i]);
      if (!is_new && at->second.parts.empty()) break;  // asked for whole already
      node = &at->second;
    }
  }
}

bool ReadMask::asks_for(std::string_view field) const {
  return is_whole() || std::any_of(root_.parts.begin(), root_.parts.end(),
                                   [&](const auto& part) { return part.first->name() == field; });
}

void ReadMask::apply(Message& answer) const {
  if (!is_whole()) clear_others(root_, answer);
}

void ReadMask::clear_others(const Node& node, Message& message) {
  const auto& reflection = *message.GetReflection();
  std::vector<const FieldDescriptor*> fields;
  reflection.ListFields(message, &fields);
  for (const FieldDescriptor* field : fields) {
    const auto part = node.parts.find(field);
    if (part == node.parts.end()) {
      reflection.ClearField(&message, field);
    } else if (part->second.parts.empty()) {
      continue;
    } else if (field->is_repeated()) {
      for (int i = 0; i < reflection.FieldSize(message, field); ++i) {
        clear_others(part->second, *reflection.MutableRepeatedMessage(&message, field, i));
      }
    } else {
      clear_others(part->second, *reflection.MutableMessage(&message, field));
    }
  }
}

}  // namespace tribodyn::server
