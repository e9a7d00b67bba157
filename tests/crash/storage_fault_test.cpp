// Tests of the store on a file system with faults: every open, read, write and sync of a session
// fails in turn, the disk is full, and power fails at any moment and takes unsynced writes with it.
// Afterwards all acknowledged changes must exist and the database must be sound.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <random>
#include <thread>

#include "server/application/call_context.h"
#include "server/application/simulations.h"
#include "server/storage/maintenance.h"
#include "server/storage/seeds.h"
#include "server/storage/store.h"
#include "tests/crash/faulty_vfs.h"
#include "tests/service/campaign_fixture.h"
#include "tests/service/support.h"
#include "tests/support/run_length.h"
#include "tribodyn/v1/results.pb.h"
#include "tribodyn/v1/surfaces.pb.h"

namespace tribodyn::crash {
namespace {

using server::AddOutcome;
using server::ResultKey;
using server::Store;
using server::StoredEvent;
using server::StoredState;
using server::StoreError;
using server::TemporaryFolder;
using testing::HasSubstr;
using testing::IsEmpty;

ResultKey key(char input) { return {std::string(64, input), "model", "platform"}; }

std::string body(char input) {
  v1::SimulationResult out;
  out.set_input_hash(key(input).input_hash);
  out.set_model_version("model");
  return out.SerializeAsString();
}

std::vector<double> rows(char input) { return std::vector<double>(700, input); }

constexpr int kTileRows = 300;

/// Resources of one batch.
constexpr std::array<const char*, 3> kBatch = {"surfaces/1", "surfaces/2", "surfaces/3"};

/// Acknowledged changes.
struct Acknowledged {
  std::map<std::string, std::int64_t> simulations;          ///< by request_id
  std::map<std::int64_t, std::vector<StoredEvent>> events;  ///< changes of state, in order
  std::map<std::int64_t, char> results;                     ///< inputs of succeeded simulations
  std::map<std::string, int> revisions;                     ///< latest revision by resource
  std::map<std::int64_t, bool> pins;   ///< pinned or not; left out after an error
  std::int64_t campaign = 0;           ///< 0: none
  std::map<std::int64_t, char> tiles;  ///< by first row: what its columns hold
  bool campaign_succeeded = false;
};

/// A session with a store. Each step is acknowledged or fails with a sentence.
class Session {
 public:
  explicit Session(std::string path) : path_(std::move(path)) {}

  void run() {
    if (!open()) return;
    step([&] {
      const auto seed = lubricant("first");
      if (store_->write_resources({{seed, std::nullopt}}, 1)) told_.revisions[seed.name] = 1;
    });
    write_batch();
    submit("r1", 'a');
    submit("r2", 'b');
    submit("r3", 'a');
    submit("r4", 'c');
    start("r1", 'a');
    succeed("r1", 'a');
    submit("r5", 'a');
    pin("r1", true);
    pin("r5", true);
    pin("r5", false);
    screen();
    add_tile(0, 'a');
    add_tile(2, 'c');
    change("r2", [&](std::int64_t id) { return store_->mark_failed(id, 5, "X", "y"); });
    change("r3", [&](std::int64_t id) { return store_->mark_cancelled(id, 6); });
    start("r4", 'c');
    change("r4", [&](std::int64_t id) { return store_->mark_queued(id, 7, "SERVER_STOPPED"); });
    start("r4", 'c');
    step([&] {
      const auto present = store_->resource("lubricants/x");
      if (present &&
          store_->write_resources({{{present->name, lubricant("second").body}, present}}, 8)) {
        told_.revisions[present->name] = present->revision + 1;
      }
    });
    store_.reset();
    if (!open()) return;
    screen();
    for (const char input : {'a', 'b', 'c'}) add_tile(input - 'a', input);
    step([&] { store_->requeue_unfinished(9); });
    submit("r1", 'a');
    start("r4", 'c');
    succeed("r4", 'c');
    submit("r6", 'd');
  }

  void close() { store_.reset(); }
  const Acknowledged& told() const { return told_; }
  const std::vector<std::string>& errors() const { return errors_; }

 private:
  server::NewResource lubricant(const std::string& title) const {
    v1::Lubricant out = server::seed<v1::Lubricant>("lubricants/paper-fluid-1");
    out.set_name("lubricants/x");
    out.set_display_name(title);
    return {out.name(), out.SerializeAsString()};
  }

