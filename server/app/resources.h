#pragma once

#include "server/app/application.h"
#include "server/app/outcome.h"
#include "tribodyn/v1/gear_sets.pb.h"
#include "tribodyn/v1/lubricants.pb.h"
#include "tribodyn/v1/surfaces.pb.h"
#include "tribodyn/v1/vehicles.pb.h"

namespace tribodyn::server {

// The standard methods of the four kinds of resource. A page ends early when it would outgrow what
// a client accepts by default.
Outcome<v1::Lubricant> get_lubricant(Application& application,
                                     const v1::GetLubricantRequest& request);
Outcome<v1::ListLubricantsResponse> list_lubricants(Application& application,
                                                    const v1::ListLubricantsRequest& request);
Outcome<v1::GearSet> get_gear_set(Application& application, const v1::GetGearSetRequest& request);
Outcome<v1::ListGearSetsResponse> list_gear_sets(Application& application,
                                                 const v1::ListGearSetsRequest& request);
Outcome<v1::Surface> get_surface(Application& application, const v1::GetSurfaceRequest& request);
Outcome<v1::ListSurfacesResponse> list_surfaces(Application& application,
                                                const v1::ListSurfacesRequest& request);
Outcome<v1::Vehicle> get_vehicle(Application& application, const v1::GetVehicleRequest& request);
Outcome<v1::ListVehiclesResponse> list_vehicles(Application& application,
                                                const v1::ListVehiclesRequest& request);

}  // namespace tribodyn::server
