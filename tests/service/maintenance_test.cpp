// Old files, damaged files, backups and what restores them.
#include "server/store/maintenance.h"

#include <SQLiteCpp/Statement.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "server/app/stored_inputs.h"
#include "server/store/schema.h"
#include "server/store/seeds.h"
#include "tests/service/support.h"
#include "tests/support/paths.h"

namespace tribodyn::server {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

class MaintenanceTest : public testing::Test {
 protected:
  std::string path() const { return folder_.file("tribodyn.db"); }
  void make() const {
    Store store(path());
    store.add_resources(seed_resources(), 1);
    const ResultKey key{std::string(64, 'a'), "model", "platform"};
    const auto id = store
                        .add_simulation({.request = point_simulation().SerializeAsString(),
                                         .key = key,
                                         .lubricant_revision = "lubricants/1@1"},
                                        5)
                        .id;
    store.mark_running(id, 6, key);
    v1::SimulationResult result;
    result.set_input_hash(std::string(64, 'a'));
    store.mark_succeeded(id, 7, {key, result.SerializeAsString(), {{"a", {1, 2}}}});
  }
  void damage(const std::string& sql) const {
    SQLite::Database raw(path(), SQLite::OPEN_READWRITE);
    raw.exec("DROP TRIGGER revisions_never_change; DROP TRIGGER revisions_stay;");
    raw.exec(sql);
  }
  TemporaryFolder folder_;
};

/// One stored file of every schema before the present one.
class OldSchema : public testing::TestWithParam<int> {};

TEST_P(OldSchema, IsMigratedAndLosesNothing) {
  const TemporaryFolder folder;
  const std::string file = folder.file("old.db");
  std::filesystem::copy_file(
      test_data_file("schemas/schema_" + std::to_string(GetParam()) + ".sqlite"), file);
  std::filesystem::permissions(file, std::filesystem::perms::owner_all);
  EXPECT_THAT(check_database(file), IsEmpty());
  Store store(file);
  EXPECT_THAT(check_database(file), IsEmpty());
  for (const NewResource& seed : seed_resources()) {
    const auto stored = store.resource(seed.name);
    ASSERT_TRUE(stored) << seed.name;
    EXPECT_EQ(stored->revision, 1);
    EXPECT_EQ(stored->body, seed.body) << seed.name;
  }
  EXPECT_EQ(store.simulations({.limit = 100, .byte_limit = 1 << 30}).rows.size(), 7U);
  EXPECT_EQ(store.simulation(1)->lubricant_revision, "lubricants/2@1");
  EXPECT_EQ(store.simulation(1)->gear_set_revision, "gearSets/B@1");
  EXPECT_EQ(store.simulation(2)->gear_set_revision, "gearSets/A@1")
      << "what the request left out meant the default";
  v1::SimulationResult result;
  ASSERT_TRUE(result.ParseFromString(*store.result(1)));
  EXPECT_EQ(result.input_hash(), store.simulation(1)->input_hash);
  EXPECT_EQ(store.history_shape(2).rows, 8);
  EXPECT_GT(result.assumptions_size(), 40) << "kept apart since schema 3";
  for (std::int64_t id = 1; id <= 7; ++id) {
    EXPECT_EQ(store.next_event(id, 0)->state, StoredState::kQueued);
    EXPECT_EQ(store.next_event(id, store.simulation(id)->sequence - 1)->state,
              store.simulation(id)->state);
  }
  EXPECT_THAT(store.requeue_unfinished(9), SizeIs(2));
  EXPECT_THAT(check_database(file, hash_stored_inputs), IsEmpty());
  SQLite::Database raw(file, SQLite::OPEN_READONLY);
  EXPECT_EQ(raw.execAndGet("PRAGMA user_version").getInt(), kSchemaVersion);
}

INSTANTIATE_TEST_SUITE_P(Schemas, OldSchema, testing::Range(1, kSchemaVersion));

TEST_F(MaintenanceTest, EveryTableIsStrict) {
  make();
  SQLite::Database raw(path(), SQLite::OPEN_READONLY);
  SQLite::Statement query(
      raw,
      "SELECT name FROM pragma_table_list WHERE schema = 'main' AND type = 'table' "
      "AND NOT strict AND name NOT LIKE 'sqlite%'");
  while (query.executeStep()) ADD_FAILURE() << query.getColumn(0).getString();
}

TEST_F(MaintenanceTest, ABackupOfARunningServerIsWholeAndComesBack) {
  make();
  {
    Store running(path());
    v1::Lubricant lubricant = seed<v1::Lubricant>("lubricants/1");
    lubricant.set_name("lubricants/new");
    running.add_resources({{lubricant.name(), lubricant.SerializeAsString()}}, 9);
    backup_database(path(), folder_.file("copy"));
    EXPECT_THROW(restore_database(folder_.file("copy"), path()), StoreError) << "it runs";
    EXPECT_THROW(backup_database(path(), folder_.file("copy")), StoreError) << "it exists";
  }
  damage("DELETE FROM properties");
  restore_database(folder_.file("copy"), path());
  EXPECT_TRUE(std::filesystem::exists(path() + ".replaced"));
  Store store(path());
  EXPECT_TRUE(store.resource("lubricants/new"));
  EXPECT_EQ(store.history_rows(1, "a", 0, 2), (std::vector<double>{1, 2}));
}

TEST_F(MaintenanceTest, ADamagedDatabaseIsNotBackedUpAsIfItWereWhole) {
  make();
  damage("UPDATE revisions SET body = x'00' WHERE id = 1");
  const std::string copy = folder_.file("copy.db");
  EXPECT_THROW(backup_database(path(), copy), StoreError);
  EXPECT_FALSE(std::filesystem::exists(copy));
  EXPECT_FALSE(std::filesystem::exists(copy + ".new"));
}

TEST_F(MaintenanceTest, ADamagedBackupIsNotRestored) {
  make();
  const auto bytes = std::filesystem::file_size(path());
  std::filesystem::copy_file(path(), folder_.file("copy"));
  {
    std::fstream file(folder_.file("copy"), std::ios::in | std::ios::out | std::ios::binary);
    for (std::uintmax_t at = 4096; at + 4096 < bytes; at += 4096) {
      file.seekp(static_cast<std::streamoff>(at + 8));
      file << std::string(64, '\xff');
    }
  }
  EXPECT_THROW(restore_database(folder_.file("copy"), path()), StoreError);
  std::ofstream(folder_.file("text")) << std::string(10000, 'x');
  EXPECT_THROW(restore_database(folder_.file("text"), path()), StoreError);
  EXPECT_THROW(restore_database(folder_.file("nothing"), path()), StoreError);
  EXPECT_THROW(restore_database(path(), path()), StoreError);
  EXPECT_FALSE(std::filesystem::exists(path() + ".replaced"));
  EXPECT_THAT(check_database(path()), IsEmpty());
}

TEST(Inputs, OfAStoredSimulationStillHaveTheirHash) {
  Bench bench;
  ASSERT_TRUE(bench.reaches(bench.create(point_simulation()), v1::Simulation::SUCCEEDED));
  bench.jobs().stop();
  EXPECT_THAT(check_database(bench.database(), hash_stored_inputs), IsEmpty());
  SQLite::Database raw(bench.database(), SQLite::OPEN_READWRITE);
  raw.exec(
      "UPDATE simulations SET lubricant = "
      "(SELECT revision_id FROM revision_names WHERE name = 'lubricants/3')");
  EXPECT_THAT(check_database(bench.database(), hash_stored_inputs),
              Contains(HasSubstr("its inputs have another hash")));
}

TEST_F(MaintenanceTest, CheckFindsWhatIsWrong) {
  const std::pair<const char*, const char*> cases[] = {
      {"UPDATE revisions SET body = x'00' WHERE id = 1", "not what was written"},
      {"UPDATE revisions SET revision = 7 WHERE id = 1", "gaps"},
      {"DELETE FROM properties WHERE key = 'lims_id'", "found by"},
      {"UPDATE properties SET value = 7.5 WHERE key = 'mass_kilograms'", "found by"},
      {"PRAGMA foreign_keys = OFF; UPDATE simulations SET lubricant = 999", "points at"},
      {"PRAGMA foreign_keys = OFF; DELETE FROM results", "points at"},
      {"DELETE FROM events WHERE sequence = 2", "gaps"},
      {"DELETE FROM events WHERE sequence = 3", "gaps"},
      {"DROP TRIGGER events_never_change; UPDATE events SET state = 2 WHERE sequence = 3",
       "another state"},
      {"DROP TRIGGER events_never_change; UPDATE events SET state = 4 WHERE sequence = 1",
       "backwards"},
      {"DROP INDEX one_result_per_input; INSERT INTO results "
       "SELECT 9, input_hash, model_version, platform, 1, body FROM results",
       "more than one result"},
      {"UPDATE simulations SET input_hash = printf('%064d', 0)", "of other inputs"},
      {"UPDATE history_blocks SET data = x'0000'", "history"},
      {"DELETE FROM history_blocks", "history"},
      {"UPDATE history_columns SET rows = 3", "history"},
  };
  for (const auto& [sql, problem] : cases) {
    for (const char* suffix : {"", "-wal", "-shm"}) std::filesystem::remove(path() + suffix);
    make();
    ASSERT_THAT(check_database(path()), IsEmpty());
    damage(sql);
    EXPECT_THAT(check_database(path()), Contains(HasSubstr(problem))) << sql;
  }
}

}  // namespace
}  // namespace tribodyn::server