  template <class Action>
  void step(const Action& action) {
    try {
      action();
    } catch (const StoreError& error) {
      errors_.emplace_back(error.what());
    }
  }

  bool open() {
    step([&] { store_ = std::make_unique<Store>(path_); });
    return store_ != nullptr;
  }

  void write_batch() {
    step([&] {
      std::vector<server::ResourceWrite> writes;
      for (const char* name : kBatch) {
        v1::Surface surface = server::seed<v1::Surface>("surfaces/run-in");
        surface.set_name(name);
        writes.push_back({{name, surface.SerializeAsString()}, std::nullopt});
      }
      if (!store_->write_resources(writes, 2)) return;
      for (const char* name : kBatch) told_.revisions[name] = 1;
    });
  }

  void pin(const std::string& request_id, bool is_pinned) {
    const auto found = told_.simulations.find(request_id);
    if (found == told_.simulations.end()) return;
    told_.pins.erase(found->second);
    step([&] {
      if (store_->set_pinned(found->second, is_pinned)) told_.pins[found->second] = is_pinned;
    });
  }

  void submit(const std::string& request_id, char input) {
    step([&] {
      const AddOutcome added = store_->add_simulation({.request = "",
                                                       .key = key(input),
                                                       .request_id = request_id,
                                                       .request_hash = std::string(1, input)},
                                                      2);
      told_.simulations[request_id] = added.id;
      if (added.kind == AddOutcome::Kind::kServed) told_.results[added.id] = input;
    });
  }

  /// Adds a campaign of three candidates, under the same request_id each time. The store asks for
  /// four revisions, whatever they are of.
  void screen() {
    if (told_.revisions.count("lubricants/x") == 0) return;
    step([&] {
      server::NewCampaign campaign;
      campaign.request_id = "c1";
      campaign.request_hash = campaign.input_hash = std::string(64, 'c');
      campaign.candidates = 3;
      campaign.conditions = kTileRows;
      for (std::string* each : {&campaign.revisions.lubricant, &campaign.revisions.gear_set,
                                &campaign.revisions.surface, &campaign.revisions.vehicle}) {
        *each = "lubricants/x@1";
      }
      told_.campaign = store_->add_campaign(campaign, 2).stored.id;
    });
  }
  /// Adds the rows of a candidate, if they are missing.
  void add_tile(std::int64_t candidate, char input) {
    if (told_.campaign == 0) return;
    step([&] {
      server::NewTile tile;
      tile.rows = {candidate * kTileRows, kTileRows};
      tile.columns.assign(3, std::vector<double>(kTileRows, input));
      const auto stored = store_->add_tile(told_.campaign, tile, 3);
      told_.tiles[tile.rows.first] = input;
      if (stored) told_.campaign_succeeded = stored->state == server::CampaignState::kSucceeded;
    });
  }

  template <class Change>
  void change(const std::string& request_id, const Change& change) {
    const auto found = told_.simulations.find(request_id);
    if (found == told_.simulations.end()) return;
    step([&] {
      const auto event = change(found->second);
      if (event) told_.events[found->second].push_back(*event);
    });
  }
  void start(const std::string& request_id, char input) {
    change(request_id, [&](std::int64_t id) { return store_->mark_running(id, 3, key(input)); });
  }
  void succeed(const std::string& request_id, char input) {
    change(request_id, [&](std::int64_t id) {
      auto event = store_->mark_succeeded(id, 4, {key(input), body(input), {{"a", rows(input)}}});
      if (event) told_.results[id] = input;
      return event;
    });
  }

