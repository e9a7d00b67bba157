#include "server/execution/simulation_jobs.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>

namespace tribodyn::server {
namespace {

using std::chrono::milliseconds;

constexpr Microseconds kLookAgain = 1'000'000;

/// Heartbeats are late by a quarter of their interval at most, and by a second.
milliseconds tick(milliseconds heartbeat) {
  return std::clamp(heartbeat / 4, milliseconds(1), milliseconds(1000));
}

Submission submission_of(Added::Kind kind) {
  switch (kind) {
    case Added::Kind::kQueued:
      return Submission::kQueued;
    case Added::Kind::kServed:
      return Submission::kCacheHit;
    case Added::Kind::kRepeated:
      return Submission::kRepeated;
    case Added::Kind::kRequestIdTaken:
      return Submission::kInvalid;
    case Added::Kind::kNoPlace:
      break;
  }
  return Submission::kTurnedAway;
}

}  // namespace

SimulationJobs::SimulationJobs(Store& store, Options options)
    : store_(store),
      clock_(options.clock),
      heartbeat_(options.heartbeat),
      runner_(store, board_, metrics_, options.clock, std::move(options.studies)),
      queue_(options.threads, options.limits,
             [this](std::int64_t id, const StopSignal& stop, JobQueue::Rest& rest) {
               runner_.run(id, stop, rest);
             }),
      retention_(options.retention),
      janitor_(store, retention_, clock_),
      timekeeper_(tick(heartbeat_), clock_, [this](std::int64_t id) { expire(id); }) {}

SimulationJobs::~SimulationJobs() { stop(); }

std::size_t SimulationJobs::resume() {
  const std::vector<Waiting> waiting = store_.requeue_unfinished(clock_());
  for (const Waiting& each : waiting) {
    if (each.deadline_time) timekeeper_.add_deadline(each.id, *each.deadline_time);
    const bool last_chance = each.lost_attempts + 1 >= kMaximumLostAttempts;
    queue_.push_resumed({each.id, each.client, each.cost_seconds, last_chance});
  }
  return waiting.size();
}

void SimulationJobs::start() {
  queue_.start();
  janitor_.start();
}

SimulationJobs::Submitted SimulationJobs::submit(const NewSimulation& simulation,
                                                 const CallLimits& limits) {
  QueuedJob job{0, simulation.client, simulation.cost_seconds};
  const Admission admission = queue_.reserve(job);
  const bool has_place = admission.is_admitted;
  Added added;
  const StopWatch watch;
  try {
    added = store_.add_simulation(simulation, clock_(), has_place, limits);
  } catch (...) {
    if (has_place) queue_.release(job);
    throw;
  }
  metrics_.observe(Phase::kStore, watch.seconds());
  metrics_.count(submission_of(added.kind));
  if (added.kind == Added::Kind::kQueued) {
    if (simulation.deadline_time) timekeeper_.add_deadline(added.id, *simulation.deadline_time);
    job.id = added.id;
    queue_.push(job);
    return {added, 0};
  }
  if (has_place) queue_.release(job);
  return {added, admission.retry_seconds};
}

void SimulationJobs::ensure_queued(const StoredSimulation& simulation) {
  if (queue_.push_missing({simulation.id, simulation.client, simulation.cost_seconds}) &&
      simulation.deadline_time) {
    timekeeper_.add_deadline(simulation.id, *simulation.deadline_time);
  }
}

std::optional<StoredEvent> SimulationJobs::cancel(std::int64_t id, const CallLimits& limits) {
  auto event = store_.mark_cancelled(id, clock_(), limits);
  if (event) metrics_.count(SimulationOutcome::kCancelled);
  end(id, event);
  return event;
}

void SimulationJobs::expire(std::int64_t id) {
  try {
    const auto event = store_.mark_failed(id, clock_(), "DEADLINE_EXCEEDED",
                                          "it had not ended when its deadline_seconds were over");
    if (event) metrics_.count(SimulationOutcome::kFailed);
    end(id, event);
  } catch (const StoreError& error) {
    spdlog::error("simulations/{}: {}", id, error.what());
    timekeeper_.add_deadline(id, clock_() + kLookAgain);
  }
}

/// Removes the job from the queue and closes its progress channel. Also called when the simulation
/// had ended before: the thread that ended it may have stopped before this step.
void SimulationJobs::end(std::int64_t id, const std::optional<StoredEvent>& event) {
  std::optional<std::int64_t> sequence;
  if (event) {
    sequence = event->sequence;
  } else if (const auto stored = store_.simulation(id); stored && has_ended(stored->state)) {
    sequence = stored->sequence;
  }
  if (!sequence) return;
  queue_.drop(id);
  board_.finish(id, *sequence);
}

std::optional<Progress> SimulationJobs::progress(std::int64_t id) const {
  const std::shared_ptr<ProgressChannel> channel = board_.find(id);
  if (!channel) return std::nullopt;
  return channel->latest().progress;
}

std::optional<SimulationJobs::Watched> SimulationJobs::watch(std::int64_t id,
                                                             const CallLimits& limits) {
  if (!store_.simulation(id, limits)) return std::nullopt;
  // The channel first, the state after: what the state does not show yet will be heard.
  std::shared_ptr<ProgressChannel> channel = board_.open(id);
  std::optional<StoredSimulation> stored = store_.simulation(id, limits);
  if (!stored) return std::nullopt;
  if (has_ended(stored->state)) board_.finish(id, stored->sequence);
  return Watched{std::move(channel), std::move(*stored)};
}

bool SimulationJobs::drain(std::chrono::milliseconds limit, const std::function<bool()>& give_up) {
  return queue_.drain(limit, give_up);
}

void SimulationJobs::stop() {
  timekeeper_.stop();
  janitor_.stop();
  queue_.stop();
}

}  // namespace tribodyn::server
