#pragma once

#include <string>
#include <vector>

#include "client/cpp/resources/json_input.h"

namespace tribodyn::client {

/// "my-oil" of "fluids/my oil.csv": the id of what a file holds, if it does not say.
std::string id_of_file(const std::string& path);

/// Resources of one kind on their way from files to the server, all or none.
class JsonImport {
 public:
  /// `id` is that of a single resource; empty: the name in the file, else the file's own. Two of
  /// the same name are refused by send() and check(), together with what else is wrong.
  JsonImport(const ResourceKind& kind, std::vector<FileResource> resources, const std::string& id);

  /// Has the server write all of them, or with `validate_only` say what they would be. Throws
  /// Failure with everything that is wrong, each with its place in the files.
  BatchWritten send(Connection& connection, bool replace, bool validate_only) const;

  /// What is found wrong, and which places in the files are known to be right.
  struct Verdict {
    std::vector<std::string> valid;
    std::vector<std::string> wrong;
  };
  /// What an import with `replace` would say.
  Verdict check(Connection& connection) const;

 private:
  BatchWritten write(Connection& connection, bool replace, bool validate_only) const;
  Verdict verdict(const ServiceError& refusal) const;

  const ResourceKind& kind_;
  std::vector<FileResource> resources_;  ///< the first of each name
  std::vector<std::string> duplicates_;  ///< a complaint for each duplicate
};

}  // namespace tribodyn::client
