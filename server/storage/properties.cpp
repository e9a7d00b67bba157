#include "server/storage/properties.h"

#include <google/protobuf/reflection.h>

#include <map>
#include <memory>
#include <utility>

#include "proto/enum_names.h"
#include "proto/field_behavior.h"
#include "server/contract/resource_kinds.h"
#include "server/contract/resource_names.h"
#include "server/storage/resource_types.h"
#include "tribodyn/v1/labels.pb.h"

namespace tribodyn::server {
namespace {

using google::protobuf::Descriptor;
using google::protobuf::FieldDescriptor;
using google::protobuf::Message;

constexpr char kCreateTime[] = "create_time";
constexpr char kUpdateTime[] = "update_time";

bool is_number(const FieldDescriptor& field) {
  return field.cpp_type() == FieldDescriptor::CPPTYPE_DOUBLE ||
         field.cpp_type() == FieldDescriptor::CPPTYPE_INT32;
}

std::vector<PropertyField> fields_of(std::string_view collection) {
  const std::unique_ptr<Message> message = new_resource(collection);
  if (!message) return {};
  std::vector<PropertyField> out = {{kCreateTime, PropertyKind::kTime},
                                    {kUpdateTime, PropertyKind::kTime}};
  const Descriptor& descriptor = *message->GetDescriptor();
  for (int i = 0; i < descriptor.field_count(); ++i) {
    const FieldDescriptor& field = *descriptor.field(i);
    const std::string& name = field.name();
    if (field.is_repeated() || name == "name" || name == "description" || is_output_only(field)) {
      continue;
    }
    if (is_number(field)) out.push_back({name, PropertyKind::kNumber});
    if (field.cpp_type() == FieldDescriptor::CPPTYPE_STRING) {
      out.push_back({name, PropertyKind::kText});
    }
    if (field.cpp_type() == FieldDescriptor::CPPTYPE_ENUM) {
      out.push_back({name, PropertyKind::kEnum});
    }
  }
  return out;
}

void add_number(const Message& message, const FieldDescriptor& field, std::vector<Property>& out) {
  const auto& reflection = *message.GetReflection();
  if (field.has_presence() && !reflection.HasField(message, &field)) return;
  out.push_back({field.name(), field.cpp_type() == FieldDescriptor::CPPTYPE_INT32
                                   ? static_cast<double>(reflection.GetInt32(message, &field))
                                   : reflection.GetDouble(message, &field)});
}

void add_labels(const Message& message, std::vector<Property>& out) {
  const FieldDescriptor* field = message.GetDescriptor()->FindFieldByName("labels");
  const auto& reflection = *message.GetReflection();
  const auto labels = reflection.GetRepeatedFieldRef<v1::Label>(message, field);
  for (const v1::Label& label : labels) out.push_back({"labels." + label.key(), label.value()});
}

}  // namespace

const std::vector<PropertyField>& property_fields(std::string_view collection) {
  static const std::map<std::string, std::vector<PropertyField>, std::less<>> kFields = [] {
    std::map<std::string, std::vector<PropertyField>, std::less<>> out;
    for (const char* each : kResourceCollections) out[each] = fields_of(each);
    std::vector<PropertyField> columns = {
        {kCreateTime, PropertyKind::kTime},  {"display_name", PropertyKind::kText},
        {"end_time", PropertyKind::kTime},   {"gear_set", PropertyKind::kText},
        {"input_hash", PropertyKind::kText}, {"lubricant", PropertyKind::kText},
        {"state", PropertyKind::kEnum},      {"surface", PropertyKind::kText},
        {"vehicle", PropertyKind::kText}};
    out[kCampaigns] = columns;
    columns.push_back({"pinned", PropertyKind::kFlag});
    out[kSimulations] = std::move(columns);
    return out;
  }();
  static const std::vector<PropertyField> kNone;
  const auto found = kFields.find(collection);
  return found == kFields.end() ? kNone : found->second;
}

std::vector<Property> properties_of(std::string_view collection, const std::string& body,
                                    Microseconds create_time, Microseconds update_time) {
  const std::unique_ptr<Message> message = new_resource(collection);
  if (!message || !message->ParseFromString(body)) return {};
  const auto& reflection = *message->GetReflection();
  std::vector<Property> out;
  for (const PropertyField& property : property_fields(collection)) {
    const FieldDescriptor* field = message->GetDescriptor()->FindFieldByName(property.key);
    switch (property.kind) {
      case PropertyKind::kTime:
        out.push_back({property.key, property.key == kCreateTime ? create_time : update_time});
        break;
      case PropertyKind::kNumber:
        add_number(*message, *field, out);
        break;
      case PropertyKind::kText:
        out.push_back({property.key, reflection.GetString(*message, field)});
        break;
      case PropertyKind::kFlag:  // only simulations have flags, and they have no rows of properties
        break;
      case PropertyKind::kEnum: {
        const auto* value =
            field->enum_type()->FindValueByNumber(reflection.GetEnumValue(*message, field));
        out.push_back({property.key, value == nullptr ? std::string() : short_name(*value)});
      }
    }
  }
  add_labels(*message, out);
  return out;
}

}  // namespace tribodyn::server
