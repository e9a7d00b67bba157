#include "server/application/method_table.h"

#include <algorithm>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>

#include "server/application/campaign_decisions.h"
#include "server/application/campaigns.h"
#include "server/application/contacts.h"
#include "server/application/cycles.h"
#include "server/application/imports.h"
#include "server/application/points.h"
#include "server/application/profiles.h"
#include "server/application/resource_writes.h"
#include "server/application/rigs.h"
#include "server/application/schemas.h"
#include "server/application/simulations.h"
#include "server/application/spectra.h"
#include "server/application/streams.h"
#include "server/application/viscosities.h"

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
Method unary(Scope scope, CallLane lane,
             Outcome<Response> (*use_case)(Application&, const Request&, const CallContext&)) {
  return {.descriptor = &method_of(*Request::descriptor(), *Response::descriptor()),
          .request = &Request::default_instance(),
          .response = &Response::default_instance(),
          .scope = scope,
          .lane = lane,
          .answer = [use_case](Application& application, const Message& request,
                               const CallContext& call) -> Outcome<Reply> {
            auto out = use_case(application, static_cast<const Request&>(request), call);
            if (!out.ok()) return out.error();
            return Reply(std::make_unique<Response>(std::move(out.message())));
          },
          .open = nullptr};
}

/// A method of which some requests are short.
template <class Request, class Response>
Method unary(Scope scope, CallLane lane,
             Outcome<Response> (*use_case)(Application&, const Request&, const CallContext&),
             bool (*is_short)(const Request&)) {
  Method out = unary(scope, lane, use_case);
  out.is_short = [is_short](const Message& request) {
    return is_short(static_cast<const Request&>(request));
  };
  return out;
}

