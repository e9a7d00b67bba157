#include "client/cpp/resources/json_input.h"

#include <google/protobuf/descriptor.h>
#include <google/protobuf/struct.pb.h>
#include <google/protobuf/util/json_util.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iostream>
#include <iterator>
#include <map>

#include "client/cpp/failure.h"
#include "client/cpp/text/nearest.h"
#include "client/cpp/text/text.h"

namespace tribodyn::client {
namespace {

using google::protobuf::Descriptor;
using google::protobuf::FieldDescriptor;
using google::protobuf::Struct;
using google::protobuf::Value;

std::string path_below(const std::string& path, const std::string& name) {
  return path.empty() ? name : path + "." + name;
}

const FieldDescriptor* find_field(const Descriptor& type, const std::string& name) {
  const FieldDescriptor* field = type.FindFieldByName(name);
  for (int i = 0; field == nullptr && i < type.field_count(); ++i) {
    if (type.field(i)->json_name() == name) field = type.field(i);
  }
  return field;
}

/// Adds every name in the text that is not a field of its message.
void find_unknown(const Struct& object, const Descriptor& type, const std::string& path,
                  std::vector<std::string>& complaints) {
  const auto check_below = [&](const Value& value, const FieldDescriptor& field,
                               const std::string& below) {
    const bool is_message = field.cpp_type() == FieldDescriptor::CPPTYPE_MESSAGE &&
                            field.message_type()->file()->package() == type.file()->package();
    if (is_message && value.has_struct_value()) {
      find_unknown(value.struct_value(), *field.message_type(), below, complaints);
    }
  };
  // Sorted, because the order of a protobuf map changes from run to run.
  const std::map<std::string, Value> fields(object.fields().begin(), object.fields().end());
  for (const auto& [name, value] : fields) {
    const std::string here = path_below(path, name);
    const FieldDescriptor* field = find_field(type, name);
    if (field == nullptr) {
      std::vector<std::string> known;
      const bool camel = name.find('_') == std::string::npos;
      for (int i = 0; i < type.field_count(); ++i) {
        known.push_back(camel ? type.field(i)->json_name() : type.field(i)->name());
      }
      const std::string meant = nearest(name, known);
      complaints.push_back(printable(here) + " is not a field of " + type.name() +
                           (meant.empty() ? "" : " (is " + meant + " meant?)"));
    } else if (field->is_repeated() && value.has_list_value()) {
      for (int i = 0; i < value.list_value().values_size(); ++i) {
        check_below(value.list_value().values(i), *field, here + "[" + std::to_string(i) + "]");
      }
    } else {
      check_below(value, *field, here);
    }
  }
}

[[noreturn]] void refuse(const std::string& path, const std::vector<std::string>& complaints) {
  std::string text = path + ":";
  for (const std::string& complaint : complaints) {
    text += (complaints.size() == 1 ? " " : "\n  ") + complaint;
  }
  throw Failure(kExitUsage, text);
}

/// Returns the only kind that has the fields of the object; null if there is none or more than one.
const ResourceKind* kind_by_fields(const Struct& object) {
  const ResourceKind* best = nullptr;
  int most = 0;
  bool tie = false;
  for (const ResourceKind& kind : resource_kinds()) {
    int known = 0;
    for (const auto& [name, value] : object.fields()) {
      if (find_field(*kind.prototype->GetDescriptor(), name) != nullptr) ++known;
    }
    if (known == most) tie = true;
    if (known > most) {
      most = known;
      best = &kind;
      tie = false;
    }
  }
  return tie ? nullptr : best;
}

const ResourceKind* kind_of_object(const Struct& object) {
  const auto name = object.fields().find("name");
  if (name != object.fields().end()) {
    for (const ResourceKind& kind : resource_kinds()) {
      if (name->second.string_value().rfind(kind.collection + "/", 0) == 0) return &kind;
    }
  }
  return kind_by_fields(object);
}

FileResource read_one(const Struct& object, const ResourceKind* expected,
                      const std::string& origin) {
  const ResourceKind* kind = expected != nullptr ? expected : kind_of_object(object);
  if (kind == nullptr) {
    refuse(origin, {"the kind of resource is unclear; give it a name, e.g. "
                    "\"name\": \"lubricants/my-oil\""});
  }
  std::vector<std::string> complaints;
  find_unknown(object, *kind->prototype->GetDescriptor(), "", complaints);
  if (!complaints.empty()) refuse(origin, complaints);
  return {kind, kind->make(), origin};
}

void parse_into(const std::string& text, FileResource& target) {
  const auto status = google::protobuf::util::JsonStringToMessage(text, target.resource.get());
  if (!status.ok()) refuse(target.origin, {printable(status.message().ToString())});
}

/// Returns the list in the object and sets `kind`; null if the object holds no list.
const google::protobuf::ListValue* list_in(const Struct& object, const ResourceKind*& kind) {
  for (const ResourceKind& each : resource_kinds()) {
    if (kind != nullptr && kind != &each) continue;
    for (const std::string& name : {each.list_field, each.collection}) {
      const auto found = object.fields().find(name);
      if (found == object.fields().end() || !found->second.has_list_value()) continue;
      kind = &each;
      return &found->second.list_value();
    }
  }
  return nullptr;
}

}  // namespace

std::string read_file(const std::string& path, std::size_t most_bytes) {
  std::ifstream file;
  if (path != "-") {
    file.open(path, std::ios::binary);
    if (!file) throw Failure(kExitUsage, "cannot read " + path + ": " + std::strerror(errno));
  }
  std::istream& in = path == "-" ? std::cin : file;
  std::string text;
  std::array<char, 65536> buffer;
  while (in.read(buffer.data(), buffer.size()) || in.gcount() > 0) {
    text.append(buffer.data(), static_cast<std::size_t>(in.gcount()));
    if (text.size() > most_bytes) {
      throw Failure(kExitUsage,
                    path + " is larger than " + std::to_string(most_bytes >> 20U) + " MiB");
    }
  }
  if (in.bad()) throw Failure(kExitUsage, "cannot read " + path + ": " + std::strerror(errno));
  return text;
}

std::vector<FileResource> read_resources(const std::string& text, const std::string& path,
                                         const ResourceKind* expected) {
  Struct object;
  const auto status = google::protobuf::util::JsonStringToMessage(text, &object);
  if (!status.ok()) refuse(path, {"not a JSON object: " + printable(status.message().ToString())});
  std::vector<FileResource> resources;
  const ResourceKind* kind = expected;
  const auto* list = list_in(object, kind);
  if (list == nullptr) {
    resources.push_back(read_one(object, expected, path));
    parse_into(text, resources.back());
    return resources;
  }
  for (int i = 0; i < list->values_size(); ++i) {
    const std::string origin = path + ", " + kind->list_field + "[" + std::to_string(i) + "]";
    if (!list->values(i).has_struct_value()) refuse(origin, {"not a JSON object"});
    resources.push_back(read_one(list->values(i).struct_value(), kind, origin));
    // Struct keeps doubles exactly, as does the text that is written from it.
    std::string part;
    const auto written =
        google::protobuf::util::MessageToJsonString(list->values(i).struct_value(), &part);
    if (!written.ok()) refuse(origin, {printable(written.message().ToString())});
    parse_into(part, resources.back());
  }
  return resources;
}

}  // namespace tribodyn::client
