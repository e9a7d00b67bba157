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

}  // namespace

void merge(const Message& source, const google::protobuf::FieldMask& mask, Message& target,
           Violations& violations) {
  const auto& paths = mask.paths();
  if (paths.empty() || (paths.size() == 1 && paths.Get(0) == "*")) {
    target.CopyFrom(source);
    return;
  }
  const auto& descriptor = *source.GetDescriptor();
  const bool with_provenance = std::find(paths.begin(), paths.end(), kProvenance) != paths.end();
  for (const std::string& path : paths) {
    const FieldDescriptor* field = descriptor.FindFieldByName(path);
    if (field == nullptr) {
      violations.push_back(
          {"update_mask",
           fmt::format("\"{}\" is no field of {}{}", plain_excerpt(path), descriptor.name(),
                       meant_text(path, settable_fields(descriptor)))});
      continue;
    }
    if (is_output_only(*field)) continue;
    const bool changed = is_other_number(source, target, *field);
    take_over(source, *field, target);
    if (changed && !with_provenance) forget_provenance(path, target);
  }
}

}  // namespace tribodyn::server
