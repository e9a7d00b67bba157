#include "server/execution/campaign_jobs.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "server/execution/running_campaign.h"

namespace tribodyn::server {
namespace {

/// Largest size of the requests of all campaigns that run, and the share of one principal.
constexpr std::size_t kMostRunningBytes = 256 << 20;
constexpr std::size_t kMostRunning = 1000;
constexpr double kShareOfPrincipal = 0.75;

}  // namespace

CampaignJobs::CampaignJobs(Store& store, Scheduler& scheduler, Metrics& metrics, int threads,
                           Clock clock)
    : store_(store),
      scheduler_(scheduler),
      metrics_(metrics),
      threads_(std::clamp(threads, 1, kMostCampaignParts)),
      clock_(std::move(clock)) {}

CampaignJobs::~CampaignJobs() = default;

CampaignJobs::RunningPointer CampaignJobs::find(std::int64_t id) {
  const std::lock_guard lock(mutex_);
  const auto found = running_.find(id);
  return found == running_.end() ? nullptr : found->second;
}

std::size_t CampaignJobs::resume() {
  const std::lock_guard control(control_mutex_);
  std::size_t count = 0;
  for (const std::int64_t id : store_.paused_campaigns()) note_state(id, CampaignState::kPaused);
  for (const std::int64_t id : store_.resume_campaigns()) {
    if (const auto stored = store_.campaign(id)) {
      activate(*stored);
      ++count;
    }
  }
  return count;
}

/// Queues the parts of a campaign. `inputs`: null if they are to be read from the store. Requires
/// control_mutex_.
void CampaignJobs::activate(const StoredCampaign& campaign,
                            std::shared_ptr<const CampaignInputs> inputs) {
  RunningPointer running;
  {
    const std::lock_guard lock(mutex_);
    RunningPointer& entry = running_[campaign.id];
    if (!entry) entry = std::make_shared<Running>(campaign, threads_);
    running = entry;
    // Before the entry can be seen: who finds it halted and idle removes it.
    const std::lock_guard inner(running->mutex);
    running->is_halted = false;
    running->submitted = std::move(inputs);
  }
  start_parts(*running);
}

/// Queues the parts that neither wait nor run and may find rows to compute.
void CampaignJobs::start_parts(Running& running) {
  const std::lock_guard lock(running.mutex);
  if (running.is_halted) return;
  const bool has_rows = !running.missing.empty() || !running.suspects.empty();
  for (Part& part : running.parts) {
    if (part.is_queued || (running.inputs && !has_rows)) continue;
    if (running.is_careful && !may_take_care(running, part)) continue;
    part.is_queued = true;
    scheduler_.add_part({running.id, part.number}, running.principal);
  }
}

/// Returns true if the part may compute a campaign that needs care: part 0, unless another campaign
/// is computed with care. Then a lost process was at the noted rows, or at none of them.
bool CampaignJobs::may_take_care(const Running& running, const Part& part) const {
  const std::int64_t careful = careful_campaign_;
  return part.number == 0 && (careful == 0 || careful == running.id);
}

/// Lets other campaigns be computed with care, if this one was.
void CampaignJobs::end_care(const Running& running) {
  std::int64_t careful = running.id;
  if (!careful_campaign_.compare_exchange_strong(careful, 0)) return;
  std::vector<RunningPointer> others;
  {
    const std::lock_guard lock(mutex_);
    for (const auto& [id, other] : running_) {
      if (id != running.id) others.push_back(other);
    }
  }
  for (const RunningPointer& other : others) start_parts(*other);
}

/// Stops the slices of a campaign; their parts write what they have. Requires control_mutex_.
void CampaignJobs::halt(std::int64_t id) {
  const RunningPointer running = find(id);
  if (!running) return;
  {
    const std::lock_guard lock(running->mutex);
    running->is_halted = true;
    for (const Part& part : running->parts) {
      if (part.stop) part.stop->request(StopReason::kEnded);
    }
  }
  forget_if_idle(id);
}

/// Keeps account of a campaign whose state may have changed. Requires control_mutex_.
void CampaignJobs::note_state(std::int64_t id, CampaignState state) {
  const std::lock_guard lock(mutex_);
  if (state == CampaignState::kPaused) {
    paused_.insert(id);
  } else {
    paused_.erase(id);
  }
}

/// Brings what runs into line with the stored state.
void CampaignJobs::settle(std::int64_t id) {
  const std::lock_guard control(control_mutex_);
  const auto stored = store_.campaign(id);
  if (stored) note_state(id, stored->state);
  if (!stored || stored->state != CampaignState::kRunning) halt(id);
}

/// Frees a campaign that is halted and none of whose parts waits or runs.
void CampaignJobs::forget_if_idle(std::int64_t id) {
  RunningPointer forgotten;  // freed without the mutex
  const std::lock_guard lock(mutex_);
  const auto found = running_.find(id);
  if (found == running_.end()) return;
  {
    const std::lock_guard inner(found->second->mutex);
    if (!found->second->is_halted) return;
    for (const Part& part : found->second->parts) {
      if (part.is_queued) return;
    }
  }
  forgotten = std::move(found->second);
  running_.erase(found);
}

std::optional<StoreError> CampaignJobs::stalled(std::int64_t id) {
  const RunningPointer running = find(id);
  if (!running) return std::nullopt;
  const std::lock_guard lock(running->stall_mutex);
  return running->is_halted ? std::nullopt : running->stalled;
}

double CampaignJobs::unfinished_seconds(const std::string& principal) const {
  double out = 0;
  const std::lock_guard lock(mutex_);
  for (const auto& [id, running] : running_) {
    if (running->principal == principal) out += running->remaining_seconds();
  }
  return out;
}

CampaignTotals CampaignJobs::totals() const {
  CampaignTotals out;
  const std::lock_guard lock(mutex_);
  out.paused = paused_.size();
  for (const auto& [id, running] : running_) {
    if (running->is_halted) continue;
    ++out.running;
    if (running->is_stalled) ++out.stalled;
    out.points_left += running->remaining_points();
    out.seconds_left += running->remaining_seconds();
  }
  return out;
}

/// Returns true if a campaign of this size may run beside all but the campaign `own`.
bool CampaignJobs::has_place(const std::string& principal, std::int64_t own,
                             std::size_t bytes) const {
  std::size_t count = 0, all_bytes = bytes, own_bytes = bytes;
  const std::lock_guard lock(mutex_);
  for (const auto& [id, running] : running_) {
    if (id == own) continue;
    ++count;
    all_bytes += running->bytes;
    if (running->principal == principal) own_bytes += running->bytes;
  }
  return count < kMostRunning && all_bytes <= kMostRunningBytes &&
         static_cast<double>(own_bytes) <=
             kShareOfPrincipal * static_cast<double>(kMostRunningBytes);
}

CampaignJobs::Admitted CampaignJobs::submit(const NewCampaign& campaign, CampaignInputs inputs,
                                            const CallLimits& limits) {
  Admitted out;
  out.has_place =
      has_place(campaign.principal, 0, campaign.request.size() + campaign.candidate_table.size());
  if (!out.has_place) return out;
  const std::lock_guard control(control_mutex_);
  out.added = store_.add_campaign(campaign, clock_(), limits);
  if (out.added.kind == CampaignAdded::Kind::kAdded) {
    inputs.table.Clear();  // the columns are in `points`
    activate(out.added.stored, std::make_shared<CampaignInputs>(std::move(inputs)));
  }
  return out;
}

CampaignJobs::Appended CampaignJobs::append(const NewCandidates& candidates,
                                            const std::shared_ptr<CampaignInputs>& inputs,
                                            const CallLimits& limits) {
  Appended out;
  const std::lock_guard control(control_mutex_);
  const auto before = store_.campaign(candidates.campaign, limits);
  const RunningPointer running = find(candidates.campaign);
  out.has_place = !before || has_place(before->principal, before->id,
                                       static_cast<std::size_t>(before->stored_bytes) +
                                           candidates.candidate_table.size());
  if (!out.has_place) return out;
  const bool is_loaded = [&] {
    if (!running) return false;
    const std::lock_guard lock(running->mutex);
    return running->inputs != nullptr;
  }();
  // Of a campaign that this process has begun the attempt counts already.
  out.added = store_.add_candidates(candidates, clock_(), is_loaded ? 1 : 0, limits);
  if (out.added.kind != CandidatesAdded::Kind::kAdded) return out;
  inputs->table.Clear();  // the columns are in `points`
  if (running) extend(*running, *out.added.stored, inputs);
  if (out.added.stored->state == CampaignState::kRunning) activate(*out.added.stored);
  return out;
}

/// Makes the candidates that were added missing ones. A campaign that is not loaded will find them
/// in the store.
void CampaignJobs::extend(Running& running, const StoredCampaign& campaign,
                          const std::shared_ptr<const CampaignInputs>& inputs) {
  {
    const std::lock_guard lock(mutex_);
    running.bytes = std::max(running.bytes, static_cast<std::size_t>(campaign.stored_bytes));
  }
  const std::lock_guard lock(running.mutex);
  running.points = campaign.points();
  running.cost_seconds = campaign.cost_seconds;
  if (!running.inputs) return;
  if (running.candidates < campaign.candidates) {
    running.missing.push_back({running.candidates, campaign.candidates - running.candidates});
    running.candidates = campaign.candidates;
  }
  running.inputs = inputs;
}

void CampaignJobs::ensure_queued(const StoredCampaign& campaign) {
  if (campaign.state != CampaignState::kRunning || find(campaign.id)) return;
  const std::lock_guard control(control_mutex_);
  const auto stored = store_.campaign(campaign.id);
  if (stored && stored->state == CampaignState::kRunning) activate(*stored);
}

/// Changes the state in the store, and what runs. Returns the campaign as it is then.
std::optional<StoredCampaign> CampaignJobs::change(CampaignChange change,
                                                   const CallLimits& limits) {
  const std::lock_guard control(control_mutex_);
  const RunningPointer running = find(change.id);
  const bool is_loaded = [&] {
    if (!running) return false;
    const std::lock_guard lock(running->mutex);
    return running->inputs != nullptr;
  }();
  change.lost_attempts = is_loaded ? 1 : 0;  // this process has begun it
  auto changed = store_.change_campaign(change, limits);
  if (!changed) return store_.campaign(change.id);
  note_state(change.id, changed->state);
  if (has_ended(changed->state)) {
    metrics_.count(changed->state == CampaignState::kFailed ? CampaignOutcome::kFailed
                                                            : CampaignOutcome::kCancelled);
  }
  if (changed->state != CampaignState::kRunning) {
    halt(change.id);
    return changed;
  }
  activate(*changed);
  return changed;
}

std::optional<StoredCampaign> CampaignJobs::pause(std::int64_t id, const CallLimits& limits) {
  return change({.id = id,
                 .to = CampaignState::kPaused,
                 .time = clock_(),
                 .reason = "PAUSE_REQUESTED",
                 .message = "it was paused; resume it to go on",
                 .from = CampaignState::kRunning},
                limits);
}

std::optional<StoredCampaign> CampaignJobs::go_on(std::int64_t id,
                                                  const std::optional<CampaignBudget>& budget,
                                                  const CallLimits& limits) {
  return change({.id = id, .to = CampaignState::kRunning, .time = clock_(), .budget = budget},
                limits);
}

std::optional<StoredCampaign> CampaignJobs::cancel(std::int64_t id, const CallLimits& limits) {
  return change({.id = id, .to = CampaignState::kCancelled, .time = clock_()}, limits);
}

void CampaignJobs::fail(std::int64_t id, const std::string& reason, const std::string& message) {
  // The message may quote inputs, so only the reason is logged.
  spdlog::warn("event=campaign_failed campaign=row:{} reason={}", id, reason);
  change({.id = id,
          .to = CampaignState::kFailed,
          .time = clock_(),
          .reason = reason,
          .message = message},
         {});
}

void CampaignJobs::finish() {
  std::map<std::int64_t, RunningPointer> ended;
  {
    const std::lock_guard lock(mutex_);
    ended.swap(running_);
  }
  for (const auto& [id, running] : ended) {
    try {
      for (Part& part : running->parts) {
        if (part.tile) write(*running, part);
      }
      if (running->inputs) store_.release_campaign(id);
    } catch (const StoreError& error) {
      spdlog::error("{}: {}", running->name, error.what());
    }
  }
}

}  // namespace tribodyn::server
