#include "server/application/field_mask.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "server/application/mask_paths.h"
#include "server/contract/output_only.h"
#include "server/contract/resource_names.h"
#include "tribodyn/v1/provenance.pb.h"

namespace tribodyn::server {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;

constexpr char kUpdateMask[] = "update_mask";
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

/// Where a path of a mask leads to.
struct Target {
  const FieldDescriptor* block = nullptr;  ///< the message that holds the field; null: the top
  const FieldDescriptor* field = nullptr;  ///< null: nothing is to be done
};

/// Finds the field that a path names: "display_name" or "measurements.densities". Leaves out what
/// only the server sets. Adds a violation if the path leads to no field, into a list, or deeper.
Target target_of(const std::string& path, const google::protobuf::Descriptor& resource,
                 Violations& violations) {
  const auto fields = fields_along(path, resource, kUpdateMask, violations);
  if (fields.empty()) return {};
  const bool is_in_list = fields.front()->is_repeated();
  if (fields.size() > (is_in_list ? 1 : 2)) {
    const std::string whole =
        is_in_list ? fields[0]->name() : fields[0]->name() + "." + fields[1]->name();
    violations.push_back(
        {kUpdateMask, fmt::format("\"{}\" is part of \"{}\", which changes as a whole",
                                  plain_excerpt(path), whole)});
    return {};
  }
  if (std::any_of(fields.begin(), fields.end(),
                  [](const FieldDescriptor* field) { return is_output_only(*field); })) {
    return {};
  }
  return {fields.size() == 2 ? fields.front() : nullptr, fields.back()};
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
  if (names_all(mask)) {
    target.CopyFrom(source);
    return;
  }
  if (!check_path_count(mask, kUpdateMask, violations)) return;
  const auto& paths = mask.paths();
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
