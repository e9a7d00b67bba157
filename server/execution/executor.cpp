#include "server/execution/executor.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <optional>

#include "server/simulation/result_key.h"

namespace tribodyn::server {
namespace {

using std::chrono::steady_clock;

constexpr auto kProgressInterval = std::chrono::milliseconds(250);
/// Least interval of Scheduler::extend. A call takes a microsecond.
constexpr auto kExtendInterval = std::chrono::milliseconds(5);
constexpr double kLeastFraction = 0.01;  // below it the estimate of the remaining time is too rough

}  // namespace

/// Receives the progress of a study. It publishes progress at most once per interval; the next
/// publication contains the latest stage.
class Executor::Reporter {
 public:
  Reporter(Executor& executor, const Lease& lease, bool may_lend)
      : executor_(executor), lease_(lease), may_lend_(may_lend) {}

  bool operator()(double fraction, const StageText& stage) {
    if (may_lend_ && executor_.scheduler_.is_urgent()) lend();
    const auto now = steady_clock::now();
    if (now - last_extension_ >= kExtendInterval) {
      last_extension_ = now;
      executor_.scheduler_.extend(lease_, processor_seconds() - begin_seconds_ - lent_seconds_);
    }
    if (now - last_progress_ >= kProgressInterval) {
      last_progress_ = now;
      lease_.channel->publish_progress({fraction, stage(), remaining(fraction, now)});
    }
    return !lease_.stop->requested();
  }

  /// Returns the processor time of other jobs on this thread [s].
  double lent_seconds() const { return lent_seconds_; }

 private:
  /// Claims one urgent job and runs it.
  void lend() {
    const double begin = processor_seconds();
    executor_.scheduler_.extend(lease_, begin - begin_seconds_ - lent_seconds_);
    if (auto urgent = executor_.scheduler_.claim_beside(LeaseTerms::kLocalWorker, lease_)) {
      executor_.run(std::move(*urgent), false);
      lent_seconds_ += processor_seconds() - begin;
    }
  }

  /// Linear extrapolation: elapsed * (1 - fraction) / fraction [s].
  std::optional<double> remaining(double fraction, steady_clock::time_point now) const {
    if (fraction < kLeastFraction) return std::nullopt;
    return std::chrono::duration<double>(now - begin_).count() * (1 - fraction) / fraction;
  }

  Executor& executor_;
  const Lease& lease_;
  const bool may_lend_;
  double lent_seconds_ = 0;
  const double begin_seconds_ = processor_seconds();
  const steady_clock::time_point begin_ = steady_clock::now();
  steady_clock::time_point last_progress_ = begin_;
  steady_clock::time_point last_extension_ = begin_;
};

Executor::Executor(Scheduler& scheduler, CampaignJobs& campaigns, Metrics& metrics, int threads,
                   StudyFunctions studies)
    : scheduler_(scheduler),
      campaigns_(campaigns),
      metrics_(metrics),
      thread_count_(std::max(1, threads)),
      studies_(std::move(studies)) {}

Executor::~Executor() { join(); }

std::string Executor::start() {
  std::string wrong = scheduler_.enroll(
      LeaseTerms::kLocalWorker, {platform(), thread_count_}, [this](const auto& task) {
        return compute(task, studies_, gear_sets_, [](double, const StageText&) { return true; });
      });
  if (!wrong.empty()) return wrong;
  for (int i = 0; i < thread_count_; ++i) {
    threads_.emplace_back([this] { compute_all(); });
    completers_.emplace_back([this] { complete_all(true); });
  }
  completers_.emplace_back([this] { complete_all(false); });
  return {};
}

void Executor::join() {
  for (std::thread& thread : threads_) thread.join();
  threads_.clear();
  {
    const std::lock_guard lock(mutex_);
    all_computed_ = true;
  }
  changed_.notify_all();
  for (std::thread& completer : completers_) completer.join();
  completers_.clear();
}

void Executor::run(Lease lease, bool may_lend) {
  if (campaign_part(lease.id)) return run_slice(lease, may_lend);
  run_simulation(std::move(lease), may_lend);
}

void Executor::run_slice(const Lease& lease, bool may_lend) {
  double lent = 0;
  campaigns_.run_slice(lease, gear_sets_, [&] {
    if (!may_lend || !scheduler_.is_urgent()) return lent;
    const double begin = processor_seconds();
    if (auto urgent = scheduler_.claim_beside(LeaseTerms::kLocalWorker, lease)) {
      run(std::move(*urgent), false);
      lent += processor_seconds() - begin;
    }
    return lent;
  });
}

void Executor::run_simulation(Lease lease, bool may_lend) {
  const v1::Simulation& asked = lease.task.effective();
  const v1::PointModel model = asked.has_operating_point() ? asked.operating_point().model()
                                                           : asked.inefficiency_curve().model();
  Reporter reporter(*this, lease, may_lend);
  const StopWatch watch;
  Computed computed;
  computed.result = compute(lease.task, studies_, gear_sets_, std::ref(reporter));
  // The histogram contains only attempts that end with a result.
  if (computed.result.has_result()) {
    metrics_.observe(model == v1::POINT_MODEL_QUASI_STATIC ? Phase::kFriction : Phase::kOrbit,
                     watch.seconds());
  }
  const double used = computed.result.processor_seconds() - reporter.lent_seconds();
  computed.result.set_processor_seconds(used);
  scheduler_.computed(lease, computed.result);
  computed.lease = std::move(lease);
  const bool is_small = computed.result.history_size() == 0;
  {
    const std::lock_guard lock(mutex_);
    (is_small ? small_ : large_).push_back(std::move(computed));
  }
  // One of the completers takes no history.
  is_small ? changed_.notify_one() : changed_.notify_all();
}

void Executor::compute_all() {
  while (scheduler_.wait_for_work()) {
    try {
      if (auto lease = scheduler_.claim(LeaseTerms::kLocalWorker)) run(std::move(*lease), true);
    } catch (const std::exception& defect) {
      spdlog::critical("defect: a computing thread caught an exception: {}", defect.what());
    }
  }
}

void Executor::complete_all(bool takes_histories) {
  for (;;) {
    std::unique_lock lock(mutex_);
    const auto has_large = [&] { return takes_histories && !large_.empty(); };
    changed_.wait(lock, [&] { return all_computed_ || !small_.empty() || has_large(); });
    if (small_.empty() && !has_large()) return;
    std::deque<Computed>& queue = small_.empty() ? large_ : small_;
    Computed next = std::move(queue.front());
    queue.pop_front();
    lock.unlock();
    try {
      scheduler_.complete(next.lease, std::move(next.result));
    } catch (const std::exception& defect) {
      spdlog::critical("defect: {}: completing its lease threw: {}", next.lease.name,
                       defect.what());
    }
  }
}

}  // namespace tribodyn::server
