#include <fmt/format.h>
#include <google/protobuf/util/time_util.h>

#include <algorithm>
#include <chrono>

#include "server/application/errors.h"
#include "server/application/guard.h"
#include "server/application/simulation_lookup.h"
#include "server/application/streams.h"

namespace tribodyn::server {
namespace {

using google::protobuf::util::TimeUtil;
using std::chrono::steady_clock;

/// Events from the store, one by one and each once; between them the latest progress and, when all
/// is quiet, heartbeats. Holds no message: what is asked for is read then.
class Watch : public MessageSource<v1::SimulationEvent> {
 public:
  Watch(Application& application, SimulationJobs::Watched watched, std::int64_t after_sequence,
        const CallContext& call)
      : store_(application.store),
        limits_{.cancelled = call.limits.cancelled},
        jobs_(application.jobs),
        channel_(std::move(watched.channel)),
        simulation_(std::move(watched.simulation)),
        sent_(after_sequence),
        is_over_(sent_ == simulation_.sequence && has_ended(simulation_.state)) {}

  void observe(const std::weak_ptr<ProgressObserver>& observer) override {
    channel_->observe(observer);
    jobs_.wake(observer);
  }

  google::rpc::Status error() const override { return error_; }

  Step next(v1::SimulationEvent& out) override {
    if (is_over_) return Step::kEnd;
    const ProgressChannel::Latest latest = channel_->latest();
    const bool is_quiet = steady_clock::now() - last_message_ >= jobs_.heartbeat();
    out.Clear();
    // A heartbeat reads the store too: an event may be on disk although its writer was told that
    // the write failed.
    if (std::max(simulation_.sequence, latest.sequence) > sent_ || is_quiet) {
      if (const auto event = store_.next_event(simulation_.id, sent_, limits_)) {
        tell_event(*event, out);
        return Step::kMessage;
      }
      if (!store_.simulation(simulation_.id, limits_)) {
        error_ = does_not_exist(name_of(simulation_));
        return Step::kEnd;
      }
    }
    const bool is_news = simulation_.state == StoredState::kRunning && latest.sequence <= sent_ &&
                         latest.progress_number != told_progress_;
    if (!is_news && !is_quiet) return Step::kWait;
    tell_progress(latest, out);
    out.set_kind(is_news ? v1::SimulationEvent::PROGRESS : v1::SimulationEvent::HEARTBEAT);
    return Step::kMessage;
  }

 private:
  void tell(v1::SimulationEvent& out) {
    last_message_ = steady_clock::now();
    out.set_state(static_cast<v1::Simulation::State>(simulation_.state));
    out.set_attempt(simulation_.attempt);
    out.set_sequence(sent_);
  }

  void tell_event(const StoredEvent& event, v1::SimulationEvent& out) {
    sent_ = event.sequence;
    simulation_.state = event.state;
    simulation_.attempt = event.attempt;
    is_over_ = has_ended(event.state);
    tell(out);
    out.set_kind(v1::SimulationEvent::STATE_CHANGE);
    out.set_reason(event.reason);
    *out.mutable_time() = TimeUtil::MicrosecondsToTimestamp(event.time);
    if (event.state == StoredState::kSucceeded) out.set_progress_fraction(1);
    if (event.state != StoredState::kFailed) return;
    const auto failed = store_.simulation(simulation_.id, limits_);
    if (!failed) return;
    out.mutable_error()->set_reason(failed->error_reason);
    out.mutable_error()->set_message(failed->error_message);
  }

  void tell_progress(const ProgressChannel::Latest& latest, v1::SimulationEvent& out) {
    tell(out);
    told_progress_ = latest.progress_number;
    if (simulation_.state != StoredState::kRunning) return;
    out.set_progress_fraction(latest.progress.fraction);
    out.set_stage(latest.progress.stage);
    if (latest.progress.remaining_seconds) {
      out.set_remaining_seconds(*latest.progress.remaining_seconds);
    }
  }

  Store& store_;
  const CallLimits limits_;  // the end of the stream is its transport's
  SimulationJobs& jobs_;
  std::shared_ptr<ProgressChannel> channel_;
  StoredSimulation simulation_;  // as the last event that was sent says
  std::int64_t sent_;
  std::uint64_t told_progress_ = 0;
  bool is_over_;
  google::rpc::Status error_;  // set if the simulation was deleted
  steady_clock::time_point last_message_ = steady_clock::now();
};

}  // namespace

StreamOutcome<v1::SimulationEvent> watch_simulation(Application& application,
                                                    const v1::WatchSimulationRequest& request,
                                                    const CallContext& call) {
  using Source = std::shared_ptr<MessageSource<v1::SimulationEvent>>;
  return guarded<Source>([&]() -> Outcome<Source> {
    const auto found = find_simulation(application, request.name(), call);
    if (!found.ok()) return found.error();
    auto watched = application.jobs.watch(found.message().id, call.limits);
    if (!watched) return does_not_exist(request.name());
    const std::int64_t after = request.after_sequence();
    if (after < 0 || after > watched->simulation.sequence) {
      return invalid({{"after_sequence", fmt::format("after_sequence = {}; allowed: 0 to {}", after,
                                                     watched->simulation.sequence)}});
    }
    return Source(std::make_shared<Watch>(application, std::move(*watched), after, call));
  });
}

}  // namespace tribodyn::server
