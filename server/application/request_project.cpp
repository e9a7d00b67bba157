#include "server/application/request_project.h"

#include <fmt/format.h>

#include <optional>
#include <string>
#include <vector>

#include "google/api/resource.pb.h"
#include "server/application/errors.h"
#include "server/contract/check_message.h"
#include "server/contract/resource_names.h"

namespace tribodyn::server {
namespace {

using google::protobuf::Descriptor;
using google::protobuf::FieldDescriptor;
using google::protobuf::Message;

constexpr char kAllowedProjectIds[] =
    "; allowed for a project: 1 to 63 lower-case letters, digits and '-', first a letter and last "
    "no '-'";

/// A text in a request that names a resource.
struct Name {
  Message* message;
  const FieldDescriptor* field;
  int index;  ///< of a repeated field; -1 for others
  std::string path;
  bool is_subject;  ///< the request is about this resource; others it only refers to

  const std::string& text(std::string& scratch) const {
    const auto& reflection = *message->GetReflection();
    return index < 0 ? reflection.GetStringReference(*message, field, &scratch)
                     : reflection.GetRepeatedStringReference(*message, field, index, &scratch);
  }
  void set(std::string text) const {
    const auto& reflection = *message->GetReflection();
    if (index < 0) {
      reflection.SetString(message, field, std::move(text));
    } else {
      reflection.SetRepeatedString(message, field, index, std::move(text));
    }
  }
};

bool is_resource(const Descriptor& type) {
  return type.options().HasExtension(google::api::resource);
}

bool is_parent(const FieldDescriptor& field) { return field.name() == "parent"; }

/// "name" of a request or of a resource, and "names" of a request.
bool is_subject(const FieldDescriptor& field) {
  return field.name() == "name" || field.name() == "names";
}

bool holds_name(const FieldDescriptor& field) {
  return field.cpp_type() == FieldDescriptor::CPPTYPE_STRING &&
         field.type() == FieldDescriptor::TYPE_STRING &&
         (is_subject(field) || is_parent(field) ||
          field.options().HasExtension(google::api::resource_reference));
}

void find_names(Message& message, const std::string& path, bool is_resource_of_request,
                std::vector<Name>& names);

/// Names stand in the request, in its resource and in the single requests of a batch. A resource in
/// a oneof only brings parameters; its name means nothing.
void find_names_below(Message& message, const FieldDescriptor& field, const std::string& path,
                      std::vector<Name>& names) {
  const auto& reflection = *message.GetReflection();
  const bool is_request = field.is_repeated() && field.name() == "requests";
  const bool is_of_request = !field.is_repeated() && is_resource(*field.message_type()) &&
                             field.containing_oneof() == nullptr;
  if (is_request) {
    for (int i = 0; i < reflection.FieldSize(message, &field); ++i) {
      find_names(*reflection.MutableRepeatedMessage(&message, &field, i),
                 fmt::format("{}[{}]", path, i), false, names);
    }
  } else if (is_of_request && reflection.HasField(message, &field)) {
    find_names(*reflection.MutableMessage(&message, &field), path, true, names);
  }
}

void find_names(Message& message, const std::string& path, bool is_resource_of_request,
                std::vector<Name>& names) {
  const Descriptor& type = *message.GetDescriptor();
  const auto& reflection = *message.GetReflection();
  for (int i = 0; i < type.field_count(); ++i) {
    const FieldDescriptor& field = *type.field(i);
    if (field.cpp_type() == FieldDescriptor::CPPTYPE_MESSAGE) {
      if (!is_resource_of_request) {
        find_names_below(message, field, join_path(path, field.name()), names);
      }
    } else if (holds_name(field)) {
      const int count = field.is_repeated() ? reflection.FieldSize(message, &field)
                                            : (reflection.HasField(message, &field) ? 1 : 0);
      for (int k = 0; k < count; ++k) {
        names.push_back({&message, &field, field.is_repeated() ? k : -1,
                         field.is_repeated()
                             ? fmt::format("{}[{}]", join_path(path, field.name()), k)
                             : join_path(path, field.name()),
                         is_subject(field)});
      }
    }
  }
}

/// True if a request of the type may hold a name, and so is about a project.
bool takes_names(const Descriptor& type) {
  for (int i = 0; i < type.field_count(); ++i) {
    const FieldDescriptor& field = *type.field(i);
    if (holds_name(field)) return true;
    if (field.cpp_type() == FieldDescriptor::CPPTYPE_MESSAGE &&
        is_resource(*field.message_type()) && field.containing_oneof() == nullptr) {
      return true;
    }
  }
  return false;
}

/// The project in "projects/{project}"; nullopt if the text has another form.
std::optional<std::string> project_of_parent(const std::string& text) {
  const auto parts = split_name(text);
  if (!parts || text != fmt::format("{}/{}", kProjects, parts->project)) return std::nullopt;
  return std::string(parts->project);
}

/// The first project that a parent, or else a subject states.
std::string stated_project(const std::vector<Name>& names, Violations& violations) {
  std::optional<std::string> of_parent, of_subject;
  std::string scratch;
  for (const Name& each : names) {
    const std::string& text = each.text(scratch);
    if (is_parent(*each.field)) {
      const auto project = project_of_parent(text);
      if (!project) {
        violations.add(each.path, "\"{}\" is not a name of the form \"projects/{{project}}\"{}",
                       plain_excerpt(text), kAllowedProjectIds);
      } else if (!of_parent) {
        of_parent = project;
      }
    } else if (each.is_subject && !of_subject && text.starts_with("projects/")) {
      if (const auto parts = split_name(text)) of_subject = std::string(parts->project);
    }
  }
  if (of_parent) return *of_parent;
  return of_subject.value_or(kDefaultProject);
}

}  // namespace

std::string take_project(Message& request, Violations& violations) {
  std::vector<Name> names;
  find_names(request, "", false, names);
  std::string project = stated_project(names, violations);
  std::string scratch;
  for (const Name& each : names) {
    const std::string& text = each.text(scratch);
    if (!text.starts_with("projects/")) continue;
    const auto parts = split_name(text);
    if (!parts) {
      if (!is_parent(*each.field)) {
        violations.add(each.path, "\"{}\" has no project behind \"projects/\"{}",
                       plain_excerpt(text), kAllowedProjectIds);
      }
      continue;
    }
    if (parts->project != project) {
      violations.add(each.path,
                     "\"{}\" belongs to another project; allowed: names of "
                     "projects/{}, which is the project of this request",
                     plain_excerpt(text), project);
    } else if (!is_parent(*each.field)) {
      each.set(std::string(parts->relative));
    }
  }
  return project;
}

std::optional<google::rpc::Status> enter_project(Application& application, Message& request,
                                                 CallContext& context) {
  Violations violations;
  context.project = take_project(request, violations);
  if (!context.grant->covers(context.project) && takes_names(*request.GetDescriptor())) {
    return project_not_granted(context.project);
  }
  if (!violations.empty()) return invalid(violations);
  if (application.store.has_project(context.project)) return std::nullopt;
  const std::string name = fmt::format("{}/{}", kProjects, context.project);
  return not_found("tribodyn.v1.Project", name, name + " does not exist");
}

}  // namespace tribodyn::server
