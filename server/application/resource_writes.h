#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "server/application/field_mask.h"
#include "server/application/resource_methods.h"
#include "server/contract/check_message.h"
#include "server/contract/constraints.h"
#include "server/resources/accept_resource.h"
#include "server/storage/resource_lookup.h"

namespace tribodyn::server {

// The standard methods that create and update, one resource or a batch of them, for every kind
// alike. They throw; the dispatcher guards them.

inline constexpr std::size_t kMaximumBatchViolations = 100;
/// Of a batch [bytes]: clients accept 4 MiB unless told otherwise, and one that cannot read the
/// answer would not know that the batch has been written.
inline constexpr std::size_t kMaximumBatchAnswerBytes = 4'000'000;
/// What set_stored_fields() adds to a resource beside its name, at most [bytes].
inline constexpr std::size_t kStoredFieldBytes = 100;

/// What the mask asks for of an accepted body, as if that had been stored.
template <class Resource>
Resource preview(const std::string& body, const CallContext& call, const ReadMask& mask = {}) {
  Resource out = body_message<Resource>(body).value_or(Resource());
  out.set_name(full_name(call.project, out.name()));
  if (mask.asks_for("characterisation")) add_characterisation(out);
  mask.apply(out);
  return out;
}

/// The name that a new resource is to have, or a violation.
template <class Resource>
std::string new_name(const std::string& id, const std::string& stated, Violations& violations) {
  const std::string collection = Kind<Resource>::kCollection;
  std::string name = id.empty() ? stated : collection + "/" + id;
  if (is_resource_name(name, collection)) return name;
  const std::string field = std::string(Kind<Resource>::kField) + "_id";
  const std::string& wrong = id.empty() ? stated : id;
  const std::string allowed = "allowed: letters, digits, '-', '_' and '.'";
  const bool has_collection = wrong.starts_with(collection + "/");
  const std::string wrong_id = has_collection ? wrong.substr(collection.size() + 1) : wrong;
  const std::string meant = allowed_id(wrong_id);
  violations.add(field, wrong.empty()
                            ? field + " is not set; " + allowed
                            : fmt::format("\"{}\"; {}, at most {} bytes{}", plain_excerpt(wrong),
                                          allowed, kMaximumTextLength - collection.size() - 1,
                                          meant.empty() || meant == wrong_id
                                              ? ""
                                              : fmt::format("; did you mean \"{}\"?", meant)));
  return {};
}

/// Stores a new resource that has been accepted.
template <class Resource>
Outcome<Resource> store_new(Application& application, const Resource& accepted, bool validate_only,
                            const CallContext& call) {
  const std::string name = full_name(call.project, accepted.name());
  if (const auto taken = application.store.resource(name, call.limits)) {
    return name_taken<Resource>(name, taken->delete_time.has_value());
  }
  const std::string body = accepted.SerializeAsString();
  if (validate_only) return preview<Resource>(body, call);
  const auto stored =
      application.store.write_resources({{{name, body}, std::nullopt}}, system_time(), call.limits);
  if (!stored) return name_taken<Resource>(name, false);
  return answer<Resource>(stored->front());
}

/// A create or an update of one resource, from the first read of the store to the resource that is
/// to be stored.
template <class Resource>
struct PendingWrite {
  std::string name;                       ///< relative, of the resource; empty where it is wrong
  std::optional<Resource> stated;         ///< whole; none: not to be judged, or accepted
  std::optional<StoredResource> present;  ///< that an update starts from; none: it is a new one
  std::string body;                       ///< what has been accepted, serialised
  Violations violations;                  ///< paths as in the request
  std::optional<google::rpc::Status> refusal;  ///< why it cannot be, whatever it states
  std::string refused_field;                   ///< what the refusal is about: "lubricant.etag"

