#include "server/storage/wire_layout.h"

#include <map>

#include "proto/resource_kinds.h"
#include "tribodyn/v1/campaigns.pb.h"
#include "tribodyn/v1/results.pb.h"
#include "tribodyn/v1/simulations.pb.h"

namespace tribodyn::server {
namespace {

using google::protobuf::Descriptor;
using google::protobuf::EnumDescriptor;
using google::protobuf::FieldDescriptor;

/// The lines of each message and enum, by its full name.
using Layouts = std::map<std::string, std::string>;

void add(const EnumDescriptor& type, Layouts& layouts) {
  std::string& lines = layouts[type.full_name()];
  lines.clear();
  for (int i = 0; i < type.value_count(); ++i) {
    lines += std::to_string(type.value(i)->number()) + " " + type.value(i)->name() + "\n";
  }
}

std::string line_of(const FieldDescriptor& field) {
  std::string out = std::to_string(field.number()) + " " + field.name() + " " + field.type_name();
  if (const Descriptor* message = field.message_type()) out += " " + message->full_name();
  if (const EnumDescriptor* type = field.enum_type()) out += " " + type->full_name();
  if (field.is_repeated()) out += " repeated";
  if (field.is_packed()) out += " packed";
  if (field.has_presence()) out += " with presence";
  if (const auto* one_of = field.real_containing_oneof()) out += " in " + one_of->name();
  return out + "\n";
}

void add(const Descriptor& message, Layouts& layouts) {
  if (layouts.contains(message.full_name())) return;
  layouts[message.full_name()];  // a message may contain itself
  std::map<int, std::string> lines;
  for (int i = 0; i < message.field_count(); ++i) {
    const FieldDescriptor& field = *message.field(i);
    lines[field.number()] = line_of(field);
    if (field.message_type() != nullptr) add(*field.message_type(), layouts);
    if (field.enum_type() != nullptr) add(*field.enum_type(), layouts);
  }
  for (const auto& [number, line] : lines) layouts[message.full_name()] += line;
}

}  // namespace

std::vector<const Descriptor*> stored_messages() {
  std::vector<const Descriptor*> out = {
      v1::Simulation::descriptor(), v1::SimulationResult::descriptor(), v1::Campaign::descriptor()};
#define TRIBODYN_ADD(Resource, field, kind, seed) out.push_back(v1::Resource::descriptor());
  TRIBODYN_RESOURCE_KINDS(TRIBODYN_ADD)
#undef TRIBODYN_ADD
  return out;
}

std::string wire_layout(const std::vector<const Descriptor*>& messages) {
  Layouts layouts;
  for (const Descriptor* message : messages) add(*message, layouts);
  std::string out;
  for (const auto& [name, lines] : layouts) out += name + "\n" + lines;
  return out;
}

}  // namespace tribodyn::server
