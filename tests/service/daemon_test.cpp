// Tests of the process: kill, termination, a second server, flags and addresses.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <thread>

#include "server/storage/database_lock.h"
#include "server/transport/listen_address.h"
#include "tests/service/grpc_fixture.h"
#include "tests/service/raw_client.h"
#include "tests/support/run_length.h"
#include "tribodyn/v1/lubricants.grpc.pb.h"

namespace tribodyn::server {
namespace {

using testing::HasSubstr;

class DaemonTest : public GrpcTest {
 protected:
  int count_of_lubricants(const std::string& filter) {
    v1::ListLubricantsRequest request;
    request.set_filter(filter);
    request.set_page_size(1000);
    int count = 0;
    do {
      grpc::ClientContext context;
      v1::ListLubricantsResponse page;
      const auto stub = v1::LubricantService::NewStub(channel_);
      const grpc::Status status = stub->ListLubricants(&context, request, &page);
      EXPECT_TRUE(status.ok()) << status.error_message();
      count += page.lubricants_size();
      request.set_page_token(page.next_page_token());
    } while (!request.page_token().empty());
    return count;
  }
};

TEST_F(DaemonTest, ResultsSurviveAKillAndUnfinishedSimulationsRunAgain) {
  v1::Simulation done, running;
  ASSERT_TRUE(create(point_simulation(), &done).ok());
  ASSERT_TRUE(eventually([&] { return get(done.name()).state() == v1::Simulation::SUCCEEDED; }));
  const v1::Simulation before = get(done.name());
  ASSERT_TRUE(create(long_simulation(), &running).ok());
  ASSERT_TRUE(eventually([&] { return get(running.name()).state() == v1::Simulation::RUNNING; }));
  process_->signal(SIGKILL);
  EXPECT_EQ(process_->wait(), 128 + SIGKILL);
  start();
  EXPECT_EQ(get(done.name()).SerializeAsString(), before.SerializeAsString());
  EXPECT_TRUE(eventually([&] { return get(running.name()).state() == v1::Simulation::RUNNING; }));
  EXPECT_EQ(cancel(running.name()).state(), v1::Simulation::CANCELLED);
  process_->signal(SIGKILL);
  process_->wait();
  start();
  EXPECT_EQ(get(running.name()).state(), v1::Simulation::CANCELLED) << "a cancelled one stays so";
}

TEST_F(DaemonTest, AKilledServerHasWrittenABatchCompletelyOrNotAtAll) {
  constexpr int kSize = kUnderAddressSanitizer ? 300 : 2000;
  v1::BatchCreateLubricantsRequest batch;
  v1::Lubricant fluid = seed<v1::Lubricant>("lubricants/paper-fluid-1");
  for (int i = 0; i < kSize; ++i) {
    fluid.set_name("lubricants/batch-" + std::to_string(i));
    *batch.add_requests()->mutable_lubricant() = fluid;
  }
  batch.mutable_read_mask()->add_paths("name");
  // Kills the server ever later, until a batch is written before the kill.
  for (std::chrono::milliseconds delay(2);; delay += delay / 2) {
    grpc::Status status;
    std::thread sender([&] {
      grpc::ClientContext context;
      v1::BatchCreateLubricantsResponse response;
      status = v1::LubricantService::NewStub(channel_)->BatchCreateLubricants(&context, batch,
                                                                              &response);
    });
    std::this_thread::sleep_for(delay);
    process_->signal(SIGKILL);
    process_->wait();
    sender.join();
    start();
    const int written = count_of_lubricants("name:batch-");
    ASSERT_TRUE(written == 0 || written == kSize) << written;
    ASSERT_TRUE(!status.ok() || written == kSize) << "what was acknowledged stays";
    if (written > 0) break;
  }
}

TEST_F(DaemonTest, ATerminationEndsStreamsAndUnfinishedSimulationsRunAfterTheNextStart) {
  v1::Simulation running;
  ASSERT_TRUE(create(long_simulation(), &running).ok());
  ASSERT_TRUE(eventually([&] { return get(running.name()).state() == v1::Simulation::RUNNING; }));
  RawClient client(channel_);
  const auto health = client.open("/grpc.health.v1.Health/Watch", "");
  const auto reflection = client.open(
      "/grpc.reflection.v1alpha.ServerReflection/ServerReflectionInfo", std::string("\x3a\x00", 2));
  grpc::Status status;
  std::thread watcher([&] { watch(running.name(), &status); });
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  process_->signal(SIGTERM);
  EXPECT_EQ(process_->wait(std::chrono::seconds(8)), 0) << process_->log();
  watcher.join();
  EXPECT_EQ(status.error_code(), grpc::StatusCode::UNAVAILABLE);
  EXPECT_FALSE(std::filesystem::exists(folder_.file("port")));
  start();
  EXPECT_NE(get(running.name()).state(), v1::Simulation::CANCELLED);
  cancel(running.name());
}

/// Returns a curve that takes one or two seconds: 13 points, or one under a sanitizer, which slows
/// the core.
v1::Simulation some_seconds() {
  constexpr double kStep = kUnderSanitizer ? 130 : 10;
  v1::Simulation simulation = curve_simulation();
  simulation.mutable_inefficiency_curve()->set_speed_step_kilometres_per_hour(kStep);
  simulation.mutable_solver_options()->set_method(v1::STEADY_STATE_METHOD_MARCH);
  return simulation;
}

class DrainTest : public GrpcTest {
 protected:
  void SetUp() override {
    drain_seconds_ = "25";
    start();
    ASSERT_TRUE(create(simulation(), &running_).ok());
    ASSERT_TRUE(
        eventually([&] { return get(running_.name()).state() == v1::Simulation::RUNNING; }));
  }
  virtual v1::Simulation simulation() const { return some_seconds(); }
  v1::Simulation running_;
};

class EndlessDrainTest : public DrainTest {
 protected:
  v1::Simulation simulation() const override { return long_simulation(); }
};

TEST_F(DrainTest, RunningSimulationsEndWhileNewOnesAreRefused) {
  RawClient client(channel_);
  grpc::Status status;
  std::vector<v1::SimulationEvent> events;
  std::thread watcher([&] { events = watch(running_.name(), &status); });
  process_->signal(SIGTERM);
  // different each time: an accepted one would not be refused again
  v1::Simulation next = point_simulation();
  EXPECT_TRUE(eventually([&] {
    auto* const cruise = next.mutable_operating_point()->mutable_cruise();
    cruise->set_speed_kilometres_per_hour(cruise->speed_kilometres_per_hour() + 0.25);
    v1::Simulation refused;
    return create(next, &refused).error_code() == grpc::StatusCode::UNAVAILABLE;
  }));
  EXPECT_EQ(client.call("/grpc.health.v1.Health/Check", "").second, std::string("\x08\x02"))
      << "NOT_SERVING";
  EXPECT_EQ(get(running_.name()).state(), v1::Simulation::RUNNING) << "reads are answered";
  EXPECT_EQ(process_->wait(std::chrono::seconds(30)), 0) << process_->log();
  watcher.join();
  ASSERT_FALSE(events.empty());
  EXPECT_EQ(events.back().state(), v1::Simulation::SUCCEEDED);
  start();
  EXPECT_EQ(get(running_.name()).state(), v1::Simulation::SUCCEEDED);
  EXPECT_EQ(get(running_.name()).attempt(), 1);
}

TEST_F(EndlessDrainTest, ASecondSignalEndsTheWaitAndLosesNothing) {
  process_->signal(SIGTERM);
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  EXPECT_TRUE(process_->running());
  const auto begin = std::chrono::steady_clock::now();
  process_->signal(SIGTERM);
  EXPECT_EQ(process_->wait(), 0) << process_->log();
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(3));
  start();
  EXPECT_TRUE(eventually([&] { return get(running_.name()).attempt() == 2; }));
  EXPECT_EQ(cancel(running_.name()).state(), v1::Simulation::CANCELLED);
}

TEST_F(DaemonTest, ABackupOfARunningServerIsRestoredAfterItsStop) {
  const std::string database = folder_.file("tribodyn.db");
  const auto run = [&](const std::vector<std::string>& arguments) {
    std::filesystem::remove(folder_.file("command.log"));
    ServerProcess command(arguments, folder_.file("command.log"));
    const int code = command.wait();
    return std::to_string(code) + " " + command.log();
  };
  EXPECT_EQ(run({"backup", "--database", database, folder_.file("copy")}), "0 ");
  EXPECT_EQ(run({"check", "--database", database}), "0 ");
  v1::Simulation simulation;
  ASSERT_TRUE(create(point_simulation(), &simulation).ok());
  EXPECT_THAT(run({"restore", "--database", database, folder_.file("copy")}),
              HasSubstr("in use by another tribodynd"));
  process_->signal(SIGTERM);
  process_->wait();
  EXPECT_EQ(run({"restore", "--database", database, folder_.file("copy")}),
            "0 the former database is kept as " + database + ".replaced\n");
  start();
  v1::ListSimulationsResponse list;
  grpc::ClientContext context;
  ASSERT_TRUE(simulations_->ListSimulations(&context, {}, &list).ok());
  EXPECT_EQ(list.simulations_size(), 0) << "made after the backup";
  EXPECT_THAT(run({"check", "--database", folder_.file("nothing")}), HasSubstr("3 "));
  EXPECT_THAT(run({"backup", "--database", database}), HasSubstr("FILE is required"));
  EXPECT_THAT(run({}), HasSubstr("--database is required"));
}

TEST_F(DaemonTest, ChangesAreRefusedWhileTheDatabaseFileIsMoved) {
  const std::string database = folder_.file("tribodyn.db");
  RawClient client(channel_);
  const auto health = [&] {
    return client.call("/grpc.health.v1.Health/Check", "").second.substr(1, 1);
  };
  const std::string serving("\x01"), not_serving("\x02");
  v1::Simulation before, during, after;
  ASSERT_TRUE(create(point_simulation(), &before).ok());
  for (const char* suffix : {"", "-wal"}) {
    const std::string file = database + suffix;
    std::filesystem::rename(file, file + ".elsewhere");
    for (int i = 0; i < 2; ++i) {
      if (i == 1) std::ofstream(file) << "another file";
      const grpc::Status status = create(point_simulation(), &during);
      EXPECT_EQ(status.error_code(), grpc::StatusCode::UNAVAILABLE) << file;
      EXPECT_THAT(status.error_message(), HasSubstr("deleted, renamed or replaced"));
    }
    if (file == database) {
      EXPECT_TRUE(eventually([&] { return health() == not_serving; }));
    }
    EXPECT_EQ(get(before.name()).name(), before.name()) << "reads are answered";
    std::filesystem::rename(file + ".elsewhere", file);
    EXPECT_TRUE(create(point_simulation(), &after).ok()) << file;
    if (file == database) {
      EXPECT_TRUE(eventually([&] { return health() == serving; }));
    }
  }
  EXPECT_THAT(process_->log(), HasSubstr(database + " was deleted or renamed while"));
  EXPECT_THAT(process_->log(), HasSubstr("the database is back at its path"));
  process_->signal(SIGKILL);
  process_->wait();
  start();
  EXPECT_EQ(get(after.name()).name(), after.name());
}

class ReplacedDatabaseTest : public DaemonTest {
 protected:
  /// Runs a command of tribodynd; its exit code and what it prints.
  std::string run(const std::vector<std::string>& arguments) {
    std::filesystem::remove(folder_.file("command.log"));
    ServerProcess command(arguments, folder_.file("command.log"));
    const int code = command.wait();
    return std::to_string(code) + " " + command.log();
  }

