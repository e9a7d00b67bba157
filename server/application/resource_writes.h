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
  violations.push_back(
      {field,
       id.empty() && stated.empty()
           ? field + " is not set; allowed: letters, digits, '-', '_' and '.'"
           : fmt::format("\"{}\"; allowed: letters, digits, '-', '_' and '.', at most {} bytes",
                         plain_excerpt(id.empty() ? stated : id),
                         kMaximumTextLength - collection.size() - 1)});
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

/// What the request of a create or an update comes to, from its first look at the store to the
/// resource that is to be stored.
template <class Resource>
struct Draft {
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
void draft_create(Application& application, const Request& request, Draft<Resource>& draft,
                  const CallContext& call) {
  draft.stated = Kind<Resource>::of(request);
  draft.name =
      new_name<Resource>(Kind<Resource>::id(request), draft.stated->name(), draft.violations);
  draft.stated->set_name(draft.name);
  if (draft.name.empty()) return;
  const std::string full = full_name(call.project, draft.name);
  if (const auto taken = application.store.resource(full, call.limits)) {
    draft.refuse(name_taken<Resource>(full, taken->delete_time.has_value()), "name");
  }
}

template <class Resource, class Request>
void draft_update(Application& application, const Request& request, Draft<Resource>& draft,
                  const CallContext& call) {
  const Resource& stated = Kind<Resource>::of(request);
  const std::string problem = name_problem<Resource>(application, stated.name(), false, call);
  if (!problem.empty()) {
    draft.violations.push_back({join_path(Kind<Resource>::kField, "name"), problem});
    return;
  }
  draft.name = stated.name();
  const auto found = find_named<Resource>(application, stated.name(), call);
  if (!found) {
    if (!request.allow_missing()) {
      return draft.refuse(unknown_name<Resource>(application, stated.name(), call), "name");
    }
    draft.stated = stated;
    return;
  }
  const StoredResource& present = *found;
  if (present.delete_time) {
    return draft.refuse(not_possible(v1::ERROR_REASON_DELETED, Resource::descriptor()->full_name(),
                                     present.name, deleted_name_text(present.name)),
                        "name");
  }
  if (!stated.etag().empty() && stated.etag() != etag_of(present)) {
    return draft.refuse(etag_mismatch<Resource>(present.name, stated.etag()), "etag");
  }
  Resource merged;
  if (!merged.ParseFromString(present.body)) {
    return draft.refuse(unreadable(present.name), "name");
  }
  merge(stated, request.update_mask(), merged, draft.violations);
  if (!draft.violations.empty()) return;
  merged.set_name(draft.name);
  draft.stated = std::move(merged);
  draft.present = present;
}

/// The draft of a Create...Request or an Update...Request.
template <class Resource, class Request>
Draft<Resource> draft_of(Application& application, const Request& request,
                         const CallContext& call) {
  Draft<Resource> draft;
  if (!Kind<Resource>::is_in(request)) {
    draft.violations.push_back({Kind<Resource>::kField, "not set"});
  } else if constexpr (requires { request.update_mask(); }) {
    draft_update(application, request, draft, call);
  } else {
    draft_create(application, request, draft, call);
  }
  return draft;
}

template <class Resource>
void accept_draft(const ResourceLookup& lookup, Draft<Resource>& draft) {
  if (!draft.stated) return;
  std::optional<Resource> before;
  if (draft.present) before.emplace().ParseFromString(draft.present->body);
  const auto accepted = accept(*draft.stated, before ? &*before : nullptr, lookup,
                               Kind<Resource>::kField, draft.violations);
  if (!accepted) return;
  draft.body = accepted->SerializeAsString();
  draft.stated.reset();
}

/// Stores what has been accepted, all or none, and says what is stored then; what is as it was
/// makes no revision. Nothing when somebody else has been faster.
template <class Resource>
std::optional<std::vector<StoredResource>> store_drafts(Application& application,
                                                        std::vector<Draft<Resource>> drafts,
                                                        const CallContext& call) {
  std::vector<StoredResource> all(drafts.size());
  std::vector<ResourceWrite> writes;
  std::vector<std::size_t> places;  // of the writes
  for (std::size_t i = 0; i < drafts.size(); ++i) {
    Draft<Resource>& draft = drafts[i];
    if (draft.present && draft.present->body == draft.body) {
      all[i] = std::move(*draft.present);
    } else {
      places.push_back(i);
      writes.push_back(
          {{full_name(call.project, draft.name), std::move(draft.body)}, std::move(draft.present)});
    }
  }
  if (writes.empty()) return all;
  auto written = application.store.write_resources(writes, system_time(), call.limits);
  if (!written) return std::nullopt;
  for (std::size_t i = 0; i < places.size(); ++i) all[places[i]] = std::move((*written)[i]);
  return all;
}

/// Creates or updates one resource.
template <class Resource, class Request>
Outcome<Resource> write_resource(Application& application, const Request& request,
                                 const CallContext& call) {
  for (int attempt = 0; attempt < kUpdateAttempts; ++attempt) {
    std::vector<Draft<Resource>> drafts;
    Draft<Resource>& draft = drafts.emplace_back(draft_of<Resource>(application, request, call));
    accept_draft(resource_lookup(application.store, call.project, call.limits), draft);
    if (!draft.violations.empty()) return invalid(draft.violations);
    if (draft.refusal) return *draft.refusal;
    if (request.validate_only()) return preview<Resource>(draft.body, call);
    if (const auto stored = store_drafts(application, std::move(drafts), call)) {
      return answer<Resource>(stored->front());
    }
  }
  return contention<Resource>(Kind<Resource>::of(request).name());
}

/// Where each resource of a batch stands in it; a violation for each that stands in it twice.
template <class Resource>
std::map<std::string, std::size_t> places_of(std::vector<Draft<Resource>>& drafts) {
  std::map<std::string, std::size_t> places;
  for (std::size_t i = 0; i < drafts.size(); ++i) {
    const std::string& name = drafts[i].name;
    if (!drafts[i].stated || name.empty()) continue;
    const auto [first, is_new] = places.emplace(name, i);
    if (is_new) continue;
    drafts[i].violations.push_back(
        {join_path(Kind<Resource>::kField, "name"),
         fmt::format("{} stands in requests[{}] too; allowed: once", name, first->second)});
  }
  return places;
}

/// The store as it will be with a batch: so that one resource of it may descend from another one.
template <class Resource>
ResourceLookup lookup_with(const std::vector<Draft<Resource>>& drafts,
                           const std::map<std::string, std::size_t>& places,
                           const ResourceLookup& stored) {
  return {[&drafts, &places, stored](const RevisionName& name) -> std::optional<FoundResource> {
            const auto found = places.find(name.name);
            if (found == places.end() || name.revision != 0) return stored.find(name);
            const Draft<Resource>& draft = drafts[found->second];
            return FoundResource{0, false,
                                 draft.stated ? draft.stated->SerializeAsString() : draft.body};
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
std::optional<google::rpc::Status> refusal_of(const std::vector<Draft<Resource>>& drafts) {
  Violations violations;
  const google::rpc::Status* first = nullptr;
  bool all_refusals = true;
  for (std::size_t i = 0; i < drafts.size() && violations.size() < kMaximumBatchViolations; ++i) {
    const std::string path = fmt::format("requests[{}]", i);
    for (const Violation& each : drafts[i].violations) {
      violations.push_back({join_path(path, each.field), each.description});
      all_refusals = false;
    }
    if (!drafts[i].refusal) continue;
    if (first == nullptr) first = &*drafts[i].refusal;
    violations.push_back({join_path(path, drafts[i].refused_field), drafts[i].refusal->message()});
  }
  if (violations.empty()) return std::nullopt;
  return all_refusals ? with_violations(*first, violations) : invalid(violations);
}

/// Returns the drafts of a batch, each accepted or with its violations. Stops after
/// kMaximumBatchViolations bad requests, and when the limits of the call are over: further requests
/// then have no draft or one that is not checked. Throws StoreError.
template <class Resource, class Batch>
std::vector<Draft<Resource>> drafts_of(Application& application, const Batch& batch,
                                       const CallContext& call) {
  std::vector<Draft<Resource>> drafts;
  std::size_t bad = 0;
  for (const auto& request : batch.requests()) {
    Draft<Resource>& draft = drafts.emplace_back(draft_of<Resource>(application, request, call));
    if (request.validate_only() && !batch.validate_only()) {
      draft.violations.push_back(
          {"validate_only", "set for one of a batch; allowed: for the whole batch"});
    }
    if (draft.is_bad() && ++bad >= kMaximumBatchViolations) return drafts;
  }
  const auto places = places_of(drafts);
  const ResourceLookup lookup =
      lookup_with(drafts, places, resource_lookup(application.store, call.project, call.limits));
  bad = 0;
  for (Draft<Resource>& draft : drafts) {
    if (call.limits.are_over()) return drafts;
    accept_draft(lookup, draft);
    if (draft.is_bad() && ++bad >= kMaximumBatchViolations) return drafts;
  }
  return drafts;
}

/// The answer to a batch before anything is written; INVALID_ARGUMENT if it would take more than
/// kMaximumBatchAnswerBytes.
template <class Resource, class Response>
Outcome<Response> draft_answer(const std::vector<Draft<Resource>>& drafts, const ReadMask& mask,
                               const CallContext& call) {
  Response response;
  std::size_t bytes = 0;
  for (std::size_t i = 0; i < drafts.size(); ++i) {
    if (call.limits.are_over()) return call_over(call.limits);
    Resource& answered = *Kind<Resource>::add(response);
    answered = preview<Resource>(drafts[i].body, call, mask);
    bytes += answered.ByteSizeLong() + drafts[i].name.size() + kStoredFieldBytes;
    if (bytes <= kMaximumBatchAnswerBytes) continue;
    return invalid(
        {{"read_mask", fmt::format("the answer would take {} bytes with {} of {} resources; "
                                   "allowed: at most {}. Ask for less, e.g. read_mask = "
                                   "\"name,etag,revision\", or send smaller batches; "
                                   "nothing was written",
                                   bytes, i + 1, drafts.size(), kMaximumBatchAnswerBytes)}});
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
    std::vector<Draft<Resource>> drafts = drafts_of<Resource>(application, batch, call);
    if (call.limits.are_over()) return call_over(call.limits);
    if (const auto refusal = refusal_of(drafts)) return *refusal;
    auto answer = draft_answer<Resource, Response>(drafts, mask, call);
    if (!answer.ok() || batch.validate_only()) return answer;
    if (const auto stored = store_drafts(application, std::move(drafts), call)) {
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