  const std::string path_;
  std::unique_ptr<Store> store_;
  Acknowledged told_;
  std::vector<std::string> errors_;
};

bool is_kept(Store& store, std::int64_t id, const StoredEvent& event) {
  const auto kept = store.next_event(id, event.sequence - 1);
  return kept && kept->sequence == event.sequence && kept->state == event.state &&
         kept->attempt == event.attempt;
}

bool is_kept(Store& store, std::int64_t id, char input) {
  return store.simulation(id)->state == StoredState::kSucceeded &&
         store.result(id) == body(input) && history_rows(store, id, "a", 0, 700) == rows(input);
}

/// Returns the acknowledged changes that are missing, and the problems of the database.
std::vector<std::string> lost(const std::string& path, const Acknowledged& told) try {
  std::vector<std::string> out;
  Store store(path);
  for (const auto& [request_id, id] : told.simulations) {
    const auto stored = store.simulation_of_request("default", request_id);
    if (!stored || stored->id != id) out.push_back(request_id);
  }
  if (!out.empty()) return out;
  for (const auto& [id, events] : told.events) {
    for (const StoredEvent& event : events) {
      if (!is_kept(store, id, event)) out.push_back("event " + std::to_string(event.sequence));
    }
  }
  if (told.campaign != 0) {
    const auto campaign = store.campaign_of_request("default", "c1");
    if (!campaign || campaign->id != told.campaign) return {"the campaign"};
    for (const auto& [row, input] : told.tiles) {
      std::vector<double> values(kTileRows);
      store.read_campaign(told.campaign, 2, row, values);
      if (values != std::vector<double>(kTileRows, input)) out.push_back("a tile");
    }
    const auto tiles = static_cast<std::int64_t>(store.campaign_tiles(told.campaign).size());
    if (campaign->points_done != kTileRows * tiles) out.push_back("progress of the campaign");
    if (told.campaign_succeeded && campaign->state != server::CampaignState::kSucceeded) {
      out.push_back("state of the campaign");
    }
  }
  for (const auto& [id, input] : told.results) {
    if (!is_kept(store, id, input)) out.push_back("result of " + std::to_string(id));
  }
  for (const auto& [name, revision] : told.revisions) {
    if (!store.revision(name, revision)) out.push_back(name + "@" + std::to_string(revision));
  }
  for (const auto& [id, is_pinned] : told.pins) {
    if (store.simulation(id)->is_pinned != is_pinned) out.push_back("pin of " + std::to_string(id));
  }
  const auto written = std::count_if(kBatch.begin(), kBatch.end(), [&](const char* name) {
    return store.resource(name).has_value();
  });
  if (written != 0 && written != std::ssize(kBatch)) out.emplace_back("part of a batch");
  for (const std::string& problem : server::check_database(path)) out.push_back(problem);
  return out;
} catch (const StoreError& error) {
  return {error.what()};
}

int number_from(const char* variable, int otherwise) {
  const char* value = std::getenv(variable);
  return value == nullptr ? otherwise : std::atoi(value);
}

class StorageFault : public testing::Test {
 protected:
  /// Runs the session under a fault in its own folder. Returns false if the session ended before
  /// the fault.
  bool survives(const std::function<void()>& plan, const std::function<bool()>& was_met,
                const std::string& trace) {
    const TemporaryFolder folder(TemporaryFolder::Kind::kMemory);
    Session session(folder.file("db"));
    plan();
    session.run();
    session.close();
    const bool met = was_met();
    vfs_.recover();
    for (const std::string& error : session.errors()) {
      EXPECT_THAT(error, HasSubstr("database " + folder.file("db"))) << trace;
    }
    EXPECT_THAT(lost(folder.file("db"), session.told()), IsEmpty()) << trace;
    return met;
  }

  void fail_every(FaultyVfs::Operation operation, const std::string& name) {
    // There is one session for each operation. A session has hundreds of writes and reads: CI fails
    // every third of them, under AddressSanitizer every twelfth (and every other open and sync);
    // the full run fails each.
    const bool many =
        operation == FaultyVfs::Operation::kWrite || operation == FaultyVfs::Operation::kRead;
    const int usual = kUnderAddressSanitizer ? (many ? 12 : 2) : many ? 3 : 1;
    const int stride = full_run() ? 1 : usual;
    for (const bool lasting : {false, true}) {
      int met = 0;
      for (int n = lasting ? 1 + stride / 2 : 1; !HasFailure(); n += stride, ++met) {
        if (!survives([&] { vfs_.fail(operation, n, lasting); },
                      [&] { return vfs_.count(operation) >= n; },
                      name + " " + std::to_string(n) + (lasting ? " and all after it" : ""))) {
          break;
        }
      }
      RecordProperty(name + (lasting ? "_lasting" : "_once"), met);
      EXPECT_GE(met, 3);
    }
  }

