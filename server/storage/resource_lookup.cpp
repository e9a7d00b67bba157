#include "server/storage/resource_lookup.h"

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace tribodyn::server {

ResourceLookup resource_lookup(Store& store, const std::string& project, const CallLimits& limits) {
  return {[&store, project, limits](const RevisionName& name) -> std::optional<FoundResource> {
            const std::string full = full_name(project, name.name);
            auto found = name.revision == 0 ? store.resource(full, limits)
                                            : store.revision(full, name.revision, limits);
            if (!found) return std::nullopt;
            return FoundResource{found->revision, found->delete_time.has_value(),
                                 std::move(found->body)};
          },
          [&store, project, limits](const std::string& collection) {
            return store.resource_names(project, collection, limits);
          }};
}

ResourceLookup accepted_lookup(Store& store, const std::string& project,
                               const ResourceRevisions& revisions) {
  ResourceLookup out = resource_lookup(store, project);
  std::vector<RevisionName> accepted;
  for (const std::string* each : revisions.all()) {
    const std::string_view collection = std::string_view(*each).substr(0, each->find('/'));
    const auto parsed = parse_revision_name(*each, collection);
    if (parsed) accepted.push_back(*parsed);
  }
  out.find = [find = out.find, accepted](RevisionName name) {
    for (const RevisionName& each : accepted) {
      if (each.name == name.name && name.revision == 0) name = each;
    }
    auto found = find(name);
    if (found) found->is_deleted = false;
    return found;
  };
  return out;
}

void set_accepted_names(const ResourceRevisions& revisions, v1::Simulation& request) {
  const auto name_of = [](const std::string& revision, const char* collection) {
    const auto parsed = parse_revision_name(revision, collection);
    return parsed ? parsed->name : std::string();
  };
  if (request.gear_set().empty()) {
    request.set_gear_set(name_of(revisions.gear_set, kGearSets));
  }
  if (request.surface().empty()) {
    request.set_surface(name_of(revisions.surface, kSurfaces));
  }
  if (request.vehicle().empty()) {
    request.set_vehicle(name_of(revisions.vehicle, kVehicles));
  }
}

}  // namespace tribodyn::server
