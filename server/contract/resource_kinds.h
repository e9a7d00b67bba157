#pragma once

#include <string>

#include "proto/resource_kinds.h"

namespace tribodyn::server {

/// What the standard methods need of a kind of resource: its collection, the field that holds it in
/// requests, the fields that bear its name, and its lists in responses.
template <class Resource>
struct Kind;

#define TRIBODYN_KIND(Resource, field, collection, seed)                               \
  template <>                                                                          \
  struct Kind<v1::Resource> {                                                          \
    static constexpr char kCollection[] = #collection;                                 \
    static constexpr char kField[] = #field;                                           \
    static const v1::Resource& of(const auto& request) { return request.field(); }     \
    static bool is_in(const auto& request) { return request.has_##field(); }           \
    static const std::string& id(const auto& request) { return request.field##_id(); } \
    static v1::Resource* add(auto& response) { return response.add_##field##s(); }     \
    static auto* all(auto& response) { return response.mutable_##field##s(); }         \
  };
TRIBODYN_RESOURCE_KINDS(TRIBODYN_KIND)
#undef TRIBODYN_KIND

/// The collections of all kinds.
#define TRIBODYN_COLLECTION(Resource, field, collection, seed) #collection,
inline constexpr const char* kResourceCollections[] = {
    TRIBODYN_RESOURCE_KINDS(TRIBODYN_COLLECTION)};
#undef TRIBODYN_COLLECTION

}  // namespace tribodyn::server
