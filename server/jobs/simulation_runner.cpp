#include "server/jobs/simulation_runner.h"

#include <spdlog/spdlog.h>

#include <chrono>
#include <new>
#include <optional>

#include "core/refusal.h"

namespace tribodyn::server {
namespace {

using std::chrono::steady_clock;

constexpr auto kProgressInterval = std::chrono::milliseconds(250);

/// At most one progress event per interval; the stage is part of the next one.
class Reporter {
 public:
  Reporter(ProgressChannel& channel, const StopSignal& stop) : channel_(channel), stop_(stop) {}

  bool operator()(double fraction, const std::string& stage) {
    const auto now = steady_clock::now();
    if (now - last_ >= kProgressInterval) {
      last_ = now;
      channel_.publish({StoredState::kRunning, fraction, stage, "", ""});
    }
    return !stop_.requested();
  }

 private:
  ProgressChannel& channel_;
  const StopSignal& stop_;
  steady_clock::time_point last_ = steady_clock::now();
};

}  // namespace

Progress end_of(const StoredSimulation& stored) {
  return {stored.state, stored.state == StoredState::kSucceeded ? 1.0 : 0.0, "",
          stored.error_reason, stored.error_message};
}

ResourceLookup resource_lookup(Store& store) {
  return {[&store](const RevisionName& name) -> std::optional<FoundResource> {
            auto found = name.revision == 0 ? store.resource(name.name)
                                            : store.revision(name.name, name.revision);
            if (!found) return std::nullopt;
            return FoundResource{found->revision, found->delete_time.has_value(),
                                 std::move(found->body)};
          },
          [&store](const std::string& collection) { return store.resource_names(collection); }};
}

ResourceLookup accepted_lookup(Store& store, const StoredSimulation& simulation) {
  ResourceLookup out = resource_lookup(store);
  std::vector<RevisionName> accepted;
  const auto add = [&accepted](const std::string& name, const char* collection) {
    if (const auto parsed = parse_revision_name(name, collection)) accepted.push_back(*parsed);
  };
  add(simulation.lubricant_revision, kLubricants);
  add(simulation.gear_set_revision, kGearSets);
  add(simulation.surface_revision, kSurfaces);
  add(simulation.vehicle_revision, kVehicles);
  out.find = [find = out.find, accepted](RevisionName name) {
    for (const RevisionName& each : accepted) {
      if (each.name == name.name) name = each;
    }
    auto found = find(name);
    if (found) found->is_deleted = false;
    return found;
  };
  return out;
}

SimulationRunner::SimulationRunner(Store& store, ProgressBoard& board, Clock clock,
                                   StudyFunctions studies)
    : store_(store), board_(board), clock_(std::move(clock)), studies_(std::move(studies)) {}

void SimulationRunner::run(std::int64_t id, const StopSignal& stop) const {
  try {
    if (!store_.mark_running(id, clock_())) return show_end(id);  // before it began
    compute_and_save(id, stop);
  } catch (const Cancelled&) {
    stopped(id, stop.reason());
  } catch (const Refusal& refusal) {
    fail(id, refusal.reason(), refusal.what());
  } catch (const std::bad_alloc&) {
    fail(id, "OUT_OF_MEMORY", "not enough memory for this simulation");
  } catch (const StoreError& error) {
    spdlog::error("simulations/{}: {}", id, error.what());
    fail(id, "STORE_FAILED", "the database could not be read or written");
  } catch (const std::exception& error) {
    fail(id, "INTERNAL", error.what());
  } catch (...) {
    fail(id, "INTERNAL", "unknown error");
  }
}

void SimulationRunner::compute_and_save(std::int64_t id, const StopSignal& stop) const {
  const std::optional<StoredSimulation> stored = store_.simulation(id);
  v1::Simulation request;
  if (!stored || !request.ParseFromString(stored->request)) {
    throw Refusal("STORED_REQUEST_UNREADABLE", "the stored request cannot be read");
  }
  const std::shared_ptr<ProgressChannel> channel = board_.open(id);
  channel->publish({StoredState::kRunning, 0, "", "", ""});
  Violations violations;
  const auto inputs =
      read_simulation(request, accepted_lookup(store_, *stored), "simulation", violations);
  if (!inputs) {
    throw Refusal("INVALID_ARGUMENT",
                  violations.front().field + ": " + violations.front().description);
  }
  Reporter reporter(*channel, stop);
  if (stop.requested()) throw Cancelled();
  const auto begin = steady_clock::now();
  const Computed computed = compute(*inputs, studies_, std::ref(reporter));
  if (!store_.mark_succeeded(id, clock_(), computed.result.SerializeAsString(), computed.history)) {
    return show_end(id);  // in its last moment
  }
  board_.finish(id, {StoredState::kSucceeded, 1, "", "", ""});
  spdlog::info(
      "simulations/{} succeeded in {} ms", id,
      std::chrono::duration_cast<std::chrono::milliseconds>(steady_clock::now() - begin).count());
}

/// Somebody else has ended the simulation, by cancelling it: a channel opened since must end too.
void SimulationRunner::show_end(std::int64_t id) const {
  try {
    const std::optional<StoredSimulation> stored = store_.simulation(id);
    if (stored && has_ended(stored->state)) board_.finish(id, end_of(*stored));
  } catch (const StoreError& error) {
    spdlog::error("simulations/{}: {}", id, error.what());
  }
}

void SimulationRunner::stopped(std::int64_t id, StopReason reason) const {
  if (reason == StopReason::kNone) {
    return fail(id, "INTERNAL", "the study stopped without being asked to");
  }
  if (reason == StopReason::kCancelled) return show_end(id);
  try {
    store_.mark_queued(id);
    spdlog::info("simulations/{} goes back to the queue", id);
  } catch (const StoreError& error) {  // the next start finds it RUNNING and requeues it
    spdlog::error("simulations/{}: {}", id, error.what());
  }
}

void SimulationRunner::fail(std::int64_t id, const std::string& reason,
                            const std::string& message) const {
  // The message may quote inputs, so only the reason is logged.
  spdlog::warn("simulations/{} failed: {}", id, reason);
  try {
    if (!store_.mark_failed(id, clock_(), reason, message)) return show_end(id);
  } catch (const StoreError& error) {
    spdlog::error("simulations/{}: {}", id, error.what());
  }
  board_.finish(id, {StoredState::kFailed, 0, "", reason, message});
}

}  // namespace tribodyn::server
