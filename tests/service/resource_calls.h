#pragma once

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "server/application/guard.h"
#include "server/application/method_table.h"
#include "tribodyn/v1/contacts.pb.h"
#include "tribodyn/v1/gear_sets.pb.h"
#include "tribodyn/v1/lubricants.pb.h"
#include "tribodyn/v1/surfaces.pb.h"
#include "tribodyn/v1/vehicles.pb.h"

namespace tribodyn::server {

/// The row of the method that takes such a request.
inline const Method& row_of(const google::protobuf::Message& request) {
  static const std::vector<Method> kTable = method_table();
  for (const Method& each : kTable) {
    if (each.descriptor->input_type() == request.GetDescriptor()) return each;
  }
  throw std::logic_error("no method takes a " + request.GetTypeName());
}

/// Calls the use case of the method that takes a request, as the dispatcher does.
template <class Response>
struct ResourceCall {
  template <class Request>
  Outcome<Response> operator()(Application& application, const Request& request,
                               const CallContext& call = {}) const {
    return guarded<Response>([&]() -> Outcome<Response> {
      auto reply = row_of(request).answer(application, request, call);
      if (!reply.ok()) return reply.error();
      return std::move(dynamic_cast<Response&>(*reply.message()));
    });
  }
};

// The methods of resources under their names.
inline constexpr ResourceCall<v1::Lubricant> create_lubricant, get_lubricant, update_lubricant,
    delete_lubricant, undelete_lubricant;
inline constexpr ResourceCall<v1::BatchCreateLubricantsResponse> batch_create_lubricants;
inline constexpr ResourceCall<v1::BatchUpdateLubricantsResponse> batch_update_lubricants;
inline constexpr ResourceCall<v1::ListLubricantsResponse> list_lubricants;
inline constexpr ResourceCall<v1::ListLubricantRevisionsResponse> list_lubricant_revisions;

inline constexpr ResourceCall<v1::GearSet> create_gear_set, get_gear_set, update_gear_set,
    delete_gear_set, undelete_gear_set;
inline constexpr ResourceCall<v1::BatchCreateGearSetsResponse> batch_create_gear_sets;
inline constexpr ResourceCall<v1::BatchUpdateGearSetsResponse> batch_update_gear_sets;
inline constexpr ResourceCall<v1::ListGearSetsResponse> list_gear_sets;
inline constexpr ResourceCall<v1::ListGearSetRevisionsResponse> list_gear_set_revisions;

inline constexpr ResourceCall<v1::Surface> create_surface, get_surface, update_surface,
    delete_surface, undelete_surface;
inline constexpr ResourceCall<v1::BatchCreateSurfacesResponse> batch_create_surfaces;
inline constexpr ResourceCall<v1::BatchUpdateSurfacesResponse> batch_update_surfaces;
inline constexpr ResourceCall<v1::ListSurfacesResponse> list_surfaces;
inline constexpr ResourceCall<v1::ListSurfaceRevisionsResponse> list_surface_revisions;

inline constexpr ResourceCall<v1::Vehicle> create_vehicle, get_vehicle, update_vehicle,
    delete_vehicle, undelete_vehicle;
inline constexpr ResourceCall<v1::BatchCreateVehiclesResponse> batch_create_vehicles;
inline constexpr ResourceCall<v1::BatchUpdateVehiclesResponse> batch_update_vehicles;
inline constexpr ResourceCall<v1::ListVehiclesResponse> list_vehicles;
inline constexpr ResourceCall<v1::ListVehicleRevisionsResponse> list_vehicle_revisions;

/// EvaluateContact, whose use case throws what the model refuses.
inline constexpr ResourceCall<v1::EvaluateContactResponse> answer_contact;

}  // namespace tribodyn::server