  /// Makes a backup, and then more changes than SQLite's first pages hold.
  void SetUp() override {
    start();
    ASSERT_EQ(run({"backup", "--database", database_, folder_.file("copy")}), "0 ");
    ASSERT_TRUE(create(point_simulation(), &later_).ok());
    ASSERT_TRUE(
        eventually([&] { return get(later_.name()).state() == v1::Simulation::SUCCEEDED; }));
    ASSERT_GT(std::filesystem::file_size(log_file_), 0U);
  }

  /// As cp and mv do.
  void replace() {
    std::filesystem::copy_file(folder_.file("copy"), database_ + ".tmp");
    std::filesystem::rename(database_ + ".tmp", database_);
  }

  /// The database is the backup, whole.
  void expect_backup() {
    EXPECT_EQ(run({"check", "--database", database_}), "0 ");
    v1::ListSimulationsResponse list;
    grpc::ClientContext context;
    ASSERT_TRUE(simulations_->ListSimulations(&context, {}, &list).ok());
    EXPECT_EQ(list.simulations_size(), 0) << "made after the backup";
    v1::Simulation created;
    EXPECT_TRUE(create(point_simulation(), &created).ok());
  }

  std::vector<std::string> logs_left() const {
    std::vector<std::string> out;
    for (const auto& entry : std::filesystem::directory_iterator(folder_.file("."))) {
      const std::string name = entry.path().filename();
      if (name.starts_with("tribodyn.db-wal.left-")) out.push_back(name);
    }
    return out;
  }

