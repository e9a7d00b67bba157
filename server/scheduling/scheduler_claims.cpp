// Scheduler: the beginning of a job, from the claim of an executor to its lease.
#include <algorithm>

#include "core/refusal.h"
#include "core/version.h"
#include "server/scheduling/scheduler.h"
#include "server/scheduling/store_retries.h"
#include "server/simulation/golden_case.h"
#include "server/simulation/input_hash.h"
#include "server/storage/resource_lookup.h"

namespace tribodyn::server {

std::string Scheduler::enroll(
    const std::string& worker, const Capabilities& capabilities,
    const std::function<internal::v1::ComputeResult(const internal::v1::ComputeTask&)>& compute) {
  if (options_.wants_proof) {
    std::string wrong = check_golden_result(compute(golden_task()));
    if (!wrong.empty()) return wrong;
  }
  const std::lock_guard lock(mutex_);
  if (enrolled_.emplace(worker, capabilities).second) policy_.add_threads(capabilities.threads);
  note_change();
  return {};
}

bool Scheduler::wait_for_work() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return stopping_ || policy_.may_begin(); });
  return !stopping_;
}

/// Starts the next job. Sets `has_begun` if a job began. Returns nullopt if none did, or if the job
/// needs no computation or waits for equal inputs.
std::optional<Lease> Scheduler::begin(const std::string& worker, const Lease* lender,
                                      bool& has_begun) {
  std::optional<QueuedJob> job;
  std::string platform;
  Lease slice;
  {
    const std::lock_guard lock(mutex_);
    const auto enrolled = enrolled_.find(worker);
    if (stopping_ || enrolled == enrolled_.end()) return std::nullopt;
    platform = enrolled->second.platform;
    job = lender == nullptr ? policy_.begin() : policy_.begin_beside(lender->id);
    has_begun = job.has_value();
    if (!job) return std::nullopt;
    Leased& leased = leased_[job->id];
    leased.stop = std::make_shared<StopSignal>();
    leased.expires = SteadyTime::max();
    slice.id = job->id;
    slice.stop = leased.stop;
    note_change();
  }
  if (campaign_part(job->id)) return slice;
  return lease_of(*job, worker, platform);
}

std::optional<Lease> Scheduler::claim(const std::string& worker) {
  for (bool has_begun = true; has_begun;) {
    has_begun = false;
    if (auto lease = begin(worker, nullptr, has_begun)) return lease;
  }
  return std::nullopt;
}

std::optional<Lease> Scheduler::claim_beside(const std::string& worker, const Lease& lender) {
  bool has_begun = false;
  return begin(worker, &lender, has_begun);
}

/// Reads the row of a simulation whose inputs were not kept and the four revisions that it was
/// accepted with. After a restart the model may be a newer one, so the inputs are checked again.
Scheduler::Known Scheduler::load(std::int64_t id, const StopSignal& stop) {
  const StopWatch watch;
  auto stored = retry_on_store_error(id, stop, [&] { return store_.simulation(id); });
  if (!stored) throw Refusal("STORED_REQUEST_UNREADABLE", "the stored request is gone");
  v1::Simulation request;
  if (!request.ParseFromString(stored->request)) {
    throw Refusal("STORED_REQUEST_UNREADABLE", "the stored request cannot be read");
  }
  set_accepted_names(stored->revisions, request);
  Violations violations;
  auto inputs = retry_on_store_error(id, stop, [&] {
    violations.clear();
    return read_simulation(request, accepted_lookup(store_, stored->project, stored->revisions),
                           "simulation", violations);
  });
  if (!inputs) {
    throw Refusal("STORED_REQUEST_INVALID",
                  violations.front().field + ": " + violations.front().description);
  }
  stored->input_hash = input_hash(*inputs);
  Known out = known_of(*stored, std::make_shared<const SimulationInputs>(std::move(*inputs)));
  metrics_.observe(Phase::kValidation, watch.seconds());
  return out;
}

/// Returns the lease of a job that has begun; nullopt if the job has ended or waits for equal
/// inputs.
std::optional<Lease> Scheduler::lease_of(const QueuedJob& job, const std::string& worker,
                                         const std::string& platform) {
  Lease lease;
  lease.id = job.id;
  Known known;
  {
    const std::lock_guard lock(mutex_);
    known = take(job.id);
    lease.stop = leased_.at(job.id).stop;
  }
  std::optional<Lease> out;
  bool waits = false;
  run_or_fail(lease, [&] {
    if (!known.inputs) known = load(job.id, *lease.stop);
    lease.name = known.name;
    {
      const std::lock_guard lock(mutex_);
      policy_.set_result_bytes(job.id, history_bytes(known.inputs->effective));
      // Another project's job is not waited for: its result would not serve this one.
      waits = !policy_.hold(job.id, full_name(known.project, known.input_hash + platform),
                            !known.is_forced);
      if (waits) {
        leased_.erase(job.id);
        keep(job.id, std::move(known));
        note_change();
        return;
      }
    }
    out = start(known, lease, worker, platform);
  });
  if (!out && !waits) end(job.id, false);
  return out;
}

/// Marks the simulation RUNNING in the store. Returns nullopt if it has ended or equal inputs have
/// a result.
std::optional<Lease> Scheduler::start(const Known& known, Lease lease, const std::string& worker,
                                      const std::string& platform) {
  const double waited =
      std::max(0.0, 1e-6 * static_cast<double>(options_.clock() - known.create_time));
  const ResultKey key{known.input_hash, kModelVersion, platform};
  const Microseconds lease_time = std::chrono::microseconds(options_.lease).count();
  const auto started = retry_on_store_error(lease.id, *lease.stop, [&] {
    const Microseconds now = options_.clock();
    return store_.mark_running(lease.id, now, key, {worker, now + lease_time});
  });
  metrics_.observe(Phase::kQueue, waited);
  if (started && started->state == StoredState::kSucceeded)
    metrics_.count(SimulationOutcome::kServedByCache);
  publish(lease.id, started);
  if (!started || started->state != StoredState::kRunning) return std::nullopt;
  lease.attempt = started->attempt;
  lease.channel = board_.open(lease.id);
  lease.task =
      compute_task(*known.inputs, lease.id, lease.attempt, known.input_hash, known.is_forced);
  const std::lock_guard lock(mutex_);
  Leased& leased = leased_.at(lease.id);
  leased.attempt = lease.attempt;
  leased.request_id = known.request_id;
  leased.name = known.name;
  leased.waited_seconds = waited;
  leased.begin = leased.written = options_.steady();
  leased.expires = leased.begin + options_.lease;
  return lease;
}

}  // namespace tribodyn::server