template <class Request, class Response>
Method stream(Scope scope, StreamOutcome<Response> (*use_case)(Application&, const Request&,
                                                               const CallContext&)) {
  return {.descriptor = &method_of(*Request::descriptor(), *Response::descriptor()),
          .request = &Request::default_instance(),
          .response = &Response::default_instance(),
          .scope = scope,
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
      unary(Scope::kWrite, kWrite, write_resource<v1::Lubricant, v1::CreateLubricantRequest>),
      unary(Scope::kWrite, kHeavy,
            write_batch<v1::Lubricant, v1::BatchCreateLubricantsResponse,
                        v1::BatchCreateLubricantsRequest>),
      unary<v1::ImportLubricantRequest, v1::Lubricant>(Scope::kWrite, kHeavy, import_lubricant),
      unary(Scope::kRead, kRead, get_resource<v1::Lubricant, v1::GetLubricantRequest>),
      unary(Scope::kRead, kSearch,
            list_resources<v1::Lubricant, v1::ListLubricantsResponse, v1::ListLubricantsRequest>),
      unary(Scope::kWrite, kWrite, write_resource<v1::Lubricant, v1::UpdateLubricantRequest>),
      unary(Scope::kWrite, kHeavy,
            write_batch<v1::Lubricant, v1::BatchUpdateLubricantsResponse,
                        v1::BatchUpdateLubricantsRequest>),
      unary(Scope::kRead, kSearch,
            list_revisions<v1::Lubricant, v1::ListLubricantRevisionsResponse,
                           v1::ListLubricantRevisionsRequest>),
      unary(Scope::kWrite, kWrite, delete_resource<v1::Lubricant, v1::DeleteLubricantRequest>),
      unary(Scope::kWrite, kWrite, undelete_resource<v1::Lubricant, v1::UndeleteLubricantRequest>),
      unary(Scope::kAdmin, kHeavy, purge_resource<v1::Lubricant, v1::PurgeLubricantRequest>),

      unary(Scope::kWrite, kWrite, write_resource<v1::GearSet, v1::CreateGearSetRequest>),
      unary(Scope::kWrite, kHeavy,
            write_batch<v1::GearSet, v1::BatchCreateGearSetsResponse,
                        v1::BatchCreateGearSetsRequest>),
      unary<v1::ImportGearSetRequest, v1::GearSet>(Scope::kWrite, kHeavy, import_gear_set),
      unary(Scope::kRead, kRead, get_resource<v1::GearSet, v1::GetGearSetRequest>),
      unary(Scope::kRead, kSearch,
            list_resources<v1::GearSet, v1::ListGearSetsResponse, v1::ListGearSetsRequest>),
      unary(Scope::kWrite, kWrite, write_resource<v1::GearSet, v1::UpdateGearSetRequest>),
      unary(Scope::kWrite, kHeavy,
            write_batch<v1::GearSet, v1::BatchUpdateGearSetsResponse,
                        v1::BatchUpdateGearSetsRequest>),
      unary(Scope::kRead, kSearch,
            list_revisions<v1::GearSet, v1::ListGearSetRevisionsResponse,
                           v1::ListGearSetRevisionsRequest>),
      unary(Scope::kWrite, kWrite, delete_resource<v1::GearSet, v1::DeleteGearSetRequest>),
      unary(Scope::kWrite, kWrite, undelete_resource<v1::GearSet, v1::UndeleteGearSetRequest>),
      unary(Scope::kAdmin, kHeavy, purge_resource<v1::GearSet, v1::PurgeGearSetRequest>),

      unary(Scope::kWrite, kWrite, write_resource<v1::Surface, v1::CreateSurfaceRequest>),
      unary(Scope::kWrite, kHeavy,
            write_batch<v1::Surface, v1::BatchCreateSurfacesResponse,
                        v1::BatchCreateSurfacesRequest>),
      unary<v1::ImportSurfaceProfilesRequest, v1::Surface>(Scope::kWrite, kHeavy,
                                                           import_surface_profiles),
      unary(Scope::kRead, kRead, get_resource<v1::Surface, v1::GetSurfaceRequest>),
      unary(Scope::kRead, kSearch,
            list_resources<v1::Surface, v1::ListSurfacesResponse, v1::ListSurfacesRequest>),
      unary(Scope::kWrite, kWrite, write_resource<v1::Surface, v1::UpdateSurfaceRequest>),
      unary(Scope::kWrite, kHeavy,
            write_batch<v1::Surface, v1::BatchUpdateSurfacesResponse,
                        v1::BatchUpdateSurfacesRequest>),
      unary(Scope::kRead, kSearch,
            list_revisions<v1::Surface, v1::ListSurfaceRevisionsResponse,
                           v1::ListSurfaceRevisionsRequest>),
      unary(Scope::kWrite, kWrite, delete_resource<v1::Surface, v1::DeleteSurfaceRequest>),
      unary(Scope::kWrite, kWrite, undelete_resource<v1::Surface, v1::UndeleteSurfaceRequest>),
      unary(Scope::kAdmin, kHeavy, purge_resource<v1::Surface, v1::PurgeSurfaceRequest>),

      unary(Scope::kWrite, kWrite, write_resource<v1::Vehicle, v1::CreateVehicleRequest>),
      unary(Scope::kWrite, kHeavy,
            write_batch<v1::Vehicle, v1::BatchCreateVehiclesResponse,
                        v1::BatchCreateVehiclesRequest>),
      unary(Scope::kRead, kRead, get_resource<v1::Vehicle, v1::GetVehicleRequest>),
      unary(Scope::kRead, kSearch,
            list_resources<v1::Vehicle, v1::ListVehiclesResponse, v1::ListVehiclesRequest>),
      unary(Scope::kWrite, kWrite, write_resource<v1::Vehicle, v1::UpdateVehicleRequest>),
      unary(Scope::kWrite, kHeavy,
            write_batch<v1::Vehicle, v1::BatchUpdateVehiclesResponse,
                        v1::BatchUpdateVehiclesRequest>),
      unary(Scope::kRead, kSearch,
            list_revisions<v1::Vehicle, v1::ListVehicleRevisionsResponse,
                           v1::ListVehicleRevisionsRequest>),
      unary(Scope::kWrite, kWrite, delete_resource<v1::Vehicle, v1::DeleteVehicleRequest>),
      unary(Scope::kWrite, kWrite, undelete_resource<v1::Vehicle, v1::UndeleteVehicleRequest>),
      unary(Scope::kAdmin, kHeavy, purge_resource<v1::Vehicle, v1::PurgeVehicleRequest>),

      unary(Scope::kRead, kRead, get_schema),
      unary<v1::EvaluateContactRequest, v1::EvaluateContactResponse>(Scope::kRead, kSearch,
                                                                     evaluate_contact),
      unary<v1::EvaluatePointsRequest, v1::EvaluatePointsResponse>(Scope::kRead, kCompute,
                                                                   evaluate_points),
      unary<v1::EvaluateCycleRequest, v1::EvaluateCycleResponse>(Scope::kRead, kCompute,
                                                                 evaluate_cycle),
      unary<v1::EvaluateProfilesRequest, v1::EvaluateProfilesResponse>(Scope::kRead, kHeavy,
                                                                       evaluate_profiles),
      unary<v1::EvaluateRigRequest, v1::EvaluateRigResponse>(Scope::kRead, kCompute, evaluate_rig),
      unary<v1::EvaluateViscosityRequest, v1::EvaluateViscosityResponse>(Scope::kRead, kSearch,
                                                                         evaluate_viscosity),
      unary<v1::ComparePointsRequest, v1::ComparePointsResponse>(Scope::kRead, kCompute,
                                                                 compare_points),
      unary<v1::ExplainPointsRequest, v1::ExplainPointsResponse>(Scope::kRead, kCompute,
                                                                 explain_points),

      unary(Scope::kWrite, kWrite, create_simulation),
      unary(Scope::kRead, kRead, get_simulation),
      unary(Scope::kRead, kSearch, list_simulations, is_short_list),
      unary(Scope::kWrite, kWrite, cancel_simulation),
      unary(Scope::kWrite, kWrite, delete_simulation),
      unary(Scope::kWrite, kWrite, update_simulation),
      unary(Scope::kWrite, kWrite, pin_simulation),
      unary(Scope::kWrite, kWrite, unpin_simulation),
      stream(Scope::kRead, watch_simulation),
      stream(Scope::kRead, watch_simulations),
      stream(Scope::kRead, read_history),
      unary(Scope::kRead, kSearch, read_spectrum),

      unary(Scope::kWrite, kWrite, create_campaign),
      unary(Scope::kRead, kRead, get_campaign),
      unary(Scope::kRead, kSearch, list_campaigns),
      unary(Scope::kWrite, kWrite, update_campaign),
      unary(Scope::kWrite, kWrite, append_candidates),
      unary(Scope::kWrite, kWrite, pause_campaign),
      unary(Scope::kWrite, kWrite, resume_campaign),
      unary(Scope::kWrite, kWrite, cancel_campaign),
      unary(Scope::kWrite, kWrite, delete_campaign),
      unary<v1::RankCandidatesRequest, v1::RankCandidatesResponse>(Scope::kRead, kCompute,
                                                                   rank_candidates),
      unary(Scope::kRead, kSearch, find_pareto_candidates),
      unary(Scope::kRead, kSearch, estimate_candidate_effects),
      unary(Scope::kWrite, kWrite, promote_candidate),
      stream(Scope::kRead, watch_campaign),
      stream(Scope::kRead, read_campaign),
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
