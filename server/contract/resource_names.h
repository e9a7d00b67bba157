#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "server/contract/violations.h"
#include "server/support/lru_cache.h"

namespace tribodyn::server {

inline constexpr char kLubricants[] = "lubricants";
inline constexpr char kGearSets[] = "gearSets";
inline constexpr char kSurfaces[] = "surfaces";
inline constexpr char kVehicles[] = "vehicles";
inline constexpr char kSimulations[] = "simulations";

inline constexpr char kDefaultGearSet[] = "gearSets/A";
inline constexpr char kDefaultSurface[] = "surfaces/run-in";
inline constexpr char kDefaultVehicle[] = "vehicles/passenger-car";

/// "lubricants/1" or "lubricants/1@2".
struct RevisionName {
  std::string name;
  int revision = 0;  ///< 0: the newest
};

/// One revision of a resource.
struct FoundResource {
  int revision = 0;
  bool is_deleted = false;
  std::string body;  ///< serialised message
};

/// What is known of chains of derived_from while one request looks at the store.
struct KnownChains {
  std::set<std::string> in_no_ring;  ///< names that are known not to descend from themselves
  std::set<std::string> in_ring;     ///< names that do
};

/// Where named resources come from: the store, or a map in a test.
struct ResourceLookup {
  std::function<std::optional<FoundResource>(const RevisionName& name)> find;
  /// All names of a collection that are not deleted, sorted.
  std::function<std::vector<std::string>(const std::string& collection)> names;
  /// Shared by the resources of a batch, whose chains would else be followed from each of them.
  std::shared_ptr<KnownChains> chains = std::make_shared<KnownChains>();
};

/// True for "collection/id" with a non-empty id of letters, digits, '-', '_' and '.'.
bool is_resource_name(std::string_view name, std::string_view collection);

/// "collection/id" or "collection/id@revision", or nothing when it is neither.
std::optional<RevisionName> parse_revision_name(std::string_view name, std::string_view collection);
/// "lubricants/1@2".
std::string revision_name(std::string_view name, int revision);

/// The number behind "simulations/{id}", or nothing when it is not such a name.
std::optional<std::int64_t> simulation_id(std::string_view name);
std::string simulation_name(std::int64_t id);

/// The start of a client's text as plain ASCII: never half a UTF-8 character, never a control code.
std::string plain_excerpt(std::string_view text);

/// Which of `existing` may be meant by `name`: the one with the fewest edits from it, its end (the
/// unit of a field) left out where that helps. Empty when none is near.
std::string nearest_name(std::string_view name, const std::vector<std::string>& existing);

/// "; did you mean \"lims_id\"?", or where nothing is near "; allowed: " and all of `known`.
std::string meant_text(std::string_view name, const std::vector<std::string>& known);

/// "lubricants/7 does not exist; did you mean lubricants/1?", or what a name must look like.
std::string unknown_name_text(std::string_view name, std::string_view collection,
                              const std::vector<std::string>& existing);

/// "lubricants/1 is deleted; undelete it to use it".
std::string deleted_name_text(std::string_view name);

/// A resource, and which revision of it this is.
template <class Resource>
struct NamedResource {
  std::shared_ptr<const Resource> resource;  ///< shared with others who asked for it lately
  std::string revision_name;
};

/// The message of a stored body; null when it is none. Thousands of simulations rest on the same
/// few, and parsing them takes longer than solving a point.
template <class Resource>
std::shared_ptr<const Resource> parse_resource(const std::string& body) {
  static LruCache<std::string, std::shared_ptr<const Resource>> kept;
  return kept.get(body, [&body]() -> std::shared_ptr<const Resource> {
    auto resource = std::make_shared<Resource>();
    return resource->ParseFromString(body) ? resource : nullptr;
  });
}

/// The resource of that name; a violation at `path` and nothing when there is none or it is
/// deleted.
template <class Resource>
std::optional<NamedResource<Resource>> find_resource(const ResourceLookup& lookup,
                                                     const std::string& name,
                                                     const std::string& collection,
                                                     const std::string& path,
                                                     Violations& violations) {
  if (const auto parsed = parse_revision_name(name, collection)) {
    if (const auto found = lookup.find(*parsed)) {
      NamedResource<Resource> out;
      if (found->is_deleted) {
        violations.push_back({path, deleted_name_text(parsed->name)});
        return std::nullopt;
      }
      out.revision_name = revision_name(parsed->name, found->revision);
      out.resource = parse_resource<Resource>(found->body);
      if (out.resource) return out;
    }
  }
  violations.push_back({path, unknown_name_text(name, collection, lookup.names(collection))});
  return std::nullopt;
}

}  // namespace tribodyn::server