  /// Runs sessions that end with a loss of power at a random moment. Returns what they lost.
  std::vector<std::string> lose_power(int losses) {
    const auto seed = static_cast<std::uint64_t>(
        number_from("TRIBODYN_TEST_SEED", static_cast<int>(std::random_device()() % 1'000'000)));
    std::mt19937_64 random(seed);
    const int all = operations_of_a_session();
    std::vector<std::string> out;
    for (int loss = 0; loss < losses; ++loss) {
      const int at = 1 + static_cast<int>(random() % static_cast<std::uint64_t>(all));
      const TemporaryFolder folder(TemporaryFolder::Kind::kMemory);
      Session session(folder.file("db"));
      vfs_.lose_power_at(at);
      session.run();
      session.close();
      vfs_.drop_unsynced(random);
      std::filesystem::remove(folder.file("db-shm"));
      vfs_.recover();
      for (const std::string& each : lost(folder.file("db"), session.told())) {
        out.push_back("power lost at operation " + std::to_string(at) + " of " +
                      std::to_string(all) + ", TRIBODYN_TEST_SEED=" + std::to_string(seed) + ": " +
                      each);
      }
    }
    return out;
  }

  int operations_of_a_session() {
    const TemporaryFolder folder(TemporaryFolder::Kind::kMemory);
    vfs_.recover();
    Session session(folder.file("db"));
    session.run();
    session.close();
    return vfs_.count();
  }

  FaultyVfs vfs_;
};

TEST_F(StorageFault, WithoutFaultsEverythingIsAcknowledged) {
  const TemporaryFolder folder(TemporaryFolder::Kind::kMemory);
  Session session(folder.file("db"));
  session.run();
  session.close();
  EXPECT_THAT(session.errors(), IsEmpty());
  EXPECT_EQ(session.told().simulations.size(), 6U);
  EXPECT_EQ(session.told().results.size(), 3U);
  EXPECT_EQ(session.told().revisions.size(), 1 + kBatch.size());
  EXPECT_EQ(session.told().pins.size(), 2U);
  EXPECT_THAT(lost(folder.file("db"), session.told()), IsEmpty());
}

TEST_F(StorageFault, EveryOpenMayFail) { fail_every(FaultyVfs::Operation::kOpen, "open"); }

TEST_F(StorageFault, EveryWriteMayFail) { fail_every(FaultyVfs::Operation::kWrite, "write"); }

TEST_F(StorageFault, EverySyncMayFail) { fail_every(FaultyVfs::Operation::kSync, "sync"); }

TEST_F(StorageFault, EveryReadMayFail) { fail_every(FaultyVfs::Operation::kRead, "read"); }

TEST_F(StorageFault, PowerMayGoAtAnyMoment) {
  const int losses = number_from("TRIBODYN_POWER_LOSSES", kUnderAddressSanitizer ? 40 : 100);
  RecordProperty("losses", losses);
  EXPECT_THAT(lose_power(losses), IsEmpty());
}

TEST_F(StorageFault, ASyncThatDoesNothingIsFound) {
  vfs_.ignore_syncs();
  EXPECT_FALSE(lose_power(30).empty()) << "this test would not see a commit that is not synced";
}

TEST_F(StorageFault, AFullDiskRefusesAndLosesNothing) {
  operations_of_a_session();
  const std::int64_t all = vfs_.written_bytes();
  constexpr int kSteps = kUnderSanitizer ? 30 : 80;
  for (int i = 0; i < kSteps && !HasFailure(); ++i) {
    const std::int64_t space = all * i / kSteps;
    EXPECT_TRUE(survives([&] { vfs_.limit_space(space); }, [] { return true; },
                         std::to_string(space) + " bytes"));
  }
}

TEST_F(StorageFault, AResultWaitsForADiskThatIsFull) {
  auto release = std::make_shared<std::atomic<bool>>(false);
  server::Bench bench(server::patient_studies(release), 1);
  const std::string name = bench.create(server::point_simulation());
  ASSERT_TRUE(bench.reaches(name, v1::Simulation::RUNNING));
  vfs_.limit_space(0);
  *release = true;
  std::this_thread::sleep_for(std::chrono::milliseconds(250));
  EXPECT_EQ(bench.get(name).state(), v1::Simulation::RUNNING);
  EXPECT_THROW(bench.create(server::curve_simulation()), std::runtime_error);
  vfs_.recover();
  EXPECT_TRUE(bench.reaches(name, v1::Simulation::SUCCEEDED)) << "without a restart";
  EXPECT_TRUE(bench.reaches(bench.create(server::curve_simulation()), v1::Simulation::SUCCEEDED));
}

TEST_F(StorageFault, ACampaignSaysThatTheDiskIsFullAndContinuesWhenThereIsRoom) {
  server::Bench bench(server::quick_studies(), 2);
  server::Application app = bench.application();
  v1::CreateCampaignRequest request;
  *request.mutable_campaign() = server::campaign_of(3 * server::kThousand);
  const auto created = server::create_campaign(app, request);
  ASSERT_TRUE(created.ok());
  vfs_.limit_space(0);
  v1::GetCampaignRequest get;
  get.set_name(created.message().name());
  const auto now = [&] { return server::get_campaign(app, get).message(); };
  ASSERT_TRUE(server::eventually([&] { return now().has_stalled(); }));
  EXPECT_EQ(now().state(), v1::Campaign::RUNNING);
  EXPECT_EQ(now().stalled().reason(), "STORE_FAILED");
  v1::WatchCampaignRequest watch;
  watch.set_name(get.name());
  const auto source = server::watch_campaign(app, watch, {});
  v1::CampaignEvent event;
  ASSERT_EQ(source.message()->next(event), server::AnyMessageSource::Step::kMessage);
  EXPECT_EQ(event.stalled().reason(), "STORE_FAILED");
  vfs_.recover();
  EXPECT_TRUE(server::eventually([&] { return now().state() == v1::Campaign::SUCCEEDED; }));
  EXPECT_FALSE(now().has_stalled());
}

/// A disk on which each commit takes longer than the deadline of the call.
class SlowCommits : public StorageFault {
 protected:
  /// Makes a call whose deadline passes during the commit of its change. Returns the answer.
  template <class Body>
  auto answer(const Body& body) {
    const auto end = server::CallLimits::Clock::now() + std::chrono::milliseconds(300);
    vfs_.after_sync([end] { std::this_thread::sleep_until(end); });
    const server::CallContext call{.limits = {.deadline = end}};
    auto outcome = body(call);
    EXPECT_TRUE(call.limits.are_over()) << "the commit was not slow";
    vfs_.recover();
    return outcome;
  }
  static v1::GetSimulationRequest named(const std::string& name) {
    v1::GetSimulationRequest out;
    out.set_name(name);
    return out;
  }

