#include "server/application/field_mask.h"

#include <fmt/format.h>

#include <memory>
#include <set>
#include <vector>

#include "server/application/element_limits.h"
#include "server/contract/output_only.h"
#include "server/contract/resource_names.h"
#include "tribodyn/v1/provenance.pb.h"

namespace tribodyn::server {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;

constexpr char kProvenance[] = "provenance";

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

/// Where a path of a mask leads to.
struct Target {
  const FieldDescriptor* block = nullptr;  ///< the message that holds the field; null: the top
  const FieldDescriptor* field = nullptr;  ///< null: nothing is to be done
};

/// The place of "display_name" or "measurements.densities". Nothing to be done for what only the
/// server sets; a violation for a field that is unknown.
Target target_of(const std::string& path, const google::protobuf::Descriptor& resource,
                 Violations& violations) {
  Target out;
  const google::protobuf::Descriptor* holder = &resource;
  std::string name = path;
  if (const std::size_t dot = path.find('.'); dot != std::string::npos) {
    const FieldDescriptor* block = resource.FindFieldByName(path.substr(0, dot));
    const bool holds_fields = block != nullptr && !block->is_repeated() &&
                              block->cpp_type() == FieldDescriptor::CPPTYPE_MESSAGE;
    if (holds_fields && !is_output_only(*block)) {
      out.block = block;
      holder = block->message_type();
      name = path.substr(dot + 1);
    }
  }
  const FieldDescriptor* field = holder->FindFieldByName(name);
  if (field == nullptr) {
    violations.push_back(
        {"update_mask", fmt::format("\"{}\" is no field of {}{}", plain_excerpt(name),
                                    holder->name(), meant_text(name, settable_fields(*holder)))});
  } else if (!is_output_only(*field)) {
    out.field = field;
  }
  return out;
}

/// Swaps one field of `target` with that of `source`, set or not. True when it was a number and
/// changes.
bool take_over(const Target& place, Message& source, Message& target) {
  const auto& reflection = *target.GetReflection();
  if (place.block == nullptr) {
    const bool changed = is_other_number(source, target, *place.field);
    reflection.SwapFields(&target, &source, {place.field});
    return changed;
  }
  if (!reflection.HasField(source, place.block) && !reflection.HasField(target, place.block)) {
    return false;
  }
  Message* to = reflection.MutableMessage(&target, place.block);
  const bool changed =
      take_over({nullptr, place.field}, *reflection.MutableMessage(&source, place.block), *to);
  if (to->ByteSizeLong() == 0) reflection.ClearField(&target, place.block);
  return changed;
}

/// The paths of an omitted mask: every field that `source` populates and a client may set, those of
/// a message in it one by one ("measurements.densities").
std::set<std::string> populated_paths(const Message& source) {
  std::set<std::string> paths;
  std::vector<const FieldDescriptor*> fields;
  std::vector<const FieldDescriptor*> inside;
  source.GetReflection()->ListFields(source, &fields);
  for (const FieldDescriptor* field : fields) {
    if (is_output_only(*field)) continue;
    if (field->is_repeated() || field->cpp_type() != FieldDescriptor::CPPTYPE_MESSAGE) {
      paths.insert(field->name());
      continue;
    }
    const Message& block = source.GetReflection()->GetMessage(source, field);
    block.GetReflection()->ListFields(block, &inside);
    for (const FieldDescriptor* each : inside) paths.insert(field->name() + "." + each->name());
  }
  return paths;
}

}  // namespace

void merge(const Message& source, const google::protobuf::FieldMask& mask, Message& target,
           Violations& violations) {
  const auto& paths = mask.paths();
  if (paths.size() == 1 && paths.Get(0) == "*") {
    target.CopyFrom(source);
    return;
  }
  if (paths.size() > kMaximumMaskPaths) {
    violations.push_back({"update_mask", too_many_text(paths.size(), kMaximumMaskPaths)});
    return;
  }
  const std::set<std::string> distinct =
      paths.empty() ? populated_paths(source) : std::set<std::string>(paths.begin(), paths.end());
  const bool with_provenance = distinct.contains(kProvenance);
  const std::unique_ptr<Message> copy(source.New());  // what is taken over is swapped out of it
  copy->CopyFrom(source);
  for (const std::string& path : distinct) {
    const Target place = target_of(path, *source.GetDescriptor(), violations);
    if (place.field == nullptr) continue;
    if (place.block != nullptr && distinct.contains(place.block->name())) continue;  // goes whole
    if (take_over(place, *copy, target) && !with_provenance) forget_provenance(path, target);
  }
}

}  // namespace tribodyn::server