  bool is_bad() const { return refusal || !violations.empty(); }
  void refuse(const google::rpc::Status& status, const char* field) {
    refusal = status;
    refused_field = join_path(Kind<Resource>::kField, field);
  }
};

template <class Resource, class Request>
void begin_create(Application& application, const Request& request, PendingWrite<Resource>& write,
                  const CallContext& call) {
  write.stated = Kind<Resource>::of(request);
  write.name =
      new_name<Resource>(Kind<Resource>::id(request), write.stated->name(), write.violations);
  write.stated->set_name(write.name);
  if (write.name.empty()) return;
  const std::string full = full_name(call.project, write.name);
  if (const auto taken = application.store.resource(full, call.limits)) {
    write.refuse(name_taken<Resource>(full, taken->delete_time.has_value()), "name");
  }
}

template <class Resource, class Request>
void begin_update(Application& application, const Request& request, PendingWrite<Resource>& write,
                  const CallContext& call) {
  const Resource& stated = Kind<Resource>::of(request);
  const std::string problem = name_problem<Resource>(application, stated.name(), false, call);
  if (!problem.empty()) {
    write.violations.add(join_path(Kind<Resource>::kField, "name"), problem);
    return;
  }
  write.name = stated.name();
  const auto found = find_named<Resource>(application, stated.name(), call);
  if (!found) {
    if (!request.allow_missing()) {
      return write.refuse(unknown_name<Resource>(application, stated.name(), call), "name");
    }
    write.stated = stated;
    return;
  }
  const StoredResource& present = *found;
  if (present.delete_time) {
    return write.refuse(not_possible(v1::ERROR_REASON_DELETED, Resource::descriptor()->full_name(),
                                     present.name, deleted_name_text(present.name)),
                        "name");
  }
  if (!stated.etag().empty() && stated.etag() != etag_of(present)) {
    return write.refuse(etag_mismatch<Resource>(present.name, stated.etag()), "etag");
  }
  Resource merged;
  if (!merged.ParseFromString(present.body)) {
    return write.refuse(unreadable(present.name), "name");
  }
  merge(stated, request.update_mask(), merged, write.violations);
  if (!write.violations.empty()) return;
  merged.set_name(write.name);
  write.stated = std::move(merged);
  write.present = present;
}

/// Begins the write of a Create...Request or an Update...Request.
template <class Resource, class Request>
PendingWrite<Resource> begin_write(Application& application, const Request& request,
                                   const CallContext& call) {
  PendingWrite<Resource> write;
  if (!Kind<Resource>::is_in(request)) {
    write.violations.add(Kind<Resource>::kField, "not set");
  } else if constexpr (requires { request.update_mask(); }) {
    begin_update(application, request, write, call);
  } else {
    begin_create(application, request, write, call);
  }
  return write;
}

template <class Resource>
void accept_write(const ResourceLookup& lookup, PendingWrite<Resource>& write) {
  if (!write.stated) return;
  std::optional<Resource> before;
  if (write.present) before.emplace().ParseFromString(write.present->body);
  const auto accepted = accept(*write.stated, before ? &*before : nullptr, lookup,
                               Kind<Resource>::kField, write.violations);
  if (!accepted) return;
  write.body = accepted->SerializeAsString();
  write.stated.reset();
}

/// Stores the accepted resources, all or none, and returns them as stored. An unchanged resource
/// gets no revision. Returns nullopt if another call has changed one of them meanwhile.
template <class Resource>
std::optional<std::vector<StoredResource>> store_writes(Application& application,
                                                        std::vector<PendingWrite<Resource>> writes,
                                                        const CallContext& call) {
  std::vector<StoredResource> all(writes.size());
  std::vector<ResourceWrite> changes;
  std::vector<std::size_t> places;  // of the changes in `all`
  for (std::size_t i = 0; i < writes.size(); ++i) {
    PendingWrite<Resource>& write = writes[i];
    if (write.present && write.present->body == write.body) {
      all[i] = std::move(*write.present);
    } else {
      places.push_back(i);
      changes.push_back(
          {{full_name(call.project, write.name), std::move(write.body)}, std::move(write.present)});
    }
  }
  if (changes.empty()) return all;
  auto written = application.store.write_resources(changes, system_time(), call.limits);
  if (!written) return std::nullopt;
  for (std::size_t i = 0; i < places.size(); ++i) all[places[i]] = std::move((*written)[i]);
  return all;
}

/// Creates or updates one resource.
template <class Resource, class Request>
Outcome<Resource> write_resource(Application& application, const Request& request,
                                 const CallContext& call) {
  for (int attempt = 0; attempt < kUpdateAttempts; ++attempt) {
    std::vector<PendingWrite<Resource>> writes;
    PendingWrite<Resource>& write =
        writes.emplace_back(begin_write<Resource>(application, request, call));
    accept_write(resource_lookup(application.store, call.project, call.limits), write);
    if (!write.violations.empty()) return invalid(write.violations);
    if (write.refusal) return *write.refusal;
    if (request.validate_only()) return preview<Resource>(write.body, call);
    if (const auto stored = store_writes(application, std::move(writes), call)) {
      return answer<Resource>(stored->front());
    }
  }
  return contention<Resource>(Kind<Resource>::of(request).name());
}

/// Where each resource of a batch stands in it; a violation for each that stands in it twice.
template <class Resource>
std::map<std::string, std::size_t> places_of(std::vector<PendingWrite<Resource>>& writes) {
  std::map<std::string, std::size_t> places;
  for (std::size_t i = 0; i < writes.size(); ++i) {
    const std::string& name = writes[i].name;
    if (!writes[i].stated || name.empty()) continue;
    const auto [first, is_new] = places.emplace(name, i);
    if (is_new) continue;
    writes[i].violations.add(join_path(Kind<Resource>::kField, "name"),
                             "{} stands in requests[{}] too; allowed: once", name, first->second);
  }
  return places;
}

/// The store as it will be with a batch: so that one resource of it may descend from another one.
template <class Resource>
ResourceLookup lookup_with(const std::vector<PendingWrite<Resource>>& writes,
                           const std::map<std::string, std::size_t>& places,
                           const ResourceLookup& stored) {
  return {[&writes, &places, stored](const RevisionName& name) -> std::optional<FoundResource> {
            const auto found = places.find(name.name);
            if (found == places.end() || name.revision != 0) return stored.find(name);
            const PendingWrite<Resource>& write = writes[found->second];
            return FoundResource{0, false,
                                 write.stated ? write.stated->SerializeAsString() : write.body};
          },
          [&places, stored](const std::string& collection) {
            std::vector<std::string> names = stored.names(collection);
            for (const auto& [name, place] : places) names.push_back(name);
            std::sort(names.begin(), names.end());
            return names;
          },
          std::make_shared<KnownChains>()};
}

/// Everything that is wrong with a batch, or nothing. A refusal that no violation goes with keeps
/// its code.
template <class Resource>
std::optional<google::rpc::Status> refusal_of(const std::vector<PendingWrite<Resource>>& writes) {
  Violations violations;
  const google::rpc::Status* first = nullptr;
  bool all_refusals = true;
  for (std::size_t i = 0; i < writes.size() && violations.size() < kMaximumBatchViolations; ++i) {
    const std::string path = fmt::format("requests[{}]", i);
    for (const Violation& each : writes[i].violations) {
      violations.add(join_path(path, each.field), each.description);
      all_refusals = false;
    }
    if (!writes[i].refusal) continue;
    if (first == nullptr) first = &*writes[i].refusal;
    violations.add(join_path(path, writes[i].refused_field), writes[i].refusal->message());
  }
  if (violations.empty()) return std::nullopt;
  return all_refusals ? with_violations(*first, violations) : invalid(violations);
}

/// Returns the writes of a batch, each accepted or with its violations. Stops after
/// kMaximumBatchViolations bad requests, and when the limits of the call are over: further requests
/// then have no write or one that is not checked. Throws StoreError.
template <class Resource, class Batch>
std::vector<PendingWrite<Resource>> begin_writes(Application& application, const Batch& batch,
                                                 const CallContext& call) {
  std::vector<PendingWrite<Resource>> writes;
  std::size_t bad = 0;
  for (const auto& request : batch.requests()) {
    PendingWrite<Resource>& write =
        writes.emplace_back(begin_write<Resource>(application, request, call));
    if (request.validate_only() && !batch.validate_only()) {
      write.violations.add("validate_only", "set for one of a batch; allowed: for the whole batch");
    }
    if (write.is_bad() && ++bad >= kMaximumBatchViolations) return writes;
  }
  const auto places = places_of(writes);
  const ResourceLookup lookup =
      lookup_with(writes, places, resource_lookup(application.store, call.project, call.limits));
  bad = 0;
  for (PendingWrite<Resource>& write : writes) {
    if (call.limits.are_over()) return writes;
    accept_write(lookup, write);
    if (write.is_bad() && ++bad >= kMaximumBatchViolations) return writes;
  }
  return writes;
}

/// The answer to a batch before anything is written; INVALID_ARGUMENT if it would take more than
/// kMaximumBatchAnswerBytes.
template <class Resource, class Response>
Outcome<Response> preview_answer(const std::vector<PendingWrite<Resource>>& writes,
                                 const ReadMask& mask, const CallContext& call) {
  Response response;
  std::size_t bytes = 0;
  for (std::size_t i = 0; i < writes.size(); ++i) {
    if (call.limits.are_over()) return call_over(call.limits);
    Resource& answered = *Kind<Resource>::add(response);
    answered = preview<Resource>(writes[i].body, call, mask);
    bytes += answered.ByteSizeLong() + writes[i].name.size() + kStoredFieldBytes;
    if (bytes <= kMaximumBatchAnswerBytes) continue;
    return invalid(
        {{"read_mask", fmt::format("the answer would take {} bytes with {} of {} resources; "
                                   "allowed: at most {}. Ask for less, e.g. read_mask = "
                                   "\"name,etag,revision\", or send smaller batches; "
                                   "nothing was written",
                                   bytes, i + 1, writes.size(), kMaximumBatchAnswerBytes)}});
  }
  return response;
}

/// Creates or updates all resources of a batch, or none.
template <class Resource, class Response, class Batch>
Outcome<Response> write_batch(Application& application, const Batch& batch,
                              const CallContext& call) {
  Violations violations;
  check_size(batch, "requests", violations);
  const ReadMask mask(batch.read_mask(), *Resource::descriptor(), violations);
  if (!violations.empty()) return invalid(violations);
  for (int attempt = 0; attempt < kUpdateAttempts; ++attempt) {
    std::vector<PendingWrite<Resource>> writes = begin_writes<Resource>(application, batch, call);
    if (call.limits.are_over()) return call_over(call.limits);
    if (const auto refusal = refusal_of(writes)) return *refusal;
    auto answer = preview_answer<Resource, Response>(writes, mask, call);
    if (!answer.ok() || batch.validate_only()) return answer;
    if (const auto stored = store_writes(application, std::move(writes), call)) {
      for (std::size_t i = 0; i < stored->size(); ++i) {
        Resource& answered = *Kind<Resource>::all(answer.message())->Mutable(static_cast<int>(i));
        set_stored_fields((*stored)[i], answered);
        mask.apply(answered);
      }
      return answer;
    }
  }
  return contention<Resource>("a resource of the batch");
}

}  // namespace tribodyn::server
