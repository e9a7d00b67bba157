#include "tests/contract/breaking_changes.h"

#include <map>

namespace tribodyn {
namespace {

using google::protobuf::DescriptorProto;
using google::protobuf::EnumDescriptorProto;
using google::protobuf::FieldDescriptorProto;
using google::protobuf::FileDescriptorProto;
using google::protobuf::FileDescriptorSet;

constexpr char kReserved[] = "reserved";

/// What clients and stored bytes rely on: "tribodyn.v1.Label #1" -> "key, string".
using Facts = std::map<std::string, std::string>;

std::string cardinality(const FieldDescriptorProto& field) {
  if (field.label() == FieldDescriptorProto::LABEL_REPEATED) return "repeated ";
  return field.proto3_optional() ? "optional " : "";
}

std::string type_of(const FieldDescriptorProto& field) {
  return field.type_name().empty() ? FieldDescriptorProto::Type_Name(field.type())
                                   : field.type_name().substr(1);
}

/// Ends of ranges are exclusive in messages, inclusive in enums.
template <class Ranges>
void add_reserved_numbers(const Ranges& ranges, int past_end, const std::string& name, Facts& out) {
  for (const auto& range : ranges) {
    for (int i = range.start(); i < range.end() + past_end; ++i) {
      out.emplace(name + " #" + std::to_string(i), kReserved);
    }
  }
}

void add_enum(const EnumDescriptorProto& type, const std::string& scope, Facts& out) {
  const std::string name = scope + "." + type.name();
  out[name] = "enum";
  for (const auto& value : type.value()) {
    out[name + " #" + std::to_string(value.number())] = value.name();
  }
  add_reserved_numbers(type.reserved_range(), 1, name, out);
  for (const auto& reserved : type.reserved_name()) out[name + " " + reserved] = kReserved;
}

void add_message(const DescriptorProto& type, const std::string& scope, Facts& out) {
  const std::string name = scope + "." + type.name();
  out[name] = "message";
  for (const auto& field : type.field()) {
    std::string fact = field.name() + ", " + cardinality(field) + type_of(field);
    if (field.has_oneof_index() && !field.proto3_optional()) {
      fact += " in oneof " + type.oneof_decl(field.oneof_index()).name();
    }
    out[name + " #" + std::to_string(field.number())] = fact;
  }
  add_reserved_numbers(type.reserved_range(), 0, name, out);
  for (const auto& reserved : type.reserved_name()) out[name + " " + reserved] = kReserved;
  for (const auto& nested : type.nested_type()) add_message(nested, name, out);
  for (const auto& nested : type.enum_type()) add_enum(nested, name, out);
}

Facts facts_of(const FileDescriptorSet& set) {
  Facts out;
  for (const FileDescriptorProto& file : set.file()) {
    for (const auto& type : file.message_type()) add_message(type, file.package(), out);
    for (const auto& type : file.enum_type()) add_enum(type, file.package(), out);
    for (const auto& service : file.service()) {
      const std::string name = file.package() + "." + service.name();
      out[name] = "service";
      for (const auto& method : service.method()) {
        out[name + "/" + method.name()] =
            (method.client_streaming() ? "stream " : "") + method.input_type().substr(1) + " -> " +
            (method.server_streaming() ? "stream " : "") + method.output_type().substr(1);
      }
    }
  }
  return out;
}

/// Whether `now` reserves the name of the field or value that stood at `key`, as in "M #3".
bool reserves_name(const Facts& now, const std::string& key, const std::string& fact) {
  const std::string owner = key.substr(0, key.find(" #"));
  return now.contains(owner + " " + fact.substr(0, fact.find(',')));
}

}  // namespace

std::vector<std::string> breaking_changes(const FileDescriptorSet& before,
                                          const FileDescriptorSet& now) {
  const Facts now_facts = facts_of(now);
  std::vector<std::string> out;
  for (const auto& [key, fact] : facts_of(before)) {
    const auto found = now_facts.find(key);
    if (found == now_facts.end()) {
      out.push_back(key + " (" + fact + ") vanished");
    } else if (found->second == kReserved && fact != kReserved) {
      if (!reserves_name(now_facts, key, fact)) {
        out.push_back(key + " (" + fact + ") vanished and its name is not reserved");
      }
    } else if (found->second != fact) {
      out.push_back(key + " was \"" + fact + "\" and is \"" + found->second + "\"");
    }
  }
  return out;
}

}  // namespace tribodyn
