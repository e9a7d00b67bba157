// Compares the life cycle of campaigns in the store, with their tiles and suspects, with a model
// over random schedules.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "server/storage/life_cycle.h"
#include "server/storage/maintenance.h"
#include "server/storage/store.h"
#include "server/storage/store_error.h"
#include "tests/service/schedule_seed.h"
#include "tests/service/support.h"
#include "tests/support/run_length.h"

namespace tribodyn::server {
namespace {

using enum CampaignState;

constexpr int kCampaignSchedules =
    kUnderSanitizer ? 150 : 1'500;  // ten times slower, and one thread
constexpr int kCampaignSteps = 25;
constexpr std::size_t kMostCampaigns = 3;  // of a schedule
constexpr int kCampaignRequestIds = 2;
constexpr std::int64_t kConditions = 2;
constexpr double kMissing = -7;  // what a reader finds in a row without a tile
constexpr char kRevision[] = "surfaces/run-in@1";

struct ExpectedSuspect {
  std::int64_t count = 0;
  int lost_attempts = 0;
  bool is_begun = false;
};

/// The expected state of a campaign.
struct ExpectedCampaign {
  std::string request_hash;
  CampaignState state = kRunning;
  std::string stop_reason = {};
  int candidates = 1;
  CampaignBudget budget = {};
  int lost_attempts = 0;
  double processor_seconds = 0;
  std::int64_t refused = 0;
  std::map<std::int64_t, std::int64_t> tiles = {};        ///< number of rows by first row
  std::map<std::int64_t, double> values = {};             ///< by row
  std::map<std::int64_t, ExpectedSuspect> suspects = {};  ///< by first row
  std::map<std::string, std::string> appends = {};        ///< hash by request_id
  std::int64_t seen_first_missing = 0;                    ///< of the last progress

  std::int64_t points() const { return candidates * kConditions; }
  std::int64_t done() const { return static_cast<std::int64_t>(values.size()); }

  void go(CampaignState to, const std::string& reason = {}, int attempts = 0) {
    state = to;
    stop_reason = reason;
    lost_attempts = attempts;
    if (has_ended(to)) suspects.clear();
  }

  /// Returns true if a suspect has one of the rows.
  bool is_suspect(std::int64_t first, std::int64_t count) const {
    return std::any_of(suspects.begin(), suspects.end(), [&](const auto& each) {
      return each.first < first + count && each.first + each.second.count > first;
    });
  }
  bool has_a_row(std::int64_t first, std::int64_t count) const {
    const auto found = values.lower_bound(first);
    return found != values.end() && found->first < first + count;
  }
  std::int64_t first_missing() const {
    std::int64_t row = 0;
    while (values.contains(row)) ++row;
    return row;
  }
};

/// Runs one schedule on the store and on the model, and reports differences.
class CampaignSchedule {
 public:
  CampaignSchedule(Store& store, int number, std::uint64_t seed)
      : store_(store), number_(number), random_(seed) {}

  void run() {
    for (int step = 0; step < kCampaignSteps && !testing::Test::HasFailure(); ++step) {
      try {
        take_step();
      } catch (const StoreError& failure) {
        ADD_FAILURE() << failure.what() << "\n" << log_;
      }
      for (auto& [id, each] : campaigns_) compare_row(id, each);
    }
    for (const auto& [id, each] : campaigns_) compare_content(id, each);
    for (const auto& [id, each] : campaigns_) {  // leave nothing that runs for the next schedule
      if (has_ended(each.state)) continue;
      store_.change_campaign({.id = id, .to = kCancelled, .time = now_});
    }
  }

 private:
  int draw(int count) { return std::uniform_int_distribution<int>(0, count - 1)(random_); }
  static std::string hash(int number) { return fmt::format("{:064d}", number); }

