#include "server/app/field_mask.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "server/convert/output_only.h"
#include "server/convert/resource_names.h"
#include "tribodyn/v1/provenance.pb.h"

namespace tribodyn::server {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;

constexpr char kProvenance[] = "provenance";

/// Swaps in the one field, set or not.
void take_over(const Message& source, const FieldDescriptor& field, Message& target) {
  Message* copy = source.New();
  copy->CopyFrom(source);
  target.GetReflection()->SwapFields(&target, copy, {&field});
  delete copy;
}

void forget_provenance(const std::string& field, Message& target) {
  const auto* descriptor = target.GetDescriptor()->FindFieldByName(kProvenance);
  const auto& reflection = *target.GetReflection();
  int kept = 0;
  const int count = reflection.FieldSize(target, descriptor);
  for (int i = 0; i < count; ++i) {
    const auto& entry = static_cast<const v1::ParameterProvenance&>(
        reflection.GetRepeatedMessage(target, descriptor, i));
    if (entry.field() == field) continue;
    reflection.SwapElements(&target, descriptor, i, kept);
    ++kept;
  }
  for (int i = kept; i < count; ++i) reflection.RemoveLast(&target, descriptor);
}

bool is_other_number(const Message& a, const Message& b, const FieldDescriptor& field) {
  if (field.is_repeated() || field.cpp_type() != FieldDescriptor::CPPTYPE_DOUBLE) return false;
  const auto& reflection = *a.GetReflection();
  return reflection.HasField(a, &field) != reflection.HasField(b, &field) ||
         reflection.GetDouble(a, &field) != reflection.GetDouble(b, &field);
}

std::vector<std::string> settable_fields(const google::protobuf::Descriptor& descriptor) {
  std::vector<std::string> out;
  for (int i = 0; i < descriptor.field_count(); ++i) out.push_back(descriptor.field(i)->name());
  return out;
}

/// Takes over the field of a message, or of one that it holds: "measurements.densities".
void take_over_path(const Message& source, const std::string& path, bool with_provenance,
                    Message& target, Violations& violations) {
  const Message* from = &source;
  Message* to = &target;
  std::string name = path;
  const FieldDescriptor* block = nullptr;
  if (const std::size_t dot = path.find('.'); dot != std::string::npos) {
    block = source.GetDescriptor()->FindFieldByName(path.substr(0, dot));
    const bool holds_fields = block != nullptr && !block->is_repeated() &&
                              block->cpp_type() == FieldDescriptor::CPPTYPE_MESSAGE;
    if (holds_fields && !is_output_only(*block)) {
      const bool is_nowhere = !source.GetReflection()->HasField(source, block) &&
                              !target.GetReflection()->HasField(target, block);
      if (is_nowhere && block->message_type()->FindFieldByName(path.substr(dot + 1))) return;
      from = &source.GetReflection()->GetMessage(source, block);
      to = target.GetReflection()->MutableMessage(&target, block);
      name = path.substr(dot + 1);
    }
  }
  const auto& descriptor = *from->GetDescriptor();
  const FieldDescriptor* field = descriptor.FindFieldByName(name);
  if (field == nullptr) {
    violations.push_back(
        {"update_mask",
         fmt::format("\"{}\" is no field of {}{}", plain_excerpt(name), descriptor.name(),
                     meant_text(name, settable_fields(descriptor)))});
    return;
  }
  if (is_output_only(*field)) return;
  const bool changed = is_other_number(*from, *to, *field);
  take_over(*from, *field, *to);
  if (block != nullptr && to != &target && to->ByteSizeLong() == 0) {
    target.GetReflection()->ClearField(&target, block);
  }
  if (changed && !with_provenance) forget_provenance(path, target);
}

}  // namespace

void merge(const Message& source, const google::protobuf::FieldMask& mask, Message& target,
           Violations& violations) {
  const auto& paths = mask.paths();
  if (paths.empty() || (paths.size() == 1 && paths.Get(0) == "*")) {
    target.CopyFrom(source);
    return;
  }
  const bool with_provenance = std::find(paths.begin(), paths.end(), kProvenance) != paths.end();
  for (const std::string& path : paths) {
    take_over_path(source, path, with_provenance, target, violations);
  }
}

}  // namespace tribodyn::server
