#include "client/cpp/service/follow.h"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <iostream>
#include <mutex>
#include <optional>
#include <stop_token>
#include <thread>

#include "client/cpp/failure.h"
#include "client/cpp/service/interrupt.h"
#include "client/cpp/text/progress.h"
#include "client/cpp/text/text.h"

namespace tribodyn::client {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kRedraw(150);

/// Progress that watching threads write and the displaying thread reads. Safe for concurrent use.
class Watches {
 public:
  Watches(const std::vector<v1::Simulation>& simulations, const std::vector<std::string>& labels)
      : failures_(simulations.size()) {
    for (std::size_t i = 0; i < simulations.size(); ++i) {
      const bool ended = has_ended(simulations[i].state());
      jobs_.push_back({labels[i], state_text(simulations[i].state()), "",
                       ended ? 1 : simulations[i].progress_fraction(), ended});
    }
    open_ = simulations.size();
  }

  void note(std::size_t index, const v1::SimulationEvent& event) {
    const std::lock_guard lock(mutex_);
    JobProgress& job = jobs_[index];
    job.state = state_text(event.state());
    job.stage = event.stage();
    if (event.has_remaining_seconds()) {
      job.stage += ", about " + duration_text(event.remaining_seconds()) + " left";
    }
    job.ended = has_ended(event.state());
    job.fraction = event.state() == v1::Simulation::SUCCEEDED ? 1 : event.progress_fraction();
  }

  void close(std::size_t index, std::optional<ServiceError> failure) {
    const std::lock_guard lock(mutex_);
    failures_[index] = std::move(failure);
    --open_;
    changed_.notify_all();
  }

  /// Copies the current progress to `picture` after at most kRedraw; returns true while a watch is
  /// open.
  bool wait(std::vector<JobProgress>& picture) {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, kRedraw, [&] { return open_ == 0; });
    picture = jobs_;
    return open_ > 0;
  }

  std::optional<ServiceError> first_failure() {
    const std::lock_guard lock(mutex_);
    for (const auto& failure : failures_) {
      if (failure) return failure;
    }
    return std::nullopt;
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<JobProgress> jobs_;
  std::vector<std::optional<ServiceError>> failures_;
  std::size_t open_ = 0;
};

std::string commands_that_resume(const std::string& program,
                                 const std::vector<v1::Simulation>& simulations,
                                 const std::vector<JobProgress>& picture) {
  std::string names;
  for (std::size_t i = 0; i < simulations.size(); ++i) {
    if (!picture[i].ended) names += " " + resource_id(simulations[i].name());
  }
  if (names.empty()) return "";
  return "\n  The simulations go on. Watch them:   " + program + " jobs watch" + names +
         "\n                         Cancel them:  " + program + " jobs cancel" + names;
}

}  // namespace

std::string program_of(const Connection& connection) {
  if (connection.project() == kDefaultProject) return "tribodyn";
  return "tribodyn --project " + connection.project();
}

std::string state_text(v1::Simulation::State state) {
  switch (state) {
    case v1::Simulation::QUEUED:
      return "queued";
    case v1::Simulation::RUNNING:
      return "running";
    case v1::Simulation::SUCCEEDED:
      return "succeeded";
    case v1::Simulation::FAILED:
      return "failed";
    case v1::Simulation::CANCELLED:
      return "cancelled";
    default:
      return "unknown state";
  }
}

std::vector<v1::Simulation> follow(Connection& connection,
                                   const std::vector<v1::Simulation>& simulations,
                                   const std::vector<std::string>& labels, ProgressForm form) {
  const InterruptGuard interrupts;
  Watches watches(simulations, labels);
  ProgressDisplay display(std::cerr, form, standard_error_width());
  std::vector<v1::Simulation> ended(simulations.size());
  std::stop_source stop;
  std::vector<std::jthread> threads;
  for (std::size_t i = 0; i < simulations.size(); ++i) {
    threads.emplace_back([&, i] {
      std::optional<ServiceError> failure;
      try {
        ended[i] = connection.wait_for_end(
            simulations[i].name(),
            [&](const v1::SimulationEvent& event) { watches.note(i, event); }, stop.get_token());
      } catch (const ServiceError& error) {
        failure = error;
      }
      watches.close(i, failure);
    });
  }
  std::vector<JobProgress> picture;
  bool open = true;
  while (open && !InterruptGuard::interrupted()) {
    open = watches.wait(picture);
    display.show(picture);
  }
  display.finish();
  stop.request_stop();
  threads.clear();

  if (open) {
    throw Failure(kExitInterrupted, "interrupted." + commands_that_resume(program_of(connection),
                                                                          simulations, picture));
  }
  if (const auto error = watches.first_failure()) {
    const Failure failure(*error);
    throw Failure(failure.exit_code(), failure.what() + commands_that_resume(program_of(connection),
                                                                             simulations, picture));
  }
  return ended;
}

}  // namespace tribodyn::client
