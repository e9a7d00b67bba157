#include "client/cpp/library/project_names.h"

#include <string_view>

#include "google/api/resource.pb.h"
#include "tribodyn/client/connection.h"

namespace tribodyn::client {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;

std::string prefix_of(const std::string& project) { return "projects/" + project + "/"; }

bool is_relative(std::string_view name) { return !name.empty() && !name.starts_with("projects/"); }

const FieldDescriptor* text_field(const Message& message, const char* name) {
  const FieldDescriptor* field = message.GetDescriptor()->FindFieldByName(name);
  return field != nullptr && field->type() == FieldDescriptor::TYPE_STRING ? field : nullptr;
}

bool is_resource(const FieldDescriptor& field) {
  return field.cpp_type() == FieldDescriptor::CPPTYPE_MESSAGE &&
         field.message_type()->options().HasExtension(google::api::resource);
}

/// Calls `change` with each of the names of a message: the fields "name" and "names".
template <class Change>
void change_names(Message& message, const Change& change) {
  const auto& reflection = *message.GetReflection();
  for (const char* key : {"name", "names"}) {
    const FieldDescriptor* field = text_field(message, key);
    if (field == nullptr) continue;
    if (field->is_repeated()) {
      for (int i = 0; i < reflection.FieldSize(message, field); ++i) {
        reflection.SetRepeatedString(&message, field, i,
                                     change(reflection.GetRepeatedString(message, field, i)));
      }
    } else {
      reflection.SetString(&message, field, change(reflection.GetString(message, field)));
    }
  }
}

/// Calls `visit` with each resource that is a field, or an element of a field, of the message.
template <class Visit>
void visit_resources(Message& message, const Visit& visit) {
  const auto& reflection = *message.GetReflection();
  for (int i = 0; i < message.GetDescriptor()->field_count(); ++i) {
    const FieldDescriptor& field = *message.GetDescriptor()->field(i);
    if (!is_resource(field) || field.containing_oneof() != nullptr) continue;
    if (field.is_repeated()) {
      for (int k = 0; k < reflection.FieldSize(message, &field); ++k) {
        visit(*reflection.MutableRepeatedMessage(&message, &field, k));
      }
    } else if (reflection.HasField(message, &field)) {
      visit(*reflection.MutableMessage(&message, &field));
    }
  }
}

}  // namespace

void add_project(const std::string& project, Message& request) {
  if (project == kDefaultProject) return;
  const auto& reflection = *request.GetReflection();
  if (const FieldDescriptor* parent = text_field(request, "parent")) {
    if (reflection.GetString(request, parent).empty()) {
      reflection.SetString(&request, parent, "projects/" + project);
    }
    return;
  }
  const auto with_project = [&](const std::string& name) {
    return is_relative(name) ? prefix_of(project) + name : name;
  };
  change_names(request, with_project);
  visit_resources(request, [&](Message& resource) { change_names(resource, with_project); });
}

ProjectAndName split_name(const std::string& project, const std::string& name) {
  constexpr std::string_view kPrefix = "projects/";
  const std::size_t end = is_relative(name) ? std::string::npos : name.find('/', kPrefix.size());
  if (end == std::string::npos) return {project, name};
  return {name.substr(kPrefix.size(), end - kPrefix.size()), name.substr(end + 1)};
}

void remove_project(const std::string& project, Message& response) {
  if (project == kDefaultProject) return;
  const std::string prefix = prefix_of(project);
  const auto relative = [&](const std::string& name) {
    if (name.starts_with(prefix)) return name.substr(prefix.size());
    // The server answers with short names of the project `default`.
    const bool is_of_default = is_relative(name) && name.find('/') != std::string::npos;
    return is_of_default ? prefix_of(kDefaultProject) + name : name;
  };
  change_names(response, relative);
  visit_resources(response, [&](Message& resource) { change_names(resource, relative); });
}

}  // namespace tribodyn::client
