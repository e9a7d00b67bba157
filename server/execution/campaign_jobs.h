#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>

#include "server/metrics/metrics.h"
#include "server/scheduling/scheduler.h"
#include "server/simulation/campaign_columns.h"
#include "server/simulation/campaign_inputs.h"
#include "server/simulation/prepared_gear_sets.h"
#include "server/storage/store.h"

namespace tribodyn::server {

/// Computes campaigns in slices on the threads of the executor. A campaign has one part for each
/// thread; a part fills a tile over one or more slices and writes it with the campaign's progress
/// in one commit. Only what a tile holds counts: after a crash the campaign continues at the rows
/// that no tile has. If a process is lost soon after it began a campaign, the next one computes it
/// with care: one tile at a time, over all campaigns, each noted in the store before it begins. A
/// tile that was noted when a process was lost is halved, down to the single candidate, which is
/// refused after kMaximumLostAttempts attempts. The store is the only truth about the state of a
/// campaign. Safe for concurrent
/// access without external synchronization; `resume` and `finish` from one thread.
class CampaignJobs {
 public:
  /// Store, scheduler and metrics must outlive the object.
  CampaignJobs(Store& store, Scheduler& scheduler, Metrics& metrics, int threads, Clock clock);
  ~CampaignJobs();
  CampaignJobs(const CampaignJobs&) = delete;
  CampaignJobs& operator=(const CampaignJobs&) = delete;

  /// Queues the campaigns that are RUNNING. Returns their number.
  std::size_t resume();

  struct Admitted {
    CampaignAdded added;
    bool has_place = true;  ///< false: too many campaigns run; nothing was added
  };
  /// Adds a campaign and queues it. `inputs`: those that the campaign was made of.
  Admitted submit(const NewCampaign& campaign, CampaignInputs inputs,
                  const CallLimits& limits = {});
  /// Returns the estimate of what is left of the campaigns of a principal that run [s of one
  /// processor].
  double unfinished_seconds(const std::string& principal) const;
  /// Returns why the campaign cannot continue until the store can be read and written again;
  /// nullopt if it can. Store::campaign_changes() counts changes of this too.
  std::optional<StoreError> stalled(std::int64_t id);
  /// Counts the campaigns that have not ended. Reads no row.
  CampaignTotals totals() const;
  /// Queues a campaign that is RUNNING in the store, if it is not queued: a commit may succeed
  /// although its writer sees an error.
  void ensure_queued(const StoredCampaign& campaign);

  struct Appended {
    CandidatesAdded added;
    bool has_place = true;  ///< as in Admitted
  };
  /// Adds candidates and queues the campaign if it is RUNNING then. `inputs`: of all candidates.
  Appended append(const NewCandidates& candidates, const std::shared_ptr<CampaignInputs>& inputs,
                  const CallLimits& limits = {});

  // These functions return the campaign as it is then; nullopt if it does not exist. They change
  // nothing if it has ended.
  std::optional<StoredCampaign> pause(std::int64_t id, const CallLimits& limits = {});
  std::optional<StoredCampaign> go_on(std::int64_t id, const std::optional<CampaignBudget>& budget,
                                      const CallLimits& limits = {});
  std::optional<StoredCampaign> cancel(std::int64_t id, const CallLimits& limits = {});

  /// Computes the slice of a lease and returns it to the scheduler. `lend` is called at least once
  /// for each point; it may run another job on this thread, and returns the processor time [s] that
  /// such jobs have taken during this slice.
  void run_slice(const Lease& lease, PreparedGearSets& gear_sets,
                 const std::function<double()>& lend);

  /// Writes what open tiles hold. Requires that no slice runs or will run.
  void finish();

 private:
  struct Tile;
  struct Part;
  struct Running;
  using RunningPointer = std::shared_ptr<Running>;

  RunningPointer find(std::int64_t id);
  bool has_place(const std::string& principal, std::int64_t own, std::size_t bytes) const;
  void extend(Running& running, const StoredCampaign& campaign,
              const std::shared_ptr<const CampaignInputs>& inputs);
  void activate(const StoredCampaign& campaign,
                std::shared_ptr<const CampaignInputs> inputs = nullptr);
  void halt(std::int64_t id);
  void settle(std::int64_t id);
  void note_state(std::int64_t id, CampaignState state);
  std::optional<StoredCampaign> change(CampaignChange change, const CallLimits& limits);
  void start_parts(Running& running);
  bool may_take_care(const Running& running, const Part& part) const;
  void end_care(const Running& running);
  void forget_if_idle(std::int64_t id);
  void load(Running& running);
  std::shared_ptr<const CampaignInputs> stored_inputs(const StoredCampaign& stored);
  static void use_inputs(Part& part, const std::shared_ptr<const CampaignInputs>& inputs);
  bool take_tile(Running& running, Part& part);
  std::optional<Tile> next_candidates(Running& running) const;
  void return_rows(Running& running, const Tile& tile);
  bool compute_slice(Running& running, Part& part, PreparedGearSets& gear_sets);
  void compute_unit(Running& running, Part& part, const std::shared_ptr<PreparedGearSet>& gear_set);
  void add_rows(Running& running, Part& part);
  void set_stalled(Running& running, const std::optional<StoreError>& cause);
  int refusal_number(Running& running, const CampaignRow& row, Tile& tile);
  void write(Running& running, Part& part);
  void fail(std::int64_t id, const std::string& reason, const std::string& message);

  Store& store_;
  Scheduler& scheduler_;
  Metrics& metrics_;
  const int threads_;
  const Clock clock_;
  std::atomic<std::int64_t> careful_campaign_ = 0;  // the one that is computed with care; 0: none
  std::mutex control_mutex_;  // of changes of states, with what follows from them in memory
  mutable std::mutex mutex_;
  std::map<std::int64_t, RunningPointer> running_;  // guarded by mutex_
  std::set<std::int64_t> paused_;                   // guarded by mutex_
};

}  // namespace tribodyn::server
