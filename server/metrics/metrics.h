#pragma once

#include <chrono>
#include <cstddef>
#include <memory>
#include <string>

namespace tribodyn::server {

/// Part of a simulation's life whose duration a histogram records.
enum class Phase {
  kQueue,       ///< from the creation of the simulation until a worker takes it
  kValidation,  ///< reading and checking the request and its resources
  kOrbit,       ///< solving the full model
  kFriction,    ///< solving the quasi-static model
  kStore,       ///< converting the result to a message and committing it to disk
};

/// Outcome of a CreateSimulation request.
enum class Submission { kQueued, kCacheHit, kRepeated, kTurnedAway, kInvalid };

/// Outcome of a queued simulation.
enum class SimulationOutcome { kSucceeded, kFailed, kCancelled, kServedByCache };

/// Number of simulations in the queue and in computation.
struct Occupancy {
  std::size_t waiting = 0;
  std::size_t running = 0;
  double waiting_seconds = 0;  ///< sum of the estimates, in seconds of one processor
  std::size_t parts = 0;       ///< of campaigns: beside the simulations, waiting or running
};

/// Measures the time since its construction.
class StopWatch {
 public:
  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
  }

 private:
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

/// Counters and histograms for Prometheus. Safe for concurrent access without external
/// synchronization.
class Metrics {
 public:
  Metrics();
  ~Metrics();
  Metrics(const Metrics&) = delete;
  Metrics& operator=(const Metrics&) = delete;

  void observe(Phase phase, double seconds);
  void count(Submission submission);
  void count(SimulationOutcome outcome);
  /// Counts a call of a method that ended with this code after so many seconds.
  void count_call(const std::string& method, const std::string& code, double seconds);
  void set_build(const std::string& version, const std::string& model_version,
                 const std::string& platform);

  /// Returns all metrics in the Prometheus text format.
  std::string text(const Occupancy& occupancy) const;

 private:
  struct Families;
  std::unique_ptr<Families> families_;
};

}  // namespace tribodyn::server
