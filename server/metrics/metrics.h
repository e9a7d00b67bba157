#pragma once

#include <chrono>
#include <cstddef>
#include <memory>
#include <string>

namespace tribodyn::server {

/// What a simulation spends its time on.
enum class Phase {
  kQueue,       ///< from its creation until a worker takes it
  kValidation,  ///< its request and what it rests on are read and checked
  kOrbit,       ///< steady states of the full or one-degree model
  kFriction,    ///< contacts alone: the quasi-static model
  kStore,       ///< made a message and written down, until it is on disk
};

/// What became of a request to simulate.
enum class Submission { kQueued, kCacheHit, kRepeated, kTurnedAway, kInvalid };

/// How simulations end.
enum class Ending { kSucceeded, kFailed, kCancelled, kServedByCache };

/// What waits and runs at the moment.
struct Occupancy {
  std::size_t waiting = 0;
  std::size_t running = 0;
  double waiting_seconds = 0;  ///< estimated, of one processor
};

/// Time since it was made.
class StopWatch {
 public:
  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
  }

 private:
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

/// Counts and histograms for Prometheus. Safe for concurrent access without external
/// synchronization.
class Metrics {
 public:
  Metrics();
  ~Metrics();
  Metrics(const Metrics&) = delete;
  Metrics& operator=(const Metrics&) = delete;

  void observe(Phase phase, double seconds);
  void count(Submission submission);
  void count(Ending ending);
  void set_build(const std::string& version, const std::string& model_version,
                 const std::string& platform);

  /// Everything in Prometheus' text format.
  std::string text(const Occupancy& occupancy) const;

 private:
  struct Families;
  std::unique_ptr<Families> families_;
};

}  // namespace tribodyn::server
