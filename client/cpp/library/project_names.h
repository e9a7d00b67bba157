#pragma once

#include <google/protobuf/message.h>

#include <string>

namespace tribodyn::client {

/// States the project in a request: as its parent, or else in the relative names that it is about.
/// A name with a project keeps it. A request of the project `default` stays as it is.
void add_project(const std::string& project, google::protobuf::Message& request);

/// A name in two parts.
struct ProjectAndName {
  std::string project;
  std::string relative;  ///< "lubricants/x"
};
/// Splits a name; one without a project belongs to `project`.
ProjectAndName split_name(const std::string& project, const std::string& name);

/// Removes the project from the names of the resources of an answer, so that they are relative to
/// the project of the connection. A name of another project keeps it; one of the project `default`,
/// which the server answers without it, gets it.
void remove_project(const std::string& project, google::protobuf::Message& response);

}  // namespace tribodyn::client