  void take_step() {
    ++now_;
    if (campaigns_.empty() || draw(10) == 0) return submit();
    if (draw(12) == 0) return die();
    auto drawn = campaigns_.begin();
    std::advance(drawn, draw(static_cast<int>(campaigns_.size())));
    const std::int64_t id = drawn->first;
    ExpectedCampaign& campaign = drawn->second;
    switch (draw(12)) {
      case 0:
        return begin(id, campaign);
      case 1:
        return begin_suspect(id, campaign);
      case 2:
        return release(id, campaign);
      case 3:
        return pause(id, campaign);
      case 4:
        return go_on(id, campaign);
      case 5:
        return append(id, campaign);
      case 6:
        if (draw(3) == 0) return end(id, campaign);
        return remove(id);
      default:
        return add_tile(id, campaign);
    }
  }

  void submit() {
    if (campaigns_.size() == kMostCampaigns) return;
    const int id_drawn = draw(kCampaignRequestIds + 1);
    NewCampaign added;
    added.request_id = id_drawn == 0 ? "" : fmt::format("{}-{}", number_, id_drawn);
    added.request_hash = hash(draw(2));
    added.input_hash = hash(0);
    added.candidates = 1 + draw(6);
    added.conditions = kConditions;
    if (draw(3) == 0) {
      added.budget = {.processor_seconds = draw(2) * 0.75, .points = draw(2) * (1 + draw(8))};
    }
    for (std::string* each : {&added.revisions.lubricant, &added.revisions.gear_set,
                              &added.revisions.surface, &added.revisions.vehicle}) {
      *each = kRevision;
    }
    log_ += fmt::format("submit {} {}\n", added.request_id, added.request_hash.back());
    const CampaignAdded outcome = store_.add_campaign(added, now_);
    const auto earlier = request_ids_.find(added.request_id);
    if (earlier != request_ids_.end()) {
      const bool is_same = campaigns_.at(earlier->second).request_hash == added.request_hash;
      EXPECT_EQ(outcome.stored.id, earlier->second) << log_;
      EXPECT_EQ(outcome.kind,
                is_same ? CampaignAdded::Kind::kRepeated : CampaignAdded::Kind::kRequestIdTaken)
          << log_;
      return;
    }
    EXPECT_EQ(outcome.kind, CampaignAdded::Kind::kAdded) << log_;
    campaigns_[outcome.stored.id] = {
        .request_hash = added.request_hash, .candidates = added.candidates, .budget = added.budget};
    if (!added.request_id.empty()) request_ids_[added.request_id] = outcome.stored.id;
  }

  /// The process ends without notice and another one starts.
  void die() {
    log_ += "die\n";
    bool is_explained = false;
    std::vector<std::int64_t> running;
    for (auto& [id, campaign] : campaigns_) {
      is_explained = lose_suspects(campaign) || is_explained;
      if (campaign.state == kRunning) running.push_back(id);
    }
    for (auto& [id, campaign] : campaigns_) {
      if (is_explained && !has_ended(campaign.state) && campaign.lost_attempts > 0) {
        --campaign.lost_attempts;
      }
    }
    EXPECT_EQ(store_.resume_campaigns(), running) << log_;
  }

  /// Returns true if the process computed a suspect of the campaign.
  static bool lose_suspects(ExpectedCampaign& campaign) {
    bool had_begun = false;
    const auto before = campaign.suspects;
    for (const auto& [first, suspect] : before) {
      if (!suspect.is_begun) continue;
      had_begun = true;
      ExpectedSuspect& now = campaign.suspects[first];
      now.is_begun = false;
      if (suspect.count > kConditions) {
        now.count = suspect.count / kConditions / 2 * kConditions;
        campaign.suspects[first + now.count] = {.count = suspect.count - now.count};
      } else {
        ++now.lost_attempts;
      }
    }
    return had_begun;
  }

