#pragma once

#include <string>
#include <vector>

#include "client/cpp/resources/json_input.h"
#include "client/cpp/text/progress.h"

namespace tribodyn::client {

/// "my-oil" of "fluids/my oil.csv": the id of what a file holds, if it does not say.
std::string id_of_file(const std::string& path);

/// Resources of one kind on their way from files to the server, all or none.
class JsonImport {
 public:
  /// `id` is that of a single resource; empty: the name in the file, else the file's own. Puts what
  /// others are derived from before them. Throws Failure when two have the same name.
  JsonImport(const ResourceKind& kind, std::vector<FileResource> resources, const std::string& id);

  /// Has the server check every one and returns what they would be. Throws Failure with all
  /// refusals.
  std::vector<ResourcePointer> check(Connection& connection, bool replace,
                                     ProgressDisplay& progress) const;
  std::vector<ResourcePointer> write(Connection& connection, bool replace,
                                     ProgressDisplay& progress) const;

 private:
  ResourcePointer send(Connection& connection, const google::protobuf::Message& resource,
                       const std::vector<std::string>& fields, bool replace,
                       bool validate_only) const;

  const ResourceKind& kind_;
  std::vector<FileResource> resources_;
};

}  // namespace tribodyn::client
