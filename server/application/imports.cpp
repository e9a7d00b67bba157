#include "server/application/imports.h"

#include "server/application/resource_writes.h"
#include "server/resources/imports/import_gear_set.h"
#include "server/resources/imports/import_lubricant.h"
#include "server/resources/imports/import_surface.h"
#include "server/storage/resource_lookup.h"

namespace tribodyn::server {
namespace {

/// Stores the resource that `read` makes of the request, or returns its violations.
template <class Resource, class Request, class Read>
Outcome<Resource> import_resource(Application& application, const Request& request,
                                  const Read& read, const CallContext& call) {
  Violations violations;
  const std::string name = new_name<Resource>(Kind<Resource>::id(request),
                                              Kind<Resource>::of(request).name(), violations);
  const ResourceLookup lookup = resource_lookup(application.store, call.project, call.limits);
  const auto accepted = read(request, name, lookup, violations);
  if (!violations.empty() || !accepted) return invalid(violations);
  return store_new(application, *accepted, request.validate_only(), call);
}

}  // namespace

Outcome<v1::Lubricant> import_lubricant(Application& application,
                                        const v1::ImportLubricantRequest& request,
                                        const CallContext& call) {
  return import_resource<v1::Lubricant>(
      application, request, [](auto&... arguments) { return import_lubricant(arguments...); },
      call);
}

Outcome<v1::GearSet> import_gear_set(Application& application,
                                     const v1::ImportGearSetRequest& request,
                                     const CallContext& call) {
  return import_resource<v1::GearSet>(
      application, request, [](auto&... arguments) { return import_gear_set(arguments...); }, call);
}

Outcome<v1::Surface> import_surface_profiles(Application& application,
                                             const v1::ImportSurfaceProfilesRequest& request,
                                             const CallContext& call) {
  return import_resource<v1::Surface>(
      application, request, [](auto&... arguments) { return import_surface(arguments...); }, call);
}

}  // namespace tribodyn::server
