#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "server/convert/violations.h"

namespace tribodyn::server {

inline constexpr char kLubricants[] = "lubricants";
inline constexpr char kGearSets[] = "gearSets";
inline constexpr char kSurfaces[] = "surfaces";
inline constexpr char kVehicles[] = "vehicles";
inline constexpr char kSimulations[] = "simulations";

inline constexpr char kDefaultGearSet[] = "gearSets/A";
inline constexpr char kDefaultSurface[] = "surfaces/run-in";
inline constexpr char kDefaultVehicle[] = "vehicles/passenger-car";

/// Where named resources come from: the store, or a map in a test.
struct ResourceLookup {
  /// The serialised message of "collection/id", if there is one.
  std::function<std::optional<std::string>(const std::string& name)> body;
  /// All names of a collection, sorted.
  std::function<std::vector<std::string>(const std::string& collection)> names;
};

/// True for "collection/id" with a non-empty id of letters, digits, '-', '_' and '.'.
bool is_resource_name(std::string_view name, std::string_view collection);

/// The number behind "simulations/{id}", or nothing when it is not such a name.
std::optional<std::int64_t> simulation_id(std::string_view name);
std::string simulation_name(std::int64_t id);

/// The name among `existing` with the fewest edits from `name`; empty when there is none.
std::string nearest_name(std::string_view name, const std::vector<std::string>& existing);

/// "lubricants/7 does not exist; did you mean lubricants/1?", or what a name must look like.
std::string unknown_name_text(std::string_view name, std::string_view collection,
                              const std::vector<std::string>& existing);

/// The resource of that name; a violation at `path` and nothing when there is none.
template <class Resource>
std::optional<Resource> find_resource(const ResourceLookup& lookup, const std::string& name,
                                      const std::string& collection, const std::string& path,
                                      Violations& violations) {
  if (is_resource_name(name, collection)) {
    if (const auto body = lookup.body(name)) {
      Resource resource;
      if (resource.ParseFromString(*body)) return resource;
    }
  }
  violations.push_back({path, unknown_name_text(name, collection, lookup.names(collection))});
  return std::nullopt;
}

}  // namespace tribodyn::server
