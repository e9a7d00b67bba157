#include "client/cpp/service/follow.h"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <iostream>
#include <map>
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

/// Progress that a watching thread writes and the displaying thread reads. Safe for concurrent use.
class Watches {
 public:
  Watches(const std::vector<v1::Simulation>& simulations, const std::vector<std::string>& labels) {
    for (std::size_t i = 0; i < simulations.size(); ++i) {
      const bool ended = has_ended(simulations[i].state());
      jobs_.push_back({labels[i], state_text(simulations[i].state()), "",
                       ended ? 1 : simulations[i].progress_fraction(), ended});
      places_[simulations[i].name()].push_back(i);
    }
  }

  void note(const v1::SimulationEvent& event) {
    const std::lock_guard lock(mutex_);
    for (const std::size_t place : places_[event.name()]) note(event, jobs_[place]);
  }

  void close(std::optional<ServiceError> failure) {
    const std::lock_guard lock(mutex_);
    failure_ = std::move(failure);
    is_open_ = false;
    changed_.notify_all();
  }

  /// Copies the current progress to `picture` after at most kRedraw; returns true while the watch
  /// is open.
  bool wait(std::vector<JobProgress>& picture) {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, kRedraw, [&] { return !is_open_; });
    picture = jobs_;
    return is_open_;
  }

  std::optional<ServiceError> failure() {
    const std::lock_guard lock(mutex_);
    return failure_;
  }

 private:
  static void note(const v1::SimulationEvent& event, JobProgress& job) {
    job.state =
        event.kind() == v1::SimulationEvent::DELETED ? "deleted" : state_text(event.state());
    job.stage = event.stage();
    if (event.has_remaining_seconds()) {
      job.stage += ", about " + duration_text(event.remaining_seconds()) + " left";
    }
    job.ended = has_ended(event.state()) || event.kind() == v1::SimulationEvent::DELETED;
    job.fraction = event.state() == v1::Simulation::SUCCEEDED ? 1 : event.progress_fraction();
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<JobProgress> jobs_;
  std::map<std::string, std::vector<std::size_t>> places_;  // in jobs_, by name
  std::optional<ServiceError> failure_;
  bool is_open_ = true;
};

/// Returns the commands that watch or cancel the simulations with these ids, each with a space
/// before it.
std::string commands_that_resume(const std::string& program, const std::string& ids) {
  if (ids.empty()) return "";
  return "\n  The simulations go on. Watch them:   " + program + " jobs watch" + ids +
         "\n                         Cancel them:  " + program + " jobs cancel" + ids;
}

std::string commands_that_resume(const std::string& program,
                                 const std::vector<v1::Simulation>& simulations,
                                 const std::vector<JobProgress>& picture) {
  std::string ids;
  for (std::size_t i = 0; i < simulations.size(); ++i) {
    if (!picture[i].ended) ids += " " + resource_id(simulations[i].name());
  }
  return commands_that_resume(program, ids);
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

std::string interrupted_submission(const Connection& connection,
                                   const std::vector<v1::Simulation>& submitted, bool are_all) {
  const std::string program = program_of(connection);
  std::string out = "interrupted", ids;
  if (!are_all) {
    out += " while simulations were submitted; `" + program +
           " jobs list` shows which ones the server has";
  }
  for (const v1::Simulation& each : submitted) {
    if (!has_ended(each.state())) ids += " " + resource_id(each.name());
  }
  return out + "." + commands_that_resume(program, ids);
}

std::vector<v1::Simulation> follow(Connection& connection,
                                   const std::vector<v1::Simulation>& simulations,
                                   const std::vector<std::string>& labels, ProgressForm form) {
  const InterruptGuard interrupts;
  Watches watches(simulations, labels);
  ProgressDisplay display(std::cerr, form, standard_error_width());
  std::vector<v1::Simulation> ended;
  std::stop_source stop;
  std::jthread watching([&] {
    std::vector<std::string> names;
    for (const v1::Simulation& each : simulations) names.push_back(each.name());
    std::optional<ServiceError> failure;
    try {
      connection.watch(
          names, [&](const v1::SimulationEvent& event) { watches.note(event); }, stop.get_token());
      for (std::size_t i = 0; i < names.size() && !stop.stop_requested(); ++i) {
        ended.push_back(connection.get_simulation(names[i]));
      }
    } catch (const ServiceError& error) {
      failure = error;
    }
    watches.close(failure);
  });
  std::vector<JobProgress> picture;
  bool open = true;
  while (open && !InterruptGuard::interrupted()) {
    open = watches.wait(picture);
    display.show(picture);
  }
  display.finish();
  stop.request_stop();
  watching.join();

  if (open) {
    throw Failure(kExitInterrupted, "interrupted." + commands_that_resume(program_of(connection),
                                                                          simulations, picture));
  }
  if (const auto error = watches.failure()) {
    const Failure failure(*error);
    throw Failure(failure.exit_code(), failure.what() + commands_that_resume(program_of(connection),
                                                                             simulations, picture));
  }
  return ended;
}

}  // namespace tribodyn::client