  void begin(std::int64_t id, ExpectedCampaign& campaign) {
    log_ += fmt::format("begin {}\n", id);
    const auto stored = store_.begin_campaign(id);
    EXPECT_EQ(stored.has_value(), !has_ended(campaign.state)) << log_;
    if (has_ended(campaign.state)) return;
    ++campaign.lost_attempts;
    // So few candidates never reach kMaximumLostCandidates, the other reason for WORKER_LOST.
    const bool is_feared = campaign.lost_attempts > kMaximumLostAttempts;
    if (is_feared && campaign.state == kRunning) campaign.go(kPaused, "WORKER_LOST");
  }

  /// Draws a suspect, or else candidates of which no row is in a tile or suspect.
  void begin_suspect(std::int64_t id, ExpectedCampaign& campaign) {
    RowRange rows;
    if (!campaign.suspects.empty() && draw(2) == 0) {
      auto drawn = campaign.suspects.begin();
      std::advance(drawn, draw(static_cast<int>(campaign.suspects.size())));
      rows = {drawn->first, drawn->second.count};
    } else {
      const int first = draw(campaign.candidates);
      const int count = 1 + draw(campaign.candidates - first);
      rows = {first * kConditions, count * kConditions};
      if (campaign.is_suspect(rows.first, rows.count)) return;
      if (campaign.has_a_row(rows.first, rows.count)) return;
    }
    log_ += fmt::format("begin suspect {} {}+{}\n", id, rows.first, rows.count);
    store_.begin_suspect(id, rows);
    if (has_ended(campaign.state)) return;
    ExpectedSuspect& suspect = campaign.suspects[rows.first];
    suspect.count = rows.count;
    suspect.is_begun = true;
  }

  void release(std::int64_t id, ExpectedCampaign& campaign) {
    log_ += fmt::format("release {}\n", id);
    store_.release_campaign(id);
    if (has_ended(campaign.state)) return;
    campaign.lost_attempts = 0;
    for (auto& [first, suspect] : campaign.suspects) suspect.is_begun = false;
  }

  void pause(std::int64_t id, ExpectedCampaign& campaign) {
    log_ += fmt::format("pause {}\n", id);
    const auto stored = store_.change_campaign(
        {.id = id, .to = kPaused, .time = now_, .reason = "REQUESTED", .from = kRunning});
    EXPECT_EQ(stored.has_value(), campaign.state == kRunning) << log_;
    if (campaign.state == kRunning) campaign.go(kPaused, "REQUESTED");
  }

  void go_on(std::int64_t id, ExpectedCampaign& campaign) {
    std::optional<CampaignBudget> budget;
    if (draw(2) == 0) budget = {.processor_seconds = 0, .points = draw(2) * 10};
    const int attempts = draw(2);
    log_ += fmt::format("go on {}\n", id);
    const auto stored = store_.change_campaign({.id = id,
                                                .to = kRunning,
                                                .time = now_,
                                                .from = kPaused,
                                                .budget = budget,
                                                .lost_attempts = attempts});
    EXPECT_EQ(stored.has_value(), campaign.state == kPaused) << log_;
    if (campaign.state != kPaused) return;
    campaign.go(kRunning, "", attempts);
    if (budget) campaign.budget = *budget;
  }

  void end(std::int64_t id, ExpectedCampaign& campaign) {
    const CampaignState to = draw(2) == 0 ? kCancelled : kFailed;
    log_ += fmt::format("end {}\n", id);
    const auto stored =
        store_.change_campaign({.id = id, .to = to, .time = now_, .reason = "REASON"});
    EXPECT_EQ(stored.has_value(), !has_ended(campaign.state)) << log_;
    if (!has_ended(campaign.state)) campaign.go(to, "REASON");
  }

  void remove(std::int64_t id) {
    log_ += fmt::format("remove {}\n", id);
    const auto campaign = campaigns_.find(id);
    const bool may = has_ended(campaign->second.state);
    EXPECT_EQ(store_.remove_campaign(id), may) << log_;
    if (!may) return;
    EXPECT_FALSE(store_.campaign(id)) << log_;
    campaigns_.erase(campaign);
    std::erase_if(request_ids_, [&](const auto& each) { return each.second == id; });
  }

