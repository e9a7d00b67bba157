#include <algorithm>

#include "client/cpp/library/services.h"
#include "proto/resource_kinds.h"

namespace tribodyn::client {
namespace {

/// The types and methods of the calls of one kind of resource.
template <class Resource>
struct Methods;

// Every kind has the same methods under other names; the macro defines them.
#define TRIBODYN_METHODS(Resource, field, collection, seed)                                      \
  template <>                                                                                    \
  struct Methods<v1::Resource> {                                                                 \
    using Stub = v1::Resource##Service::Stub;                                                    \
    using Create = v1::Create##Resource##Request;                                                \
    using Get = v1::Get##Resource##Request;                                                      \
    using List = v1::List##Resource##sRequest;                                                   \
    using Update = v1::Update##Resource##Request;                                                \
    using Revisions = v1::List##Resource##RevisionsRequest;                                      \
    using BatchCreate = v1::BatchCreate##Resource##sRequest;                                     \
    using BatchUpdate = v1::BatchUpdate##Resource##sRequest;                                     \
    using Delete = v1::Delete##Resource##Request;                                                \
    using Undelete = v1::Undelete##Resource##Request;                                            \
    using Purge = v1::Purge##Resource##Request;                                                  \
    static constexpr auto kCreate = &Stub::Create##Resource;                                     \
    static constexpr auto kGet = &Stub::Get##Resource;                                           \
    static constexpr auto kList = &Stub::List##Resource##s;                                      \
    static constexpr auto kUpdate = &Stub::Update##Resource;                                     \
    static constexpr auto kBatchCreate = &Stub::BatchCreate##Resource##s;                        \
    static constexpr auto kBatchUpdate = &Stub::BatchUpdate##Resource##s;                        \
    static constexpr auto kRevisions = &Stub::List##Resource##Revisions;                         \
    static constexpr auto kDelete = &Stub::Delete##Resource;                                     \
    static constexpr auto kUndelete = &Stub::Undelete##Resource;                                 \
    static constexpr auto kPurge = &Stub::Purge##Resource;                                       \
    template <class Services>                                                                    \
    static Stub& stub(Services& services) {                                                      \
      return *services.field##s;                                                                 \
    }                                                                                            \
    template <class Request>                                                                     \
    static v1::Resource& part(Request& request) {                                                \
      return *request.mutable_##field();                                                         \
    }                                                                                            \
    template <class Response>                                                                    \
    static const auto& parts(const Response& response) {                                         \
      return response.field##s();                                                                \
    }                                                                                            \
    static void set_id(Create& request, const std::string& id) { request.set_##field##_id(id); } \
  };
TRIBODYN_RESOURCE_KINDS(TRIBODYN_METHODS)
#undef TRIBODYN_METHODS

template <class Request>
void set_basic(Request&) {}
void set_basic(v1::ListGearSetsRequest& request) { request.set_view(v1::GEAR_SET_VIEW_BASIC); }

/// Reads pages until the last one or until `limit` entries.
template <class Resource, class Request, class Call>
Listing<Resource> all_pages(Request request, int limit, const Call& call) {
  Listing<Resource> all;
  do {
    const int missing = limit - static_cast<int>(all.resources.size());
    request.set_page_size(limit == 0 ? kLargestPage : std::min(missing, kLargestPage));
    const auto page = call(request);
    const auto& parts = Methods<Resource>::parts(page);
    all.resources.insert(all.resources.end(), parts.begin(), parts.end());
    all.total_size = page.total_size();
    request.set_page_token(page.next_page_token());
  } while (!request.page_token().empty() &&
           (limit == 0 || static_cast<int>(all.resources.size()) < limit));
  all.next_page_token = request.page_token();
  all.has_more = !all.next_page_token.empty();
  return all;
}

template <class Batch>
void set_options(const BatchOptions& options, Batch& batch) {
  batch.set_validate_only(options.validate_only);
  for (const std::string& path : options.read_mask) batch.mutable_read_mask()->add_paths(path);
}

template <class Resource, class Response>
std::vector<Resource> resources_of(const Response& response) {
  const auto& parts = Methods<Resource>::parts(response);
  return {parts.begin(), parts.end()};
}

}  // namespace

template <class Resource>
Resource Connection::create(const Resource& resource, const std::string& id, bool validate_only) {
  typename Methods<Resource>::Create request;
  Methods<Resource>::part(request) = resource;
  Methods<Resource>::set_id(request, id);
  request.set_validate_only(validate_only);
  return services_->call(Methods<Resource>::stub(*services_), Methods<Resource>::kCreate, request);
}

template <class Resource>
Resource Connection::get(const std::string& name) {
  typename Methods<Resource>::Get request;
  request.set_name(name);
  return services_->call(Methods<Resource>::stub(*services_), Methods<Resource>::kGet, request);
}

template <class Resource>
Listing<Resource> Connection::list(const ListOptions& options) {
  typename Methods<Resource>::List request;
  request.set_filter(options.filter);
  request.set_order_by(options.order_by);
  request.set_show_deleted(options.show_deleted);
  request.set_page_token(options.page_token);
  if (options.basic) set_basic(request);
  return all_pages<Resource>(request, options.limit, [&](const auto& page_request) {
    return services_->call(Methods<Resource>::stub(*services_), Methods<Resource>::kList,
                           page_request);
  });
}

template <class Resource>
Resource Connection::update(const Resource& resource, const UpdateOptions& options) {
  typename Methods<Resource>::Update request;
  Methods<Resource>::part(request) = resource;
  for (const std::string& path : options.update_mask) {
    request.mutable_update_mask()->add_paths(path);
  }
  request.set_allow_missing(options.allow_missing);
  request.set_validate_only(options.validate_only);
  return services_->call(Methods<Resource>::stub(*services_), Methods<Resource>::kUpdate, request);
}

template <class Resource>
std::vector<Resource> Connection::create_all(const std::vector<Resource>& resources,
                                             const BatchOptions& options) {
  typename Methods<Resource>::BatchCreate batch;
  for (const Resource& each : resources) Methods<Resource>::part(*batch.add_requests()) = each;
  set_options(options, batch);
  return resources_of<Resource>(
      services_->call(Methods<Resource>::stub(*services_), Methods<Resource>::kBatchCreate, batch));
}

template <class Resource>
std::vector<Resource> Connection::update_all(const std::vector<ResourceUpdate<Resource>>& updates,
                                             const BatchOptions& options) {
  typename Methods<Resource>::BatchUpdate batch;
  for (const ResourceUpdate<Resource>& each : updates) {
    auto& request = *batch.add_requests();
    Methods<Resource>::part(request) = each.resource;
    for (const std::string& path : each.update_mask) request.mutable_update_mask()->add_paths(path);
    request.set_allow_missing(options.allow_missing);
  }
  set_options(options, batch);
  return resources_of<Resource>(
      services_->call(Methods<Resource>::stub(*services_), Methods<Resource>::kBatchUpdate, batch));
}

template <class Resource>
Listing<Resource> Connection::revisions(const std::string& name, int limit) {
  typename Methods<Resource>::Revisions request;
  request.set_name(name);
  return all_pages<Resource>(request, limit, [&](const auto& page_request) {
    return services_->call(Methods<Resource>::stub(*services_), Methods<Resource>::kRevisions,
                           page_request);
  });
}

template <class Resource>
Resource Connection::remove(const std::string& name, const std::string& etag) {
  typename Methods<Resource>::Delete request;
  request.set_name(name);
  request.set_etag(etag);
  return services_->call(Methods<Resource>::stub(*services_), Methods<Resource>::kDelete, request);
}

template <class Resource>
Resource Connection::undelete(const std::string& name, const std::string& etag) {
  typename Methods<Resource>::Undelete request;
  request.set_name(name);
  request.set_etag(etag);
  return services_->call(Methods<Resource>::stub(*services_), Methods<Resource>::kUndelete,
                         request);
}

template <class Resource>
v1::PurgeReport Connection::purge(const std::string& name, const PurgeOptions& options) {
  typename Methods<Resource>::Purge request;
  request.set_name(name);
  request.set_etag(options.etag);
  request.set_delete_simulations(options.delete_simulations);
  request.set_allow_missing(options.allow_missing);
  request.set_validate_only(options.validate_only);
  return services_->call(Methods<Resource>::stub(*services_), Methods<Resource>::kPurge, request);
}

#define TRIBODYN_INSTANTIATE(Resource, field, collection, seed)                               \
  template v1::Resource Connection::create(const v1::Resource&, const std::string&, bool);    \
  template v1::Resource Connection::get(const std::string&);                                  \
  template Listing<v1::Resource> Connection::list(const ListOptions&);                        \
  template v1::Resource Connection::update(const v1::Resource&, const UpdateOptions&);        \
  template std::vector<v1::Resource> Connection::create_all(const std::vector<v1::Resource>&, \
                                                            const BatchOptions&);             \
  template std::vector<v1::Resource> Connection::update_all(                                  \
      const std::vector<ResourceUpdate<v1::Resource>>&, const BatchOptions&);                 \
  template Listing<v1::Resource> Connection::revisions(const std::string&, int);              \
  template v1::Resource Connection::remove(const std::string&, const std::string&);           \
  template v1::Resource Connection::undelete(const std::string&, const std::string&);         \
  template v1::PurgeReport Connection::purge<v1::Resource>(const std::string&, const PurgeOptions&);
TRIBODYN_RESOURCE_KINDS(TRIBODYN_INSTANTIATE)
#undef TRIBODYN_INSTANTIATE

v1::Lubricant Connection::import_lubricant(const v1::ImportLubricantRequest& request) {
  return services_->call(*services_->lubricants, &v1::LubricantService::Stub::ImportLubricant,
                         request);
}

v1::GearSet Connection::import_gear_set(const v1::ImportGearSetRequest& request) {
  return services_->call(*services_->gear_sets, &v1::GearSetService::Stub::ImportGearSet, request);
}

v1::Surface Connection::import_surface_profiles(const v1::ImportSurfaceProfilesRequest& request) {
  return services_->call(*services_->surfaces, &v1::SurfaceService::Stub::ImportSurfaceProfiles,
                         request);
}

}  // namespace tribodyn::client
