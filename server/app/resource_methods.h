#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>

#include "server/app/application.h"
#include "server/app/field_mask.h"
#include "server/app/guard.h"
#include "server/app/list_filter.h"
#include "server/app/outcome.h"
#include "server/app/page_token.h"
#include "server/app/paging.h"
#include "server/app/resource_kinds.h"
#include "server/app/stored_messages.h"
#include "server/convert/accept_resource.h"
#include "server/convert/constraints.h"
#include "server/convert/lubricant_parameters.h"
#include "server/convert/output_only.h"
#include "server/jobs/simulation_runner.h"

namespace tribodyn::server {

// The standard methods, for every kind of resource alike. Bodies of RPCs: run inside `guarded`.

inline constexpr int kDefaultResourcePageSize = 100;
inline constexpr int kUpdateAttempts = 10;  ///< against other writers

template <class Resource>
google::rpc::Status name_taken(const std::string& name, bool deleted) {
  return already_exists("ALREADY_EXISTS", Resource::descriptor()->full_name(), name,
                        deleted ? name + " exists and is deleted; undelete it or take another name"
                                : name + " exists already; update it or take another name");
}

template <class Resource>
google::rpc::Status etag_mismatch(const std::string& name) {
  return aborted("ETAG_MISMATCH", Resource::descriptor()->full_name(), name,
                 name + " has changed since this etag was given out; get it again", false);
}

template <class Resource>
google::rpc::Status contention(const std::string& name) {
  return aborted("CONTENTION", Resource::descriptor()->full_name(), name,
                 name + " keeps being changed by others; try again", true);
}

inline google::rpc::Status unreadable(const std::string& name) {
  return error(google::rpc::DATA_LOSS, "STORED_RESOURCE_UNREADABLE",
               name + " cannot be read from the database");
}

/// What a single lubricant shows beside its parameters.
inline void add_characterisation(v1::Lubricant& lubricant) {
  *lubricant.mutable_characterisation() = characterisation(lubricant);
}
inline void add_characterisation(v1::GearSet&) {}
inline void add_characterisation(v1::Surface&) {}
inline void add_characterisation(v1::Vehicle&) {}

/// What a lubricant shows in a list.
inline void add_list_figures(v1::Lubricant& lubricant) {
  *lubricant.mutable_characterisation() = brief_characterisation(lubricant);
}
inline void add_list_figures(v1::GearSet&) {}
inline void add_list_figures(v1::Surface&) {}
inline void add_list_figures(v1::Vehicle&) {}

template <class Resource>
Outcome<Resource> answer(const std::optional<StoredResource>& stored, const std::string& name) {
  if (!stored) return error(google::rpc::INTERNAL, "INTERNAL", name + " is gone");
  auto out = to_message<Resource>(*stored);
  if (!out) return unreadable(name);
  add_characterisation(*out);
  return *out;
}

/// The stored revision that a name means; INVALID_ARGUMENT for what is no name, or NOT_FOUND.
template <class Resource>
Outcome<StoredResource> find_stored(Application& application, const std::string& name,
                                    bool revisions_allowed) {
  const std::string collection = Kind<Resource>::kCollection;
  const auto explain = [&] {
    return unknown_name_text(name, collection, application.store.resource_names(collection));
  };
  const auto parsed = parse_revision_name(name, collection);
  if (!parsed) return invalid({{"name", explain()}});
  if (parsed->revision != 0 && !revisions_allowed) {
    return invalid({{"name", plain_excerpt(name) + " is a revision; legal: the name without it"}});
  }
  const auto stored = parsed->revision == 0
                          ? application.store.resource(parsed->name)
                          : application.store.revision(parsed->name, parsed->revision);
  if (!stored) return not_found(Resource::descriptor()->full_name(), name, explain());
  return *stored;
}

template <class Resource>
Outcome<Resource> get_resource(Application& application, const std::string& name) {
  const auto found = find_stored<Resource>(application, name, true);
  if (!found.ok()) return found.error();
  return answer<Resource>(found.message(), name);
}

/// As if it had been stored.
template <class Resource>
Outcome<Resource> preview(const Resource& accepted) {
  Resource out = accepted;
  fill_units(*Resource::descriptor(), *out.mutable_provenance());
  add_characterisation(out);
  return out;
}

/// The name that a new resource is to have, or a violation.
template <class Resource>
std::string new_name(const std::string& id, const std::string& stated, Violations& violations) {
  const std::string collection = Kind<Resource>::kCollection;
  std::string name = id.empty() ? stated : collection + "/" + id;
  if (is_resource_name(name, collection)) return name;
  const std::string field = std::string(Kind<Resource>::kField) + "_id";
  violations.push_back(
      {field,
       id.empty() && stated.empty()
           ? field + " is not set; legal: letters, digits, '-', '_' and '.'"
           : fmt::format("\"{}\"; legal: letters, digits, '-', '_' and '.', at most {} bytes",
                         plain_excerpt(id.empty() ? stated : id),
                         kMaximumTextLength - collection.size() - 1)});
  return {};
}

/// Stores what has been accepted.
template <class Resource>
Outcome<Resource> store_new(Application& application, const Resource& accepted,
                            bool validate_only) {
  const std::string& name = accepted.name();
  if (const auto taken = application.store.resource(name)) {
    return name_taken<Resource>(name, taken->delete_time.has_value());
  }
  if (validate_only) return preview(accepted);
  if (!application.store.create_resource({name, accepted.SerializeAsString()}, system_time())) {
    return name_taken<Resource>(name, false);
  }
  return answer<Resource>(application.store.resource(name), name);
}

template <class Resource, class Request>
Outcome<Resource> create_resource(Application& application, const Request& request) {
  const std::string field = Kind<Resource>::kField;
  if (!Kind<Resource>::is_in(request)) return invalid({{field, "not set"}});
  Violations violations;
  Resource stated = Kind<Resource>::of(request);
  stated.set_name(new_name<Resource>(Kind<Resource>::id(request), stated.name(), violations));
  const auto accepted = accept(stated, static_cast<const Resource*>(nullptr),
                               resource_lookup(application.store), field, violations);
  if (!violations.empty() || !accepted) return invalid(violations);
  return store_new(application, *accepted, request.validate_only());
}

template <class Resource, class Request>
Outcome<Resource> update_resource(Application& application, const Request& request) {
  const std::string field = Kind<Resource>::kField;
  if (!Kind<Resource>::is_in(request)) return invalid({{field, "not set"}});
  const Resource& stated = Kind<Resource>::of(request);
  for (int attempt = 0; attempt < kUpdateAttempts; ++attempt) {
    const auto found = find_stored<Resource>(application, stated.name(), false);
    if (!found.ok() && found.error().code() == google::rpc::NOT_FOUND && request.allow_missing()) {
      Violations violations;
      const auto accepted = accept(stated, static_cast<const Resource*>(nullptr),
                                   resource_lookup(application.store), field, violations);
      if (!accepted) return invalid(violations);
      return store_new(application, *accepted, request.validate_only());
    }
    if (!found.ok()) return found.error();
    const StoredResource& present = found.message();
    if (present.delete_time) {
      return not_possible("DELETED", Resource::descriptor()->full_name(), present.name,
                          deleted_name_text(present.name));
    }
    if (!stated.etag().empty() && stated.etag() != etag_of(present)) {
      return etag_mismatch<Resource>(present.name);
    }
    Resource before;
    if (!before.ParseFromString(present.body)) return unreadable(present.name);
    Violations violations;
    Resource merged = before;
    merge(stated, request.update_mask(), merged, violations);
    merged.set_name(present.name);
    if (!violations.empty()) return invalid(violations);
    const auto accepted =
        accept(merged, &before, resource_lookup(application.store), field, violations);
    if (!accepted) return invalid(violations);
    if (request.validate_only()) return preview(*accepted);
    const std::string body = accepted->SerializeAsString();
    if (body == present.body || application.store.update_resource(present, body, system_time())) {
      return answer<Resource>(application.store.resource(present.name), present.name);
    }
  }
  return contention<Resource>(stated.name());
}

/// Deletes or undeletes; what is so already stays as it is.
template <class Resource, class Request>
Outcome<Resource> set_deleted(Application& application, const Request& request, bool deleted) {
  for (int attempt = 0; attempt < kUpdateAttempts; ++attempt) {
    const auto found = find_stored<Resource>(application, request.name(), false);
    if (!found.ok()) return found.error();
    const StoredResource& present = found.message();
    if (!request.etag().empty() && request.etag() != etag_of(present)) {
      return etag_mismatch<Resource>(present.name);
    }
    if (present.delete_time.has_value() == deleted ||
        (deleted ? application.store.delete_resource(present, system_time())
                 : application.store.undelete_resource(present))) {
      return answer<Resource>(application.store.resource(present.name), present.name);
    }
  }
  return contention<Resource>(request.name());
}

/// Appends rows to a response; false when one of them cannot be read.
template <class Resource, class Response>
google::rpc::Status append(const Page<StoredResource>& page, Response& response) {
  for (const StoredResource& row : page.rows) {
    auto message = to_message<Resource>(row);
    if (!message) return unreadable(row.name);
    add_list_figures(*message);
    *Kind<Resource>::add(response) = std::move(*message);
  }
  return {};
}

/// The value that a page was ordered by, of its last row.
inline PropertyValue order_value(const StoredResource& row, const std::string& key) {
  if (key.empty()) return std::string();
  for (Property& each : properties_of(row.name.substr(0, row.name.find('/')), row.body,
                                      row.create_time, row.revision_create_time)) {
    if (each.key == key) return std::move(each.value);
  }
  return std::string();
}

template <class Resource, class Response, class Request>
Outcome<Response> list_resources(Application& application, const Request& request) {
  Violations violations;
  ResourceQuery query;
  query.collection = Kind<Resource>::kCollection;
  query.limit = page_size(request.page_size(), kDefaultResourcePageSize, violations);
  query.byte_limit = kMaximumPageBytes;
  query.show_deleted = request.show_deleted();
  query.restrictions = parse_filter(request.filter(), query.collection, violations);
  const Order order = parse_order(request.order_by(), query.collection, violations);
  query.order_key = order.key;
  query.descending = order.descending;
  const std::string scope = fmt::format("{} {} {} {}", query.collection, request.show_deleted(),
                                        request.order_by(), request.filter());
  if (!request.page_token().empty()) {
    query.after = parse_page_token(scope, request.page_token());
    if (!query.after) add_bad_page_token(violations);
  }
  if (!violations.empty()) return invalid(violations);
  const Page<StoredResource> page = application.store.resources(query);
  Response response;
  if (const auto failed = append<Resource>(page, response); failed.code() != 0) return failed;
  if (page.more) {
    const StoredResource& last = page.rows.back();
    response.set_next_page_token(page_token(scope, {order_value(last, order.key), last.name}));
  }
  return response;
}

template <class Resource, class Response, class Request>
Outcome<Response> list_revisions(Application& application, const Request& request) {
  Violations violations;
  const int size = page_size(request.page_size(), kDefaultResourcePageSize, violations);
  const std::string scope = "revisions of " + request.name();
  std::optional<PageStart> after;
  if (!request.page_token().empty()) {
    after = parse_page_token(scope, request.page_token());
    if (!after || !std::holds_alternative<std::int64_t>(after->value)) {
      add_bad_page_token(violations);
    }
  }
  if (!violations.empty()) return invalid(violations);
  const auto found = find_stored<Resource>(application, request.name(), false);
  if (!found.ok()) return found.error();
  const int before = after ? static_cast<int>(std::get<std::int64_t>(after->value)) : 0;
  Page<StoredResource> page =
      application.store.revisions(request.name(), before, size, kMaximumPageBytes);
  for (StoredResource& row : page.rows) row.is_present = false;  // all names with their revision
  Response response;
  if (const auto failed = append<Resource>(page, response); failed.code() != 0) return failed;
  if (page.more) {
    response.set_next_page_token(
        page_token(scope, {std::int64_t{page.rows.back().revision}, request.name()}));
  }
  return response;
}

}  // namespace tribodyn::server