  void append(std::int64_t id, ExpectedCampaign& campaign) {
    using enum CandidatesAdded::Kind;
    const int id_drawn = draw(kCampaignRequestIds + 1);
    const bool is_stale = draw(4) == 0;
    NewCandidates added;
    added.campaign = id;
    added.request_id = id_drawn == 0 ? "" : std::to_string(id_drawn);
    added.request_hash = hash(draw(2));
    added.candidates_before = campaign.candidates + (is_stale ? 1 : 0);
    added.candidates = added.candidates_before + 1 + draw(2);
    added.input_hash = hash(1);
    const int attempts = draw(2);
    log_ += fmt::format("append {} {}\n", id, added.request_id);
    const CandidatesAdded outcome = store_.add_candidates(added, now_, attempts);
    if (const auto earlier = campaign.appends.find(added.request_id);
        earlier != campaign.appends.end()) {
      EXPECT_EQ(outcome.kind, earlier->second == added.request_hash ? kRepeated : kRequestIdTaken)
          << log_;
      return;
    }
    const bool may = !is_stale && campaign.state != kFailed && campaign.state != kCancelled;
    EXPECT_EQ(outcome.kind, may ? kAdded : kChanged) << log_;
    if (!may) return;
    campaign.candidates = added.candidates;
    if (!added.request_id.empty()) campaign.appends[added.request_id] = added.request_hash;
    if (campaign.state != kSucceeded) return;
    campaign.state = kRunning;
    campaign.lost_attempts = attempts;
  }

  /// Draws the rows of a tile: a suspect, its first candidate, or rows of one candidate that no
  /// suspect has.
  RowRange drawn_rows(const ExpectedCampaign& campaign) {
    if (!campaign.suspects.empty() && draw(2) == 0) {
      auto drawn = campaign.suspects.begin();
      std::advance(drawn, draw(static_cast<int>(campaign.suspects.size())));
      return {drawn->first, draw(2) == 0 ? drawn->second.count : kConditions};
    }
    const std::int64_t within = draw(kConditions);
    const std::int64_t first = draw(campaign.candidates) * kConditions + within;
    return {first, 1 + draw(static_cast<int>(kConditions - within))};
  }

