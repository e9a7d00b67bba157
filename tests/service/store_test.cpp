#include "server/storage/store.h"

#include <SQLiteCpp/Statement.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <stdexcept>

#include "server/storage/schema.h"
#include "server/storage/seeds.h"
#include "tests/service/support.h"

namespace tribodyn::server {
namespace {

const std::string kHash(64, 'a');
const ResultKey kKey{kHash, "model", "platform"};

class StoreTest : public testing::Test {
 protected:
  std::string path() const { return folder_.file("tribodyn.db"); }
  StoreError::Kind kind_of_opening(const std::string& file) const {
    try {
      const Store store(file);
    } catch (const StoreError& error) {
      message_ = error.what();
      return error.kind();
    }
    ADD_FAILURE() << "opened";
    return StoreError::Kind::kFailed;
  }

  TemporaryFolder folder_;
  mutable std::string message_;
};

TEST_F(StoreTest, SeedsAreAddedOnceAndNeverOverwritten) {
  Store store(path());
  store.add_project("default", {{"lubricants/paper-fluid-1", "first"}}, 1);
  store.add_project("default",
                    {{"lubricants/paper-fluid-1", "second"}, {"lubricants/paper-fluid-2", "other"}},
                    2);
  EXPECT_EQ(store.resource("lubricants/paper-fluid-1")->body, "first");
  EXPECT_EQ(store.resource("lubricants/paper-fluid-2")->body, "other");
  EXPECT_EQ(store.resource("lubricants/paper-fluid-3"), std::nullopt);
}

ResourceQuery all_of_b(int limit, std::size_t byte_limit, const std::string& after = "") {
  ResourceQuery query;
  query.collection = "b";
  query.limit = limit;
  query.byte_limit = byte_limit;
  if (!after.empty()) query.after = PageStart{{}, after};
  return query;
}

TEST_F(StoreTest, ResourcesArePagedByNumberAndBytesWithinTheirCollection) {
  Store store(path());
  store.add_project(
      "default",
      {{"a/1", "x"}, {"b/1", "x"}, {"b/2", std::string(100, 'x')}, {"b/3", "x"}, {"c/1", "x"}}, 1);
  auto page = store.resources(all_of_b(2, 1000));
  ASSERT_EQ(page.rows.size(), 2U);
  EXPECT_EQ(page.rows.front().name, "b/1");
  EXPECT_TRUE(page.more);
  page = store.resources(all_of_b(2, 1000, "b/2"));
  ASSERT_EQ(page.rows.size(), 1U);
  EXPECT_FALSE(page.more);
  page = store.resources(all_of_b(10, 50));
  EXPECT_EQ(page.rows.size(), 1U);
  EXPECT_TRUE(page.more);
  page = store.resources(all_of_b(10, 50, "b/1"));
  EXPECT_EQ(page.rows.size(), 1U) << "one row always comes, however large";
  EXPECT_EQ(store.resource_names("default", "b").size(), 3U);
}

TEST_F(StoreTest, AnUpdateAddsARevisionAndKeepsTheOthers) {
  Store store(path());
  ASSERT_TRUE(store.write_resources({{{"lubricants/x", "first"}, {}}}, 1));
  EXPECT_FALSE(store.write_resources({{{"lubricants/x", "again"}, {}}}, 2));
  const StoredResource first = *store.resource("lubricants/x");
  EXPECT_TRUE(store.write_resources({{{"lubricants/x", "second"}, first}}, 3));
  EXPECT_FALSE(store.write_resources({{{"lubricants/x", "third"}, first}}, 4))
      << "somebody else was faster";
  EXPECT_FALSE(store.delete_resource(first, 4));
  const StoredResource second = *store.resource("lubricants/x");
  EXPECT_EQ(second.revision, 2);
  EXPECT_EQ(second.body, "second");
  EXPECT_EQ(second.create_time, 1);
  EXPECT_EQ(second.revision_create_time, 3);
  EXPECT_EQ(store.revision("lubricants/x", 1)->body, "first");
  EXPECT_FALSE(store.revision("lubricants/x", 1)->is_present);
  EXPECT_EQ(store.revision("lubricants/x", 3), std::nullopt);
  EXPECT_EQ(store.revisions("lubricants/x", 0, 10, 1000).rows.size(), 2U);
  EXPECT_EQ(store.revisions("lubricants/x", 2, 10, 1000).rows.front().body, "first");
}

TEST_F(StoreTest, AWriteDoesNotReachTheResourceThatGotTheIdOfAPurgedOne) {
  Store store(path());
  ASSERT_TRUE(store.write_resources({{{"lubricants/purged", "first"}, {}}}, 1));
  const StoredResource purged = *store.resource("lubricants/purged");
  ASSERT_TRUE(store.purge_resource(purged, true).is_current);
  for (const char* name : {"lubricants/other", "lubricants/purged"}) {
    ASSERT_TRUE(store.write_resources({{{name, "second"}, {}}}, 2));
    const StoredResource next = *store.resource(name);
    ASSERT_EQ(next.id, purged.id) << "this test is of use only then";
    EXPECT_FALSE(store.write_resources({{{purged.name, "third"}, purged}}, 3));
    EXPECT_FALSE(store.delete_resource(purged, 3));
    EXPECT_FALSE(store.purge_resource(purged, true).is_current);
    EXPECT_EQ(store.resource(name)->body, "second");
    ASSERT_TRUE(store.purge_resource(next, true).is_current);
  }
}

TEST_F(StoreTest, RevisionTimesDoNotGoBackWhenTheClockDoes) {
  Store store(path());
  ASSERT_TRUE(store.write_resources({{{"lubricants/x", "first"}, {}}}, 100));
  const auto written =
      store.write_resources({{{"lubricants/x", "second"}, store.resource("lubricants/x")}}, 40);
  ASSERT_TRUE(written);
  EXPECT_EQ(written->front().revision_create_time, 100);
  EXPECT_EQ(store.resource("lubricants/x")->revision_create_time, 100);
}

TEST_F(StoreTest, ADeletedResourceIsNotListedAndIsUndeletedUnchanged) {
  Store store(path());
  store.add_project("default", {{"b/1", "body"}}, 1);
  ASSERT_TRUE(store.delete_resource(*store.resource("b/1"), 5));
  EXPECT_EQ(store.resource("b/1")->delete_time, 5);
  EXPECT_TRUE(store.resources(all_of_b(10, 1000)).rows.empty());
  EXPECT_TRUE(store.resource_names("default", "b").empty());
  ResourceQuery with_deleted = all_of_b(10, 1000);
  with_deleted.show_deleted = true;
  EXPECT_EQ(store.resources(with_deleted).rows.size(), 1U);
  ASSERT_TRUE(store.undelete_resource(*store.resource("b/1")));
  EXPECT_EQ(store.resources(all_of_b(10, 1000)).rows.size(), 1U);
}

TEST_F(StoreTest, ASimulationGoesThroughItsStatesAndKeepsItsResult) {
  Store store(path());
  const auto id =
      store.add_simulation({.request = std::string("re\0quest", 8), .key = kKey}, 10).id;
  EXPECT_EQ(store.simulation(id)->state, StoredState::kQueued);
  EXPECT_TRUE(store.mark_running(id, 20, kKey));
  EXPECT_FALSE(store.mark_running(id, 20, kKey)) << "only one worker gets it";
  EXPECT_TRUE(store.mark_succeeded(id, 30, {kKey, "result", {{"a", {1, 2, 3}}, {"b", {4, 5, 6}}}}));
  const auto stored = store.simulation(id);
  EXPECT_EQ(stored->state, StoredState::kSucceeded);
  EXPECT_EQ(stored->create_time, 10);
  EXPECT_EQ(stored->start_time, 20);
  EXPECT_EQ(stored->end_time, 30);
  EXPECT_EQ(stored->request, std::string("re\0quest", 8));
  EXPECT_EQ(store.result(id), "result");
  EXPECT_EQ(store.history_shape(id).names, (std::vector<std::string>{"a", "b"}));
  EXPECT_EQ(store.history_shape(id).rows, 3);
  EXPECT_EQ(history_rows(store, id, "b", 1, 2), (std::vector<double>{5, 6}));
  EXPECT_FALSE(store.mark_cancelled(id, 40)) << "an end is final";
  EXPECT_FALSE(store.mark_failed(id, 40, "X", "y"));
}

TEST_F(StoreTest, ACancelledSimulationTakesNoResult) {
  Store store(path());
  const auto id = store.add_simulation({.request = "request", .key = kKey}, 1).id;
  store.mark_running(id, 2, kKey);
  EXPECT_TRUE(store.mark_cancelled(id, 3));
  EXPECT_FALSE(store.mark_succeeded(id, 4, {kKey, "result", {{"a", {1}}}}));
  EXPECT_EQ(store.result(id), std::nullopt);
  EXPECT_TRUE(store.history_shape(id).names.empty());
}

TEST_F(StoreTest, TheBytesThatCanBeRemovedAreThoseThatRemovalFrees) {
  Store store(path());
  const auto finish = [&](char input) {
    const ResultKey key{std::string(64, input), "model", "platform"};
    const auto id = store.add_simulation({.request = "", .key = key}, 1).id;
    store.mark_running(id, 2, key);
    store.mark_succeeded(id, 3, {key, std::string(500, input), {{"a", {1, 2, 3}}}});
    return id;
  };
  finish('a');
  const std::int64_t pinned = finish('b');
  finish('b');  // shares the result of the pinned one
  ASSERT_TRUE(store.set_pinned(pinned, true));
  const std::int64_t removable = store.removable_bytes();
  EXPECT_GT(removable, 500);
  const Removed removed = store.remove_oldest(3, 10);
  EXPECT_EQ(removed.simulations, 2);
  EXPECT_EQ(removed.bytes, removable);
  EXPECT_EQ(store.removable_bytes(), 0);
  ASSERT_TRUE(store.set_pinned(pinned, false));
  const std::int64_t unpinned = store.removable_bytes();
  EXPECT_EQ(store.remove_oldest(3, 10).bytes, unpinned);
}

TEST_F(StoreTest, AfterACrashInterruptedSimulationsAreQueuedAndResultsKept) {
  std::int64_t queued = 0, running = 0, done = 0;
  {
    Store store(path());
    queued = store.add_simulation({.request = "q", .key = kKey}, 1).id;
    running = store.add_simulation({.request = "r", .key = kKey}, 2).id;
    done = store.add_simulation({.request = "d", .key = kKey}, 3).id;
    store.mark_running(running, 4, kKey);
    store.mark_running(done, 4, kKey);
    store.mark_succeeded(done, 5, {kKey, "result", {}});
  }
  Store store(path());
  const std::vector<UnfinishedSimulation> waiting = store.requeue_unfinished(6);
  ASSERT_EQ(waiting.size(), 2U);
  EXPECT_EQ(waiting[0].id, queued);
  EXPECT_EQ(waiting[1].id, running);
  EXPECT_EQ(store.simulation(queued)->attempt, 1);
  EXPECT_EQ(store.simulation(running)->attempt, 2);
  EXPECT_EQ(store.next_event(running, 2)->reason, "SERVER_LOST");
  EXPECT_EQ(store.simulation(running)->state, StoredState::kQueued);
  EXPECT_EQ(store.simulation(running)->start_time, std::nullopt);
  EXPECT_EQ(store.result(done), "result");
}

TEST_F(StoreTest, IdsAreNeverUsedAgainAndListsAreNewestFirst) {
  Store store(path());
  for (int i = 0; i < 5; ++i) store.add_simulation({.request = "r", .key = kKey}, i);
  const auto page = store.simulations({.limit = 2, .byte_limit = 1000});
  ASSERT_EQ(page.rows.size(), 2U);
  EXPECT_TRUE(page.more);
  EXPECT_EQ(page.rows[0].id, 5);
  EXPECT_EQ(store.simulations({.after = {{3, 4}}, .limit = 10, .byte_limit = 1000}).rows.size(),
            3U);
  EXPECT_FALSE(store.simulations({.after = {{3, 4}}, .limit = 10, .byte_limit = 1000}).more);
}

TEST_F(StoreTest, TheSchemaRefusesInvalidRows) {
  Store store(path());
  EXPECT_THROW(
      store.add_simulation({.request = "r", .key = {"short hash", "model", "platform"}}, 1),
      StoreError);
  SQLite::Database raw(path(), SQLite::OPEN_READWRITE);
  raw.exec("PRAGMA foreign_keys = ON");
  const auto id = store.add_simulation({.request = "r", .key = kKey}, 1).id;
  EXPECT_THROW(raw.exec("INSERT INTO history VALUES (1, 77, 0, 'a', x'00')"), SQLite::Exception);
  store.add_project("default", {{"a/1", "body"}}, 1);
  for (const char* invalid :
       {"INSERT INTO revisions VALUES (9, 1, 2, 1, printf('%064d', 0), 'text is no blob')",
        "INSERT INTO revisions VALUES (9, 1, 3, 1, printf('%064d', 0), x'00')",
        "INSERT INTO revisions VALUES (9, 7, 1, 1, printf('%064d', 0), x'00')",
        "UPDATE revisions SET body = x'00'", "DELETE FROM revisions",
        "UPDATE resources SET present = 77", "UPDATE resources SET name = 'c/1'",
        "UPDATE simulations SET lubricant = 77 WHERE id = 1",
        "UPDATE simulations SET state = 2 WHERE id = 1",
        "UPDATE simulations SET state = 3, sequence = 2, end_time = 1 WHERE id = 1",
        "UPDATE events SET time = 7",
        "INSERT INTO events (project, number, simulation, sequence, time, state, attempt, reason) "
        "VALUES ('default', 9, 1, 3, 1, 2, 1, '')",
        "INSERT INTO events (project, number, simulation, sequence, time, state, attempt, reason) "
        "VALUES ('default', 9, 77, 1, 1, 1, 1, '')",
        "INSERT INTO events (project, number, simulation, sequence, time, state, attempt, reason) "
        "VALUES ('default', 9, 1, 2, 1, 0, 1, '')",
        "INSERT INTO events (project, number, simulation, sequence, time, state, attempt, reason) "
        "VALUES ('acme', 9, 1, 2, 1, 2, 1, '')"}) {
    EXPECT_THROW(raw.exec(invalid), SQLite::Exception) << invalid;
  }
  EXPECT_THROW(raw.exec("UPDATE simulations SET state = 9 WHERE id = " + std::to_string(id)),
               SQLite::Exception);
  EXPECT_THROW(raw.exec("UPDATE simulations SET state = 4 WHERE id = " + std::to_string(id)),
               SQLite::Exception)
      << "no failure without a reason";
}

TEST_F(StoreTest, CommitsAreDurable) {
  Store store(path());
  SQLite::Database raw(path(), SQLite::OPEN_READONLY);
  EXPECT_EQ(raw.execAndGet("PRAGMA journal_mode").getString(), "wal");
  EXPECT_EQ(raw.execAndGet("PRAGMA user_version").getInt(),
            static_cast<int>(schema_steps().size()));
}

TEST_F(StoreTest, RefusesADatabaseInUse) {
  const Store store(path());
  EXPECT_EQ(kind_of_opening(path()), StoreError::Kind::kInUse);
  EXPECT_NE(message_.find("another tribodynd"), std::string::npos) << message_;
  std::filesystem::create_directory(folder_.path() / "sub");
  EXPECT_EQ(kind_of_opening(folder_.file("sub/../tribodyn.db")), StoreError::Kind::kInUse);
}

TEST_F(StoreTest, RefusesTheDatabaseOfAnotherProgram) {
  {
    SQLite::Database raw(path(), SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
    raw.exec("CREATE TABLE contacts (name TEXT)");
  }
  EXPECT_EQ(kind_of_opening(path()), StoreError::Kind::kForeign);
}

TEST_F(StoreTest, RefusesAFileThatIsNotADatabase) {
  std::ofstream(path()) << std::string(8192, 'x');
  EXPECT_EQ(kind_of_opening(path()), StoreError::Kind::kCorrupt);
  EXPECT_NE(message_.find(path()), std::string::npos) << message_;
}

TEST_F(StoreTest, RefusesAMissingFolder) {
  EXPECT_EQ(kind_of_opening(folder_.file("no/such/folder.db")), StoreError::Kind::kCannotOpen);
}

TEST_F(StoreTest, RefusesToReplaceALostDatabaseByAnEmptyOne) {
  for (const char* suffix : {".replaced", ".replaced.2", ".new-Ab3xYz", "-wal"}) {
    const TemporaryFolder folder;
    std::ofstream(folder.file(std::string("db") + suffix)) << "something";
    EXPECT_EQ(kind_of_opening(folder.file("db")), StoreError::Kind::kCannotOpen) << suffix;
    EXPECT_NE(message_.find("there is no database"), std::string::npos) << message_;
    EXPECT_NE(message_.find(folder.file(std::string("db") + suffix)), std::string::npos)
        << message_;
    EXPECT_FALSE(std::filesystem::exists(folder.file("db"))) << suffix;
    std::ofstream(folder.file("db")).flush();
    EXPECT_EQ(kind_of_opening(folder.file("db")), StoreError::Kind::kCannotOpen)
        << "an empty file is none either";
    std::filesystem::remove(folder.file(std::string("db") + suffix));
    std::ofstream(folder.file("database.replaced")) << "of another database";
    EXPECT_NO_THROW(Store(folder.file("db")));
  }
}

/// While the object exists, this process has the rights of a user other than root, who may write
/// everything. The files of the folder are given to that user.
class WithoutRoot {
 public:
  explicit WithoutRoot(const TemporaryFolder& folder) {
    if (geteuid() != 0) return;
    EXPECT_EQ(chown(folder.path().c_str(), kNobody, kNobody), 0);
    for (const auto& entry : std::filesystem::directory_iterator(folder.path())) {
      EXPECT_EQ(chown(entry.path().c_str(), kNobody, kNobody), 0);
    }
    EXPECT_EQ(seteuid(kNobody), 0);
  }
  ~WithoutRoot() {
    if (getuid() == 0) {
      EXPECT_EQ(seteuid(0), 0);
    }
  }
  WithoutRoot(const WithoutRoot&) = delete;
  WithoutRoot& operator=(const WithoutRoot&) = delete;

 private:
  static constexpr uid_t kNobody = 65534;
};

TEST_F(StoreTest, RefusesAReadOnlyFile) {
  // a folder that every user may enter
  const TemporaryFolder folder(TemporaryFolder::Kind::kMemory);
  const std::string file = folder.file("tribodyn.db");
  { const Store store(file); }
  std::filesystem::permissions(file, std::filesystem::perms::owner_read);
  const WithoutRoot without_root(folder);
  EXPECT_EQ(kind_of_opening(file), StoreError::Kind::kReadOnly);
}

TEST_F(StoreTest, EverySeedParsesAndHasItsOwnName) {
  std::set<std::string> names;
  for (const NewResource& seed : seed_resources()) names.insert(seed.name);
  EXPECT_EQ(names, (std::set<std::string>{
                       "lubricants/paper-fluid-1", "lubricants/paper-fluid-2",
                       "lubricants/paper-fluid-3", "lubricants/shell-t9", "gearSets/reference-axle",
                       "gearSets/reference-axle-loaded-error", "gearSets/reference-axle-conformal",
                       "surfaces/run-in", "vehicles/passenger-car"}));
}

TEST(SimulationQueries, EveryPropertyOfSimulationsFiltersAList) {
  const TemporaryFolder folder;
  Store store(folder.file("db"));
  for (const PropertyField& field : property_fields("simulations")) {
    const PropertyValue value = field.kind == PropertyKind::kText ? PropertyValue(std::string("x"))
                                                                  : PropertyValue(std::int64_t{1});
    const SimulationQuery query{
        .restrictions = {{field.key, Restriction::Comparison::kNotEqual, value}},
        .limit = 1,
        .byte_limit = 1000};
    EXPECT_NO_THROW(store.simulations(query)) << "no column " << field.key;
  }
}

TEST(SimulationQueries, NoKeyOfAFilterEntersAStatement) {
  const TemporaryFolder folder;
  Store store(folder.file("db"));
  SimulationQuery query{.limit = 1, .byte_limit = 1000};
  query.restrictions = {{"state", Restriction::Comparison::kEqual, std::int64_t{1}}};
  EXPECT_NO_THROW(store.simulations(query));
  query.restrictions.front().key = "1 OR state";
  EXPECT_THROW(store.simulations(query), std::logic_error);
}

}  // namespace
}  // namespace tribodyn::server
