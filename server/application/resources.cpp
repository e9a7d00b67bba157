#include "server/application/resources.h"

#include "server/application/resource_writes.h"

namespace tribodyn::server {
namespace {

void clear_tables(v1::ListGearSetsResponse& response) {
  for (v1::GearSet& gear_set : *response.mutable_gear_sets()) {
    gear_set.clear_series();
    gear_set.clear_flank_slots();
    gear_set.clear_series_by_torque();
    gear_set.clear_load_share_by_torque();
  }
}

}  // namespace

Outcome<v1::Lubricant> create_lubricant(Application& application,
                                        const v1::CreateLubricantRequest& request,
                                        const CallContext& call) {
  return guarded<v1::Lubricant>([&]() -> Outcome<v1::Lubricant> {
    return write_resource<v1::Lubricant>(application, request, call);
  });
}

Outcome<v1::BatchCreateLubricantsResponse> batch_create_lubricants(
    Application& application, const v1::BatchCreateLubricantsRequest& request,
    const CallContext& call) {
  return guarded<v1::BatchCreateLubricantsResponse>(
      [&]() -> Outcome<v1::BatchCreateLubricantsResponse> {
        return write_batch<v1::Lubricant, v1::BatchCreateLubricantsResponse>(application, request,
                                                                             call);
      });
}

Outcome<v1::Lubricant> get_lubricant(Application& application,
                                     const v1::GetLubricantRequest& request,
                                     const CallContext& call) {
  return guarded<v1::Lubricant>([&]() -> Outcome<v1::Lubricant> {
    return get_resource<v1::Lubricant>(application, request, call);
  });
}

Outcome<v1::ListLubricantsResponse> list_lubricants(Application& application,
                                                    const v1::ListLubricantsRequest& request,
                                                    const CallContext& call) {
  return guarded<v1::ListLubricantsResponse>([&]() -> Outcome<v1::ListLubricantsResponse> {
    return list_resources<v1::Lubricant, v1::ListLubricantsResponse>(application, request, call);
  });
}

Outcome<v1::Lubricant> update_lubricant(Application& application,
                                        const v1::UpdateLubricantRequest& request,
                                        const CallContext& call) {
  return guarded<v1::Lubricant>([&]() -> Outcome<v1::Lubricant> {
    return write_resource<v1::Lubricant>(application, request, call);
  });
}

Outcome<v1::BatchUpdateLubricantsResponse> batch_update_lubricants(
    Application& application, const v1::BatchUpdateLubricantsRequest& request,
    const CallContext& call) {
  return guarded<v1::BatchUpdateLubricantsResponse>(
      [&]() -> Outcome<v1::BatchUpdateLubricantsResponse> {
        return write_batch<v1::Lubricant, v1::BatchUpdateLubricantsResponse>(application, request,
                                                                             call);
      });
}

Outcome<v1::ListLubricantRevisionsResponse> list_lubricant_revisions(
    Application& application, const v1::ListLubricantRevisionsRequest& request,
    const CallContext& call) {
  return guarded<v1::ListLubricantRevisionsResponse>(
      [&]() -> Outcome<v1::ListLubricantRevisionsResponse> {
        return list_revisions<v1::Lubricant, v1::ListLubricantRevisionsResponse>(application,
                                                                                 request, call);
      });
}

Outcome<v1::Lubricant> delete_lubricant(Application& application,
                                        const v1::DeleteLubricantRequest& request,
                                        const CallContext& call) {
  return guarded<v1::Lubricant>([&]() -> Outcome<v1::Lubricant> {
    return set_deleted<v1::Lubricant>(application, request, true, call);
  });
}

Outcome<v1::Lubricant> undelete_lubricant(Application& application,
                                          const v1::UndeleteLubricantRequest& request,
                                          const CallContext& call) {
  return guarded<v1::Lubricant>([&]() -> Outcome<v1::Lubricant> {
    return set_deleted<v1::Lubricant>(application, request, false, call);
  });
}

Outcome<v1::GearSet> create_gear_set(Application& application,
                                     const v1::CreateGearSetRequest& request,
                                     const CallContext& call) {
  return guarded<v1::GearSet>([&]() -> Outcome<v1::GearSet> {
    return write_resource<v1::GearSet>(application, request, call);
  });
}

Outcome<v1::BatchCreateGearSetsResponse> batch_create_gear_sets(
    Application& application, const v1::BatchCreateGearSetsRequest& request,
    const CallContext& call) {
  return guarded<v1::BatchCreateGearSetsResponse>(
      [&]() -> Outcome<v1::BatchCreateGearSetsResponse> {
        return write_batch<v1::GearSet, v1::BatchCreateGearSetsResponse>(application, request,
                                                                         call);
      });
}

Outcome<v1::GearSet> get_gear_set(Application& application, const v1::GetGearSetRequest& request,
                                  const CallContext& call) {
  return guarded<v1::GearSet>([&]() -> Outcome<v1::GearSet> {
    return get_resource<v1::GearSet>(application, request, call);
  });
}

Outcome<v1::ListGearSetsResponse> list_gear_sets(Application& application,
                                                 const v1::ListGearSetsRequest& request,
                                                 const CallContext& call) {
  return guarded<v1::ListGearSetsResponse>([&]() -> Outcome<v1::ListGearSetsResponse> {
    auto out = list_resources<v1::GearSet, v1::ListGearSetsResponse>(application, request, call);
    if (out.ok() && request.view() == v1::GEAR_SET_VIEW_BASIC) clear_tables(out.message());
    return out;
  });
}

Outcome<v1::GearSet> update_gear_set(Application& application,
                                     const v1::UpdateGearSetRequest& request,
                                     const CallContext& call) {
  return guarded<v1::GearSet>([&]() -> Outcome<v1::GearSet> {
    return write_resource<v1::GearSet>(application, request, call);
  });
}

Outcome<v1::BatchUpdateGearSetsResponse> batch_update_gear_sets(
    Application& application, const v1::BatchUpdateGearSetsRequest& request,
    const CallContext& call) {
  return guarded<v1::BatchUpdateGearSetsResponse>(
      [&]() -> Outcome<v1::BatchUpdateGearSetsResponse> {
        return write_batch<v1::GearSet, v1::BatchUpdateGearSetsResponse>(application, request,
                                                                         call);
      });
}

Outcome<v1::ListGearSetRevisionsResponse> list_gear_set_revisions(
    Application& application, const v1::ListGearSetRevisionsRequest& request,
    const CallContext& call) {
  return guarded<v1::ListGearSetRevisionsResponse>(
      [&]() -> Outcome<v1::ListGearSetRevisionsResponse> {
        return list_revisions<v1::GearSet, v1::ListGearSetRevisionsResponse>(application, request,
                                                                             call);
      });
}

Outcome<v1::GearSet> delete_gear_set(Application& application,
                                     const v1::DeleteGearSetRequest& request,
                                     const CallContext& call) {
  return guarded<v1::GearSet>([&]() -> Outcome<v1::GearSet> {
    return set_deleted<v1::GearSet>(application, request, true, call);
  });
}

Outcome<v1::GearSet> undelete_gear_set(Application& application,
                                       const v1::UndeleteGearSetRequest& request,
                                       const CallContext& call) {
  return guarded<v1::GearSet>([&]() -> Outcome<v1::GearSet> {
    return set_deleted<v1::GearSet>(application, request, false, call);
  });
}

Outcome<v1::Surface> create_surface(Application& application,
                                    const v1::CreateSurfaceRequest& request,
                                    const CallContext& call) {
  return guarded<v1::Surface>([&]() -> Outcome<v1::Surface> {
    return write_resource<v1::Surface>(application, request, call);
  });
}

Outcome<v1::BatchCreateSurfacesResponse> batch_create_surfaces(
    Application& application, const v1::BatchCreateSurfacesRequest& request,
    const CallContext& call) {
  return guarded<v1::BatchCreateSurfacesResponse>(
      [&]() -> Outcome<v1::BatchCreateSurfacesResponse> {
        return write_batch<v1::Surface, v1::BatchCreateSurfacesResponse>(application, request,
                                                                         call);
      });
}

Outcome<v1::Surface> get_surface(Application& application, const v1::GetSurfaceRequest& request,
                                 const CallContext& call) {
  return guarded<v1::Surface>([&]() -> Outcome<v1::Surface> {
    return get_resource<v1::Surface>(application, request, call);
  });
}

Outcome<v1::ListSurfacesResponse> list_surfaces(Application& application,
                                                const v1::ListSurfacesRequest& request,
                                                const CallContext& call) {
  return guarded<v1::ListSurfacesResponse>([&]() -> Outcome<v1::ListSurfacesResponse> {
    return list_resources<v1::Surface, v1::ListSurfacesResponse>(application, request, call);
  });
}

Outcome<v1::Surface> update_surface(Application& application,
                                    const v1::UpdateSurfaceRequest& request,
                                    const CallContext& call) {
  return guarded<v1::Surface>([&]() -> Outcome<v1::Surface> {
    return write_resource<v1::Surface>(application, request, call);
  });
}

Outcome<v1::BatchUpdateSurfacesResponse> batch_update_surfaces(
    Application& application, const v1::BatchUpdateSurfacesRequest& request,
    const CallContext& call) {
  return guarded<v1::BatchUpdateSurfacesResponse>(
      [&]() -> Outcome<v1::BatchUpdateSurfacesResponse> {
        return write_batch<v1::Surface, v1::BatchUpdateSurfacesResponse>(application, request,
                                                                         call);
      });
}

Outcome<v1::ListSurfaceRevisionsResponse> list_surface_revisions(
    Application& application, const v1::ListSurfaceRevisionsRequest& request,
    const CallContext& call) {
  return guarded<v1::ListSurfaceRevisionsResponse>(
      [&]() -> Outcome<v1::ListSurfaceRevisionsResponse> {
        return list_revisions<v1::Surface, v1::ListSurfaceRevisionsResponse>(application, request,
                                                                             call);
      });
}

Outcome<v1::Surface> delete_surface(Application& application,
                                    const v1::DeleteSurfaceRequest& request,
                                    const CallContext& call) {
  return guarded<v1::Surface>([&]() -> Outcome<v1::Surface> {
    return set_deleted<v1::Surface>(application, request, true, call);
  });
}

Outcome<v1::Surface> undelete_surface(Application& application,
                                      const v1::UndeleteSurfaceRequest& request,
                                      const CallContext& call) {
  return guarded<v1::Surface>([&]() -> Outcome<v1::Surface> {
    return set_deleted<v1::Surface>(application, request, false, call);
  });
}

Outcome<v1::Vehicle> create_vehicle(Application& application,
                                    const v1::CreateVehicleRequest& request,
                                    const CallContext& call) {
  return guarded<v1::Vehicle>([&]() -> Outcome<v1::Vehicle> {
    return write_resource<v1::Vehicle>(application, request, call);
  });
}

Outcome<v1::BatchCreateVehiclesResponse> batch_create_vehicles(
    Application& application, const v1::BatchCreateVehiclesRequest& request,
    const CallContext& call) {
  return guarded<v1::BatchCreateVehiclesResponse>(
      [&]() -> Outcome<v1::BatchCreateVehiclesResponse> {
        return write_batch<v1::Vehicle, v1::BatchCreateVehiclesResponse>(application, request,
                                                                         call);
      });
}

Outcome<v1::Vehicle> get_vehicle(Application& application, const v1::GetVehicleRequest& request,
                                 const CallContext& call) {
  return guarded<v1::Vehicle>([&]() -> Outcome<v1::Vehicle> {
    return get_resource<v1::Vehicle>(application, request, call);
  });
}

Outcome<v1::ListVehiclesResponse> list_vehicles(Application& application,
                                                const v1::ListVehiclesRequest& request,
                                                const CallContext& call) {
  return guarded<v1::ListVehiclesResponse>([&]() -> Outcome<v1::ListVehiclesResponse> {
    return list_resources<v1::Vehicle, v1::ListVehiclesResponse>(application, request, call);
  });
}

Outcome<v1::Vehicle> update_vehicle(Application& application,
                                    const v1::UpdateVehicleRequest& request,
                                    const CallContext& call) {
  return guarded<v1::Vehicle>([&]() -> Outcome<v1::Vehicle> {
    return write_resource<v1::Vehicle>(application, request, call);
  });
}

Outcome<v1::BatchUpdateVehiclesResponse> batch_update_vehicles(
    Application& application, const v1::BatchUpdateVehiclesRequest& request,
    const CallContext& call) {
  return guarded<v1::BatchUpdateVehiclesResponse>(
      [&]() -> Outcome<v1::BatchUpdateVehiclesResponse> {
        return write_batch<v1::Vehicle, v1::BatchUpdateVehiclesResponse>(application, request,
                                                                         call);
      });
}

Outcome<v1::ListVehicleRevisionsResponse> list_vehicle_revisions(
    Application& application, const v1::ListVehicleRevisionsRequest& request,
    const CallContext& call) {
  return guarded<v1::ListVehicleRevisionsResponse>(
      [&]() -> Outcome<v1::ListVehicleRevisionsResponse> {
        return list_revisions<v1::Vehicle, v1::ListVehicleRevisionsResponse>(application, request,
                                                                             call);
      });
}

Outcome<v1::Vehicle> delete_vehicle(Application& application,
                                    const v1::DeleteVehicleRequest& request,
                                    const CallContext& call) {
  return guarded<v1::Vehicle>([&]() -> Outcome<v1::Vehicle> {
    return set_deleted<v1::Vehicle>(application, request, true, call);
  });
}

Outcome<v1::Vehicle> undelete_vehicle(Application& application,
                                      const v1::UndeleteVehicleRequest& request,
                                      const CallContext& call) {
  return guarded<v1::Vehicle>([&]() -> Outcome<v1::Vehicle> {
    return set_deleted<v1::Vehicle>(application, request, false, call);
  });
}

}  // namespace tribodyn::server
