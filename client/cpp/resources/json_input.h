#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "client/cpp/resources/kind.h"

namespace tribodyn::client {

inline constexpr std::size_t kLargestFile = std::size_t{64} << 20U;
inline constexpr std::size_t kLargestTable = std::size_t{3}
                                             << 20U;  ///< the most that the server accepts

/// Returns the whole text of a file; "-" is standard input. Throws Failure.
std::string read_file(const std::string& path, std::size_t most_bytes = kLargestFile);

/// A resource that was read from a file, and its position there.
struct FileResource {
  const ResourceKind* kind;
  ResourcePointer resource;
  std::string origin;  ///< "fluids.json", "fluids.json, lubricants[2]", "fluids.csv row 3"
  std::vector<std::string> fields = {};  ///< fields that the file can set; empty: all
  /// For a row of a table: the headers as typed, by the names of their fields.
  std::map<std::string, std::string> columns = {};
};

/// Reads resources from a text in protobuf's JSON mapping (names in camelCase or as in the protos):
/// one resource, or an object with a list such as {"lubricants": [...]}, as `export` writes them.
/// The kind is `expected`; if that is null, it follows from the list's name, from "name" or from
/// the fields. Throws Failure (kExitUsage) that lists every unknown name with the nearest known
/// one.
std::vector<FileResource> read_resources(const std::string& text, const std::string& path,
                                         const ResourceKind* expected);

}  // namespace tribodyn::client
