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

  /// Writes all resources, or checks them with `validate_only`, and returns what was or would be
  /// written; with `names_alone` only the names. Throws Failure that lists every error with its
  /// place in the files.
  std::vector<ResourcePointer> send(Connection& connection, bool replace, bool validate_only,
                                    bool names_alone) const;

  /// Whether all of them might not fit into one answer, which takes at most 4 MB: they are more
  /// than 200, or take more than 1 MB. With what the server adds to a lubricant, 200 take 1 MB
  /// more.
  bool is_large() const;

  /// The errors, and the places in the files that are certainly valid.
  struct Verdict {
    std::vector<std::string> valid;
    std::vector<std::string> wrong;
  };
  /// Returns the result of an import with `replace`, without writing.
  Verdict check(Connection& connection) const;

 private:
  std::vector<ResourcePointer> write(Connection& connection, bool replace, bool validate_only,
                                     bool names_alone) const;
  Verdict verdict(const ServiceError& refusal) const;

  const ResourceKind& kind_;
  std::vector<FileResource> resources_;  ///< the first resource of each name
  std::vector<std::string> duplicates_;  ///< a complaint for each duplicate
};

}  // namespace tribodyn::client
