// CampaignJobs: the slices, in which parts take tiles, compute and write them.
#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <new>
#include <utility>

#include "core/refusal.h"
#include "core/version.h"
#include "server/execution/running_campaign.h"
#include "server/simulation/campaign_columns.h"
#include "server/simulation/compute.h"
#include "server/simulation/result_key.h"
#include "server/storage/life_cycle.h"
#include "server/storage/resource_lookup.h"

namespace tribodyn::server {
namespace {

/// Rows of the first tiles of a campaign that runs: the first rows come early, and tiles of a few
/// rows would cost a quarter more (measured).
constexpr std::int64_t kRamp[] = {128, 512, 2048, kMaximumTileRows};
/// Tiles that a process writes before earlier processes that were lost are forgiven: some seconds.
constexpr int kTilesOfHealth = 16;
/// Sentences of refusals that a campaign tells apart.
constexpr std::size_t kMostSentences = 100;
constexpr char kFurtherSentences[] =
    "other sentences of this reason; EvaluatePoints states that of each point";
/// Pause before another attempt to write a tile while the store cannot be written.
constexpr auto kStorePause = std::chrono::milliseconds(200);
/// Processes that began a campaign, the present one included, from which on it is computed with
/// care: one tile at a time, each noted before it is computed. If the process is lost then, its
/// successor has the rows that it was at.
constexpr int kCarefulAttempts = 2;

/// Returns the runs of candidates whose rows are in none of the runs of rows, which are in their
/// order and hold whole candidates.
std::deque<RowRange> missing_candidates(const std::vector<RowRange>& tiles, std::int64_t candidates,
                                        std::int64_t conditions) {
  std::deque<RowRange> out;
  std::int64_t next = 0;
  for (const RowRange& tile : tiles) {
    const std::int64_t first = tile.first / conditions;
    if (first > next) out.push_back({next, first - next});
    next = (tile.first + tile.count) / conditions;
  }
  if (next < candidates) out.push_back({next, candidates - next});
  return out;
}

/// A row of a candidate whose computation no process has survived.
CampaignRow lost_row() {
  CampaignRow out;
  out.refuse("WORKER_LOST", "the server ended " + std::to_string(kMaximumLostAttempts) +
                                " times while it computed this candidate");
  return out;
}

}  // namespace

/// Reads the campaign from the store. Requires its mutex. Throws Refusal or StoreError.
void CampaignJobs::load(Running& running) {
  const auto stored = store_.begin_campaign(running.id);
  if (!stored || stored->state != CampaignState::kRunning) {
    running.is_halted = true;
    return;
  }
  if (stored->model_version != kModelVersion || stored->platform != platform()) {
    throw Refusal("MODEL_CHANGED", "its rows are of model " + stored->model_version + " on " +
                                       stored->platform + ", this server computes model " +
                                       kModelVersion + " on " + platform() + ": create it again");
  }
  std::shared_ptr<const CampaignInputs> inputs = std::move(running.submitted);
  // Candidates may have been added since the request.
  if (!inputs || inputs->points.candidates != stored->candidates) inputs = stored_inputs(*stored);
  for (const CampaignRefusal& each : store_.campaign_refusals(running.id)) {
    running.refusal_numbers[{each.reason, each.message}] = each.number;
  }
  std::vector<RowRange> taken = store_.campaign_tiles(running.id);
  for (const CampaignSuspect& each : store_.campaign_suspects(running.id)) {
    running.suspects.push_back(each);
    taken.push_back(each.rows);
  }
  std::sort(taken.begin(), taken.end(),
            [](const RowRange& one, const RowRange& other) { return one.first < other.first; });
  running.missing = missing_candidates(taken, stored->candidates, stored->conditions);
  running.candidates = stored->candidates;
  running.is_careful = stored->lost_attempts >= kCarefulAttempts || !running.suspects.empty();
  running.inputs = std::move(inputs);
}

/// Reads the inputs of a campaign from the store. Throws Refusal or StoreError.
std::shared_ptr<const CampaignInputs> CampaignJobs::stored_inputs(const StoredCampaign& stored) {
  const ResourceLookup lookup = accepted_lookup(store_, stored.project, stored.revisions);
  CampaignInputs out = stored_campaign_inputs(stored, store_.candidate_table(stored.id), lookup);
  out.table.Clear();  // the columns are in `points`
  return std::make_shared<CampaignInputs>(std::move(out));
}

void CampaignJobs::run_slice(const Lease& lease, PreparedGearSets& gear_sets,
                             const std::function<double()>& lend) {
  const CampaignPart asked = *campaign_part(lease.id);
  const RunningPointer running = find(asked.campaign);
  if (!running) return scheduler_.return_slice(lease, 0, false);
  Part& part = running->parts[static_cast<std::size_t>(asked.part)];
  const double begin = processor_seconds();
  double lent = 0;
  part.used_seconds = [&] { return processor_seconds() - begin - lent; };
  part.counted_seconds = 0;
  part.goes_on = [&] {
    lent = lend();
    return !lease.stop->requested();
  };
  {
    const std::lock_guard lock(running->mutex);
    part.stop = lease.stop;
  }
  bool goes_on = false;
  try {
    try {
      goes_on = compute_slice(*running, part, gear_sets);
    } catch (const Refusal& refusal) {
      fail(running->id, refusal.reason(), refusal.what());
    } catch (const std::bad_alloc&) {
      fail(running->id, "OUT_OF_MEMORY", "not enough memory for this campaign");
    } catch (const StoreError&) {
      throw;
    } catch (const std::exception& defect) {
      spdlog::error("event=internal_error campaign={} cause=\"{}\"", running->name, defect.what());
      fail(running->id, "INTERNAL", "internal error; the server's log states its cause");
    }
  } catch (const StoreError& error) {
    spdlog::error("{}: {}", running->name, error.what());
    set_stalled(*running, error);
    goes_on = lease.stop->wait_for(kStorePause);
  }
  part.goes_on = nullptr;
  scheduler_.return_slice(lease, part.used_seconds(), goes_on);
  {
    const std::lock_guard lock(running->mutex);
    part.stop = nullptr;
    part.is_queued = goes_on;
  }
  if (goes_on) return;
  if (part.number == 0) end_care(*running);
  start_parts(*running);  // if it was resumed meanwhile, or needs no care any more
  forget_if_idle(running->id);
}

/// Sets why rows cannot be written; nullopt: they can. Tells those who watch if that changed.
void CampaignJobs::set_stalled(Running& running, const std::optional<StoreError>& cause) {
  {
    const std::lock_guard lock(running.stall_mutex);
    const bool has_changed = running.stalled.has_value() != cause.has_value() ||
                             (cause && running.stalled->kind() != cause->kind());
    if (!has_changed) return;
    running.stalled = cause;
    running.is_stalled = cause.has_value();
  }
  store_.tell_campaign_change();
}

/// Computes for about Scheduler::kSliceSeconds. Returns true if there may be more to do. Throws
/// Refusal or StoreError; then the tile stays as it is.
bool CampaignJobs::compute_slice(Running& running, Part& part, PreparedGearSets& gear_sets) {
  const bool is_loaded = [&] {
    const std::lock_guard lock(running.mutex);
    if (!running.inputs && !running.is_halted) load(running);
    if (running.inputs && !part.inputs) use_inputs(part, running.inputs);
    return running.inputs != nullptr;
  }();
  if (!is_loaded) {
    settle(running.id);  // its beginning may have paused it
    return false;
  }
  std::shared_ptr<PreparedGearSet> gear_set;
  const auto give_back = [&] {
    if (!gear_set) return;
    part.candidate->give_back(gear_sets, std::move(gear_set));
  };
  for (;;) {
    const bool is_halted = running.is_halted;
    if (part.tile && (part.tile->is_full() || is_halted || !part.goes_on())) write(running, part);
    if (is_halted || !part.goes_on()) break;
    if (!part.tile) {
      if (!take_tile(running, part)) break;
      part.counted_seconds = part.used_seconds();
    }
    if (!gear_set) {
      gear_set = part.candidate->take_gear_set(gear_sets);
    }
    try {
      compute_unit(running, part, gear_set);
    } catch (const Cancelled&) {
      gear_set.reset();  // it may be half prepared
      part.tile->group = 0;
      continue;
    }
    if (part.counted_seconds < Scheduler::kSliceSeconds) continue;
    if (part.tile->is_full()) write(running, part);
    give_back();
    return true;
  }
  give_back();
  return false;
}

/// Makes the part compute candidates of these inputs. Its gear set is the same one: candidates
/// that are added differ in fluid and surface.
void CampaignJobs::use_inputs(Part& part, const std::shared_ptr<const CampaignInputs>& inputs) {
  part.candidate.reset();  // it refers to the inputs before
  part.inputs = inputs;
  part.candidate = campaign_scene(*inputs, [&part] { return part.goes_on(); });
}

/// Takes the next candidates for a tile. Returns false if the part finds none. Throws StoreError;
/// then no candidates are taken.
bool CampaignJobs::take_tile(Running& running, Part& part) {
  bool is_careful = false;
  {
    const std::lock_guard lock(running.mutex);
    is_careful = running.is_careful;
    if (is_careful) {
      if (!may_take_care(running, part)) return false;
      std::int64_t careful = 0;
      careful_campaign_.compare_exchange_strong(careful, running.id);
      if (careful_campaign_ != running.id) return false;  // another one was faster
    }
    const auto candidates = next_candidates(running);
    if (!candidates) return false;
    if (part.inputs != running.inputs) use_inputs(part, running.inputs);
    Tile& tile = part.tile.emplace(*candidates);
    const auto conditions = static_cast<std::size_t>(part.inputs->points.conditions);
    tile.rows.resize(conditions);
    tile.columns.resize(part.inputs->columns);
    for (auto& each : tile.columns) {
      each.reserve(static_cast<std::size_t>(tile.candidates.count) * conditions);
    }
    ++running.tiles_taken;
  }
  if (!is_careful || part.tile->lost_attempts >= kMaximumLostAttempts) return true;
  try {
    const std::int64_t conditions = part.inputs->points.conditions;
    store_.begin_suspect(running.id, {part.tile->candidates.first * conditions,
                                      part.tile->candidates.count * conditions});
    part.tile->is_noted = true;
  } catch (...) {
    return_rows(running, *part.tile);
    part.tile.reset();
    throw;
  }
  return true;
}

/// Takes candidates out of those that are missing, suspects first. The last tiles are small, so
/// that all threads end at about the same time. Returns nullopt if there are none. Requires the
/// mutex of the campaign.
std::optional<CampaignJobs::Tile> CampaignJobs::next_candidates(Running& running) const {
  const std::int64_t conditions = running.inputs->points.conditions;
  Tile out;
  if (!running.suspects.empty()) {
    const CampaignSuspect& suspect = running.suspects.front();
    out.candidates = {suspect.rows.first / conditions, suspect.rows.count / conditions};
    out.lost_attempts = suspect.lost_attempts;
    running.suspects.pop_front();
    return out;
  }
  if (running.missing.empty()) return std::nullopt;
  std::int64_t left = 0;
  for (const RowRange& each : running.missing) left += each.count;
  const std::int64_t ramp = kRamp[std::min(running.tiles_taken, std::size(kRamp) - 1)];
  const std::int64_t share = std::max(kRamp[0], left * conditions / (2 * threads_));
  RowRange& next = running.missing.front();
  const std::int64_t count =
      std::clamp<std::int64_t>(std::min(ramp, share) / conditions, 1, next.count);
  out.candidates = {next.first, count};
  next.first += count;
  next.count -= count;
  if (next.count == 0) running.missing.pop_front();
  return out;
}

/// Makes the candidates of a tile that are not computed the next ones.
void CampaignJobs::return_rows(Running& running, const Tile& tile) {
  const RowRange rest{tile.candidates.first + tile.done, tile.candidates.count - tile.done};
  if (rest.count == 0) return;
  const std::lock_guard lock(running.mutex);
  if (!running.is_careful) return running.missing.push_front(rest);
  const std::int64_t conditions = running.inputs->points.conditions;
  running.suspects.push_front(
      {{rest.first * conditions, rest.count * conditions}, tile.lost_attempts});
}

/// Computes the next candidate of the tile at its next group of conditions. Throws Cancelled.
void CampaignJobs::compute_unit(Running& running, Part& part,
                                const std::shared_ptr<PreparedGearSet>& gear_set) {
  Tile& tile = *part.tile;
  const std::size_t groups = part.candidate->groups();
  if (tile.lost_attempts >= kMaximumLostAttempts) {
    std::fill(tile.rows.begin(), tile.rows.end(), lost_row());
    tile.group = groups;
  } else {
    if (tile.group == 0) {
      part.candidate->set_candidate(static_cast<int>(tile.candidates.first + tile.done));
    }
    part.candidate->evaluate(tile.group, gear_set, tile.rows);
    ++tile.group;
  }
  if (tile.group == groups) {
    tile.group = 0;
    add_rows(running, part);
    ++tile.done;
  }
  // Once for all: reading the clock of a thread takes a microsecond.
  const double used = part.used_seconds();
  tile.seconds += used - std::exchange(part.counted_seconds, used);
}

/// Adds the rows of the present candidate to the columns.
void CampaignJobs::add_rows(Running& running, Part& part) {
  Tile& tile = *part.tile;
  for (const CampaignRow& row : tile.rows) {
    add_campaign_row(row, refusal_number(running, row, tile), tile.columns);
  }
}

/// Returns the number of the refusal of a row; 0 if it has figures.
int CampaignJobs::refusal_number(Running& running, const CampaignRow& row, Tile& tile) {
  if (!row.figures.empty()) return 0;
  ++tile.refused;
  const std::lock_guard lock(running.mutex);
  auto& numbers = running.refusal_numbers;
  std::pair<std::string, std::string> key(row.refusal_reason, row.refusal_message);
  if (!numbers.contains(key) && numbers.size() >= kMostSentences) key.second = kFurtherSentences;
  const int number = numbers.emplace(key, static_cast<int>(numbers.size()) + 1).first->second;
  tile.refusals[number] = {number, key.first, key.second};
  return number;
}

/// Writes the complete candidates of the tile; the others are missing again. Throws StoreError, and
/// then changes nothing.
void CampaignJobs::write(Running& running, Part& part) {
  Tile& tile = *part.tile;
  const std::int64_t conditions = part.inputs->points.conditions;
  std::optional<StoredCampaign> stored;
  if (tile.done > 0) {
    NewTile rows;
    rows.rows = {tile.candidates.first * conditions, tile.done * conditions};
    for (const auto& [number, refusal] : tile.refusals) rows.refusals.push_back(refusal);
    rows.refused_points = tile.refused;
    rows.processor_seconds = tile.seconds;
    {
      const std::lock_guard lock(running.mutex);
      rows.proves_health = running.tiles_written >= kTilesOfHealth;
    }
    rows.columns.swap(tile.columns);
    try {
      // Compressing takes 10 ms, for which an urgent job of the same thread need not wait.
      stored = store_.add_tile(running.id, rows, clock_(), [&part] {
        if (part.goes_on) part.goes_on();
      });
    } catch (...) {
      rows.columns.swap(tile.columns);
      throw;
    }
  }
  if (stored) metrics_.count_tile(tile.done * conditions - tile.refused, tile.refused);
  if (tile.done == 0 && tile.is_noted) store_.end_suspects(running.id);
  if (tile.done > 0) set_stalled(running, std::nullopt);
  return_rows(running, tile);
  const bool was_written = tile.done > 0;
  part.tile.reset();
  bool has_ended_care = false;
  {
    const std::lock_guard lock(running.mutex);
    if (was_written) ++running.tiles_written;
    // Another part may have written a later tile meanwhile.
    if (stored) running.points_done = std::max(running.points_done.load(), stored->points_done);
    has_ended_care =
        running.is_careful && running.suspects.empty() && running.tiles_written > kTilesOfHealth;
    if (has_ended_care) running.is_careful = false;
  }
  if (has_ended_care) {
    end_care(running);
    start_parts(running);
  }
  if (was_written && (!stored || stored->state != CampaignState::kRunning)) settle(running.id);
  if (stored && stored->state == CampaignState::kSucceeded) {
    metrics_.count(CampaignOutcome::kSucceeded);
    spdlog::info("event=campaign_computed campaign={} points={} processor_seconds={:.3f}",
                 running.name, stored->points(), stored->processor_seconds);
  }
}

}  // namespace tribodyn::server
