#include "client/cpp/service/follow.h"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <iostream>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>

#include "client/cpp/service/errors.h"
#include "client/cpp/service/interrupt.h"
#include "client/cpp/text/progress.h"
#include "client/cpp/text/text.h"

namespace tribodyn::client {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kRedraw(150);
constexpr milliseconds kFirstRetry(250);
constexpr int kRetries = 6;  // about 16 s in all: long enough for a server that restarts

/// What the watching threads tell the displaying one. Safe for concurrent use.
class Watches {
 public:
  Watches(const std::vector<v1::Simulation>& simulations, const std::vector<std::string>& labels)
      : contexts_(simulations.size()), failures_(simulations.size()) {
    for (std::size_t i = 0; i < simulations.size(); ++i) {
      const bool ended = has_ended(simulations[i].state());
      jobs_.push_back({labels[i], state_text(simulations[i].state()), "",
                       ended ? 1 : simulations[i].progress_fraction(), ended});
    }
    open_ = simulations.size();
  }

  /// A fresh context for a watch; null once everything is to stop.
  std::shared_ptr<grpc::ClientContext> start(std::size_t index) {
    const std::lock_guard lock(mutex_);
    if (stopping_) return nullptr;
    contexts_[index] = std::make_shared<grpc::ClientContext>();
    return contexts_[index];
  }

  void note(std::size_t index, const v1::SimulationEvent& event) {
    const std::lock_guard lock(mutex_);
    JobProgress& job = jobs_[index];
    job.state = state_text(event.state());
    job.stage = event.stage();
    job.ended = has_ended(event.state());
    job.fraction = event.state() == v1::Simulation::SUCCEEDED ? 1 : event.progress_fraction();
  }

  bool ended(std::size_t index) {
    const std::lock_guard lock(mutex_);
    return jobs_[index].ended;
  }

  /// Waits between two tries; false when everything is to stop.
  bool pause(milliseconds time) {
    std::unique_lock lock(mutex_);
    return !changed_.wait_for(lock, time, [&] { return stopping_; });
  }

  void close(std::size_t index, std::optional<Failure> failure) {
    const std::lock_guard lock(mutex_);
    failures_[index] = std::move(failure);
    --open_;
    changed_.notify_all();
  }

  /// The present picture, after at most kRedraw; true while a watch is open.
  bool wait(std::vector<JobProgress>& picture) {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, kRedraw, [&] { return open_ == 0; });
    picture = jobs_;
    return open_ > 0;
  }

  void stop() {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
    for (const auto& context : contexts_) {
      if (context) context->TryCancel();
    }
    changed_.notify_all();
  }

  std::optional<Failure> first_failure() {
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
  std::vector<std::shared_ptr<grpc::ClientContext>> contexts_;
  std::vector<std::optional<Failure>> failures_;
  std::size_t open_ = 0;
  bool stopping_ = false;
};

/// Runs in a thread of its own. A stream that breaks before the last event is opened again.
std::optional<Failure> watch_to_the_end(Connection& connection, const std::string& name,
                                        Watches& watches, std::size_t index) {
  milliseconds wait = kFirstRetry;
  for (int tries_left = kRetries; !watches.ended(index);) {
    const auto context = watches.start(index);
    if (!context) return std::nullopt;
    bool heard = false;
    const grpc::Status status =
        connection.watch(name, *context, [&](const v1::SimulationEvent& event) {
          heard = true;
          watches.note(index, event);
        });
    if (watches.ended(index) || status.error_code() == grpc::StatusCode::CANCELLED) break;
    const bool broken = status.ok() || status.error_code() == grpc::StatusCode::UNAVAILABLE;
    if (heard) {
      tries_left = kRetries;
      wait = kFirstRetry;
    }
    if (!broken) return to_failure(status, connection.address());
    if (tries_left-- == 0) {
      return Failure(kExitCannotConnect, "lost the server at " + connection.address() + ".");
    }
    if (!watches.pause(wait)) break;
    wait *= 2;
  }
  return std::nullopt;
}

std::string how_to_go_on(const std::vector<v1::Simulation>& simulations,
                         const std::vector<JobProgress>& picture) {
  std::string names;
  for (std::size_t i = 0; i < simulations.size(); ++i) {
    if (!picture[i].ended) names += " " + resource_id(simulations[i].name());
  }
  if (names.empty()) return "";
  return "\n  The server goes on with them. Follow again:  tribodyn jobs watch" + names +
         "\n                              Cancel:        tribodyn jobs cancel" + names;
}

}  // namespace

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

bool has_ended(v1::Simulation::State state) {
  return state == v1::Simulation::SUCCEEDED || state == v1::Simulation::FAILED ||
         state == v1::Simulation::CANCELLED;
}

std::vector<v1::Simulation> follow(Connection& connection,
                                   const std::vector<v1::Simulation>& simulations,
                                   const std::vector<std::string>& labels) {
  const InterruptGuard interrupts;
  Watches watches(simulations, labels);
  ProgressDisplay display(std::cerr, standard_error_is_terminal(), standard_error_width());
  std::vector<std::thread> threads;
  for (std::size_t i = 0; i < simulations.size(); ++i) {
    threads.emplace_back([&, i] {
      watches.close(i, watch_to_the_end(connection, simulations[i].name(), watches, i));
    });
  }
  std::vector<JobProgress> picture;
  bool open = true;
  while (open && !InterruptGuard::interrupted()) {
    open = watches.wait(picture);
    display.show(picture);
  }
  display.finish();
  watches.stop();
  for (std::thread& thread : threads) thread.join();

  if (open) {
    throw Failure(kExitInterrupted, "interrupted." + how_to_go_on(simulations, picture));
  }
  if (const auto failure = watches.first_failure()) {
    throw Failure(failure->exit_code(), failure->what() + how_to_go_on(simulations, picture));
  }
  std::vector<v1::Simulation> ended;
  ended.reserve(simulations.size());
  for (const auto& simulation : simulations) {
    ended.push_back(connection.get_simulation(simulation.name()));
  }
  return ended;
}

}  // namespace tribodyn::client
