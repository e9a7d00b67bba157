#include "server/scheduling/scheduler.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <new>

#include "core/refusal.h"
#include "core/version.h"
#include "server/simulation/golden_case.h"
#include "server/simulation/input_hash.h"
#include "server/storage/resource_lookup.h"

namespace tribodyn::server {
namespace {

using std::chrono::milliseconds;

constexpr auto kDrainPollInterval = milliseconds(20);
constexpr auto kFirstPause = milliseconds(100);
constexpr auto kLongestPause = milliseconds(30'000);
constexpr Microseconds kDeadlineRetryDelay = 1'000'000;
/// Size of the inputs that are kept for waiting simulations [bytes]: some 8,000 points. claim()
/// reads the inputs of other simulations from the store.
constexpr std::size_t kMostKnownBytes = 16 << 20;

Submission submission_of(AddOutcome::Kind kind) {
  switch (kind) {
    case AddOutcome::Kind::kQueued:
      return Submission::kQueued;
    case AddOutcome::Kind::kServed:
      return Submission::kCacheHit;
    case AddOutcome::Kind::kRepeated:
      return Submission::kRepeated;
    case AddOutcome::Kind::kRequestIdTaken:
      return Submission::kInvalid;
    case AddOutcome::Kind::kNoPlace:
      break;
  }
  return Submission::kTurnedAway;
}

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
      "event=simulation_computed simulation={} "
      "request_id={} input_hash={} "
      "waited_seconds={:.6f} computed_seconds={:.6f} "
      "stored_seconds={:.6f}",
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

Scheduler::Scheduler(Store& store, ProgressBoard& board, Metrics& metrics, Options options)
    : store_(store),
      board_(board),
      metrics_(metrics),
      options_(std::move(options)),
      policy_(options_.limits),
      last_look_(options_.steady()),
      timekeeper_(
          options_.tick, options_.clock, [this](std::int64_t id) { expire(id); },
          [this] { expire_leases(); }) {}

Scheduler::~Scheduler() { stop(); }

/// Wakes a thread if a job may begin. Requires the lock.
void Scheduler::note_change() {
  is_urgent_.store(policy_.is_urgent(), std::memory_order_relaxed);
  if (policy_.may_begin()) changed_.notify_one();
}

std::size_t Scheduler::resume() {
  const std::vector<UnfinishedSimulation> unfinished = store_.requeue_unfinished(options_.clock());
  std::size_t queued = 0;
  for (const UnfinishedSimulation& each : unfinished) {
    if (each.deadline_time) timekeeper_.set_deadline(each.id, *each.deadline_time);
    const bool last_chance = each.lost_attempts + 1 >= kMaximumLostAttempts;
    const QueuedJob job{each.id, each.principal, each.cost_seconds, last_chance,
                        static_cast<RequestedClass>(each.scheduling_class)};
    const std::lock_guard lock(mutex_);
    if (!each.lease) {
      policy_.add(job);
      ++queued;
      continue;
    }
    policy_.add_running(job);
    const std::chrono::microseconds left(each.lease->expire_time - options_.clock());
    Leased& leased = leased_[each.id];
    leased.attempt = each.attempt;
    leased.stop = std::make_shared<StopSignal>();
    leased.begin = leased.written = options_.steady();
    leased.expires = leased.begin + std::max(left, std::chrono::microseconds(0));
  }
  const std::lock_guard lock(mutex_);
  note_change();
  return queued;
}

/// Keeps the inputs if there is room. Requires the lock.
void Scheduler::keep(std::int64_t id, Known known) {
  if (known_bytes_ + known.bytes > kMostKnownBytes) return;
  known_bytes_ += known.bytes;
  known_[id] = std::move(known);
}

/// Removes and returns the kept inputs. Requires the lock.
Scheduler::Known Scheduler::take(std::int64_t id) {
  const auto found = known_.find(id);
  if (found == known_.end()) return {};
  Known out = std::move(found->second);
  known_bytes_ -= out.bytes;
  known_.erase(found);
  return out;
}

Scheduler::Admitted Scheduler::admit(const NewSimulation& simulation,
                                     std::shared_ptr<const SimulationInputs> inputs,
                                     const CallLimits& limits, bool may_wait) {
  QueuedJob job{0, simulation.principal, simulation.cost_seconds, false,
                static_cast<RequestedClass>(simulation.scheduling_class)};
  if (inputs) job.result_bytes = history_bytes(inputs->effective);
  Admission admission;
  {
    const std::lock_guard lock(mutex_);
    if (!stopping_ && may_wait) admission = policy_.reserve(job, options_.steady());
  }
  const auto release = [&] {
    const std::lock_guard lock(mutex_);
    if (admission.is_admitted) policy_.release(job);
  };
  AddOutcome added;
  const StopWatch watch;
  try {
    added = store_.add_simulation(simulation, options_.clock(), admission.is_admitted, limits);
  } catch (...) {
    release();
    throw;
  }
  metrics_.observe(Phase::kStore, watch.seconds());
  metrics_.count(submission_of(added.kind));
  if (added.kind != AddOutcome::Kind::kQueued) {
    release();
    return {added, admission.retry_seconds};
  }
  if (simulation.deadline_time) timekeeper_.set_deadline(added.id, *simulation.deadline_time);
  job.id = added.id;
  Known known;
  if (inputs) {
    known.bytes = inputs->effective.SpaceUsedLong();
    known.inputs = std::move(inputs);
    known.project = simulation.project;
    known.input_hash = simulation.key.input_hash;
    known.is_forced = simulation.is_forced;
    known.request_id = simulation.request_id;
    known.name = server::name_of(added.stored);
    known.create_time = added.stored.create_time;
    known.is_loaded = true;
  }
  const std::lock_guard lock(mutex_);
  if (known.is_loaded) keep(job.id, std::move(known));
  policy_.push(job);
  note_change();
  return {added, 0};
}

double Scheduler::unfinished_seconds(const std::string& principal) const {
  const std::lock_guard lock(mutex_);
  return policy_.unfinished_seconds(principal);
}

void Scheduler::ensure_queued(const StoredSimulation& simulation) {
  const QueuedJob job{simulation.id, simulation.principal, simulation.cost_seconds, false,
                      static_cast<RequestedClass>(simulation.scheduling_class)};
  const std::lock_guard lock(mutex_);
  if (stopping_ || !policy_.add(job)) return;
  if (simulation.deadline_time) {
    timekeeper_.set_deadline(simulation.id, *simulation.deadline_time);
  }
  note_change();
}

void Scheduler::add_part(const CampaignPart& part, const std::string& principal) {
  const QueuedJob job{campaign_part_id(part.campaign, part.part), principal, kSliceSeconds};
  const std::lock_guard lock(mutex_);
  policy_.add(job);
  note_change();
}

void Scheduler::return_slice(const Lease& lease, double used_seconds, bool goes_on) {
  {
    const std::lock_guard lock(mutex_);
    leased_.erase(lease.id);
    policy_.computed(lease.id, used_seconds);
    goes_on ? policy_.requeue(lease.id, false) : policy_.end(lease.id);
    note_change();
  }
  ended_.notify_all();
}

std::optional<StoredEvent> Scheduler::cancel(std::int64_t id, const CallLimits& limits) {
  auto event = store_.mark_cancelled(id, options_.clock(), limits);
  if (event) metrics_.count(SimulationOutcome::kCancelled);
  end_otherwise(id, event);
  return event;
}

/// Marks a simulation FAILED whose deadline has passed.
void Scheduler::expire(std::int64_t id) {
  try {
    const auto event = store_.mark_failed(id, options_.clock(), "DEADLINE_EXCEEDED",
                                          "it had not ended when its deadline_seconds were over");
    if (event) metrics_.count(SimulationOutcome::kFailed);
    end_otherwise(id, event);
  } catch (const StoreError& error) {
    spdlog::error("simulation of row {}: {}", id, error.what());
    timekeeper_.set_deadline(id, options_.clock() + kDeadlineRetryDelay);
  }
}

/// Removes the job from the queue, or asks its executor to stop, and closes its progress channel.
/// Also called when the simulation had ended before: the thread that ended it may have stopped
/// before this step.
void Scheduler::end_otherwise(std::int64_t id, const std::optional<StoredEvent>& event) {
  std::optional<std::int64_t> sequence;
  if (event) {
    sequence = event->sequence;
  } else if (const auto stored = store_.simulation(id); stored && has_ended(stored->state)) {
    sequence = stored->sequence;
  }
  if (!sequence) return;
  timekeeper_.remove_deadline(id);
  {
    const std::lock_guard lock(mutex_);
    const auto leased = leased_.find(id);
    if (leased != leased_.end()) {
      leased->second.stop->request(StopReason::kEnded);
    } else {
      take(id);
      policy_.end(id);
      note_change();
    }
  }
  board_.finish(id, *sequence);
}

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

/// Repeats the action while it throws StoreError, with growing pauses. Rethrows the error once the
/// simulation is asked to stop.
template <class Action>
auto Scheduler::retry_on_store_error(std::int64_t id, const StopSignal& stop,
                                     const Action& action) const {
  for (auto pause = kFirstPause;; pause = std::min(2 * pause, kLongestPause)) {
    try {
      return action();
    } catch (const StoreError& error) {
      spdlog::error("simulation of row {}: {}", id, error.what());
      if (!stop.wait_for(pause)) throw;
    }
  }
}

template <class Action>
bool Scheduler::run_or_fail(const Lease& lease, const Action& action) {
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
  set_accepted_names(*stored, request);
  Violations violations;
  auto inputs = retry_on_store_error(id, stop, [&] {
    violations.clear();
    return read_simulation(request, accepted_lookup(store_, *stored), "simulation", violations);
  });
  if (!inputs) {
    throw Refusal("STORED_REQUEST_INVALID",
                  violations.front().field + ": " + violations.front().description);
  }
  Known out;
  out.project = stored->project;
  out.input_hash = input_hash(*inputs);
  out.bytes = inputs->effective.SpaceUsedLong();
  out.inputs = std::make_shared<const SimulationInputs>(std::move(*inputs));
  out.is_forced = stored->is_forced;
  out.request_id = stored->request_id;
  out.name = server::name_of(*stored);
  out.create_time = stored->create_time;
  out.is_loaded = true;
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
    if (!known.is_loaded) known = load(job.id, *lease.stop);
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
  if (!out && !waits) end(job.id);
  return out;
}

/// Marks the simulation RUNNING in the store. Returns nullopt if it has ended or equal inputs have
/// a result.
std::optional<Lease> Scheduler::start(const Known& known, Lease lease, const std::string& worker,
                                      const std::string& platform) {
  const double waited =
      std::max(0.0, 1e-6 * static_cast<double>(options_.clock() - known.create_time));
  const ResultKey key{known.input_hash, kModelVersion, platform};
  const Microseconds lease_time =
      std::chrono::duration_cast<std::chrono::microseconds>(options_.lease).count();
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
  const auto time = std::chrono::duration_cast<std::chrono::microseconds>(options_.lease);
  try {
    store_.extend_lease(lease.id, lease.attempt, options_.clock() + time.count());
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
  goes_back ? requeue(lease.id, false) : end(lease.id);
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
  spdlog::error(
      "event=internal_error simulation={} "
      "cause=\"{}\"",
      name_of(lease), cause);
  fail(lease, "INTERNAL", "internal error; the server's log states its cause");
}

void Scheduler::fail(const Lease& lease, const std::string& reason, const std::string& message) {
  // The message may quote inputs, so only the reason is logged.
  spdlog::warn(
      "event=simulation_failed simulation={} "
      "reason={}",
      name_of(lease), reason);
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

void Scheduler::end(std::int64_t id) {
  {
    const std::lock_guard lock(mutex_);
    leased_.erase(id);
    policy_.end(id);
    note_change();
  }
  ended_.notify_all();
}

void Scheduler::requeue(std::int64_t id, bool alone) {
  {
    const std::lock_guard lock(mutex_);
    leased_.erase(id);
    policy_.requeue(id, alone);
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
      const bool waits = event && event->state == StoredState::kQueued;
      waits ? requeue(lease.id, false) : end(lease.id);
    } catch (const StoreError& error) {  // tried again at the next tick
      spdlog::error("{}: {}", name_of(lease), error.what());
    }
  }
}

Occupancy Scheduler::occupancy() const {
  const std::lock_guard lock(mutex_);
  return policy_.occupancy();
}

bool Scheduler::is_stopping() const {
  const std::lock_guard lock(mutex_);
  return stopping_;
}

bool Scheduler::drain(std::chrono::milliseconds limit, const std::function<bool()>& give_up) {
  const auto end = std::chrono::steady_clock::now() + limit;
  std::unique_lock lock(mutex_);
  stopping_ = true;
  changed_.notify_all();
  while (!leased_.empty() && std::chrono::steady_clock::now() < end && !give_up()) {
    ended_.wait_for(lock, kDrainPollInterval);
  }
  return leased_.empty();
}

void Scheduler::stop() {
  timekeeper_.stop();
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
    for (const auto& [id, leased] : leased_) leased.stop->request(StopReason::kShutdown);
  }
  changed_.notify_all();
}

}  // namespace tribodyn::server
