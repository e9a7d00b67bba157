#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "server/execution/campaign_jobs.h"
#include "server/simulation/campaign_scene.h"
#include "server/storage/store_error.h"

namespace tribodyn::server {

// What CampaignJobs keeps of a campaign that runs. Included by its sources only.

/// Processor time after which a tile is written although it has room [s]: what a crash loses on
/// each thread.
inline constexpr double kTileSeconds = 0.4;

/// Rows that are computed and not written yet.
struct CampaignJobs::Tile {
  RowRange candidates;
  int lost_attempts = 0;          ///< as in CampaignSuspect
  bool is_noted = false;          ///< as a suspect that is begun
  std::int64_t done = 0;          ///< candidates whose rows are in `columns`
  std::size_t group = 0;          ///< next group of conditions of the candidate after those
  std::vector<CampaignRow> rows;  ///< of that candidate, by condition
  std::vector<std::vector<double>> columns;
  std::map<int, CampaignRefusal> refusals;  ///< by number
  std::int64_t refused = 0;
  double seconds = 0;  ///< processor time

  bool is_full() const { return done == candidates.count || (done > 0 && seconds >= kTileSeconds); }
};

/// What one thread computes. The thread of its slice alone uses it, but for what is marked.
struct CampaignJobs::Part {
  int number = 0;
  bool is_queued = false;                // guarded by Running::mutex; waits or runs
  std::shared_ptr<StopSignal> stop;      // guarded by Running::mutex; of the present slice
  std::function<bool()> goes_on;         ///< of the present slice; null without one
  std::function<double()> used_seconds;  ///< by the present slice, without other jobs
  double counted_seconds = 0;            ///< used_seconds() when it was last read
  std::optional<Tile> tile;
  std::shared_ptr<const CampaignInputs> inputs;  ///< with which the tile was taken
  std::unique_ptr<CampaignScene> candidate;      ///< of these inputs
};

/// A campaign that is RUNNING, or whose last slices end.
struct CampaignJobs::Running {
  Running(const StoredCampaign& campaign, int parts_)
      : id(campaign.id),
        name(name_of(campaign)),
        principal(campaign.principal),
        bytes(static_cast<std::size_t>(campaign.stored_bytes)),
        points(campaign.points()),
        cost_seconds(campaign.cost_seconds),
        points_done(campaign.points_done),
        parts(static_cast<std::size_t>(parts_)) {
    for (std::size_t i = 0; i < parts.size(); ++i) parts[i].number = static_cast<int>(i);
  }
  const std::int64_t id;
  const std::string name;
  const std::string principal;
  std::size_t bytes;  // of its request and candidates at least; guarded by CampaignJobs::mutex_

  // Changed under mutex and read without it, which load() holds while it reads the store.
  std::atomic<std::int64_t> points;
  std::atomic<double> cost_seconds;  // estimate of all points, of one processor
  std::atomic<std::int64_t> points_done;
  std::mutex stall_mutex;                // `mutex` is locked while the campaign is read
  std::optional<StoreError> stalled;     // why its rows cannot be written; guarded by stall_mutex
  std::atomic<bool> is_stalled = false;  // whether `stalled` is set, without a lock
  std::atomic<bool> is_halted = false;   // no further row is to be computed

  std::mutex mutex;
  // Guarded by mutex, as all below.
  std::int64_t candidates = 0;                      // those that are missing or in tiles
  std::shared_ptr<const CampaignInputs> inputs;     // null before the first slice
  std::shared_ptr<const CampaignInputs> submitted;  // of the request; null after the first slice
  std::deque<RowRange> missing;                     // candidates that no part has taken
  std::deque<CampaignSuspect> suspects;             // the same that come first, one at a time
  bool is_careful = false;                          // part 0 alone computes
  std::size_t tiles_taken = 0;
  int tiles_written = 0;
  std::map<std::pair<std::string, std::string>, int> refusal_numbers;  // by reason and message
  std::deque<Part> parts;

  std::int64_t remaining_points() const {
    return is_halted ? 0 : std::max<std::int64_t>(0, points - points_done);
  }
  double remaining_seconds() const {
    return cost_seconds * static_cast<double>(remaining_points()) / static_cast<double>(points);
  }
};

}  // namespace tribodyn::server