  server::Bench bench_{server::patient_studies(std::make_shared<std::atomic<bool>>(false)), 1};
  server::Application app_ = bench_.application();
};

TEST_F(SlowCommits, ACreationThatIsCommittedIsAnsweredAfterTheDeadline) {
  v1::CreateSimulationRequest request;
  *request.mutable_simulation() = server::point_simulation();
  const auto created = answer(
      [&](const server::CallContext& call) { return create_simulation(app_, request, call); });
  ASSERT_TRUE(created.ok()) << created.error().message();
  EXPECT_EQ(created.message().state(), v1::Simulation::QUEUED);
  EXPECT_EQ(created.message().event_sequence(), 1);
  EXPECT_EQ(created.message().create_time().DebugString(),
            bench_.get(created.message().name()).create_time().DebugString());
}

TEST_F(SlowCommits, ACancellationThatIsCommittedIsAnsweredAfterTheDeadline) {
  const std::string name = bench_.create(server::point_simulation());
  ASSERT_TRUE(bench_.reaches(name, v1::Simulation::RUNNING));
  v1::CancelSimulationRequest request;
  request.set_name(name);
  const auto cancelled = answer(
      [&](const server::CallContext& call) { return cancel_simulation(app_, request, call); });
  ASSERT_TRUE(cancelled.ok()) << cancelled.error().message();
  EXPECT_EQ(cancelled.message().state(), v1::Simulation::CANCELLED);
  EXPECT_EQ(cancelled.message().DebugString(), bench_.get(name).DebugString());
}

TEST_F(SlowCommits, APinThatIsCommittedIsAnsweredAfterTheDeadline) {
  const std::string name = bench_.create(server::point_simulation());
  ASSERT_TRUE(bench_.reaches(name, v1::Simulation::RUNNING));
  v1::PinSimulationRequest request;
  request.set_name(name);
  const auto pinned =
      answer([&](const server::CallContext& call) { return pin_simulation(app_, request, call); });
  ASSERT_TRUE(pinned.ok()) << pinned.error().message();
  EXPECT_TRUE(pinned.message().pinned());
  EXPECT_TRUE(bench_.get(name).pinned());
}

}  // namespace
}  // namespace tribodyn::crash
