#include "server/execution/simulation_jobs.h"

#include <algorithm>

namespace tribodyn::server {
namespace {

using std::chrono::milliseconds;

/// Returns the interval of the checks for heartbeats: these are late by at most a quarter of their
/// interval, and by at most a second.
milliseconds tick(milliseconds heartbeat) {
  return std::clamp(heartbeat / 4, milliseconds(1), milliseconds(1000));
}

Scheduler::Options scheduler_options(const SimulationJobs::Options& options) {
  Scheduler::Options out;
  out.limits = options.limits;
  out.clock = options.clock;
  out.tick = tick(options.heartbeat);
  out.wants_proof = options.wants_proof;
  return out;
}

}  // namespace

SimulationJobs::SimulationJobs(Store& store, Options options)
    : store_(store),
      heartbeat_(options.heartbeat),
      limits_(options.limits),
      retention_(options.retention),
      janitor_(store, retention_, options.clock),
      scheduler_(store, board_, metrics_, scheduler_options(options)),
      campaigns_(store, scheduler_, metrics_, options.threads, options.clock),
      executor_(scheduler_, campaigns_, metrics_, options.threads, std::move(options.studies)) {}

SimulationJobs::~SimulationJobs() { stop(); }

std::string SimulationJobs::start() {
  std::string wrong = executor_.start();
  if (wrong.empty()) janitor_.start();
  return wrong;
}

std::optional<Progress> SimulationJobs::progress(std::int64_t id) const {
  const std::shared_ptr<ProgressChannel> channel = board_.find(id);
  if (!channel) return std::nullopt;
  return channel->latest().progress;
}

std::optional<SimulationJobs::Watched> SimulationJobs::watch(std::int64_t id,
                                                             const CallLimits& limits) {
  if (!store_.simulation(id, limits)) return std::nullopt;
  // The channel is opened before the state is read, so that no change is missed.
  std::shared_ptr<ProgressChannel> channel = board_.open(id);
  std::optional<StoredSimulation> stored = store_.simulation(id, limits);
  if (!stored) return std::nullopt;
  if (has_ended(stored->state)) board_.finish(id, stored->sequence);
  return Watched{std::move(channel), std::move(*stored)};
}

SimulationJobs::WatchedStates SimulationJobs::watch(const std::string& project,
                                                    const std::vector<std::int64_t>& numbers,
                                                    const CallLimits& limits) {
  const std::uint64_t changes = store_.changes();
  WatchedStates out{store_.simulation_states(project, numbers, limits), {}};
  for (const auto& each : out.states) {
    const bool is_unfinished = each && !has_ended(each->state);
    out.channels.push_back(is_unfinished ? board_.open(each->id) : nullptr);
  }
  if (store_.changes() == changes) return out;  // whatever ends now will finish its channel
  out.states = store_.simulation_states(project, numbers, limits);
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const auto& state = out.states[i];
    if (state && has_ended(state->state)) board_.finish(state->id, state->sequence);
  }
  return out;
}

void SimulationJobs::stop() {
  janitor_.stop();
  scheduler_.stop();
  executor_.join();
  campaigns_.finish();
}

}  // namespace tribodyn::server
