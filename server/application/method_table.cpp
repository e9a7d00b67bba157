#include "server/application/method_table.h"

#include <algorithm>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>

#include "server/application/contacts.h"
#include "server/application/imports.h"
#include "server/application/points.h"
#include "server/application/resource_writes.h"
#include "server/application/schemas.h"
#include "server/application/simulations.h"
#include "server/application/streams.h"

namespace tribodyn::server {
namespace {

using google::protobuf::Descriptor;
using google::protobuf::FileDescriptor;
using google::protobuf::Message;
using google::protobuf::MethodDescriptor;
using google::protobuf::ServiceDescriptor;

template <class Visit>
void visit_methods(const FileDescriptor& file, const Visit& visit) {
  for (int i = 0; i < file.service_count(); ++i) {
    const ServiceDescriptor& service = *file.service(i);
    for (int k = 0; k < service.method_count(); ++k) visit(*service.method(k));
  }
}

/// Returns the method with these types. Every method has a request type of its own. Throws
/// std::logic_error if there is none.
const MethodDescriptor& method_of(const Descriptor& request, const Descriptor& response) {
  const MethodDescriptor* out = nullptr;
  visit_methods(*request.file(), [&](const MethodDescriptor& method) {
    if (method.input_type() == &request && method.output_type() == &response) out = &method;
  });
  if (out == nullptr) throw std::logic_error("no method takes a " + request.full_name());
  return *out;
}

template <class Request, class Response>
Method unary(CallLane lane,
             Outcome<Response> (*use_case)(Application&, const Request&, const CallContext&)) {
  return {.descriptor = &method_of(*Request::descriptor(), *Response::descriptor()),
          .request = &Request::default_instance(),
          .response = &Response::default_instance(),
          .lane = lane,
          .answer = [use_case](Application& application, const Message& request,
                               const CallContext& call) -> Outcome<Reply> {
            auto out = use_case(application, static_cast<const Request&>(request), call);
            if (!out.ok()) return out.error();
            return Reply(std::make_unique<Response>(std::move(out.message())));
          },
          .open = nullptr};
}

template <class Request, class Response>
Method stream(StreamOutcome<Response> (*use_case)(Application&, const Request&,
                                                  const CallContext&)) {
  return {.descriptor = &method_of(*Request::descriptor(), *Response::descriptor()),
          .request = &Request::default_instance(),
          .response = &Response::default_instance(),
          .lane = CallLane::kRead,
          .answer = nullptr,
          .open = [use_case](Application& application, const Message& request,
                             const CallContext& call) -> Outcome<ReplySource> {
            auto out = use_case(application, static_cast<const Request&>(request), call);
            if (!out.ok()) return out.error();
            return ReplySource(std::move(out.message()));
          }};
}

std::vector<Method> rows() {
  using enum CallLane;
  return {
      unary(kWrite, write_resource<v1::Lubricant, v1::CreateLubricantRequest>),
      unary(kHeavy, write_batch<v1::Lubricant, v1::BatchCreateLubricantsResponse,
                                v1::BatchCreateLubricantsRequest>),
      unary<v1::ImportLubricantRequest, v1::Lubricant>(kHeavy, import_lubricant),
      unary(kRead, get_resource<v1::Lubricant, v1::GetLubricantRequest>),
      unary(kSearch,
            list_resources<v1::Lubricant, v1::ListLubricantsResponse, v1::ListLubricantsRequest>),
      unary(kWrite, write_resource<v1::Lubricant, v1::UpdateLubricantRequest>),
      unary(kHeavy, write_batch<v1::Lubricant, v1::BatchUpdateLubricantsResponse,
                                v1::BatchUpdateLubricantsRequest>),
      unary(kSearch, list_revisions<v1::Lubricant, v1::ListLubricantRevisionsResponse,
                                    v1::ListLubricantRevisionsRequest>),
      unary(kWrite, delete_resource<v1::Lubricant, v1::DeleteLubricantRequest>),
      unary(kWrite, undelete_resource<v1::Lubricant, v1::UndeleteLubricantRequest>),
      unary(kHeavy, purge_resource<v1::Lubricant, v1::PurgeLubricantRequest>),

      unary(kWrite, write_resource<v1::GearSet, v1::CreateGearSetRequest>),
      unary(kHeavy, write_batch<v1::GearSet, v1::BatchCreateGearSetsResponse,
                                v1::BatchCreateGearSetsRequest>),
      unary<v1::ImportGearSetRequest, v1::GearSet>(kHeavy, import_gear_set),
      unary(kRead, get_resource<v1::GearSet, v1::GetGearSetRequest>),
      unary(kSearch,
            list_resources<v1::GearSet, v1::ListGearSetsResponse, v1::ListGearSetsRequest>),
      unary(kWrite, write_resource<v1::GearSet, v1::UpdateGearSetRequest>),
      unary(kHeavy, write_batch<v1::GearSet, v1::BatchUpdateGearSetsResponse,
                                v1::BatchUpdateGearSetsRequest>),
      unary(kSearch, list_revisions<v1::GearSet, v1::ListGearSetRevisionsResponse,
                                    v1::ListGearSetRevisionsRequest>),
      unary(kWrite, delete_resource<v1::GearSet, v1::DeleteGearSetRequest>),
      unary(kWrite, undelete_resource<v1::GearSet, v1::UndeleteGearSetRequest>),
      unary(kHeavy, purge_resource<v1::GearSet, v1::PurgeGearSetRequest>),

      unary(kWrite, write_resource<v1::Surface, v1::CreateSurfaceRequest>),
      unary(kHeavy, write_batch<v1::Surface, v1::BatchCreateSurfacesResponse,
                                v1::BatchCreateSurfacesRequest>),
      unary<v1::ImportSurfaceProfilesRequest, v1::Surface>(kHeavy, import_surface_profiles),
      unary(kRead, get_resource<v1::Surface, v1::GetSurfaceRequest>),
      unary(kSearch,
            list_resources<v1::Surface, v1::ListSurfacesResponse, v1::ListSurfacesRequest>),
      unary(kWrite, write_resource<v1::Surface, v1::UpdateSurfaceRequest>),
      unary(kHeavy, write_batch<v1::Surface, v1::BatchUpdateSurfacesResponse,
                                v1::BatchUpdateSurfacesRequest>),
      unary(kSearch, list_revisions<v1::Surface, v1::ListSurfaceRevisionsResponse,
                                    v1::ListSurfaceRevisionsRequest>),
      unary(kWrite, delete_resource<v1::Surface, v1::DeleteSurfaceRequest>),
      unary(kWrite, undelete_resource<v1::Surface, v1::UndeleteSurfaceRequest>),
      unary(kHeavy, purge_resource<v1::Surface, v1::PurgeSurfaceRequest>),

      unary(kWrite, write_resource<v1::Vehicle, v1::CreateVehicleRequest>),
      unary(kHeavy, write_batch<v1::Vehicle, v1::BatchCreateVehiclesResponse,
                                v1::BatchCreateVehiclesRequest>),
      unary(kRead, get_resource<v1::Vehicle, v1::GetVehicleRequest>),
      unary(kSearch,
            list_resources<v1::Vehicle, v1::ListVehiclesResponse, v1::ListVehiclesRequest>),
      unary(kWrite, write_resource<v1::Vehicle, v1::UpdateVehicleRequest>),
      unary(kHeavy, write_batch<v1::Vehicle, v1::BatchUpdateVehiclesResponse,
                                v1::BatchUpdateVehiclesRequest>),
      unary(kSearch, list_revisions<v1::Vehicle, v1::ListVehicleRevisionsResponse,
                                    v1::ListVehicleRevisionsRequest>),
      unary(kWrite, delete_resource<v1::Vehicle, v1::DeleteVehicleRequest>),
      unary(kWrite, undelete_resource<v1::Vehicle, v1::UndeleteVehicleRequest>),
      unary(kHeavy, purge_resource<v1::Vehicle, v1::PurgeVehicleRequest>),

      unary(kRead, get_schema),
      unary<v1::EvaluateContactRequest, v1::EvaluateContactResponse>(kSearch, evaluate_contact),
      unary<v1::EvaluatePointsRequest, v1::EvaluatePointsResponse>(kCompute, evaluate_points),

      unary(kWrite, create_simulation),
      unary(kRead, get_simulation),
      unary(kSearch, list_simulations),
      unary(kWrite, cancel_simulation),
      unary(kWrite, delete_simulation),
      unary(kWrite, update_simulation),
      unary(kWrite, pin_simulation),
      unary(kWrite, unpin_simulation),
      stream(watch_simulation),
      stream(watch_simulations),
      stream(read_history),
  };
}

}  // namespace

std::vector<Method> method_table() {
  std::vector<Method> out = rows();
  std::set<const MethodDescriptor*> methods;
  std::set<const FileDescriptor*> files;
  for (const Method& each : out) {
    files.insert(each.descriptor->file());
    if (!methods.insert(each.descriptor).second) {
      throw std::logic_error("two rows for " + each.descriptor->full_name());
    }
  }
  for (const FileDescriptor* file : files) {
    visit_methods(*file, [&](const MethodDescriptor& method) {
      if (!methods.contains(&method)) throw std::logic_error("no row for " + method.full_name());
    });
  }
  return out;
}

}  // namespace tribodyn::server
