#include "server/execution/simulation_runner.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <new>
#include <optional>

#include "core/refusal.h"
#include "server/simulation/result_key.h"
#include "server/storage/resource_lookup.h"

namespace tribodyn::server {
namespace {

using std::chrono::steady_clock;

constexpr auto kProgressInterval = std::chrono::milliseconds(250);
constexpr double kLeastFraction = 0.01;  // below it nothing can be said of the time that is left
constexpr auto kBetweenLooks = std::chrono::milliseconds(1);
constexpr auto kFirstPause = std::chrono::milliseconds(100);
constexpr auto kLongestPause = std::chrono::milliseconds(30'000);

/// At most one publication per interval; the stage is part of the next one.
class Reporter {
 public:
  Reporter(ProgressChannel& channel, const StopSignal& stop) : channel_(channel), stop_(stop) {}

  bool operator()(double fraction, const StageText& stage) {
    const auto now = steady_clock::now();
    if (now - last_ >= kProgressInterval) {
      last_ = now;
      channel_.publish_progress({fraction, stage(), remaining(fraction, now)});
    }
    return !stop_.requested();
  }

 private:
  /// As if it went on as it went so far.
  std::optional<double> remaining(double fraction, steady_clock::time_point now) const {
    if (fraction < kLeastFraction) return std::nullopt;
    return std::chrono::duration<double>(now - begin_).count() * (1 - fraction) / fraction;
  }

  ProgressChannel& channel_;
  const StopSignal& stop_;
  const steady_clock::time_point begin_ = steady_clock::now();
  steady_clock::time_point last_ = begin_;
};

}  // namespace

SimulationRunner::SimulationRunner(Store& store, ProgressBoard& board, Metrics& metrics,
                                   Clock clock, StudyFunctions studies)
    : store_(store),
      board_(board),
      metrics_(metrics),
      clock_(std::move(clock)),
      studies_(std::move(studies)) {}

/// Repeats what the store refuses, until it does not or the
/// simulation is to stop.
template <class Action>
auto SimulationRunner::insist(std::int64_t id, const StopSignal& stop, const Action& action) const {
  for (auto pause = kFirstPause;; pause = std::min(2 * pause, kLongestPause)) {
    try {
      return action();
    } catch (const StoreError& error) {
      spdlog::error("simulations/{}: {}", id, error.what());
      if (!stop.wait_for(pause)) throw;
    }
  }
}

/// Whatever goes wrong ends in the store.
template <class Action>
void SimulationRunner::guarded(std::int64_t id, const StopSignal& stop,
                               const Action& action) const {
  try {
    try {
      action();
    } catch (const Cancelled&) {
      stopped(id, stop);
    } catch (const Refusal& refusal) {
      fail(id, stop, refusal.reason(), refusal.what());
    } catch (const std::bad_alloc&) {
      fail(id, stop, "OUT_OF_MEMORY", "not enough memory for this simulation");
    } catch (const StoreError&) {
      throw;
    } catch (const std::exception& error) {
      fail_on_defect(id, stop, error.what());
    } catch (...) {
      fail_on_defect(id, stop, "an exception of unknown type");
    }
  } catch (const StoreError& error) {  // the next start finds it
                                       // unfinished and goes on
    spdlog::error("simulations/{} is left as it is: {}", id, error.what());
  }
}

void SimulationRunner::run(std::int64_t id, const StopSignal& stop, JobQueue::Rest& rest) const {
  guarded(id, stop, [&] {
    const std::shared_ptr<Unwritten> computed = compute(id, stop);
    if (!computed) return;
    rest = [this, id, &stop, computed] { guarded(id, stop, [&] { save(*computed, stop); }); };
  });
}

StoredSimulation SimulationRunner::stored(std::int64_t id, const StopSignal& stop) const {
  auto found = insist(id, stop, [&] { return store_.simulation(id); });
  if (!found) throw Refusal("STORED_REQUEST_UNREADABLE", "the stored request is gone");
  return std::move(*found);
}

/// As they are in the store, read again: a restart may have
/// brought another model.
SimulationInputs SimulationRunner::inputs_of(const StoredSimulation& simulation,
                                             const StopSignal& stop) const {
  return insist(simulation.id, stop, [&] {
    v1::Simulation request;
    if (!request.ParseFromString(simulation.request)) {
      throw Refusal("STORED_REQUEST_UNREADABLE", "the stored request cannot be read");
    }
    set_accepted_names(simulation, request);
    Violations violations;
    auto inputs =
        read_simulation(request, accepted_lookup(store_, simulation), "simulation", violations);
    if (!inputs) {
      throw Refusal("STORED_REQUEST_INVALID",
                    violations.front().field + ": " + violations.front().description);
    }
    return std::move(*inputs);
  });
}

/// Attempts that end otherwise than with a result are not timed.
Solved SimulationRunner::solve_timed(const SimulationInputs& inputs,
                                     const ReportProgress& report) const {
  const v1::Simulation& asked = inputs.effective;
  const v1::PointModel model = asked.has_operating_point() ? asked.operating_point().model()
                                                           : asked.inefficiency_curve().model();
  const StopWatch watch;
  Solved solved = solve(inputs, studies_, gear_sets_, report);
  metrics_.observe(model == v1::POINT_MODEL_QUASI_STATIC ? Phase::kFriction : Phase::kOrbit,
                   watch.seconds());
  return solved;
}

/// Equal inputs are computed once: a result that is being
/// written down is waited for.
void SimulationRunner::wait_until_written(const ResultKey& key, const StopSignal& stop) const {
  while (unwritten_.contains(key.input_hash)) {
    if (!stop.wait_for(kBetweenLooks)) throw Cancelled();
  }
}

/// Nothing when it has ended otherwise, or its result was there.
std::shared_ptr<SimulationRunner::Unwritten> SimulationRunner::compute(
    std::int64_t id, const StopSignal& stop) const {
  StoredSimulation simulation = stored(id, stop);
  const double waited = 1e-6 * static_cast<double>(clock_() - simulation.create_time);
  const StopWatch validation;
  SimulationInputs inputs = inputs_of(simulation, stop);
  const ResultKey key = result_key(inputs);
  metrics_.observe(Phase::kValidation, validation.seconds());
  wait_until_written(key, stop);
  const auto started = insist(id, stop, [&] { return store_.mark_running(id, clock_(), key); });
  metrics_.observe(Phase::kQueue, std::max(0.0, waited));
  if (started && started->state == StoredState::kSucceeded)
    metrics_.count(SimulationOutcome::kServedByCache);
  publish(id, started);
  if (!started || started->state != StoredState::kRunning) return nullptr;
  const std::shared_ptr<ProgressChannel> channel = board_.open(id);
  Reporter reporter(*channel, stop);
  if (stop.requested()) throw Cancelled();
  const StopWatch computing;
  Solved solved = solve_timed(inputs, std::ref(reporter));
  return std::shared_ptr<Unwritten>(new Unwritten{std::move(simulation),
                                                  std::move(inputs),
                                                  key,
                                                  std::move(solved),
                                                  waited,
                                                  computing.seconds(),
                                                  {unwritten_, key.input_hash}});
}

void SimulationRunner::save(Unwritten& unwritten, const StopSignal& stop) const {
  const std::int64_t id = unwritten.simulation.id;
  const StopWatch storing;
  Computed computed = to_result(unwritten.inputs, unwritten.key, std::move(unwritten.solved));
  const NewResult result{unwritten.key, computed.result.SerializeAsString(),
                         std::move(computed.history)};
  const auto ended = insist(id, stop, [&] { return store_.mark_succeeded(id, clock_(), result); });
  metrics_.observe(Phase::kStore, storing.seconds());
  if (ended) {
    metrics_.count(ended->state == StoredState::kSucceeded ? SimulationOutcome::kSucceeded
                                                           : SimulationOutcome::kFailed);
  }
  publish(id, ended);
  spdlog::info(
      "event=simulation_computed simulation=simulations/{} "
      "request_id={} input_hash={} "
      "waited_seconds={:.6f} computed_seconds={:.6f} "
      "stored_seconds={:.6f}",
      id, unwritten.simulation.request_id, unwritten.key.input_hash, unwritten.waited_seconds,
      unwritten.computed_seconds, storing.seconds());
}

/// Without an event somebody else has ended the simulation, by
/// cancelling it: a channel opened since must hear of it too.
void SimulationRunner::publish(std::int64_t id, const std::optional<StoredEvent>& event) const {
  StoredState state = StoredState::kQueued;
  std::int64_t sequence = 0;
  if (event) {
    state = event->state;
    sequence = event->sequence;
  } else if (const std::optional<StoredSimulation> stored = store_.simulation(id)) {
    state = stored->state;
    sequence = stored->sequence;
  }
  if (has_ended(state)) {
    board_.finish(id, sequence);
  } else {
    board_.open(id)->publish_event(sequence);
  }
}

void SimulationRunner::stopped(std::int64_t id, const StopSignal& stop) const {
  switch (stop.reason()) {
    case StopReason::kNone:
      return fail_on_defect(id, stop, "the study stopped without being asked to");
    case StopReason::kEnded:
      return publish(id, std::nullopt);
    case StopReason::kShutdown:
      publish(id, store_.mark_queued(id, clock_(), "SERVER_STOPPED"));
      spdlog::info("simulations/{} goes back to the queue", id);
  }
}

void SimulationRunner::fail_on_defect(std::int64_t id, const StopSignal& stop,
                                      const char* cause) const {
  spdlog::error(
      "event=internal_error simulation=simulations/{} "
      "cause=\"{}\"",
      id, cause);
  fail(id, stop, "INTERNAL", "internal error; the server's log states its cause");
}

void SimulationRunner::fail(std::int64_t id, const StopSignal& stop, const std::string& reason,
                            const std::string& message) const {
  // The message may quote inputs, so only the reason is logged.
  spdlog::warn(
      "event=simulation_failed simulation=simulations/{} "
      "reason={}",
      id, reason);
  const auto event =
      insist(id, stop, [&] { return store_.mark_failed(id, clock_(), reason, message); });
  if (event) metrics_.count(SimulationOutcome::kFailed);
  publish(id, event);
}

}  // namespace tribodyn::server
