#include "server/app/resources.h"

#include "server/app/guard.h"
#include "server/app/paging.h"
#include "server/convert/resource_names.h"

namespace tribodyn::server {
namespace {

constexpr int kDefaultPageSize = 100;

template <class Resource>
Outcome<Resource> get(Application& application, const std::string& name,
                      const std::string& collection) {
  return guarded<Resource>([&]() -> Outcome<Resource> {
    const auto explain = [&] {
      return unknown_name_text(name, collection, application.store.resource_names(collection));
    };
    if (!is_resource_name(name, collection)) return invalid({{"name", explain()}});
    const auto body = application.store.resource(name);
    if (!body) return not_found(Resource::descriptor()->full_name(), name, explain());
    Resource resource;
    if (!resource.ParseFromString(*body)) {
      return error(google::rpc::DATA_LOSS, "STORED_RESOURCE_UNREADABLE",
                   name + " cannot be read from the database");
    }
    return resource;
  });
}

/// `add` appends a new element to the response and returns it.
template <class Response, class Request, class Add>
Outcome<Response> list(Application& application, const Request& request,
                       const std::string& collection, const Add& add) {
  return guarded<Response>([&]() -> Outcome<Response> {
    Violations violations;
    const int size = page_size(request.page_size(), kDefaultPageSize, violations);
    if (!request.page_token().empty() && !is_resource_name(request.page_token(), collection)) {
      add_bad_page_token(violations);
    }
    if (!violations.empty()) return invalid(violations);
    const Page<StoredResource> page =
        application.store.resources(collection, request.page_token(), size, kMaximumPageBytes);
    Response response;
    for (const StoredResource& row : page.rows) add(response)->ParseFromString(row.body);
    if (page.more) response.set_next_page_token(page.rows.back().name);
    return response;
  });
}

}  // namespace

Outcome<v1::Lubricant> get_lubricant(Application& application,
                                     const v1::GetLubricantRequest& request) {
  return get<v1::Lubricant>(application, request.name(), kLubricants);
}

Outcome<v1::ListLubricantsResponse> list_lubricants(Application& application,
                                                    const v1::ListLubricantsRequest& request) {
  return list<v1::ListLubricantsResponse>(
      application, request, kLubricants,
      [](v1::ListLubricantsResponse& response) { return response.add_lubricants(); });
}

Outcome<v1::GearSet> get_gear_set(Application& application, const v1::GetGearSetRequest& request) {
  return get<v1::GearSet>(application, request.name(), kGearSets);
}

Outcome<v1::ListGearSetsResponse> list_gear_sets(Application& application,
                                                 const v1::ListGearSetsRequest& request) {
  return list<v1::ListGearSetsResponse>(
      application, request, kGearSets,
      [](v1::ListGearSetsResponse& response) { return response.add_gear_sets(); });
}

Outcome<v1::Surface> get_surface(Application& application, const v1::GetSurfaceRequest& request) {
  return get<v1::Surface>(application, request.name(), kSurfaces);
}

Outcome<v1::ListSurfacesResponse> list_surfaces(Application& application,
                                                const v1::ListSurfacesRequest& request) {
  return list<v1::ListSurfacesResponse>(
      application, request, kSurfaces,
      [](v1::ListSurfacesResponse& response) { return response.add_surfaces(); });
}

Outcome<v1::Vehicle> get_vehicle(Application& application, const v1::GetVehicleRequest& request) {
  return get<v1::Vehicle>(application, request.name(), kVehicles);
}

Outcome<v1::ListVehiclesResponse> list_vehicles(Application& application,
                                                const v1::ListVehiclesRequest& request) {
  return list<v1::ListVehiclesResponse>(
      application, request, kVehicles,
      [](v1::ListVehiclesResponse& response) { return response.add_vehicles(); });
}

}  // namespace tribodyn::server