  const std::string database_ = folder_.file("tribodyn.db"), log_file_ = database_ + "-wal";
  v1::Simulation later_;
};

TEST_F(ReplacedDatabaseTest, DoesNotGetTheWriteAheadLogOfTheFormerOne) {
  replace();
  process_->signal(SIGTERM);
  EXPECT_EQ(process_->wait(), 0) << process_->log();
  ASSERT_EQ(logs_left().size(), 1U);
  EXPECT_THAT(process_->log(), HasSubstr(logs_left().front()));
  start();
  expect_backup();
}

TEST_F(ReplacedDatabaseTest, TheFormerOneUnderAnotherNameIsWholeWithItsLog) {
  std::filesystem::rename(database_, database_ + ".former");
  replace();
  process_->signal(SIGTERM);
  process_->wait();
  ASSERT_EQ(logs_left().size(), 1U);
  for (const char* suffix : {"", "-shm"}) std::filesystem::remove(database_ + suffix);
  std::filesystem::rename(folder_.file(logs_left().front()), log_file_);
  std::filesystem::rename(database_ + ".former", database_);
  EXPECT_EQ(run({"check", "--database", database_}), "0 ");
  start();
  EXPECT_EQ(get(later_.name()).state(), v1::Simulation::SUCCEEDED);
}

TEST_F(ReplacedDatabaseTest, IsRefusedBesideTheLogOfAServerThatWasKilled) {
  process_->signal(SIGKILL);
  process_->wait();
  replace();
  const testing::Matcher<std::string> is_refused =
      testing::AllOf(testing::StartsWith("3 "), HasSubstr("is another file than the one that"),
                     HasSubstr("move " + log_file_ + " elsewhere"));
  EXPECT_THAT(run(flags()), is_refused);
  EXPECT_THAT(run(flags()), is_refused) << "the first refusal changed nothing";
  EXPECT_THAT(run({"check", "--database", database_}), is_refused);
  EXPECT_THAT(run({"backup", "--database", database_, folder_.file("another")}), is_refused);
  EXPECT_THAT(run({"restore", "--database", database_, folder_.file("copy")}), is_refused);
  std::filesystem::rename(log_file_, log_file_ + ".elsewhere");
  start();
  expect_backup();
}

TEST_F(ReplacedDatabaseTest, BothFilesMayBeMovedTogetherAfterAKill) {
  process_->signal(SIGKILL);
  process_->wait();
  for (const std::string& file : {database_, log_file_}) {
    std::filesystem::copy_file(file, file + ".tmp");
    std::filesystem::rename(file + ".tmp", file);
  }
  start();
  EXPECT_EQ(get(later_.name()).state(), v1::Simulation::SUCCEEDED);
}

TEST_F(DaemonTest, ADatabaseInUseIsRefusedUnderEveryName) {
  const std::string database = folder_.file("tribodyn.db");
  const std::string linked = folder_.file("linked.db");
  std::filesystem::create_hard_link(database, linked);
  const auto refusal_of = [&](const std::vector<std::string>& arguments) {
    std::filesystem::remove(folder_.file("second.log"));
    ServerProcess second(arguments, folder_.file("second.log"));
    const int code = second.wait();
    return std::to_string(code) + " " + second.log();
  };
  const testing::Matcher<std::string> is_refused =
      testing::AllOf(testing::StartsWith("3 "), HasSubstr("in use by another tribodynd"));
  EXPECT_THAT(refusal_of({"--listen", "127.0.0.1:0", "--database", linked}), is_refused);
  EXPECT_EQ(refusal_of({"backup", "--database", database, folder_.file("copy")}), "0 ");
  std::filesystem::remove(database + ".lock");
  EXPECT_THAT(refusal_of({"--listen", "127.0.0.1:0", "--database", database}), is_refused);
  EXPECT_THAT(refusal_of({"restore", "--database", database, folder_.file("copy")}), is_refused);
  v1::Simulation created;
  EXPECT_TRUE(create(point_simulation(), &created).ok()) << "the first one is not disturbed";
}

TEST(Flags, AStartWaitsForACommandThatHasTheDatabaseForAMoment) {
  const TemporaryFolder folder;
  const std::string database = folder.file("db");
  { Store store(database); }
  std::optional<DatabaseLock> command(database);
  std::thread ends([&command] {
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    command.reset();
  });
  EXPECT_NO_THROW(Store(database, schema_steps(), std::chrono::seconds(10)));
  ends.join();
}

TEST_F(DaemonTest, ASecondServerOnTheSameDatabaseOrPortIsRefused) {
  ServerProcess same_database(
      {"--listen", "127.0.0.1:0", "--database", folder_.file("tribodyn.db")},
      folder_.file("second.log"));
  EXPECT_EQ(same_database.wait(), 3);
  EXPECT_THAT(same_database.log(), HasSubstr("in use by another tribodynd"));
  ServerProcess same_port({"--listen", address_, "--database", folder_.file("other.db")},
                          folder_.file("third.log"));
  EXPECT_EQ(same_port.wait(), 4);
  EXPECT_THAT(same_port.log(), HasSubstr("cannot listen on " + address_));
}

/// Limits the size of files that this process, and one that it starts meanwhile, may write. A
/// process that does not handle the signal is killed at the limit.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) {
    std::signal(SIGXFSZ, SIG_DFL);
    getrlimit(RLIMIT_FSIZE, &former_);
    const rlimit limit{bytes, former_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileSizeLimit() { setrlimit(RLIMIT_FSIZE, &former_); }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;

 private:
  rlimit former_{};
};

class FileSizeLimitTest : public DaemonTest {
 protected:
  void SetUp() override {
    const FileSizeLimit limit(2'000'000);
    start();
  }
};

TEST_F(FileSizeLimitTest, AFileSizeLimitIsReportedAsAFullDisk) {
  v1::BatchCreateLubricantsRequest batch;
  v1::Lubricant fluid = seed<v1::Lubricant>("lubricants/paper-fluid-1");
  fluid.set_description(std::string(4000, 'x'));
  for (int i = 0; i < 600; ++i) {
    fluid.set_name("lubricants/batch-" + std::to_string(i));
    *batch.add_requests()->mutable_lubricant() = fluid;
  }
  grpc::ClientContext context;
  v1::BatchCreateLubricantsResponse response;
  const grpc::Status status =
      v1::LubricantService::NewStub(channel_)->BatchCreateLubricants(&context, batch, &response);
  EXPECT_EQ(status.error_code(), grpc::StatusCode::UNAVAILABLE) << status.error_message();
  EXPECT_TRUE(process_->running()) << process_->log();
  EXPECT_EQ(count_of_lubricants("name:batch-"), 0);
  v1::Simulation created;
  EXPECT_TRUE(create(point_simulation(), &created).ok()) << "what is small has room";
}

class UnixSocketTest : public GrpcTest {
 protected:
  void SetUp() override {
    listen_ = "unix:" + folder_.file("socket");
    start();
  }
};

TEST_F(UnixSocketTest, ServesOnASocketOfItsOwnerAndRemovesIt) {
  EXPECT_EQ(address_, listen_);
  v1::Simulation created;
  EXPECT_TRUE(create(point_simulation(), &created).ok());
  const auto mode = std::filesystem::status(folder_.file("socket")).permissions();
  EXPECT_EQ(mode & std::filesystem::perms::group_all, std::filesystem::perms::none);
  EXPECT_EQ(mode & std::filesystem::perms::others_all, std::filesystem::perms::none);
  ServerProcess second({"--listen", listen_, "--database", folder_.file("other.db")},
                       folder_.file("second.log"));
  EXPECT_EQ(second.wait(), 4);
  EXPECT_THAT(second.log(), HasSubstr("in use by another server"));
  process_->signal(SIGKILL);
  process_->wait();
  start();  // the socket of the killed server does not prevent the start
  process_->signal(SIGINT);
  EXPECT_EQ(process_->wait(), 0);
  EXPECT_FALSE(std::filesystem::exists(folder_.file("socket")));
}

int run_briefly(const std::vector<std::string>& arguments, std::string* log) {
  const TemporaryFolder folder;
  ServerProcess process(arguments, folder.file("log"));
  const int code = process.wait();
  *log = process.log();
  return code;
}

TEST(Flags, AddressesOtherThanLoopbackAreRefusedWithoutTls) {
  const TemporaryFolder folder;
  for (const char* address : {"0.0.0.0:50651", "192.168.1.5:50651", "[::]:50651", "example.com:80",
                              "10.0.0.1:0", "*:50651"}) {
    std::string log;
    EXPECT_EQ(run_briefly({"--listen", address, "--database", folder.file("db")}, &log), 4);
    EXPECT_THAT(log, HasSubstr("refusing to listen")) << address;
    EXPECT_FALSE(std::filesystem::exists(folder.file("db"))) << "refused before anything is made";
  }
}

TEST(Flags, AddressesOfAllFormsAreAccepted) {
  EXPECT_EQ(to_text(parse_listen_address("localhost:7")), "127.0.0.1:7");
  EXPECT_EQ(to_text(parse_listen_address("127.3.2.1:0")), "127.3.2.1:0");
  EXPECT_EQ(to_text(parse_listen_address("[::1]:50651")), "[::1]:50651");
  EXPECT_EQ(to_text(parse_listen_address("unix:/a/b")), "unix:/a/b");
  for (const std::string& bad :
       {std::string("127.0.0.1"), std::string("127.0.0.1:"), std::string("127.0.0.1:70000"),
        std::string("127.0.0.1:-1"), std::string("127.0.0.1:1x"), std::string("::1:50651"),
        std::string("[::1]"), std::string(""), std::string("unix:"), std::string(":80"),
        "unix:/" + std::string(200, 'x')}) {
    EXPECT_THROW(parse_listen_address(bad), ListenError) << bad;
  }
}

/// Sets a variable of the environment while the object exists.
class Variable {
 public:
  Variable(const char* name, const std::string& value) : name_(name) {
    setenv(name, value.c_str(), 1);
  }
  ~Variable() { unsetenv(name_); }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;

