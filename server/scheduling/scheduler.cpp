#include "server/scheduling/scheduler.h"

#include <spdlog/spdlog.h>

#include <algorithm>

#include "server/support/value_of.h"

namespace tribodyn::server {
namespace {

using std::chrono::milliseconds;

constexpr auto kDrainPollInterval = milliseconds(20);
constexpr Microseconds kDeadlineRetryDelay = 1'000'000;
/// Size of the inputs that are kept for waiting simulations [bytes]: some 8,000 points. claim()
/// reads the inputs of other simulations from the store.
constexpr std::size_t kMostKnownBytes = 16 << 20;

constexpr std::pair<AddOutcome::Kind, Submission> kSubmissions[] = {
    {AddOutcome::Kind::kQueued, Submission::kQueued},
    {AddOutcome::Kind::kServed, Submission::kCacheHit},
    {AddOutcome::Kind::kRepeated, Submission::kRepeated},
    {AddOutcome::Kind::kRequestIdTaken, Submission::kInvalid},
    {AddOutcome::Kind::kNoPlace, Submission::kTurnedAway}};

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

/// Returns what the lease needs of a simulation with these inputs.
Scheduler::Known Scheduler::known_of(const StoredSimulation& stored,
                                     std::shared_ptr<const SimulationInputs> inputs) {
  const std::size_t bytes = inputs->effective.SpaceUsedLong();
  return {.inputs = std::move(inputs),
          .bytes = bytes,
          .project = stored.project,
          .input_hash = stored.input_hash,
          .is_forced = stored.is_forced,
          .request_id = stored.request_id,
          .name = server::name_of(stored),
          .create_time = stored.create_time};
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
  metrics_.count(value_of(kSubmissions, added.kind, Submission::kTurnedAway));
  if (added.kind != AddOutcome::Kind::kQueued) {
    release();
    return {added, admission.retry_seconds};
  }
  if (simulation.deadline_time) timekeeper_.set_deadline(added.id, *simulation.deadline_time);
  job.id = added.id;
  Known known;
  if (inputs) known = known_of(added.stored, std::move(inputs));
  const std::lock_guard lock(mutex_);
  if (known.inputs) keep(job.id, std::move(known));
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
