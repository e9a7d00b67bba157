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
inline constexpr char kCampaigns[] = "campaigns";

// Projects. The full name of a resource is "projects/{project}/lubricants/{id}". The project
// `default` is the exception: the full name of its resource is the relative name,
// "lubricants/{id}". So each resource has one full name.
//
// A client may state a full name, "projects/default/lubricants/{id}" or a relative name. The parent
// or the name that a request is about gives the project of the request; a relative name alone gives
// `default`. Within the request, every relative name means a resource of that project, and a name
// of another project is a violation: no resource refers to another project. Stored bodies,
// references and error texts have relative names; the names of answered resources are full names.
//
// application/request_project.h brings a request into this form. Behind it, names are relative and
// CallContext::project says of which project.

inline constexpr char kDefaultProject[] = "default";
inline constexpr char kProjects[] = "projects";

inline constexpr char kDefaultGearSet[] = "gearSets/reference-axle";
inline constexpr char kDefaultSurface[] = "surfaces/run-in";
inline constexpr char kDefaultVehicle[] = "vehicles/passenger-car";

/// A name with or without a revision: "lubricants/paper-fluid-1" or "lubricants/paper-fluid-1@2".
struct RevisionName {
  std::string name;
  int revision = 0;  ///< 0: the latest revision
};

/// One stored revision of a resource.
struct FoundResource {
  int revision = 0;
  bool is_deleted = false;
  std::string body;  ///< serialised message
};

/// Results of following `derived_from`, kept during one request.
struct KnownChains {
  std::set<std::string> in_no_cycle;  ///< names that do not descend from themselves
  std::set<std::string> in_cycle;     ///< names that descend from themselves
};

/// Finds named resources: in the store, or in a map of a test.
struct ResourceLookup {
  /// Returns the named revision, or nullopt if it does not exist.
  std::function<std::optional<FoundResource>(const RevisionName& name)> find;
  /// Returns the names of all resources of a collection that are not deleted, sorted.
  std::function<std::vector<std::string>(const std::string& collection)> names;
  /// All resources of a batch share it, so that each step of a chain is read once.
  std::shared_ptr<KnownChains> chains = std::make_shared<KnownChains>();
};

/// Returns true for 1 to 63 lower-case letters, digits and '-' that begin with a letter and do not
/// end with '-'.
bool is_project_id(std::string_view id);

/// A name in two parts; both are part of the split text or kDefaultProject.
struct ProjectAndName {
  std::string_view project;
  std::string_view relative;  ///< "lubricants/x"; empty for the name of a project
};
/// Splits a full or a relative name. Returns nullopt for a name that begins with "projects/" but
/// not with a project.
std::optional<ProjectAndName> split_name(std::string_view name);

/// Returns "projects/acme/lubricants/x" for "acme" and "lubricants/x"; the relative name for the
/// project `default`.
std::string full_name(std::string_view project, std::string_view relative);
/// Returns the full name of what a client calls `name` within a project, e.g.
/// "projects/acme/lubricants/x" for "lubricants/x" within "acme". A name with a project keeps it.
std::string name_in(std::string_view project, std::string_view name);
/// Returns "lubricants/x" for "projects/acme/lubricants/x" and for "lubricants/x".
std::string relative_name(std::string_view name);

/// Returns true for "collection/id" whose id is not empty and consists of letters, digits, '-', '_'
/// and '.'.
bool is_resource_name(std::string_view name, std::string_view collection);

/// Returns an allowed id that resembles a text: "Mobil-1" for "Mobil 1". Empty if no character of
/// the text is allowed.
std::string allowed_id(std::string_view text);

/// Parses "collection/id" or "collection/id@revision". Returns nullopt if `name` has another form.
std::optional<RevisionName> parse_revision_name(std::string_view name, std::string_view collection);
/// Returns the name with its revision, e.g. "lubricants/paper-fluid-1@2".
std::string revision_name(std::string_view name, int revision);

/// Returns the number in "simulations/{id}", or nullopt if `name` has another form.
std::optional<std::int64_t> simulation_id(std::string_view name);
/// Returns the full name of a simulation. Each project numbers its simulations from 1.
std::string simulation_name(std::string_view project, std::int64_t number);
/// Returns the number in "campaigns/{id}", or nullopt if `name` has another form.
std::optional<std::int64_t> campaign_id(std::string_view name);
/// Returns the full name of a campaign. Each project numbers its campaigns from 1.
std::string campaign_name(std::string_view project, std::int64_t number);

/// Returns the first 60 bytes of a client's text with '?' for each byte that is not printable
/// ASCII.
std::string plain_excerpt(std::string_view text);

/// Returns the name of `existing` that `name` is most likely a misspelling of, by edit distance to
/// the whole name or to a prefix of it (a name without its unit). Empty if no name is near.
std::string nearest_name(std::string_view name, const std::vector<std::string>& existing);

/// Returns "; did you mean \"lims_id\"?", or "; allowed: " and all of `known` if no name is near.
std::string meant_text(std::string_view name, const std::vector<std::string>& known);

/// Returns "lubricants/7 does not exist; did you mean lubricants/paper-fluid-1?", or the required
/// form of a name.
std::string unknown_name_text(std::string_view name, std::string_view collection,
                              const std::vector<std::string>& existing);

/// Returns "lubricants/paper-fluid-1 is deleted; undelete it to use it".
std::string deleted_name_text(std::string_view name);

/// A resource and the name of its revision.
template <class Resource>
struct NamedResource {
  std::shared_ptr<const Resource> resource;  ///< shared by all recent callers
  std::string revision_name;
};

/// Parses a stored body. Returns null if the body cannot be parsed. A cache holds recent messages:
/// thousands of simulations use the same few resources, and parsing a gear set takes longer than
/// solving a point.
template <class Resource>
std::shared_ptr<const Resource> parse_resource(const std::string& body) {
  static LruCache<std::string, std::shared_ptr<const Resource>> cache;
  return cache.get(body, [&body]() -> std::shared_ptr<const Resource> {
    auto resource = std::make_shared<Resource>();
    return resource->ParseFromString(body) ? resource : nullptr;
  });
}

/// Returns the named resource. Adds a violation at `path` and returns nullopt if it does not exist
/// or is deleted.
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
        violations.add(path, deleted_name_text(parsed->name));
        return std::nullopt;
      }
      out.revision_name = revision_name(parsed->name, found->revision);
      out.resource = parse_resource<Resource>(found->body);
      if (out.resource) return out;
    }
  }
  violations.add(path, unknown_name_text(name, collection, lookup.names(collection)));
  return std::nullopt;
}

}  // namespace tribodyn::server
