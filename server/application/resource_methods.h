#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>

#include "server/application/application.h"
#include "server/application/call_context.h"
#include "server/application/computed_fields.h"
#include "server/application/errors.h"
#include "server/application/list_filter.h"
#include "server/application/outcome.h"
#include "server/application/page_token.h"
#include "server/application/paging.h"
#include "server/application/read_mask.h"
#include "server/application/stored_messages.h"
#include "server/contract/output_only.h"
#include "server/contract/resource_kinds.h"
#include "server/resources/lubricant_parameters.h"
#include "tribodyn/v1/purge_report.pb.h"

namespace tribodyn::server {

// The standard methods that read or delete, for every kind of resource alike; resource_writes.h has
// the others. They throw; the dispatcher guards them.

inline constexpr int kDefaultResourcePageSize = 100;
inline constexpr int kUpdateAttempts = 10;  ///< against other writers

template <class Resource>
google::rpc::Status name_taken(const std::string& name, bool deleted) {
  return already_exists(v1::ERROR_REASON_ALREADY_EXISTS, Resource::descriptor()->full_name(), name,
                        deleted ? name + " exists and is deleted; undelete it or take another name"
                                : name + " exists already; update it or take another name");
}

template <class Resource>
google::rpc::Status etag_mismatch(const std::string& name, const std::string& etag) {
  return etag_mismatch(Resource::descriptor()->full_name(), name, etag);
}

template <class Resource>
google::rpc::Status contention(const std::string& name) {
  return contention(Resource::descriptor()->full_name(), name);
}

inline google::rpc::Status unreadable(const std::string& name) {
  return error(google::rpc::DATA_LOSS, v1::ERROR_REASON_STORED_RESOURCE_UNREADABLE,
               name + " cannot be read from the database", {{"name", name}});
}

/// What a single lubricant shows beside its parameters.
inline void add_characterisation(v1::Lubricant& lubricant) {
  *lubricant.mutable_characterisation() = characterisation(lubricant);
}
template <class Resource>
void add_characterisation(Resource&) {}

/// What a lubricant shows in a list.
inline void add_list_figures(v1::Lubricant& lubricant) {
  *lubricant.mutable_characterisation() = brief_characterisation(lubricant);
}
template <class Resource>
void add_list_figures(Resource&) {}

/// Does not ask the store, so that what has been written is answered whatever the deadline.
template <class Resource>
Outcome<Resource> answer(const StoredResource& stored) {
  auto out = to_message<Resource>(stored);
  if (!out) return unreadable(stored.name);
  add_characterisation(*out);
  return *out;
}

/// What is wrong with a name, whether there is such a resource or not; empty: nothing.
template <class Resource>
std::string name_problem(Application& application, const std::string& name, bool revisions_allowed,
                         const CallContext& call) {
  const std::string collection = Kind<Resource>::kCollection;
  const auto parsed = parse_revision_name(name, collection);
  if (!parsed) {
    return unknown_name_text(
        name, collection, application.store.resource_names(call.project, collection, call.limits));
  }
  if (parsed->revision == 0 || revisions_allowed) return {};
  return plain_excerpt(name) + " is a revision; allowed: the name without it";
}

/// The stored revision that a name without problems means; nullopt if there is none.
template <class Resource>
std::optional<StoredResource> find_named(Application& application, const std::string& name,
                                         const CallContext& call) {
  const RevisionName parsed = *parse_revision_name(name, Kind<Resource>::kCollection);
  const std::string full = full_name(call.project, parsed.name);
  return parsed.revision == 0 ? application.store.resource(full, call.limits)
                              : application.store.revision(full, parsed.revision, call.limits);
}

/// NOT_FOUND with the name that may be meant. Compares the name with all of its collection.
template <class Resource>
google::rpc::Status unknown_name(Application& application, const std::string& name,
                                 const CallContext& call) {
  const std::string collection = Kind<Resource>::kCollection;
  return not_found(
      Resource::descriptor()->full_name(), full_name(call.project, name),
      unknown_name_text(name, collection,
                        application.store.resource_names(call.project, collection, call.limits)));
}

/// The stored revision that a name means; INVALID_ARGUMENT for what is no name, or NOT_FOUND.
template <class Resource>
Outcome<StoredResource> find_stored(Application& application, const std::string& name,
                                    bool revisions_allowed, const CallContext& call) {
  const std::string problem = name_problem<Resource>(application, name, revisions_allowed, call);
  if (!problem.empty()) return invalid({{"name", problem}});
  if (auto found = find_named<Resource>(application, name, call)) return *std::move(found);
  return unknown_name<Resource>(application, name, call);
}

template <class Resource, class Request>
Outcome<Resource> get_resource(Application& application, const Request& request,
                               const CallContext& call) {
  Violations violations;
  const ReadMask mask(request.read_mask(), *Resource::descriptor(), violations);
  if (!violations.empty()) return invalid(violations);
  const auto found = find_stored<Resource>(application, request.name(), true, call);
  if (!found.ok()) return found.error();
  Outcome<Resource> out = answer<Resource>(found.message());
  if (out.ok()) mask.apply(out.message());
  return out;
}

/// Deletes, also what is deleted already, or undeletes; ALREADY_EXISTS for what is not deleted
/// (AIP-164).
template <bool deleted, class Resource, class Request>
Outcome<Resource> set_deleted(Application& application, const Request& request,
                              const CallContext& call) {
  for (int attempt = 0; attempt < kUpdateAttempts; ++attempt) {
    const auto found = find_stored<Resource>(application, request.name(), false, call);
    if (!found.ok()) return found.error();
    StoredResource present = found.message();
    if (!request.etag().empty() && request.etag() != etag_of(present)) {
      return etag_mismatch<Resource>(present.name, request.etag());
    }
    if (present.delete_time.has_value() == deleted) {
      if (deleted) return answer<Resource>(present);
      return already_exists(v1::ERROR_REASON_NOT_DELETED, Resource::descriptor()->full_name(),
                            present.name, present.name + " is not deleted");
    }
    const Microseconds now = system_time();
    if (deleted ? application.store.delete_resource(present, now, call.limits)
                : application.store.undelete_resource(present, call.limits)) {
      present.delete_time = deleted ? std::optional(now) : std::nullopt;
      return answer<Resource>(present);
    }
  }
  return contention<Resource>(request.name());
}

/// Why a resource cannot be purged as the request asks; nullopt if it can.
template <class Resource, class Request>
std::optional<google::rpc::Status> unpurgeable(const StoredResource& present,
                                               const Dependents& dependents,
                                               const Request& request) {
  if (!request.etag().empty() && request.etag() != etag_of(present)) {
    return etag_mismatch<Resource>(present.name, request.etag());
  }
  if (!dependents.exist() || request.delete_simulations()) return std::nullopt;
  const int simulations = dependents.simulations(), campaigns = dependents.campaigns();
  std::string users;
  if (simulations > 0) {
    users = fmt::format("{} {}", simulations, simulations == 1 ? "simulation" : "simulations");
  }
  if (campaigns > 0) {
    users += fmt::format("{}{} {}", users.empty() ? "" : " and ", campaigns,
                         campaigns == 1 ? "campaign" : "campaigns");
  }
  return not_possible(
      v1::ERROR_REASON_IN_USE, Resource::descriptor()->full_name(), present.name,
      fmt::format("{} used {}; delete_simulations deletes them too", users, present.name),
      {{"simulations", std::to_string(simulations)}, {"campaigns", std::to_string(campaigns)}});
}

/// Erases a resource with all its revisions, and what a former purge left to be erased.
template <class Resource, class Request>
Outcome<v1::PurgeReport> purge_resource(Application& application, const Request& request,
                                        const CallContext& call) {
  Store& store = application.store;
  v1::PurgeReport report;
  report.set_name(full_name(call.project, request.name()));
  const auto erase = [&] {
    const bool sees_all = call.grant->projects.empty();
    const auto copies = store.erase_removed(sees_all);
    report.set_copies_remain(!sees_all && !copies.empty());
    for (const auto& file : copies) {
      if (sees_all) report.add_remaining_files(file.filename());
    }
    return report;
  };
  for (int attempt = 0; attempt < kUpdateAttempts; ++attempt) {
    const auto found = find_stored<Resource>(application, request.name(), false, call);
    if (!found.ok()) {
      const bool is_missing = found.error().code() == google::rpc::NOT_FOUND;
      if (!is_missing || !request.allow_missing()) return found.error();
      return store.has_unerased_purge() && !request.validate_only() ? erase() : report;
    }
    const StoredResource& present = found.message();
    const Dependents dependents = store.dependents_of(present, call.limits);
    if (auto refused = unpurgeable<Resource>(present, dependents, request)) {
      return *std::move(refused);
    }
    const auto state = [&report](const Dependents& users) {
      report.set_simulations(users.simulations());
      report.set_results(users.results);
      report.set_campaigns(users.campaigns());
    };
    report.set_revisions(present.revision);  // numbered from 1 without gaps
    state(dependents);
    if (request.validate_only()) return report;
    for (const std::int64_t id : dependents.unfinished)
      application.jobs.scheduler().cancel(id, call.limits);
    for (const std::int64_t id : dependents.unfinished_campaigns) {
      application.jobs.campaigns().cancel(id, call.limits);
    }
    const Store::Purge purge =
        store.purge_resource(present, request.delete_simulations(), call.limits);
    if (purge.revisions == 0) continue;  // others changed or used it meanwhile
    state(purge.dependents);
    return erase();
  }
  return contention<Resource>(request.name());
}

/// Appends to a response what the mask asks for of each row; an error if one cannot be read.
template <class Resource, class Response>
google::rpc::Status append(const Page<StoredResource>& page, const ReadMask& mask,
                           Response& response) {
  for (const StoredResource& row : page.rows) {
    auto message = to_message<Resource>(row);
    if (!message) return unreadable(row.name);
    if (mask.asks_for("characterisation")) add_list_figures(*message);
    mask.apply(*message);
    *Kind<Resource>::add(response) = std::move(*message);
  }
  return {};
}

/// Leaves of a page what its view shows.
template <class Request, class Response>
void keep_view(const Request&, Response&) {}
inline void keep_view(const v1::ListGearSetsRequest& request, v1::ListGearSetsResponse& response) {
  if (request.view() != v1::GEAR_SET_VIEW_BASIC) return;
  for (v1::GearSet& gear_set : *response.mutable_gear_sets()) {
    gear_set.clear_series();
    gear_set.clear_flank_slots();
    gear_set.clear_series_by_torque();
    gear_set.clear_load_share_by_torque();
  }
}

template <class Resource, class Response, class Request>
Outcome<Response> list_resources(Application& application, const Request& request,
                                 const CallContext& call) {
  Violations violations;
  ResourceQuery query;
  query.project = call.project;
  query.collection = Kind<Resource>::kCollection;
  query.limit = page_size(request.page_size(), kDefaultResourcePageSize, violations);
  query.byte_limit = kMaximumPageBytes;
  query.show_deleted = request.show_deleted();
  query.restrictions = parse_filter(request.filter(), query.collection, violations);
  const Order order = parse_order(request.order_by(), query.collection, violations);
  query.order_key = order.key;
  query.descending = order.descending;
  const ReadMask mask(request.read_mask(), *Resource::descriptor(), violations);
  const std::string scope =
      fmt::format("{} {} {} {}", full_name(query.project, query.collection), request.show_deleted(),
                  request.order_by(), request.filter());
  std::int64_t total = 0;
  query.counts_all = request.page_token().empty();
  if (!query.counts_all) {
    if (auto token = parse_page_token(application.page_token_key, scope, request.page_token())) {
      query.after = std::move(token->last);
      total = token->total;
    } else {
      add_bad_page_token(violations);
    }
  }
  if (!violations.empty()) return invalid(violations);
  const auto read_page = [&](const ResourceQuery& stored) {
    return application.store.resources(stored, call.limits);
  };
  const Page<StoredResource> page =
      needs_computed_fields(query) ? query_by_computed_fields(query, read_page) : read_page(query);
  Response response;
  if (const auto failed = append<Resource>(page, mask, response); failed.code() != 0) return failed;
  keep_view(request, response);
  if (query.counts_all) total = page.total;
  response.set_total_size(clamped_total(total));
  if (page.more) {
    const StoredResource& last = page.rows.back();
    response.set_next_page_token(page_token(application.page_token_key, scope,
                                            {{order_value(last, order.key), last.name}, total}));
  }
  return response;
}

template <class Resource, class Response, class Request>
Outcome<Response> list_revisions(Application& application, const Request& request,
                                 const CallContext& call) {
  Violations violations;
  const int size = page_size(request.page_size(), kDefaultResourcePageSize, violations);
  const std::string name = full_name(call.project, request.name());
  const std::string scope = "revisions of " + name;
  std::optional<PageToken> after;
  if (!request.page_token().empty()) {
    after = parse_page_token(application.page_token_key, scope, request.page_token());
    if (!after || !std::holds_alternative<std::int64_t>(after->last.value)) {
      add_bad_page_token(violations);
    }
  }
  if (!violations.empty()) return invalid(violations);
  const auto found = find_stored<Resource>(application, request.name(), false, call);
  if (!found.ok()) return found.error();
  const int before = after ? static_cast<int>(std::get<std::int64_t>(after->last.value)) : 0;
  Page<StoredResource> page =
      application.store.revisions(name, before, size, kMaximumPageBytes, call.limits);
  for (StoredResource& row : page.rows) row.is_present = false;  // all names with their revision
  Response response;
  if (const auto failed = append<Resource>(page, ReadMask(), response); failed.code() != 0) {
    return failed;
  }
  response.set_total_size(found.message().revision);  // numbered from 1 without gaps
  if (page.more) {
    response.set_next_page_token(page_token(application.page_token_key, scope,
                                            {{std::int64_t{page.rows.back().revision}, name}}));
  }
  return response;
}

}  // namespace tribodyn::server