 private:
  const char* name_;
};

TEST(Flags, OverrideTheEnvironmentWhichOverridesTheFile) {
  const TemporaryFolder folder;
  const std::string file = folder.file("tribodynd.conf");
  std::ofstream(file) << "database = \"" << folder.file("db") << "\"\nlisten = \"from.file:1\"\n";
  std::string log;
  EXPECT_EQ(run_briefly({"--config", file, "--check"}, &log), 4);
  EXPECT_THAT(log, HasSubstr("from.file:1"));
  const Variable listen("TRIBODYND_LISTEN", "from.environment:1");
  EXPECT_EQ(run_briefly({"--config", file, "--check"}, &log), 4);
  EXPECT_THAT(log, HasSubstr("from.environment:1"));
  EXPECT_EQ(run_briefly({"--config", file, "--listen", "127.0.0.1:0", "--check"}, &log), 0) << log;
  const Variable config("TRIBODYND_CONFIG", folder.file("nothing"));
  EXPECT_EQ(run_briefly({"--check"}, &log), 2) << "a file that is named must be there";
}

TEST(Flags, ACheckFindsProblemsAndCreatesNothing) {
  const TemporaryFolder folder;
  std::string log;
  EXPECT_EQ(run_briefly({"--database", folder.file("db"), "--check"}, &log), 0) << log;
  EXPECT_FALSE(std::filesystem::exists(folder.file("db")));
  EXPECT_EQ(run_briefly({"--database", folder.file("no/db"), "--check"}, &log), 3);
  std::ofstream(folder.file("db.replaced")) << "a database";
  EXPECT_EQ(run_briefly({"--database", folder.file("db"), "--check"}, &log), 3);
  EXPECT_THAT(log, HasSubstr("db.replaced"));
  std::ofstream(folder.file("text")) << std::string(9000, 'x');
  EXPECT_EQ(run_briefly({"--database", folder.file("text"), "--check"}, &log), 3);
  std::ofstream(folder.file("conf")) << "thread = 2\n";
  EXPECT_EQ(run_briefly({"--config", folder.file("conf"), "--check"}, &log), 2);
  EXPECT_THAT(log, HasSubstr("thread"));
}

TEST(Flags, ADatabaseOfAnotherVersionHasAnExitCodeOfItsOwn) {
  const TemporaryFolder folder;
  const std::string database = folder.file("db");
  { Store store(database); }
  SQLite::Database(database, SQLite::OPEN_READWRITE).exec("DELETE FROM format");
  const std::vector<std::vector<std::string>> uses = {
      {}, {"--check"}, {"check"}, {"tokens", "list"}};
  for (std::vector<std::string> arguments : uses) {
    arguments.insert(arguments.end(), {"--database", database});
    std::string log;
    EXPECT_EQ(run_briefly(arguments, &log), 6) << log;
    EXPECT_THAT(log, HasSubstr(database + " was written by another development version"));
  }
}

TEST(Flags, TooFewDescriptorsRefuseTheStart) {
  const TemporaryFolder folder;
  ServerProcess process({"--listen", "127.0.0.1:0", "--database", folder.file("db")},
                        folder.file("log"), 64);
  EXPECT_EQ(process.wait(), 4);
  EXPECT_THAT(process.log(), HasSubstr("open files is 64"));
}

TEST(Flags, APortFileDoesNotWriteThroughALink) {
  const TemporaryFolder folder;
  const std::string victim = folder.file("victim"), port = folder.file("port");
  std::ofstream(victim) << "kept";
  std::filesystem::create_symlink(victim, port + ".new");
  ServerProcess process(
      {"--listen", "127.0.0.1:0", "--database", folder.file("db"), "--port-file", port},
      folder.file("log"));
  EXPECT_TRUE(eventually([&] { return std::filesystem::exists(port); }));
  std::ifstream file(victim);
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(file), {}), "kept");
}

