// Tests of backup, restore, migration and purge when a system call fails or the process is killed:
// a backup appears complete or not at all, and the database is the old or the new one, complete.
#include <SQLiteCpp/Database.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "server/storage/maintenance.h"
#include "server/storage/schema.h"
#include "server/storage/seeds.h"
#include "server/storage/store.h"
#include "tests/crash/faulty_vfs.h"
#include "tests/crash/file_call_hook.h"
#include "tests/service/support.h"
#include "tests/support/run_length.h"
#include "tribodyn/v1/lubricants.pb.h"
#include "tribodyn/v1/results.pb.h"

namespace tribodyn::crash {
namespace {

using server::backup_database;
using server::check_database;
using server::restore_database;
using server::SchemaSteps;
using server::Store;
using server::StoreError;
using server::TemporaryFolder;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::StartsWith;

constexpr int kInBackup = 2;
constexpr int kInDatabase = 3;
constexpr int kMostCalls = 100;  // far more than a backup or a restore makes

/// Adds simulations. The process ends without closing the store, so that a write-ahead log remains.
void fill(const std::string& database, int simulations) {
  const int code = run_in_child([&] {
    Store store(database);
    store.add_project("default", server::seed_resources(), 1);
    const server::ResultKey key{std::string(64, 'a'), "model", "platform"};
    for (int i = 0; i < simulations; ++i) store.add_simulation({.request = "", .key = key}, 2);
    _exit(0);
  });
  ASSERT_EQ(code, 0);
}

int simulations_of(const std::string& database, const SchemaSteps& steps = server::schema_steps()) {
  Store store(database, steps);
  return static_cast<int>(store.simulations({.limit = 100, .byte_limit = 1 << 20}).rows.size());
}

std::string text_of(const std::string& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

/// Returns the files whose names contain `part`.
std::vector<std::string> files_with(const TemporaryFolder& folder, const std::string& part) {
  std::vector<std::string> out;
  for (const auto& entry : std::filesystem::directory_iterator(folder.path())) {
    const std::string name = entry.path().filename().string();
    if (name.find(part) != std::string::npos) out.push_back(name);
  }
  return out;
}

int schema_of(const std::string& database) {
  SQLite::Database db(database, SQLite::OPEN_READWRITE);
  return db.execAndGet("PRAGMA user_version").getInt();
}

class MaintenanceFault : public testing::Test {
 protected:
  void SetUp() override {
    fill(folder_.file("source"), kInBackup);
    backup_database(folder_.file("source"), backup_);
    fill(folder_.file("former"), kInDatabase);
    ASSERT_GT(std::filesystem::file_size(folder_.file("former-wal")), 0U);
  }

  /// Writes the old database, which a restore will replace, with commits that only its write-ahead
  /// log has.
  std::string place_former(const TemporaryFolder& place) const {
    for (const char* suffix : {"", "-wal"}) {
      std::filesystem::copy_file(folder_.file(std::string("former") + suffix),
                                 place.file(std::string("db") + suffix));
    }
    return place.file("db");
  }

  /// Checks that a finished or interrupted restore left one of the two databases.
  void expect_former_or_new(const std::string& database, bool is_restored,
                            const std::string& trace) const {
    ASSERT_TRUE(std::filesystem::exists(database)) << trace;
    const int found = simulations_of(database);
    EXPECT_THAT(check_database(database), IsEmpty()) << trace;
    EXPECT_TRUE(found == kInBackup || (!is_restored && found == kInDatabase))
        << found << " simulations, " << trace;
    if (found == kInBackup) {
      EXPECT_EQ(simulations_of(database + ".replaced"), kInDatabase) << trace;
    }
  }

  std::string place_backup(const TemporaryFolder& place) const {
    std::filesystem::copy_file(backup_, place.file("db"));
    return place.file("db");
  }

  /// Checks that a finished or interrupted migration left the old or the new schema, and with the
  /// new one a backup.
  void expect_old_or_migrated(const std::string& database, bool is_migrated,
                              const std::string& trace) const {
    const int schema = schema_of(database);
    EXPECT_TRUE(schema == 2 || (!is_migrated && schema == 1)) << schema << trace;
    const SchemaSteps steps = schema == 2 ? server::two_schemas() : server::schema_steps();
    EXPECT_THAT(check_database(database, nullptr, steps), IsEmpty()) << trace;
    EXPECT_EQ(simulations_of(database, steps), kInBackup) << trace;
    if (schema == 2) {
      EXPECT_THAT(check_database(database + ".schema-1"), IsEmpty()) << trace;
      EXPECT_EQ(simulations_of(database + ".schema-1"), kInBackup) << trace;
    }
  }

  /// Runs `action` on a database that `place_database` places, once for each n; `meet` handles the
  /// n-th call: it returns an errno or does not return. Then calls `check`.
  template <class Place, class Action, class Check, class Meet>
  void fault_each_call(const Place& place_database, const Action& action, const Check& check,
                       const Meet& meet) {
    int n = 1;
    for (bool was_met = true; was_met && n < kMostCalls; ++n) {
      const TemporaryFolder place(TemporaryFolder::Kind::kMemory);
      const std::string database = place_database(place);
      was_met =
          run_in_child([&] {
            std::atomic<int> calls = 0;
            const FileCallHook hook([&](const std::string&) { return ++calls == n ? meet() : 0; });
            action(database);
            if (calls >= n) _exit(2);  // e.g. SQLite ignores the error of syncing a folder
          }) != 0;
      check(database, !was_met, "call " + std::to_string(n));
    }
    EXPECT_GE(n, 8) << "calls that this test must meet: syncs, removals and renames";
    EXPECT_LT(n, kMostCalls);
  }

  template <class Meet>
  void restore_with_a_fault_at_each_call(const Meet& meet) {
    fault_each_call([this](const auto& place) { return place_former(place); },
                    [this](const auto& database) { restore_database(backup_, database); },
                    [this](const auto&... found) { expect_former_or_new(found...); }, meet);
  }

  template <class Meet>
  void migrate_with_a_fault_at_each_call(const Meet& meet) {
    fault_each_call([this](const auto& place) { return place_backup(place); },
                    [](const auto& database) { Store store(database, server::two_schemas()); },
                    [this](const auto&... found) { expect_old_or_migrated(found...); }, meet);
  }

  TemporaryFolder folder_{TemporaryFolder::Kind::kMemory};
  const std::string backup_ = folder_.file("backup");
};

TEST_F(MaintenanceFault, ARestoreKilledAtAnyCallLeavesTheFormerOrTheNewDatabase) {
  restore_with_a_fault_at_each_call([] { return kill(getpid(), SIGKILL); });
}

TEST_F(MaintenanceFault, ARestoreWhoseCallsFailLeavesTheFormerOrTheNewDatabase) {
  restore_with_a_fault_at_each_call([] { return EIO; });
}

TEST_F(MaintenanceFault, AMigrationKilledAtAnyCallLeavesTheOldDatabaseOrTheNewOneWithABackup) {
  migrate_with_a_fault_at_each_call([] { return kill(getpid(), SIGKILL); });
}

TEST_F(MaintenanceFault, AMigrationWhoseCallsFailLeavesTheOldDatabaseOrTheNewOneWithABackup) {
  migrate_with_a_fault_at_each_call([] { return EIO; });
}

TEST_F(MaintenanceFault, ABackupWhoseCallsFailLeavesNoFile) {
  int n = 1;
  for (bool was_met = true; was_met && n < kMostCalls; ++n) {
    const std::string copy = folder_.file("copy-" + std::to_string(n));
    int calls = 0;
    bool is_done = false;
    try {
      const FileCallHook hook([&](const std::string& call) {
        // After a failure the unfinished file is removed.
        if (call.starts_with("remove ")) return 0;
        return ++calls == n ? EIO : 0;
      });
      backup_database(backup_, copy);
      is_done = true;
    } catch (const StoreError&) {
    }
    EXPECT_EQ(std::filesystem::exists(copy), is_done) << "call " << n;
    if (is_done) {
      EXPECT_THAT(check_database(copy), IsEmpty()) << "call " << n;
    }
    EXPECT_THAT(files_with(folder_, ".new-"), IsEmpty()) << "call " << n;
    was_met = calls >= n;
  }
  EXPECT_GE(n, 5);
  EXPECT_LT(n, kMostCalls);
}

/// Tests with faults of SQLite's own file operations.
class MaintenanceOnAFaultyDisk : public MaintenanceFault {
 protected:
  /// Runs `action` with each operation of each kind failing in turn, once or from then on, and
  /// calls `check` with the success of the action.
  template <class Action, class Check>
  void fail_each_operation(const Action& action, const Check& check) {
    using Operation = FaultyVfs::Operation;
    for (const Operation operation : {Operation::kOpen, Operation::kWrite, Operation::kSync}) {
      const bool many = operation == Operation::kWrite;
      const int stride = kUnderAddressSanitizer ? (many ? 80 : 2) : many ? 10 : 1;
      for (const bool lasting : {false, true}) {
        int n = 1;
        for (bool was_met = true; was_met && !HasFailure(); n += stride) {
          vfs_.fail(operation, n, lasting);
          bool is_done = true;
          try {
            action();
          } catch (const StoreError&) {
            is_done = false;
          }
          was_met = vfs_.count(operation) >= n;
          vfs_.recover();
          check(is_done, "operation " + std::to_string(n) + " of kind " +
                             std::to_string(static_cast<int>(operation)));
        }
        EXPECT_GE(n, 3) << "operations met";
      }
    }
  }

  FaultyVfs vfs_;
};

TEST_F(MaintenanceOnAFaultyDisk, ABackupIsCompleteOrNotThere) {
  const std::string copy = folder_.file("copy");
  fail_each_operation([&] { backup_database(folder_.file("source"), copy); },
                      [&](bool is_done, const std::string& trace) {
                        EXPECT_EQ(std::filesystem::exists(copy), is_done) << trace;
                        if (is_done) {
                          EXPECT_EQ(simulations_of(copy), kInBackup) << trace;
                          EXPECT_THAT(check_database(copy), IsEmpty()) << trace;
                        }
                        EXPECT_THAT(files_with(folder_, ".new-"), IsEmpty()) << trace;
                        for (const char* suffix : {"", "-wal", "-shm", ".lock"}) {
                          std::filesystem::remove(copy + suffix);
                        }
                      });
}

TEST_F(MaintenanceOnAFaultyDisk, ARestoreLeavesTheFormerOrTheNewDatabase) {
  std::optional<TemporaryFolder> place;
  place.emplace(TemporaryFolder::Kind::kMemory);
  std::string database = place_former(*place);
  fail_each_operation([&] { restore_database(backup_, database); },
                      [&](bool is_done, const std::string& trace) {
                        expect_former_or_new(database, is_done, trace);
                        EXPECT_THAT(files_with(*place, ".new-"), IsEmpty()) << trace;
                        place.emplace(TemporaryFolder::Kind::kMemory);
                        database = place_former(*place);
                      });
}

TEST_F(MaintenanceOnAFaultyDisk, AMigrationLeavesTheOldDatabaseOrTheNewOneWithABackup) {
  std::optional<TemporaryFolder> place;
  place.emplace(TemporaryFolder::Kind::kMemory);
  std::string database = place_backup(*place);
  fail_each_operation([&] { Store store(database, server::two_schemas()); },
                      [&](bool is_done, const std::string& trace) {
                        expect_old_or_migrated(database, is_done, trace);
                        EXPECT_THAT(files_with(*place, ".new-"), IsEmpty()) << trace;
                        place.emplace(TemporaryFolder::Kind::kMemory);
                        database = place_backup(*place);
                      });
}

TEST_F(MaintenanceOnAFaultyDisk, APurgeRemovesAResourceWithItsSimulationsOrNothing) {
  const std::string marker = "a formulation by mistake";
  std::optional<TemporaryFolder> place;
  std::string database;
  const auto renew = [&] {
    place.emplace(TemporaryFolder::Kind::kMemory);
    database = place->file("db");
    Store store(database);
    tribodyn::v1::Lubricant lubricant;
    lubricant.set_name("lubricants/secret");
    lubricant.set_display_name(marker);
    store.add_project("default", {{"lubricants/secret", lubricant.SerializeAsString()}}, 1);
    const server::ResultKey key{std::string(64, 'a'), "model", "platform"};
    const auto id =
        store
            .add_simulation(
                {.request = "", .key = key, .revisions = {.lubricant = "lubricants/secret@1"}}, 2)
            .id;
    store.mark_running(id, 3, key);
    tribodyn::v1::SimulationResult result;
    result.set_input_hash(key.input_hash);
    result.add_input_warnings()->set_message(marker);
    store.mark_succeeded(id, 4, {key, result.SerializeAsString()});
  };
  const auto purge = [&] {
    Store store(database);
    if (const auto present = store.resource("lubricants/secret")) {
      store.purge_resource(*present, true);
    }
    store.erase_removed();
  };
  renew();
  fail_each_operation(purge, [&](bool is_done, const std::string& trace) {
    bool is_there = false;
    {
      Store store(database);
      is_there = store.resource("lubricants/secret").has_value();
      EXPECT_EQ(store.simulation(1).has_value(), is_there) << trace;
    }
    EXPECT_THAT(check_database(database), IsEmpty()) << trace;
    EXPECT_FALSE(is_done && is_there) << trace;
    purge();  // again, on a sound disk
    for (const char* suffix : {"", "-wal"}) {
      EXPECT_EQ(text_of(database + suffix).find(marker), std::string::npos) << suffix << trace;
    }
    renew();
  });
}

TEST_F(MaintenanceFault, AFileHasItsNameOnlyOnceItIsOnDiskAndTheNameIsWrittenToo) {
  std::vector<std::string> calls;
  const FileCallHook hook([&](const std::string& call) {
    if (!call.starts_with("remove ")) calls.push_back(call);
    return 0;
  });
  const auto last_three = [&] { return std::vector(calls.end() - 3, calls.end()); };
  backup_database(backup_, folder_.file("copy"));
  EXPECT_THAT(last_three(), ElementsAre(StartsWith("fsync " + folder_.file("copy.new-")),
                                        StartsWith("renameat2 " + folder_.file("copy.new-")),
                                        "fsync " + folder_.path().string()));
  restore_database(backup_, folder_.file("source"));
  EXPECT_THAT(last_three(), ElementsAre(StartsWith("fsync " + folder_.file("source.new-")),
                                        StartsWith("rename " + folder_.file("source.new-")),
                                        "fsync " + folder_.path().string()));
}

TEST_F(MaintenanceFault, ABackupDoesNotReplaceAFileThatAppearsMeanwhile) {
  const std::string copy = folder_.file("copy");
  const auto another_writes_it = [&](const std::string& call) {
    if (call.starts_with("renameat2 ")) std::ofstream(copy) << "of another program";
    return 0;
  };
  {
    const FileCallHook hook(another_writes_it);
    EXPECT_THROW(backup_database(backup_, copy), StoreError);
  }
  EXPECT_EQ(text_of(copy), "of another program");
  std::filesystem::remove(copy);
  const auto without_the_call = [&](const std::string& call) {
    another_writes_it(call);
    return call.starts_with("renameat2 ") ? EINVAL : 0;
  };
  const FileCallHook hook(without_the_call);
  EXPECT_THROW(backup_database(backup_, copy), StoreError);
  EXPECT_EQ(text_of(copy), "of another program");
}

TEST_F(MaintenanceFault, ABackupNeedsNoRenameThatRefusesToReplace) {
  const FileCallHook hook(
      [](const std::string& call) { return call.starts_with("renameat2 ") ? EINVAL : 0; });
  backup_database(backup_, folder_.file("copy"));
  EXPECT_EQ(simulations_of(folder_.file("copy")), kInBackup);
  EXPECT_THAT(files_with(folder_, ".new-"), IsEmpty());
}

TEST_F(MaintenanceFault, ARestoreOverADamagedDatabaseKeepsItsLogAndDoesNotApplyIt) {
  const std::string database = place_former(folder_);
  std::filesystem::resize_file(database, 0);
  EXPECT_EQ(restore_database(backup_, database), database + ".replaced");
  EXPECT_EQ(simulations_of(database), kInBackup);
  EXPECT_THAT(check_database(database), IsEmpty());
  EXPECT_EQ(std::filesystem::file_size(database + ".replaced"), 0U);
  EXPECT_GT(std::filesystem::file_size(database + ".replaced-wal"), 0U);
  std::ofstream(database) << std::string(5000, 'x');
  EXPECT_EQ(restore_database(backup_, database), database + ".replaced.2");
  EXPECT_EQ(simulations_of(database), kInBackup);
  EXPECT_THAT(text_of(database + ".replaced.2"), StartsWith("xxx"));
}

TEST_F(MaintenanceFault, ARestoreKeepsWhatEarlierOnesKept) {
  const std::string database = folder_.file("db");
  EXPECT_EQ(restore_database(backup_, database), std::nullopt) << "there is no former one";
  fill(database, 1);
  EXPECT_EQ(restore_database(backup_, database), database + ".replaced");
  EXPECT_EQ(restore_database(backup_, database), database + ".replaced.2");
  EXPECT_EQ(simulations_of(database + ".replaced"), kInBackup + 1);
  EXPECT_EQ(simulations_of(database + ".replaced.2"), kInBackup);
}

}  // namespace
}  // namespace tribodyn::crash
