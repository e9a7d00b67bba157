#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "client/cpp/resources/kind.h"

namespace tribodyn::client {

inline constexpr std::size_t kLargestFile = std::size_t{64} << 20U;
inline constexpr std::size_t kLargestTable = std::size_t{3} << 20U;  ///< that a server takes

/// The whole text of a file; "-" is standard input. Throws Failure.
std::string read_file(const std::string& path, std::size_t most_bytes = kLargestFile);

/// A resource as read from a file, and where it stands in it.
struct FileResource {
  const ResourceKind* kind;
  ResourcePointer resource;
  std::string origin;  ///< "fluids.json", "fluids.json, lubricants[2]", "fluids.csv row 3"
  std::vector<std::string> fields = {};  ///< that it can tell of; empty: all
  /// Of the table whose row it is: by the name of the field, the header as it was typed.
  std::map<std::string, std::string> columns = {};
};

/// The resources of a JSON text in the protos' JSON form (names in camelCase or as in the protos):
/// one, or an object with a list such as {"lubricants": [...]}, as `export` writes them. The kind
/// is `expected`, or if that is null follows from the list's name, from "name" or from the fields.
/// Throws Failure (kExitUsage) with every unknown name and the one that may be meant.
std::vector<FileResource> read_resources(const std::string& text, const std::string& path,
                                         const ResourceKind* expected);

}  // namespace tribodyn::client
