// Tests of files of other versions, damaged files, backup and restore.
#include "server/storage/maintenance.h"

#include <SQLiteCpp/Statement.h>
#include <gmock/gmock.h>
#include <google/protobuf/descriptor.pb.h>
#include <google/protobuf/text_format.h>
#include <gtest/gtest.h>

#include <atomic>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <optional>
#include <random>
#include <thread>

#include "server/application/stored_inputs.h"
#include "server/storage/seeds.h"
#include "server/storage/token_table.h"
#include "server/storage/wire_layout.h"
#include "tests/service/support.h"
#include "tests/support/run_length.h"

namespace tribodyn::server {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;

class MaintenanceTest : public testing::Test {
 protected:
  std::string path() const { return folder_.file("tribodyn.db"); }
  void make() const {
    Store store(path());
    store.add_project("default", seed_resources(), 1);
    const ResultKey key{std::string(64, 'a'), "model", "platform"};
    const auto id = store
                        .add_simulation({.request = point_simulation().SerializeAsString(),
                                         .key = key,
                                         .ledger = "assumptions",
                                         .revisions = {.lubricant = "lubricants/paper-fluid-1@1"}},
                                        5)
                        .id;
    store.mark_running(id, 6, key);
    v1::SimulationResult result;
    result.set_input_hash(std::string(64, 'a'));
    store.mark_succeeded(id, 7, {key, result.SerializeAsString(), {{"a", {1, 2}}}});
  }
  /// Changes the database without its triggers and creates them again.
  void damage(const std::string& sql) const {
    SQLite::Database raw(path(), SQLite::OPEN_READWRITE);
    std::vector<std::string> triggers;
    SQLite::Statement query(raw, "SELECT name, sql FROM sqlite_master WHERE type = 'trigger'");
    std::string drop;
    while (query.executeStep()) {
      drop += "DROP TRIGGER " + query.getColumn(0).getString() + ";";
      triggers.push_back(query.getColumn(1).getString());
    }
    query.reset();
    raw.exec(drop);
    raw.exec(sql);
    for (const std::string& trigger : triggers) raw.exec(trigger);
  }
  TemporaryFolder folder_;
};

TEST_F(MaintenanceTest, AMigrationLosesNothingAndKeepsABackup) {
  make();
  const std::string backup = path() + ".schema-1";
  EXPECT_THROW(TokenTable(path(), two_schemas()), StoreError) << "a server may still use schema 1";
  EXPECT_THAT(check_database(path(), nullptr, two_schemas()), IsEmpty());
  EXPECT_EQ(Store(path(), two_schemas()).migration_backup(), backup);
  EXPECT_EQ(Store(path(), two_schemas()).migration_backup(), std::nullopt) << "migrated already";
  EXPECT_THAT(check_database(path(), nullptr, two_schemas()), IsEmpty());
  EXPECT_THAT(check_database(backup), IsEmpty());
  EXPECT_NO_THROW(TokenTable(path(), two_schemas()));
  EXPECT_THROW(Store{path()}, StoreError) << "of a newer version";
  SQLite::Database raw(path(), SQLite::OPEN_READWRITE);
  EXPECT_EQ(raw.execAndGet("PRAGMA user_version").getInt(), 2);
  EXPECT_GT(raw.execAndGet("SELECT count(*) FROM body_lengths").getInt(), 0);
  raw.exec("ATTACH '" + backup + "' AS backup");
  SQLite::Statement tables(
      raw, "SELECT name FROM backup.sqlite_master WHERE type = 'table' AND name <> 'format'");
  while (tables.executeStep()) {
    const std::string table = tables.getColumn(0).getString();
    EXPECT_EQ(raw.execAndGet("SELECT count(*) FROM (SELECT * FROM backup." + table +
                             " EXCEPT SELECT * FROM main." + table + ")")
                  .getInt(),
              0)
        << table;
  }
}

TEST_F(MaintenanceTest, ABackupThatCannotBeWrittenIsCheckedAndRestored) {
  make();
  const std::string folder = folder_.file("medium"), copy = folder + "/copy";
  std::filesystem::create_directory(folder);
  backup_database(path(), copy);
  // Root may write to a folder and a file whatever their permissions: the log mode shows in bytes
  // 18 and 19 of the header (1: no write-ahead log).
  std::ifstream file(copy, std::ios::binary);
  std::string header(20, '\0');
  file.read(header.data(), 20);
  EXPECT_EQ(header[18], 1);
  EXPECT_EQ(header[19], 1);
  std::filesystem::permissions(folder, std::filesystem::perms(0500));
  EXPECT_THAT(check_database(copy), IsEmpty());
  restore_database(copy, folder_.file("restored"));
  std::filesystem::permissions(folder, std::filesystem::perms(0700));
  EXPECT_THAT(check_database(folder_.file("restored")), IsEmpty());
}

TEST_F(MaintenanceTest, AFlippedBitChangesNothingUnseenOfResourcesRequestsCandidatesAndResults) {
  make();
  std::int64_t campaign = 0;
  {
    Store store(path());
    NewCampaign added;
    added.request = std::string(2000, 'r');
    added.candidate_table = std::string(40'000, 't');
    added.request_hash = added.input_hash = std::string(64, 'h');
    added.candidates = 5;
    added.revisions = {"lubricants/paper-fluid-1@1", "", "", ""};
    campaign = store.add_campaign(added, 5).stored.id;
  }
  using Read = std::function<std::string(Store&)>;
  std::vector<Read> reads = {[](Store& store) { return store.simulation(1)->request; },
                             [](Store& store) { return store.result(1).value_or(""); },
                             [campaign](Store& store) { return store.campaign(campaign)->request; },
                             [campaign](Store& store) { return store.candidate_table(campaign); }};
  for (const NewResource& each : seed_resources()) {
    reads.push_back([name = full_name(kDefaultProject, each.name)](Store& store) {
      return store.resource(name)->body;
    });
  }
  std::vector<std::string> right;
  for (Store store(path()); const Read& read : reads) right.push_back(read(store));
  std::mt19937 random(7);
  const auto size = std::filesystem::file_size(path());
  int seen = 0;
  for (int i = 0; i < (kUnderSanitizer ? 40 : 200); ++i) {
    const std::string rotten = folder_.file("rotten");
    std::filesystem::copy_file(path(), rotten, std::filesystem::copy_options::overwrite_existing);
    std::fstream file(rotten, std::ios::binary | std::ios::in | std::ios::out);
    const auto at = static_cast<std::streamoff>(random() % size);
    file.seekg(at);
    const auto flipped = static_cast<char>(file.get() ^ (1 << random() % 8));
    file.seekp(at);
    file.put(flipped);
    file.close();
    try {
      Store store(rotten);
      for (std::size_t k = 0; k < reads.size(); ++k) {
        try {
          EXPECT_EQ(reads[k](store), right[k]) << "read " << k << ", byte " << at;
        } catch (const StoreError&) {
          ++seen;
        } catch (const std::bad_optional_access&) {
          ++seen;  // a key rotted: it is not found
        }
      }
    } catch (const StoreError&) {
      ++seen;
    }
    for (const char* suffix : {"-wal", "-shm", ".lock"}) std::filesystem::remove(rotten + suffix);
  }
  EXPECT_GT(seen, 10);
}

TEST_F(MaintenanceTest, AnEarlierBackupBeforeAMigrationStays) {
  make();
  std::filesystem::copy_file(path(), path() + ".schema-1");
  EXPECT_EQ(Store(path(), two_schemas()).migration_backup(), path() + ".schema-1.2");
}

TEST_F(MaintenanceTest, AnotherVersionsDatabaseIsRefusedWithTheCureAndLeftAsItIs) {
  make();
  const std::string file = folder_.file("refused"), log = file + "-wal";
  const auto bytes_of_both = [&] {
    std::string out;
    for (const std::string& each : {file, log}) {
      std::ifstream in(each, std::ios::binary);
      out.append(std::istreambuf_iterator<char>(in), {});
    }
    return out;
  };
  for (const char* sql :
       {"UPDATE format SET fingerprint = printf('%064d', 0)", "DELETE FROM format",
        "DROP TABLE format", "DROP TABLE format; PRAGMA user_version = 14",
        "PRAGMA user_version = 0", "PRAGMA user_version = -1", "PRAGMA user_version = 2",
        "PRAGMA user_version = 99"}) {
    {  // with a log, as a killed server leaves it
      std::filesystem::copy_file(path(), folder_.file("changed"),
                                 std::filesystem::copy_options::overwrite_existing);
      SQLite::Database raw(folder_.file("changed"), SQLite::OPEN_READWRITE);
      raw.exec(sql);
      for (const char* suffix : {"", "-wal"}) {
        std::filesystem::copy_file(folder_.file("changed") + suffix, file + suffix,
                                   std::filesystem::copy_options::overwrite_existing);
      }
    }
    const std::string before = bytes_of_both();
    const std::function<void()> uses[] = {
        [&] { Store store(file); }, [&] { TokenTable tokens(file); }, [&] { check_database(file); },
        [&] { backup_database(file, folder_.file("copy")); },
        [&] { restore_database(file, folder_.file("other")); }};
    for (const auto& use : uses) {
      try {
        use();
        ADD_FAILURE() << sql;
      } catch (const StoreError& error) {
        EXPECT_EQ(error.kind(), StoreError::Kind::kOtherVersion) << sql;
        EXPECT_THAT(error.what(), AllOf(HasSubstr(file), HasSubstr("lubricants export --all"),
                                        HasSubstr("--database")));
      }
      EXPECT_EQ(bytes_of_both(), before) << sql;
    }
    EXPECT_FALSE(std::filesystem::exists(folder_.file("other")));
  }
}

TEST(Layout, HasEveryNumberNameAndTypeInOneOrder) {
  google::protobuf::FileDescriptorProto file;
  ASSERT_TRUE(google::protobuf::TextFormat::ParseFromString(R"(
    name: "a.proto" syntax: "proto3"
    message_type {
      name: "M"
      field { name: "inner" number: 4 type: TYPE_MESSAGE type_name: ".N" oneof_index: 0 }
      field { name: "kind" number: 2 type: TYPE_ENUM type_name: ".K" }
      field { name: "x" number: 1 type: TYPE_DOUBLE label: LABEL_REPEATED }
      oneof_decl { name: "one" }
    }
    message_type {
      name: "N"
      field { name: "n" number: 1 type: TYPE_MESSAGE type_name: ".N" }
      field { name: "y" number: 2 type: TYPE_INT32 proto3_optional: true oneof_index: 0 }
      oneof_decl { name: "_y" }
    }
    enum_type { name: "K" value { name: "NONE" number: 0 } value { name: "SOME" number: 3 } })",
                                                            &file));
  google::protobuf::DescriptorPool pool;
  EXPECT_EQ(wire_layout({pool.BuildFile(file)->message_type(0)}),
            "K\n0 NONE\n3 SOME\n"
            "M\n1 x double repeated packed\n2 kind enum K\n4 inner message N with presence in one\n"
            "N\n1 n message N with presence\n2 y int32 with presence\n");
}

TEST_F(MaintenanceTest, ListsFindResourcesThatWereStoredBeforeAFieldWasAdded) {
  make();
  damage("DELETE FROM properties WHERE key IN ('lims_id', 'base_oil_class')");
  Store store(path());
  ResourceQuery query;
  query.collection = "lubricants";
  query.order_key = "lims_id";
  query.limit = 100;
  query.byte_limit = 1'000'000;
  const std::size_t all = store.resource_names("default", "lubricants").size();
  EXPECT_GT(all, 0U);
  EXPECT_EQ(store.resources(query).rows.size(), all) << "ordered by the field";
  query.order_key.clear();
  query.restrictions = {
      {"base_oil_class", Restriction::Comparison::kEqual, std::string("POLYALPHAOLEFIN")}};
  EXPECT_EQ(store.resources(query).rows.size(), all - 1) << "all but shell-t9";
  EXPECT_THAT(check_database(path()), IsEmpty());
}

TEST_F(MaintenanceTest, EveryTableIsStrict) {
  make();
  SQLite::Database raw(path(), SQLite::OPEN_READONLY);
  SQLite::Statement query(
      raw,
      "SELECT name FROM pragma_table_list WHERE schema = 'main' AND type = 'table' "
      "AND NOT strict AND name NOT LIKE 'sqlite%'");
  while (query.executeStep()) ADD_FAILURE() << query.getColumn(0).getString();
}

TEST_F(MaintenanceTest, ABackupOfARunningServerIsCompleteAndRestored) {
  make();
  {
    Store running(path());
    v1::Lubricant lubricant = seed<v1::Lubricant>("lubricants/paper-fluid-1");
    lubricant.set_name("lubricants/new");
    running.add_project("default", {{lubricant.name(), lubricant.SerializeAsString()}}, 9);
    backup_database(path(), folder_.file("copy"));
    EXPECT_THROW(restore_database(folder_.file("copy"), path()), StoreError) << "it runs";
    EXPECT_THROW(backup_database(path(), folder_.file("copy")), StoreError) << "it exists";
  }
  damage("DELETE FROM properties");
  restore_database(folder_.file("copy"), path());
  EXPECT_TRUE(std::filesystem::exists(path() + ".replaced"));
  Store store(path());
  EXPECT_TRUE(store.resource("lubricants/new"));
  EXPECT_EQ(history_rows(store, 1, "a", 0, 2), (std::vector<double>{1, 2}));
}

TEST_F(MaintenanceTest, ABackupEndsWhileAnotherConnectionCommitsAllTheTime) {
  const TemporaryFolder memory(TemporaryFolder::Kind::kMemory);
  Store store(memory.file("db"));
  store.add_project("default", seed_resources(), 1);
  v1::Lubricant lubricant = seed<v1::Lubricant>("lubricants/paper-fluid-1");
  lubricant.set_description(std::string(1'000'000, 'x'));
  for (int i = 0; i < 12; ++i) {  // thousands of pages
    lubricant.set_name("lubricants/large-" + std::to_string(i));
    store.add_project("default", {{lubricant.name(), lubricant.SerializeAsString()}}, 2);
  }
  const ResultKey key{std::string(64, 'a'), "model", "platform"};
  const std::int64_t id = store.add_simulation({.request = "", .key = key}, 3).id;
  std::atomic<bool> is_over = false;
  std::thread writer([&] {
    for (bool is_pinned = true; !is_over; is_pinned = !is_pinned) store.set_pinned(id, is_pinned);
  });
  EXPECT_NO_THROW(backup_database(memory.file("db"), memory.file("copy")));
  is_over = true;
  writer.join();
  EXPECT_THAT(check_database(memory.file("copy")), IsEmpty());
}

TEST_F(MaintenanceTest, ABackupLeavesFilesOfSimilarNamesAlone) {
  make();
  std::ofstream(folder_.file("copy.new")) << "mine";
  backup_database(path(), folder_.file("copy"));
  std::string text;
  std::getline(std::ifstream(folder_.file("copy.new")), text);
  EXPECT_EQ(text, "mine");
}

TEST_F(MaintenanceTest, ADamagedDatabaseIsNotBackedUp) {
  make();
  damage("UPDATE revisions SET body = x'00' WHERE id = 1");
  const std::string copy = folder_.file("copy.db");
  EXPECT_THROW(backup_database(path(), copy), StoreError);
  EXPECT_FALSE(std::filesystem::exists(copy));
  EXPECT_FALSE(std::filesystem::exists(copy + ".new"));
}

TEST_F(MaintenanceTest, ADatabaseWrittenWhileTheClockWasSetBackIsBackedUp) {
  make();
  {
    Store store(path());
    const StoredResource present = *store.resource("gearSets/reference-axle");
    ASSERT_TRUE(store.write_resources({{{present.name, present.body}, present}}, 100));
  }
  damage(
      "UPDATE revisions SET create_time = 40 WHERE revision = 2;"
      "UPDATE revisions SET create_time = 50 WHERE resource = "
      "(SELECT resource FROM revisions WHERE revision = 2) AND revision = 1;"
      "UPDATE properties SET value = 40 WHERE name = 'gearSets/reference-axle' AND key = "
      "'update_time'");
  EXPECT_THAT(check_database(path()), IsEmpty());
  EXPECT_NO_THROW(backup_database(path(), folder_.file("copy")));
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

TEST(Inputs, OfAStoredSimulationKeepTheirHash) {
  Bench bench;
  ASSERT_TRUE(bench.reaches(bench.create(point_simulation()), v1::Simulation::SUCCEEDED));
  bench.jobs().stop();
  EXPECT_THAT(check_database(bench.database(), hash_stored_inputs), IsEmpty());
  SQLite::Database raw = bench.open_database();
  raw.exec(
      "UPDATE simulations SET lubricant = "
      "(SELECT revision_id FROM revision_names WHERE name = 'lubricants/paper-fluid-3')");
  EXPECT_THAT(check_database(bench.database(), hash_stored_inputs),
              Contains(HasSubstr("its inputs have another hash")));
}

TEST_F(MaintenanceTest, ServerCheckAndRestoreRefuseTheSameDatabases) {
  const std::pair<const char*, const char*> cases[] = {
      {"PRAGMA application_id = 7", "another program"},
      {"CREATE TABLE notes (text TEXT)", "its table notes is not of this program"},
      {"CREATE TRIGGER planted AFTER INSERT ON simulations BEGIN DELETE FROM results; END",
       "its trigger planted is not of this program"},
      {"DROP INDEX one_result_per_input", "its index one_result_per_input is missing"},
      {"DROP TABLE token_log", "its table token_log is missing"},
      {"DROP VIEW revision_names; CREATE VIEW revision_names AS SELECT 1", "view revision_names"},
  };
  make();
  std::filesystem::copy_file(path(), folder_.file("sound"));
  for (const auto& [sql, reason] : cases) {
    std::filesystem::copy_file(folder_.file("sound"), path(),
                               std::filesystem::copy_options::overwrite_existing);
    { SQLite::Database(path(), SQLite::OPEN_READWRITE).exec(sql); }
    const auto sentence_of = [](const auto& action) -> std::string {
      try {
        action();
      } catch (const StoreError& error) {
        return error.what();
      }
      return "nothing";
    };
    EXPECT_THAT(sentence_of([&] { Store store(path()); }), HasSubstr(reason)) << sql;
    EXPECT_THAT(sentence_of([&] { backup_database(path(), folder_.file("copy")); }),
                HasSubstr(reason));
    EXPECT_THAT(sentence_of([&] { restore_database(path(), folder_.file("other")); }),
                HasSubstr(reason));
    std::vector<std::string> problems;
    problems.push_back(sentence_of([&] { problems = check_database(path()); }));
    EXPECT_THAT(problems, Contains(HasSubstr(reason))) << sql;
  }
}

TEST_F(MaintenanceTest, AnEmptyFileIsANewDatabaseButNoBackup) {
  std::ofstream(folder_.file("empty")).flush();
  EXPECT_THAT(check_database(folder_.file("empty")), IsEmpty());
  EXPECT_THROW(restore_database(folder_.file("empty"), path()), StoreError);
  EXPECT_FALSE(std::filesystem::exists(path()));
  EXPECT_NO_THROW(Store(folder_.file("empty")));
  EXPECT_THROW(Store("/dev/null"), StoreError);
  EXPECT_THROW(check_database("/dev/null"), StoreError);
}

TEST_F(MaintenanceTest, AnImpossibleNumberOfRowsIsDamageAndAllocatesNothing) {
  make();
  damage("UPDATE history_columns SET rows = 1000000000000");
  EXPECT_THAT(check_database(path()), Contains(HasSubstr("its history is damaged")));
  damage("UPDATE history_columns SET rows = 20000000");
  EXPECT_THAT(check_database(path()), Contains(HasSubstr("its history is damaged")));
  damage("UPDATE history_columns SET rows = 9223372036854775807");
  EXPECT_THAT(check_database(path()), Contains(HasSubstr("its history is damaged")));
}

TEST_F(MaintenanceTest, CheckFindsEveryKindOfProblem) {
  const std::pair<const char*, const char*> cases[] = {
      {"UPDATE revisions SET body = x'00' WHERE id = 1", "differs from its checksum"},
      {"UPDATE revisions SET revision = 7 WHERE id = 1", "gaps"},
      {"DELETE FROM properties WHERE key = 'lims_id'", "the search index does not match"},
      {"UPDATE properties SET value = 7.5 WHERE key = 'mass_kilograms'",
       "the search index does not match"},
      {"PRAGMA foreign_keys = OFF; UPDATE simulations SET lubricant = 999", "refers to a row"},
      {"PRAGMA foreign_keys = OFF; DELETE FROM results", "refers to a row"},
      {"DELETE FROM events WHERE sequence = 2", "gaps"},
      {"DELETE FROM events WHERE sequence = 3", "gaps"},
      {"UPDATE events SET state = 2 WHERE sequence = 3", "another state"},
      {"UPDATE events SET state = 4 WHERE sequence = 1", "backwards"},
      {"UPDATE events SET number = number + 100 WHERE sequence = 1", "smaller number"},
      {"UPDATE events SET simulation = 99", "its simulation does not exist"},
      {"UPDATE events SET state = 0, project = 'default', simulation_number = 1 "
       "WHERE sequence = 3",
       "its simulation was not deleted"},
      {"UPDATE events SET project = 'acme' WHERE sequence = 1",
       "its simulation belongs to another project"},
      {"UPDATE events SET number = 99 WHERE sequence = 3",
       "its project does not exist or has given no such number"},
      {"UPDATE events SET state = 0, project = 'default', simulation_number = 99 "
       "WHERE sequence = 3",
       "its project does not exist or has given no such number"},
      {"UPDATE projects SET deletions = 1",
       "the number of deleted simulations of default is wrong"},
      {"UPDATE projects SET simulations = 9", "the number of simulations of default is wrong"},
      {"UPDATE results SET body = x'0a00'", "result 1: its content differs from its checksum"},
      {"UPDATE results SET checksum = checksum + 1", "result 1: its content differs from"},
      {"UPDATE ledgers SET body = x'0a00'", "ledger 1: its content differs from its checksum"},
      {"UPDATE simulations SET input_hash = printf('%064d', 0)", "belongs to other inputs"},
      {"UPDATE history_blocks SET data = x'0000'", "history"},
      {"UPDATE history_blocks SET checksum = checksum + 1", "history"},
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
