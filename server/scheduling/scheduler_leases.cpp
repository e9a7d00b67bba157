// Scheduler: a lease until its end, which is a result, a failure, a stop or its expiry.
#include <spdlog/spdlog.h>

#include <new>

#include "core/refusal.h"
#include "server/scheduling/scheduler.h"
#include "server/scheduling/store_retries.h"

namespace tribodyn::server {
namespace {

/// Name of the simulation in log lines; its row until the name is read.
std::string name_of(const Lease& lease) {
  return lease.name.empty() ? "row:" + std::to_string(lease.id) : lease.name;
}

/// Durations in the log line of a computed simulation.
struct Timings {
  double waited_seconds = 0;
  double computed_seconds = 0;
  double stored_seconds = 0;
};

void log_computed(const Lease& lease, const std::string& request_id, const std::string& input_hash,
                  const Timings& timings) {
  spdlog::info(
      "event=simulation_computed simulation={} request_id={} input_hash={} waited_seconds={:.6f} "
      "computed_seconds={:.6f} stored_seconds={:.6f}",
      name_of(lease), request_id, input_hash, timings.waited_seconds, timings.computed_seconds,
      timings.stored_seconds);
}

std::int64_t bytes_of(const internal::v1::ComputeResult& result) {
  std::int64_t bytes = 0;
  for (const auto& column : result.history()) {
    bytes += column.values_size() * static_cast<std::int64_t>(sizeof(double));
  }
  return bytes;
}

}  // namespace

/// Returns false if the lease has ended or has expired. Requires the lock.
bool Scheduler::is_current(const Lease& lease) const {
  const auto leased = leased_.find(lease.id);
  return leased != leased_.end() && leased->second.stop == lease.stop;
}

void Scheduler::extend(const Lease& lease, double used_seconds) {
  {
    const std::lock_guard lock(mutex_);
    if (!is_current(lease)) return lease.stop->request(StopReason::kEnded);
    switch (policy_.use(lease.id, used_seconds)) {
      case ClaimPolicy::Verdict::kGoOn:
        break;
      case ClaimPolicy::Verdict::kReclassed:
        spdlog::info("event=simulation_reclassified simulation={} used_seconds={:.3f}",
                     name_of(lease), used_seconds);
        break;
      case ClaimPolicy::Verdict::kGiveBack:
        lease.stop->request(StopReason::kReclassed);
    }
    note_change();
    Leased& leased = leased_.at(lease.id);
    const SteadyTime now = options_.steady();
    leased.expires = now + options_.lease;
    if (now - leased.written < options_.lease / 3) return;
    leased.written = now;
  }
  const Microseconds lease_time = std::chrono::microseconds(options_.lease).count();
  try {
    store_.extend_lease(lease.id, lease.attempt, options_.clock() + lease_time);
  } catch (const StoreError& error) {  // while the server runs, the lease in memory decides
    spdlog::error("{}: {}", name_of(lease), error.what());
  }
}

void Scheduler::computed(const Lease& lease, const internal::v1::ComputeResult& result) {
  const std::lock_guard lock(mutex_);
  if (!is_current(lease)) return;
  leased_.at(lease.id).is_computed = true;
  policy_.set_result_bytes(lease.id, bytes_of(result));
  policy_.computed(lease.id, result.processor_seconds());
  note_change();
}

void Scheduler::return_slice(const Lease& lease, double used_seconds, bool goes_on) {
  {
    const std::lock_guard lock(mutex_);
    leased_.erase(lease.id);
    policy_.computed(lease.id, used_seconds);
    goes_on ? policy_.requeue(lease.id) : policy_.end(lease.id);
    note_change();
  }
  ended_.notify_all();
}

bool Scheduler::run_or_fail(const Lease& lease, const std::function<void()>& action) {
  try {
    try {
      action();
    } catch (const Refusal& refusal) {
      fail(lease, refusal.reason(), refusal.what());
    } catch (const std::bad_alloc&) {
      fail(lease, "OUT_OF_MEMORY", "not enough memory for this simulation");
    } catch (const StoreError&) {
      throw;
    } catch (const std::exception& error) {
      fail_on_defect(lease, error.what());
    } catch (...) {
      fail_on_defect(lease, "an exception of unknown type");
    }
    return true;
  } catch (const StoreError& error) {  // the next start finds it unfinished and queues it
    spdlog::error("{} keeps its state: {}", name_of(lease), error.what());
    return false;
  }
}

void Scheduler::complete(const Lease& lease, internal::v1::ComputeResult result) {
  {
    const std::lock_guard lock(mutex_);
    if (!is_current(lease)) return;
  }
  bool goes_back = false;
  const bool is_written = run_or_fail(lease, [&] {
    if (result.has_refusal()) {
      fail(lease, result.refusal().reason(), result.refusal().message());
    } else if (result.has_result()) {
      save(lease, result);
    } else if (result.stopped()) {
      goes_back = stopped(lease);
    } else {
      fail_on_defect(lease, result.defect());
    }
  });
  if (!is_written && !is_stopping()) {
    // The simulation stays RUNNING in the store until its lease expires; expire_leases() then tries
    // at every tick to write.
    const std::lock_guard lock(mutex_);
    leased_.at(lease.id).is_computed = false;
    return;
  }
  end(lease.id, goes_back);
}

void Scheduler::save(const Lease& lease, internal::v1::ComputeResult& result) {
  const StopWatch storing;
  std::string request_id;
  Timings timings;
  {
    const std::lock_guard lock(mutex_);
    const Leased& leased = leased_.at(lease.id);
    request_id = leased.request_id;
    timings.waited_seconds = leased.waited_seconds;
    timings.computed_seconds =
        std::chrono::duration<double>(options_.steady() - leased.begin).count();
  }
  const NewResult stored{{lease.task.input_hash(), result.model_version(), result.platform()},
                         std::move(*result.mutable_result()),
                         take_history(result)};
  const auto ended = retry_on_store_error(lease.id, *lease.stop, [&] {
    return store_.mark_succeeded(lease.id, options_.clock(), stored, lease.attempt);
  });
  metrics_.observe(Phase::kStore, storing.seconds());
  if (ended) {
    metrics_.count(ended->state == StoredState::kSucceeded ? SimulationOutcome::kSucceeded
                                                           : SimulationOutcome::kFailed);
  }
  publish(lease.id, ended);
  timings.stored_seconds = storing.seconds();
  log_computed(lease, request_id, stored.key.input_hash, timings);
}

/// Writes the end of an attempt that was asked to stop. Returns true if the job must wait again in
/// this process.
bool Scheduler::stopped(const Lease& lease) {
  const auto back = [&](const char* reason) {
    const auto event = retry_on_store_error(lease.id, *lease.stop, [&] {
      return store_.mark_queued(lease.id, options_.clock(), reason, lease.attempt);
    });
    publish(lease.id, event);
    return event.has_value();
  };
  switch (lease.stop->reason()) {
    case StopReason::kNone:
      fail_on_defect(lease, "the study ended early without a request to stop");
      return false;
    case StopReason::kEnded:
      publish(lease.id, std::nullopt);
      return false;
    case StopReason::kReclassed:
      spdlog::info("event=simulation_preempted simulation={}", name_of(lease));
      return back("OUTRAN_ESTIMATE");
    case StopReason::kShutdown:
      back("SERVER_STOPPED");
      spdlog::info("event=simulation_requeued simulation={}", name_of(lease));
  }
  return false;
}

void Scheduler::fail_on_defect(const Lease& lease, const std::string& cause) {
  spdlog::error("event=internal_error simulation={} cause=\"{}\"", name_of(lease), cause);
  fail(lease, "INTERNAL", "internal error; the server's log states its cause");
}

void Scheduler::fail(const Lease& lease, const std::string& reason, const std::string& message) {
  // The message may quote inputs, so only the reason is logged.
  spdlog::warn("event=simulation_failed simulation={} reason={}", name_of(lease), reason);
  const auto event = retry_on_store_error(lease.id, *lease.stop, [&] {
    return store_.mark_failed(lease.id, options_.clock(), reason, message);
  });
  if (event) metrics_.count(SimulationOutcome::kFailed);
  publish(lease.id, event);
}

/// Publishes the event on the simulation's channel. Without an event another thread has ended the
/// simulation, and a channel that was opened since then needs that end. A deleted simulation has
/// ended.
void Scheduler::publish(std::int64_t id, const std::optional<StoredEvent>& event) {
  StoredState state = StoredState::kCancelled;
  std::int64_t sequence = 0;
  if (event) {
    state = event->state;
    sequence = event->sequence;
  } else if (const std::optional<StoredSimulation> stored = store_.simulation(id)) {
    state = stored->state;
    sequence = stored->sequence;
  }
  if (has_ended(state)) {
    timekeeper_.remove_deadline(id);
    board_.finish(id, sequence);
  } else {
    board_.open(id)->publish_event(sequence);
  }
}

/// Forgets the lease of a job, which `goes_back` to the queue or has ended.
void Scheduler::end(std::int64_t id, bool goes_back) {
  {
    const std::lock_guard lock(mutex_);
    leased_.erase(id);
    goes_back ? policy_.requeue(id) : policy_.end(id);
    note_change();
  }
  ended_.notify_all();
}

void Scheduler::expire_leases() {
  std::vector<Lease> expired;
  {
    const std::lock_guard lock(mutex_);
    if (stopping_) return;
    const SteadyTime now = options_.steady();
    const auto gap = now - last_look_;
    last_look_ = now;
    // If this process was suspended, so were its executors, and the messages of others wait.
    const bool stood_still = gap > 3 * options_.tick + std::chrono::seconds(1);
    for (auto& [id, leased] : leased_) {
      if (leased.is_computed || leased.expires == SteadyTime::max()) continue;
      if (stood_still) leased.expires += gap;
      if (leased.expires > now) continue;
      Lease& lease = expired.emplace_back();
      lease.id = id;
      lease.name = leased.name;
      lease.attempt = leased.attempt;
      lease.stop = leased.stop;
    }
  }
  for (const Lease& lease : expired) {
    try {
      const auto event =
          store_.mark_lost(lease.id, lease.attempt, options_.clock(), "LEASE_EXPIRED");
      lease.stop->request(StopReason::kEnded);
      if (event && event->state == StoredState::kFailed) metrics_.count(SimulationOutcome::kFailed);
      spdlog::warn("event=lease_expired simulation={} attempt={}", name_of(lease), lease.attempt);
      publish(lease.id, event);
      end(lease.id, event && event->state == StoredState::kQueued);
    } catch (const StoreError& error) {  // tried again at the next tick
      spdlog::error("{}: {}", name_of(lease), error.what());
    }
  }
}

}  // namespace tribodyn::server