  void add_tile(std::int64_t id, ExpectedCampaign& campaign) {
    NewTile tile;
    tile.rows = drawn_rows(campaign);
    const auto [first, count] = tile.rows;
    const bool is_suspect = campaign.is_suspect(first, count);
    if (is_suspect && (count % kConditions != 0 || !campaign.suspects.contains(first))) return;
    std::vector<double> values;
    for (std::int64_t i = 0; i < count; ++i) values.push_back(draw(1'000) / 8.0);
    tile.columns = {values, std::vector<double>(values.size(), 1)};
    tile.refused_points = draw(static_cast<int>(count) + 1);
    tile.processor_seconds = draw(4) * 0.25;
    tile.proves_health = draw(2) == 0;
    log_ += fmt::format("tile {} {}+{}\n", id, first, count);
    const auto stored = store_.add_tile(id, tile, now_);
    const bool may = !has_ended(campaign.state) && !campaign.has_a_row(first, count);
    EXPECT_EQ(stored.has_value(), may) << log_;
    if (!may) return;
    campaign.tiles[first] = count;
    for (std::int64_t i = 0; i < count; ++i) {
      campaign.values[first + i] = values[static_cast<std::size_t>(i)];
    }
    campaign.refused += tile.refused_points;
    campaign.processor_seconds += tile.processor_seconds;
    if (tile.proves_health) campaign.lost_attempts = 0;
    if (is_suspect) {
      ExpectedSuspect suspect = campaign.suspects.at(first);
      campaign.suspects.erase(first);
      suspect.count -= count;
      suspect.is_begun = false;
      if (suspect.count > 0) campaign.suspects[first + count] = suspect;
    }
    const CampaignBudget& budget = campaign.budget;
    const bool is_spent =
        (budget.points > 0 && campaign.done() >= budget.points) ||
        (budget.processor_seconds > 0 && campaign.processor_seconds >= budget.processor_seconds);
    if (campaign.done() == campaign.points()) {
      campaign.go(kSucceeded);
    } else if (is_spent && campaign.state == kRunning) {
      campaign.go(kPaused, "BUDGET_SPENT");
    }
  }

  void compare_row(std::int64_t id, ExpectedCampaign& campaign) {
    const auto stored = store_.campaign(id);
    ASSERT_TRUE(stored) << log_;
    EXPECT_EQ(stored->state, campaign.state) << log_;
    EXPECT_EQ(stored->stop_reason, campaign.stop_reason) << log_;
    EXPECT_EQ(stored->candidates, campaign.candidates) << log_;
    EXPECT_EQ(stored->points_done, campaign.done()) << log_;
    EXPECT_EQ(stored->points_refused, campaign.refused) << log_;
    EXPECT_EQ(stored->lost_attempts, campaign.lost_attempts) << log_;
    EXPECT_EQ(stored->processor_seconds, campaign.processor_seconds) << log_;
    EXPECT_EQ(stored->end_time.has_value(), has_ended(campaign.state)) << log_;
    const auto progress = store_.campaign_progress(id, campaign.seen_first_missing);
    ASSERT_TRUE(progress) << log_;
    EXPECT_EQ(progress->first_missing_row, campaign.first_missing()) << log_;
    campaign.seen_first_missing = progress->first_missing_row;
  }

  void compare_content(std::int64_t id, const ExpectedCampaign& campaign) {
    std::map<std::int64_t, std::int64_t> tiles;
    for (const RowRange& each : store_.campaign_tiles(id)) tiles[each.first] = each.count;
    EXPECT_EQ(tiles, campaign.tiles) << log_;
    std::map<std::int64_t, std::pair<std::int64_t, int>> suspects, expected_suspects;
    for (const CampaignSuspect& each : store_.campaign_suspects(id)) {
      suspects[each.rows.first] = {each.rows.count, each.lost_attempts};
    }
    for (const auto& [first, each] : campaign.suspects) {
      expected_suspects[first] = {each.count, each.lost_attempts};
    }
    EXPECT_EQ(suspects, expected_suspects) << log_;
    std::vector<double> values(static_cast<std::size_t>(campaign.points()), kMissing);
    std::vector<double> expected = values;
    store_.read_campaign(id, 0, 0, values);
    for (const auto& [row, value] : campaign.values) {
      expected[static_cast<std::size_t>(row)] = value;
    }
    EXPECT_EQ(values, expected) << log_;
  }

  Store& store_;
  const int number_;
  std::mt19937_64 random_;
  Microseconds now_ = 0;
  std::map<std::int64_t, ExpectedCampaign> campaigns_;
  std::map<std::string, std::int64_t> request_ids_;
  std::string log_;
};

TEST(CampaignModel, AgreesWithTheStoreOverRandomSchedules) {
  const std::uint64_t first_seed = first_schedule_seed();
  const TemporaryFolder folder(TemporaryFolder::Kind::kMemory);
  const std::string path = folder.file("tribodyn.db");
  {
    Store store(path);
    const std::string surface = seed<v1::Surface>("surfaces/run-in").SerializeAsString();
    ASSERT_TRUE(store.write_resources({{{"surfaces/run-in", surface}, std::nullopt}}, 1));
    for (int number = 0; number < kCampaignSchedules && !HasFailure(); ++number) {
      CampaignSchedule(store, number, first_seed + static_cast<std::uint64_t>(number)).run();
    }
  }
  EXPECT_FALSE(HasFailure()) << "TRIBODYN_TEST_SEED=" << first_seed;
  EXPECT_THAT(check_database(path), testing::IsEmpty());
}

}  // namespace
}  // namespace tribodyn::server