TEST(Flags, TheServiceManagerIsNotifiedOfStartAndStop) {
  const TemporaryFolder folder;
  const std::string path = folder.file("notify");
  const int receiver = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  sockaddr_un name{};
  name.sun_family = AF_UNIX;
  path.copy(name.sun_path, sizeof(name.sun_path) - 1);
  ASSERT_EQ(bind(receiver, reinterpret_cast<const sockaddr*>(&name), sizeof(name)), 0);
  const Variable notify("NOTIFY_SOCKET", path);
  ServerProcess process({"--listen", "127.0.0.1:0", "--database", folder.file("db")},
                        folder.file("log"));
  const auto heard = [receiver] {
    char text[64] = {};
    return std::string(text, static_cast<std::size_t>(recv(receiver, text, sizeof(text), 0)));
  };
  EXPECT_EQ(heard(), "READY=1");
  process.signal(SIGTERM);
  EXPECT_EQ(heard(), "STOPPING=1");
  EXPECT_EQ(process.wait(), 0);
  close(receiver);
}

TEST(Flags, MistakesAreExplained) {
  std::string log;
  EXPECT_EQ(run_briefly({}, &log), 2);
  EXPECT_THAT(log, HasSubstr("--database"));
  EXPECT_EQ(run_briefly({"--database", "x", "--threads", "many"}, &log), 2);
  EXPECT_EQ(run_briefly({"--database", "x", "--call-limit-seconds", "nan"}, &log), 2);
  EXPECT_THAT(log, HasSubstr("nan is not a number from 0 to 86400"));
  EXPECT_EQ(run_briefly({"--database", "x", "--disk-budget-megabytes", "-1"}, &log), 2);
  EXPECT_EQ(run_briefly({"--config", "/dev/zero"}, &log), 2);
  EXPECT_THAT(log, HasSubstr("/dev/zero is not a regular file"));
  EXPECT_EQ(run_briefly({"--database", "/no/such/folder/x.db"}, &log), 3);
  EXPECT_THAT(log, HasSubstr("/no/such/folder/x.db"));
  EXPECT_EQ(run_briefly({"--version"}, &log), 0);
  EXPECT_THAT(log, HasSubstr("tribodyn-model-"));
  EXPECT_EQ(run_briefly({"--help"}, &log), 0);
}

}  // namespace
}  // namespace tribodyn::server
