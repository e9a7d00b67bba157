#include "server/application/read_mask.h"

#include <algorithm>
#include <string>
#include <vector>

#include "server/application/mask_paths.h"

namespace tribodyn::server {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;

constexpr char kReadMask[] = "read_mask";

}  // namespace

ReadMask::ReadMask(const google::protobuf::FieldMask& mask,
                   const google::protobuf::Descriptor& answer, Violations& violations) {
  if (names_all(mask) || !check_path_count(mask, kReadMask, violations)) return;
  // Sorted, so that "result" comes before "result.points" and stays whole.
  std::vector<std::string> sorted(mask.paths().begin(), mask.paths().end());
  std::sort(sorted.begin(), sorted.end());
  for (const std::string& path : sorted) {
    Node* node = &root_;
    const auto fields = fields_along(path, answer, kReadMask, violations);
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
