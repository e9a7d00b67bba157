#include "server/jobs/simulation_jobs.h"

namespace tribodyn::server {

SimulationJobs::SimulationJobs(Store& store, Options options)
    : store_(store),
      clock_(options.clock),
      runner_(store, board_, options.clock, std::move(options.studies)),
      queue_(options.threads, options.maximum_waiting,
             [this](std::int64_t id, const StopSignal& stop) { runner_.run(id, stop); }) {}

std::size_t SimulationJobs::resume() {
  const std::vector<std::int64_t> ids = store_.requeue_unfinished();
  for (const std::int64_t id : ids) {
    board_.open(id);
    queue_.push_resumed(id);
  }
  return ids.size();
}

std::optional<std::int64_t> SimulationJobs::submit(const NewSimulation& simulation) {
  if (!queue_.reserve()) return std::nullopt;
  std::int64_t id = 0;
  try {
    id = store_.add_simulation(simulation, clock_());
    board_.open(id);
  } catch (...) {
    queue_.release();
    throw;
  }
  queue_.push(id);
  return id;
}

void SimulationJobs::cancel(std::int64_t id) {
  if (!store_.mark_cancelled(id, clock_())) return;
  queue_.cancel(id);
  board_.finish(id, {StoredState::kCancelled, 0, "", "", ""});
}

std::optional<Progress> SimulationJobs::progress(std::int64_t id) const {
  const std::shared_ptr<ProgressChannel> channel = board_.find(id);
  if (!channel) return std::nullopt;
  return channel->latest().progress;
}

std::shared_ptr<ProgressChannel> SimulationJobs::watch(std::int64_t id) {
  if (!store_.simulation(id)) return nullptr;
  // The channel first, the state after: an end that the state does not show yet will still be
  // published on this channel.
  std::shared_ptr<ProgressChannel> channel = board_.open(id);
  const std::optional<StoredSimulation> stored = store_.simulation(id);
  if (stored && has_ended(stored->state)) {
    board_.finish(id, end_of(*stored));
    // Another finish may have taken the channel off the board and be about to publish the end;
    // of two ends the first stays, and they are equal.
    channel->publish(end_of(*stored));
  }
  return channel;
}

void SimulationJobs::stop() { queue_.stop(); }

}  // namespace tribodyn::server
