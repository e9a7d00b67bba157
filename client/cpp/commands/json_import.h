#pragma once

#include <string>
#include <vector>

#include "client/cpp/resources/json_input.h"

namespace tribodyn::client {

/// Returns the id for the content of a file without an id, e.g. "my-oil" for "fluids/my oil.csv".
std::string id_of_file(const std::string& path);

/// Resources of one kind that were read from files. An import writes all of them or none.
class JsonImport {
 public:
  /// `id` is the id of a single resource; empty: the name in the file, else the file's own name.
  /// send() and check() reject two resources of the same name, together with all other errors.
  JsonImport(const ResourceKind& kind, std::vector<FileResource> resources, const std::string& id);

  /// Writes all resources, or returns what would be written with `validate_only`. Throws Failure
  /// that lists every error with its place in the files.
  BatchWritten send(Connection& connection, bool replace, bool validate_only) const;

  /// The errors, and the places in the files that are certainly valid.
  struct Verdict {
    std::vector<std::string> valid;
    std::vector<std::string> wrong;
  };
  /// Returns the result of an import with `replace`, without writing.
  Verdict check(Connection& connection) const;

 private:
  BatchWritten write(Connection& connection, bool replace, bool validate_only) const;
  Verdict verdict(const ServiceError& refusal) const;

  const ResourceKind& kind_;
  std::vector<FileResource> resources_;  ///< the first resource of each name
  std::vector<std::string> duplicates_;  ///< a complaint for each duplicate
};

}  // namespace tribodyn::client
