#include "server/app/guard.h"
#include "server/app/simulation_lookup.h"
#include "server/app/streams.h"

namespace tribodyn::server {
namespace {

class Watch : public MessageSource<v1::SimulationEvent> {
 public:
  explicit Watch(std::shared_ptr<ProgressChannel> channel) : channel_(std::move(channel)) {}

  void observe(const std::weak_ptr<ProgressObserver>& observer) override {
    channel_->observe(observer);
  }

  Step next(v1::SimulationEvent& out) override {
    if (ended_) return Step::kEnd;
    const ProgressChannel::Numbered latest = channel_->latest();
    if (latest.number == seen_) return Step::kWait;
    seen_ = latest.number;
    const Progress& progress = latest.progress;
    ended_ = has_ended(progress.state);
    out.Clear();
    out.set_state(static_cast<v1::Simulation::State>(progress.state));
    out.set_progress_fraction(progress.fraction);
    out.set_stage(progress.stage);
    if (progress.state == StoredState::kFailed) {
      out.mutable_error()->set_reason(progress.error_reason);
      out.mutable_error()->set_message(progress.error_message);
    }
    return Step::kMessage;
  }

 private:
  std::shared_ptr<ProgressChannel> channel_;
  std::uint64_t seen_ = 0;
  bool ended_ = false;
};

}  // namespace

StreamOutcome<v1::SimulationEvent> watch_simulation(Application& application,
                                                    const v1::WatchSimulationRequest& request) {
  using Source = std::shared_ptr<MessageSource<v1::SimulationEvent>>;
  return guarded<Source>([&]() -> Outcome<Source> {
    const auto found = find_simulation(application, request.name());
    if (!found.ok()) return found.error();
    return Source(std::make_shared<Watch>(application.jobs.watch(found.message().id)));
  });
}

}  // namespace tribodyn::server
