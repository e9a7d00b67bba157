#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "server/metrics/system_use.h"

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

/// State in which a campaign ended.
enum class CampaignOutcome { kSucceeded, kFailed, kCancelled };

/// Number of simulations in the queue and in computation.
struct Occupancy {
  std::size_t waiting = 0;
  std::size_t running = 0;
  double waiting_seconds = 0;  ///< sum of the estimates, in seconds of one processor
  std::size_t parts = 0;       ///< of campaigns: beside the simulations, waiting or running
};

/// Campaigns that have not ended, and what is left of those that run.
struct CampaignTotals {
  std::size_t running = 0;
  std::size_t stalled = 0;  ///< of the running ones
  std::size_t paused = 0;
  std::int64_t points_left = 0;
  double seconds_left = 0;  ///< estimate, in seconds of one processor
};

/// Number of calls in a lane.
struct LaneOccupancy {
  std::string lane;
  std::size_t waiting = 0;
  std::size_t running = 0;
};

/// What the server has to do at a moment.
struct Workload {
  Occupancy simulations;
  CampaignTotals campaigns;
  std::vector<LaneOccupancy> lanes;
  std::size_t open_streams = 0;
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

/// Metrics for Prometheus: all their names are in metrics.cpp. Safe for concurrent access without
/// external synchronization.
class Metrics {
 public:
  Metrics();
  ~Metrics();
  Metrics(const Metrics&) = delete;
  Metrics& operator=(const Metrics&) = delete;

  void observe(Phase phase, double seconds);
  void count(Submission submission);
  void count(SimulationOutcome outcome);
  void count(CampaignOutcome outcome);
  /// Counts a tile of a campaign that was written.
  void count_tile(std::int64_t computed_points, std::int64_t refused_points);
  /// Counts a call of a method that ended with this code after so many seconds.
  void count_call(const std::string& method, const std::string& code, double seconds);
  /// Counts calls that ended with an error of this reason. `calls` = 0 only makes the series:
  /// rate() does not see the first call of a series that did not exist before it.
  void count_refusal(const std::string& reason, int calls = 1);

  // To be called before text().
  /// Sets the files whose sizes are metrics, and of the first one the file system.
  void set_files(std::vector<NamedFile> files);
  void set_build(const std::string& version, const std::string& model_version,
                 const std::string& platform);

  /// Returns all metrics in the Prometheus text format. Reads no database.
  std::string text(const Workload& workload) const;

 private:
  struct Families;
  std::unique_ptr<Families> families_;
};

}  // namespace tribodyn::server
