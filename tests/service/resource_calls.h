#pragma once

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "proto/resource_kinds.h"
#include "server/application/guard.h"
#include "server/application/method_table.h"
#include "tribodyn/v1/contacts.pb.h"

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

// The methods of resources under their names, e.g. create_gear_set, list_gear_sets.
#define TRIBODYN_CALLS(Resource, field, collection, seed)                                      \
  inline constexpr ResourceCall<v1::Resource> create_##field, get_##field, update_##field,     \
      delete_##field, undelete_##field;                                                        \
  inline constexpr ResourceCall<v1::BatchCreate##Resource##sResponse> batch_create_##field##s; \
  inline constexpr ResourceCall<v1::BatchUpdate##Resource##sResponse> batch_update_##field##s; \
  inline constexpr ResourceCall<v1::List##Resource##sResponse> list_##field##s;                \
  inline constexpr ResourceCall<v1::List##Resource##RevisionsResponse> list_##field##_revisions;
TRIBODYN_RESOURCE_KINDS(TRIBODYN_CALLS)
#undef TRIBODYN_CALLS

/// EvaluateContact, whose use case throws what the model refuses.
inline constexpr ResourceCall<v1::EvaluateContactResponse> answer_contact;

}  // namespace tribodyn::server
