#include "server/application/simulations.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <mutex>
#include <optional>

#include "server/application/element_limits.h"
#include "server/application/errors.h"
#include "server/application/label_update.h"
#include "server/application/list_filter.h"
#include "server/application/page_token.h"
#include "server/application/paging.h"
#include "server/application/project_space.h"
#include "server/application/read_mask.h"
#include "server/application/request_text.h"
#include "server/application/result_summary.h"
#include "server/application/simulation_lookup.h"
#include "server/application/stored_messages.h"
#include "server/simulation/assumptions.h"
#include "server/simulation/cost_estimate.h"
#include "server/simulation/input_hash.h"
#include "server/simulation/result_key.h"
#include "server/simulation/simulation_inputs.h"
#include "server/simulation/study_checks.h"
#include "server/storage/checksum.h"
#include "server/storage/resource_lookup.h"
#include "server/support/sha256.h"

namespace tribodyn::server {
namespace {

constexpr int kDefaultPageSize = 50;
constexpr int kLongestShortPage = 100;  // simulations, some 10 us each

static_assert(static_cast<int>(StoredState::kQueued) == v1::Simulation::QUEUED);
static_assert(static_cast<int>(StoredState::kRunning) == v1::Simulation::RUNNING);
static_assert(static_cast<int>(StoredState::kSucceeded) == v1::Simulation::SUCCEEDED);
static_assert(static_cast<int>(StoredState::kFailed) == v1::Simulation::FAILED);
static_assert(static_cast<int>(StoredState::kCancelled) == v1::Simulation::CANCELLED);

static_assert(static_cast<int>(RequestedClass::kInteractive) == v1::SCHEDULING_CLASS_INTERACTIVE);
static_assert(static_cast<int>(RequestedClass::kBulk) == v1::SCHEDULING_CLASS_BULK);

/// Returns the time at which a requested deadline passes; nullopt if the request sets none.
std::optional<Microseconds> deadline_time(const v1::Simulation& requested, Microseconds now) {
  if (!requested.has_deadline_seconds()) return std::nullopt;
  return now + static_cast<Microseconds>(1e6 * requested.deadline_seconds());
}

NewSimulation new_simulation(const v1::CreateSimulationRequest& request,
                             const SimulationInputs& inputs, const std::string& request_hash,
                             const CallContext& call) {
  const v1::Simulation& effective = inputs.effective;
  std::vector<std::pair<std::string, std::string>> labels;
  for (const v1::Label& each : inputs.requested.labels()) {
    labels.emplace_back(each.key(), each.value());
  }
  return {.project = call.project,
          .request = inputs.requested.SerializeAsString(),
          .key = result_key(inputs),
          .ledger = serialised_assumptions(inputs),
          .request_id = request.request_id(),
          .request_hash = request_hash,
          .is_forced = request.force(),
          .deadline_time = deadline_time(inputs.requested, system_time()),
          .client = call.client,
          .principal = payer(call),
          .scheduling_class = request.scheduling_class(),
          .cost_seconds = estimate_cost(inputs).processor_seconds(),
          .labels = std::move(labels),
          .revisions = {effective.lubricant_revision(), effective.gear_set_revision(),
                        effective.surface_revision(), effective.vehicle_revision()}};
}

/// Returns the simulation that a request with validate_only would create, without a name.
v1::Simulation preview(const SimulationInputs& inputs, const NewSimulation& simulation) {
  v1::Simulation out = inputs.requested;
  set_revisions(simulation.revisions, out);
  out.set_state(v1::Simulation::QUEUED);
  out.set_input_hash(simulation.key.input_hash);
  out.set_canonical_inputs(canonical_inputs(inputs));
  *out.mutable_cost_estimate() = estimate_cost(inputs);
  if (simulation.deadline_time)
    *out.mutable_deadline_time() = timestamp_of(*simulation.deadline_time);
  return out;
}

/// Returns the etag (AIP-154). It changes with every part of a simulation that clients can change.
std::string etag_of(const StoredSimulation& stored) {
  return fmt::format("{:016x}",
                     static_cast<std::uint64_t>(checksum(name_of(stored) + stored.request)));
}

/// Returns the stored simulation as a message, without its result.
v1::Simulation to_message(Application& application, const StoredSimulation& stored) {
  v1::Simulation out;
  out.ParseFromString(stored.request);
  out.set_name(name_of(stored));
  out.set_state(static_cast<v1::Simulation::State>(stored.state));
  set_revisions(stored.revisions, out);
  out.set_input_hash(stored.input_hash);
  out.set_attempt(stored.attempt);
  out.set_cache_hit(stored.cache_hit);
  out.set_event_sequence(stored.sequence);
  out.set_request_id(stored.request_id);
  out.set_pinned(stored.is_pinned);
  out.set_etag(etag_of(stored));
  const auto& keep = application.jobs.retention().keep;
  if (keep && stored.end_time && !stored.is_pinned) {
    *out.mutable_expire_time() = timestamp_of(*stored.end_time + *keep);
  }
  *out.mutable_create_time() = timestamp_of(stored.create_time);
  if (stored.start_time) *out.mutable_start_time() = timestamp_of(*stored.start_time);
  if (stored.end_time) *out.mutable_end_time() = timestamp_of(*stored.end_time);
  if (stored.deadline_time) *out.mutable_deadline_time() = timestamp_of(*stored.deadline_time);
  if (stored.state == StoredState::kFailed) {
    out.mutable_error()->set_reason(stored.error_reason);
    out.mutable_error()->set_message(stored.error_message);
  }
  if (stored.state == StoredState::kSucceeded) {
    out.set_progress_fraction(1);
  } else if (stored.state == StoredState::kRunning) {
    const auto progress = application.jobs.progress(stored.id);
    if (progress) out.set_progress_fraction(progress->fraction);
  }
  return out;
}

/// Returns the error for a request whose request_id an earlier, different request has used.
google::rpc::Status request_id_taken(const StoredSimulation& stored,
                                     const v1::CreateSimulationRequest& request,
                                     const std::string& text) {
  v1::Simulation earlier;
  earlier.ParseFromString(stored.request);
  const std::string field = first_difference(text, request_text(earlier, stored.is_forced));
  return already_exists(
      v1::ERROR_REASON_REQUEST_ID_REUSED, "tribodyn.v1.Simulation", name_of(stored),
      fmt::format("request_id \"{}\" made {} by a request that differs in {}; take another one",
                  request.request_id(), name_of(stored), field),
      {{"request_id", request.request_id()}, {"field", field}},
      {{"request_id", fmt::format("belongs to another request; it differs in {}", field)}});
}

/// Returns the simulation that an earlier request with the same request_id created, or an error if
/// that request differs. Returns nullopt if there is none.
std::optional<Outcome<v1::Simulation>> earlier_answer(Application& application,
                                                      const v1::CreateSimulationRequest& request,
                                                      const std::string& text,
                                                      const CallContext& call) {
  if (request.request_id().empty()) return std::nullopt;
  const auto stored =
      application.store.simulation_of_request(call.project, request.request_id(), call.limits);
  if (!stored) return std::nullopt;
  if (stored->request_hash != sha256(text)) return request_id_taken(*stored, request, text);
  if (stored->state == StoredState::kQueued) application.jobs.scheduler().ensure_queued(*stored);
  return to_message(application, *stored);
}

/// Sets the part of the result that `view` includes (`fallback` if it is unspecified). Sets nothing
/// if the read mask excludes the result or the simulation has none.
void set_result(Application& application, v1::SimulationView view, v1::SimulationView fallback,
                const ReadMask& mask, std::int64_t id, v1::Simulation& out,
                const CallContext& call) {
  const v1::SimulationView meant = view == v1::SIMULATION_VIEW_UNSPECIFIED ? fallback : view;
  if (meant == v1::SIMULATION_VIEW_BASIC || !mask.asks_for("result")) return;
  auto result = application.store.result(id, call.limits);
  if (!result) return;
  if (call.sends_wire_format && meant == v1::SIMULATION_VIEW_FULL && mask.is_whole()) {
    // The store holds results in the wire format, so the bytes can be sent without being parsed.
    auto* unknown = v1::Simulation::GetReflection()->MutableUnknownFields(&out);
    *unknown->AddLengthDelimited(v1::Simulation::kResultFieldNumber) = *std::move(result);
    return;
  }
  out.mutable_result()->ParseFromString(*result);
  if (meant == v1::SIMULATION_VIEW_SUMMARY) summarise(*out.mutable_result());
}

bool is_ascending(const std::string& order_by, Violations& violations) {
  if (order_by == "create_time" || order_by == "create_time asc") return true;
  if (!order_by.empty() && order_by != "create_time desc") {
    violations.add("order_by", "allowed: create_time, followed by nothing, asc or desc");
  }
  return false;
}

/// Returns the row after which the page of a token begins; nullopt if the token has no such row.
std::optional<SimulationQuery::Cursor> cursor(const PageStart& start) {
  const auto* time = std::get_if<std::int64_t>(&start.value);
  const auto number = simulation_id(start.name);
  if (time == nullptr || !number) return std::nullopt;
  return SimulationQuery::Cursor{*time, *number};
}

/// Logs the names of request, simulation and inputs, which connect them. Logs no inputs.
void log_submission(const CallContext& call, const NewSimulation& simulation,
                    const AddOutcome& added) {
  spdlog::info(
      "event=simulation_{} simulation={} request_id={} client={} input_hash={} cost_seconds={:.6f} "
      "call={}",
      added.kind == AddOutcome::Kind::kQueued   ? "queued"
      : added.kind == AddOutcome::Kind::kServed ? "served"
                                                : "not_added",
      added.id == 0 ? "-" : name_of(added.stored), simulation.request_id, simulation.client,
      simulation.key.input_hash, simulation.cost_seconds, call.request_id);
}

google::rpc::Status no_place(Application& application, double retry_seconds) {
  if (application.jobs.scheduler().is_stopping()) return shutting_down();
  return exhausted(
      v1::ERROR_REASON_TOO_MANY_WAITING,
      fmt::format("the queue has no place for this simulation: at most {} simulations and {:.3g} "
                  "processor hours may wait, three quarters of them for one client; try again in "
                  "{:.2f} s",
                  application.jobs.limits().jobs, application.jobs.limits().cost_seconds / 3600,
                  retry_seconds),
      retry_seconds);
}

}  // namespace

Outcome<v1::Simulation> create_simulation(Application& application,
                                          const v1::CreateSimulationRequest& request,
                                          const CallContext& call) {
  Violations violations;
  check_request_id(request.request_id(), violations);
  if (!request.has_simulation()) violations.add("simulation", "not set");
  check_choice(request, "scheduling_class", violations);
  check_counts(request.simulation(), "simulation", violations);  // first: work grows with them
  if (!violations.empty()) return invalid(violations);
  const std::string text = request_text(client_part(request.simulation()), request.force());
  // Before the inputs are checked: the resources may have changed since the earlier request.
  auto earlier = earlier_answer(application, request, text, call);
  if (earlier && (!request.validate_only() || !earlier->ok())) return *std::move(earlier);
  std::unique_lock slot(*application.submission_slots);
  const StopWatch watch;
  auto inputs = read_simulation(request.simulation(),
                                resource_lookup(application.store, call.project, call.limits),
                                "simulation", violations);
  application.jobs.metrics().observe(Phase::kValidation, watch.seconds());
  if (inputs) {
    check_pour_point(*inputs->lubricant, inputs->effective.sump_temperature_celsius(),
                     "simulation.lubricant", violations, inputs->effective.lubricant_revision());
  }
  if (!violations.empty()) {
    application.jobs.metrics().count(Submission::kInvalid);
    return invalid(violations);
  }
  const NewSimulation simulation = new_simulation(request, *inputs, sha256(text), call);
  slot.unlock();
  if (request.validate_only()) return preview(*inputs, simulation);
  if (auto full = project_full(application, call)) return *std::move(full);
  WorkPlace place;
  auto refused = take_hours(application, simulation.cost_seconds, call, place);
  const Scheduler::Admitted submitted = application.jobs.scheduler().admit(
      simulation, std::make_shared<const SimulationInputs>(std::move(*inputs)), call.limits,
      !refused);
  const AddOutcome& added = submitted.added;
  log_submission(call, simulation, added);
  if (added.kind == AddOutcome::Kind::kNoPlace) {
    return refused ? *std::move(refused) : no_place(application, submitted.retry_seconds);
  }
  if (added.kind == AddOutcome::Kind::kRequestIdTaken) {
    return request_id_taken(added.stored, request, text);
  }
  return to_message(application, added.stored);
}

Outcome<v1::Simulation> get_simulation(Application& application,
                                       const v1::GetSimulationRequest& request,
                                       const CallContext& call) {
  Violations violations;
  const ReadMask mask(request.read_mask(), *v1::Simulation::descriptor(), violations);
  if (!violations.empty()) return invalid(violations);
  const auto found = find_simulation(application, request.name(), call);
  if (!found.ok()) return found.error();
  v1::Simulation out = to_message(application, found.message());
  set_result(application, request.view(), v1::SIMULATION_VIEW_FULL, mask, found.message().id, out,
             call);
  mask.apply(out);
  return out;
}

bool is_short_list(const v1::ListSimulationsRequest& request) {
  const bool has_results = request.view() != v1::SIMULATION_VIEW_UNSPECIFIED &&
                           request.view() != v1::SIMULATION_VIEW_BASIC;
  return request.filter().empty() && !has_results && request.read_mask().paths().empty() &&
         request.page_size() <= kLongestShortPage;
}

Outcome<v1::ListSimulationsResponse> list_simulations(Application& application,
                                                      const v1::ListSimulationsRequest& request,
                                                      const CallContext& call) {
  Violations violations;
  SimulationQuery query;
  query.project = call.project;
  query.limit = page_size(request.page_size(), kDefaultPageSize, violations);
  query.byte_limit = kMaximumPageBytes;
  query.restrictions = parse_job_filter(request.filter(), kSimulations, violations);
  query.ascending = is_ascending(request.order_by(), violations);
  const ReadMask mask(request.read_mask(), *v1::Simulation::descriptor(), violations);
  const v1::SimulationView fallback =
      mask.is_whole() ? v1::SIMULATION_VIEW_BASIC : v1::SIMULATION_VIEW_FULL;
  const std::string scope = fmt::format("{}\n{}\n{}", full_name(query.project, kSimulations),
                                        request.filter(), request.order_by());
  std::int64_t total = 0;
  query.counts_all = request.page_token().empty();
  if (!query.counts_all) {
    const auto token = parse_page_token(application.page_token_key, scope, request.page_token());
    if (token) query.after = cursor(token->last);
    if (query.after) total = token->total;
    if (!query.after) add_bad_page_token(violations);
  }
  if (!violations.empty()) return invalid(violations);
  v1::ListSimulationsResponse response;
  // Before the page: an event between the two is in both rather than in none.
  response.set_event_number(application.store.event_range(call.project, call.limits).latest);
  const Page<StoredSimulation> page = application.store.simulations(query, call.limits);
  if (query.counts_all) total = page.total;
  response.set_total_size(clamped_total(total));
  std::size_t bytes = 0;
  bool is_cut = false;
  for (const StoredSimulation& row : page.rows) {
    v1::Simulation next = to_message(application, row);
    set_result(application, request.view(), fallback, mask, row.id, next, call);
    mask.apply(next);
    bytes += next.ByteSizeLong();
    is_cut = response.simulations_size() > 0 && bytes > kMaximumPageBytes;
    if (is_cut) break;
    *response.add_simulations() = std::move(next);
  }
  if (page.more || is_cut) {
    const StoredSimulation& last = page.rows[response.simulations_size() - 1];
    response.set_next_page_token(
        page_token(application.page_token_key, scope,
                   {{last.create_time, relative_name(name_of(last))}, total}));
  }
  return response;
}

namespace {

Outcome<v1::Simulation> set_pinned(Application& application, const std::string& name,
                                   bool is_pinned, const CallContext& call) {
  const auto found = find_simulation(application, name, call);
  if (!found.ok()) return found.error();
  // All reads come before the write: after the commit the call must not fail.
  v1::Simulation result;
  set_result(application, v1::SIMULATION_VIEW_FULL, v1::SIMULATION_VIEW_FULL, {},
             found.message().id, result, call);
  const auto pinned = application.store.set_pinned(found.message().id, is_pinned, call.limits);
  if (!pinned) return does_not_exist(name);
  v1::Simulation out = to_message(application, *pinned);
  out.MergeFrom(result);
  return out;
}

}  // namespace

namespace {

constexpr int kWriteAttempts = 10;  // against other writers
constexpr char kSimulationType[] = "tribodyn.v1.Simulation";

Outcome<v1::Simulation> update_stored(Application& application,
                                      const v1::UpdateSimulationRequest& request,
                                      const CallContext& call) {
  const std::string& name = request.simulation().name();
  for (int attempt = 0; attempt < kWriteAttempts; ++attempt) {
    const auto found = find_simulation(application, name, call);
    if (!found.ok()) return found.error();
    const StoredSimulation& present = found.message();
    const std::string& etag = request.simulation().etag();
    if (!etag.empty() && etag != etag_of(present))
      return etag_mismatch(kSimulationType, name, etag);
    v1::Simulation changed;
    changed.ParseFromString(present.request);
    Violations violations;
    take_over_labels(request.update_mask(), request.simulation(), "simulation", changed,
                     violations);
    if (!violations.empty()) return invalid(violations);
    const auto updated = application.store.relabel_simulation(present, changed.SerializeAsString(),
                                                              labels_of(changed), call.limits);
    if (updated) return to_message(application, *updated);
  }
  return contention(kSimulationType, name);
}

/// Why a simulation cannot be deleted as the request asks; nullopt if it can.
std::optional<google::rpc::Status> undeletable(const StoredSimulation& stored,
                                               const v1::DeleteSimulationRequest& request) {
  if (!request.etag().empty() && request.etag() != etag_of(stored)) {
    return etag_mismatch(kSimulationType, request.name(), request.etag());
  }
  if (stored.is_pinned) {
    return not_possible(v1::ERROR_REASON_PINNED, kSimulationType, request.name(),
                        request.name() + " is pinned; unpin it to delete it");
  }
  if (has_ended(stored.state) || request.cancel()) return std::nullopt;
  const std::string state =
      v1::Simulation::State_Name(static_cast<v1::Simulation::State>(stored.state));
  return not_possible(v1::ERROR_REASON_NOT_ENDED, kSimulationType, request.name(),
                      fmt::format("{} is {}; cancel it to delete it", request.name(), state),
                      {{"state", state}});
}

}  // namespace

Outcome<google::protobuf::Empty> delete_simulation(Application& application,
                                                   const v1::DeleteSimulationRequest& request,
                                                   const CallContext& call) {
  using google::protobuf::Empty;
  for (int attempt = 0; attempt < kWriteAttempts; ++attempt) {
    const auto found = find_simulation(application, request.name(), call);
    if (!found.ok()) {
      const bool is_missing = found.error().code() == google::rpc::NOT_FOUND;
      if (is_missing && request.allow_missing()) return Empty();
      return found.error();
    }
    const StoredSimulation& stored = found.message();
    if (auto refused = undeletable(stored, request)) return *std::move(refused);
    if (!has_ended(stored.state)) application.jobs.scheduler().cancel(stored.id, call.limits);
    if (application.store.remove_simulation(stored.id, stored.request, call.limits) ==
        Store::Removal::kDone) {
      return Empty();
    }
  }
  return contention(kSimulationType, request.name());
}

Outcome<v1::Simulation> update_simulation(Application& application,
                                          const v1::UpdateSimulationRequest& request,
                                          const CallContext& call) {
  if (!request.has_simulation()) return invalid({{"simulation", "not set"}});
  if (!simulation_id(request.simulation().name())) {
    return invalid(
        {{"simulation.name", "not a name of the form \"simulations/{id}\", id a number"}});
  }
  return update_stored(application, request, call);
}

Outcome<v1::Simulation> pin_simulation(Application& application,
                                       const v1::PinSimulationRequest& request,
                                       const CallContext& call) {
  return set_pinned(application, request.name(), true, call);
}

Outcome<v1::Simulation> unpin_simulation(Application& application,
                                         const v1::UnpinSimulationRequest& request,
                                         const CallContext& call) {
  return set_pinned(application, request.name(), false, call);
}

Outcome<v1::Simulation> cancel_simulation(Application& application,
                                          const v1::CancelSimulationRequest& request,
                                          const CallContext& call) {
  auto found = find_simulation(application, request.name(), call);
  if (!found.ok()) return found.error();
  StoredSimulation& stored = found.message();
  const auto event = application.jobs.scheduler().cancel(stored.id, call.limits);
  if (!event) {
    v1::GetSimulationRequest now;
    now.set_name(request.name());
    return get_simulation(application, now, call);
  }
  // The answer is not read from the store: a read after the deadline would fail, although the
  // simulation is cancelled.
  stored.state = event->state;
  stored.attempt = event->attempt;
  stored.sequence = event->sequence;
  stored.start_time = event->start_time;
  stored.end_time = event->time;
  return to_message(application, stored);
}

}  // namespace tribodyn::server
