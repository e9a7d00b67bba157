#pragma once

#include "server/application/application.h"
#include "server/application/call_context.h"
#include "server/application/outcome.h"
#include "tribodyn/v1/gear_sets.pb.h"
#include "tribodyn/v1/lubricants.pb.h"
#include "tribodyn/v1/surfaces.pb.h"
#include "tribodyn/v1/vehicles.pb.h"

namespace tribodyn::server {

// The standard methods of the four kinds of resource. A page ends early when it would outgrow what
// a client accepts by default. What is refused leaves nothing behind; of a batch nothing at all.

Outcome<v1::Lubricant> create_lubricant(Application& application,
                                        const v1::CreateLubricantRequest& request,
                                        const CallContext& call = {});
Outcome<v1::BatchCreateLubricantsResponse> batch_create_lubricants(
    Application& application, const v1::BatchCreateLubricantsRequest& request,
    const CallContext& call = {});
Outcome<v1::Lubricant> get_lubricant(Application& application,
                                     const v1::GetLubricantRequest& request,
                                     const CallContext& call = {});
Outcome<v1::ListLubricantsResponse> list_lubricants(Application& application,
                                                    const v1::ListLubricantsRequest& request,
                                                    const CallContext& call = {});
Outcome<v1::Lubricant> update_lubricant(Application& application,
                                        const v1::UpdateLubricantRequest& request,
                                        const CallContext& call = {});
Outcome<v1::BatchUpdateLubricantsResponse> batch_update_lubricants(
    Application& application, const v1::BatchUpdateLubricantsRequest& request,
    const CallContext& call = {});
Outcome<v1::ListLubricantRevisionsResponse> list_lubricant_revisions(
    Application& application, const v1::ListLubricantRevisionsRequest& request,
    const CallContext& call = {});
Outcome<v1::Lubricant> delete_lubricant(Application& application,
                                        const v1::DeleteLubricantRequest& request,
                                        const CallContext& call = {});
Outcome<v1::Lubricant> undelete_lubricant(Application& application,
                                          const v1::UndeleteLubricantRequest& request,
                                          const CallContext& call = {});

Outcome<v1::GearSet> create_gear_set(Application& application,
                                     const v1::CreateGearSetRequest& request,
                                     const CallContext& call = {});
Outcome<v1::BatchCreateGearSetsResponse> batch_create_gear_sets(
    Application& application, const v1::BatchCreateGearSetsRequest& request,
    const CallContext& call = {});
Outcome<v1::GearSet> get_gear_set(Application& application, const v1::GetGearSetRequest& request,
                                  const CallContext& call = {});
Outcome<v1::ListGearSetsResponse> list_gear_sets(Application& application,
                                                 const v1::ListGearSetsRequest& request,
                                                 const CallContext& call = {});
Outcome<v1::GearSet> update_gear_set(Application& application,
                                     const v1::UpdateGearSetRequest& request,
                                     const CallContext& call = {});
Outcome<v1::BatchUpdateGearSetsResponse> batch_update_gear_sets(
    Application& application, const v1::BatchUpdateGearSetsRequest& request,
    const CallContext& call = {});
Outcome<v1::ListGearSetRevisionsResponse> list_gear_set_revisions(
    Application& application, const v1::ListGearSetRevisionsRequest& request,
    const CallContext& call = {});
Outcome<v1::GearSet> delete_gear_set(Application& application,
                                     const v1::DeleteGearSetRequest& request,
                                     const CallContext& call = {});
Outcome<v1::GearSet> undelete_gear_set(Application& application,
                                       const v1::UndeleteGearSetRequest& request,
                                       const CallContext& call = {});

Outcome<v1::Surface> create_surface(Application& application,
                                    const v1::CreateSurfaceRequest& request,
                                    const CallContext& call = {});
Outcome<v1::BatchCreateSurfacesResponse> batch_create_surfaces(
    Application& application, const v1::BatchCreateSurfacesRequest& request,
    const CallContext& call = {});
Outcome<v1::Surface> get_surface(Application& application, const v1::GetSurfaceRequest& request,
                                 const CallContext& call = {});
Outcome<v1::ListSurfacesResponse> list_surfaces(Application& application,
                                                const v1::ListSurfacesRequest& request,
                                                const CallContext& call = {});
Outcome<v1::Surface> update_surface(Application& application,
                                    const v1::UpdateSurfaceRequest& request,
                                    const CallContext& call = {});
Outcome<v1::BatchUpdateSurfacesResponse> batch_update_surfaces(
    Application& application, const v1::BatchUpdateSurfacesRequest& request,
    const CallContext& call = {});
Outcome<v1::ListSurfaceRevisionsResponse> list_surface_revisions(
    Application& application, const v1::ListSurfaceRevisionsRequest& request,
    const CallContext& call = {});
Outcome<v1::Surface> delete_surface(Application& application,
                                    const v1::DeleteSurfaceRequest& request,
                                    const CallContext& call = {});
Outcome<v1::Surface> undelete_surface(Application& application,
                                      const v1::UndeleteSurfaceRequest& request,
                                      const CallContext& call = {});

Outcome<v1::Vehicle> create_vehicle(Application& application,
                                    const v1::CreateVehicleRequest& request,
                                    const CallContext& call = {});
Outcome<v1::BatchCreateVehiclesResponse> batch_create_vehicles(
    Application& application, const v1::BatchCreateVehiclesRequest& request,
    const CallContext& call = {});
Outcome<v1::Vehicle> get_vehicle(Application& application, const v1::GetVehicleRequest& request,
                                 const CallContext& call = {});
Outcome<v1::ListVehiclesResponse> list_vehicles(Application& application,
                                                const v1::ListVehiclesRequest& request,
                                                const CallContext& call = {});
Outcome<v1::Vehicle> update_vehicle(Application& application,
                                    const v1::UpdateVehicleRequest& request,
                                    const CallContext& call = {});
Outcome<v1::BatchUpdateVehiclesResponse> batch_update_vehicles(
    Application& application, const v1::BatchUpdateVehiclesRequest& request,
    const CallContext& call = {});
Outcome<v1::ListVehicleRevisionsResponse> list_vehicle_revisions(
    Application& application, const v1::ListVehicleRevisionsRequest& request,
    const CallContext& call = {});
Outcome<v1::Vehicle> delete_vehicle(Application& application,
                                    const v1::DeleteVehicleRequest& request,
                                    const CallContext& call = {});
Outcome<v1::Vehicle> undelete_vehicle(Application& application,
                                      const v1::UndeleteVehicleRequest& request,
                                      const CallContext& call = {});

}  // namespace tribodyn::server
