#include "server/application/method_table.h"

#include <algorithm>
#include <initializer_list>
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

/// The rows of the methods that every kind of resource has.
#define TRIBODYN_STANDARD_ROWS(Resource, field, collection, seed)                                \
  unary(Scope::kWrite, kWrite, write_resource<v1::Resource, v1::Create##Resource##Request>),     \
      unary(Scope::kWrite, kHeavy,                                                               \
            write_batch<v1::Resource, v1::BatchCreate##Resource##sResponse,                      \
                        v1::BatchCreate##Resource##sRequest>),                                   \
      unary(Scope::kRead, kRead, get_resource<v1::Resource, v1::Get##Resource##Request>),        \
      unary(Scope::kRead, kSearch,                                                               \
            list_resources<v1::Resource, v1::List##Resource##sResponse,                          \
                           v1::List##Resource##sRequest>),                                       \
      unary(Scope::kWrite, kWrite, write_resource<v1::Resource, v1::Update##Resource##Request>), \
      unary(Scope::kWrite, kHeavy,                                                               \
            write_batch<v1::Resource, v1::BatchUpdate##Resource##sResponse,                      \
                        v1::BatchUpdate##Resource##sRequest>),                                   \
      unary(Scope::kRead, kSearch,                                                               \
            list_revisions<v1::Resource, v1::List##Resource##RevisionsResponse,                  \
                           v1::List##Resource##RevisionsRequest>),                               \
      unary(Scope::kWrite, kWrite,                                                               \
            set_deleted<true, v1::Resource, v1::Delete##Resource##Request>),                     \
      unary(Scope::kWrite, kWrite,                                                               \
            set_deleted<false, v1::Resource, v1::Undelete##Resource##Request>),                  \
      unary(Scope::kAdmin, kHeavy, purge_resource<v1::Resource, v1::Purge##Resource##Request>),

std::vector<Method> rows() {
  using enum CallLane;
  std::vector<Method> out = {TRIBODYN_RESOURCE_KINDS(TRIBODYN_STANDARD_ROWS)};
  const std::initializer_list<Method> others = {
      unary(Scope::kWrite, kHeavy, import_lubricant),
      unary(Scope::kWrite, kHeavy, import_gear_set),
      unary(Scope::kWrite, kHeavy, import_surface_profiles),

      unary(Scope::kRead, kRead, get_schema),
      unary(Scope::kRead, kSearch, evaluate_contact),
      unary(Scope::kRead, kCompute, evaluate_points),
      unary(Scope::kRead, kCompute, evaluate_cycle),
      unary(Scope::kRead, kHeavy, evaluate_profiles),
      unary(Scope::kRead, kCompute, evaluate_rig),
      unary(Scope::kRead, kSearch, evaluate_viscosity),
      unary(Scope::kRead, kCompute, compare_points),
      unary(Scope::kRead, kCompute, explain_points),

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
      unary(Scope::kRead, kCompute, rank_candidates),
      unary(Scope::kRead, kSearch, find_pareto_candidates),
      unary(Scope::kRead, kSearch, estimate_candidate_effects),
      unary(Scope::kWrite, kWrite, promote_candidate),
      stream(Scope::kRead, watch_campaign),
      stream(Scope::kRead, read_campaign),
  };
  out.insert(out.end(), others);
  return out;
}
#undef TRIBODYN_STANDARD_ROWS

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
