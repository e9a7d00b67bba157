// The life of the process: kill, termination, a second server, flags and addresses.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <thread>

#include "server/api/listen_address.h"
#include "tests/service/grpc_fixture.h"
#include "tests/service/raw_client.h"
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
      const auto stub = v1::Lubricants::NewStub(channel_);
      const grpc::Status status = stub->ListLubricants(&context, request, &page);
      EXPECT_TRUE(status.ok()) << status.error_message();
      count += page.lubricants_size();
      request.set_page_token(page.next_page_token());
    } while (!request.page_token().empty());
    return count;
  }
};

TEST_F(DaemonTest, ResultsSurviveAKillAndUnfinishedWorkIsTakenUpAgain) {
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

TEST_F(DaemonTest, AKillInTheMiddleOfABatchLeavesNothingHalfWritten) {
  constexpr int kSize = 2000;
  v1::BatchCreateLubricantsRequest batch;
  v1::Lubricant fluid = seed<v1::Lubricant>("lubricants/1");
  for (int i = 0; i < kSize; ++i) {
    fluid.set_name("lubricants/batch-" + std::to_string(i));
    *batch.add_requests()->mutable_lubricant() = fluid;
  }
  // Killed ever later, until a batch has been written before.
  for (std::chrono::milliseconds delay(2);; delay += delay / 2) {
    grpc::Status status;
    std::thread sender([&] {
      grpc::ClientContext context;
      v1::BatchCreateLubricantsResponse response;
      status = v1::Lubricants::NewStub(channel_)->BatchCreateLubricants(&context, batch, &response);
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

TEST_F(DaemonTest, ATerminationEndsStreamsAndKeepsWorkForTheNextStart) {
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

TEST_F(DaemonTest, ABackupIsTakenWhileItRunsAndRestoredOnceItHasStopped) {
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
  EXPECT_EQ(run({"restore", "--database", database, folder_.file("copy")}), "0 ");
  start();
  v1::ListSimulationsResponse list;
  grpc::ClientContext context;
  ASSERT_TRUE(simulations_->ListSimulations(&context, {}, &list).ok());
  EXPECT_EQ(list.simulations_size(), 0) << "made after the backup";
  EXPECT_THAT(run({"check", "--database", folder_.file("nothing")}), HasSubstr("3 "));
  EXPECT_THAT(run({"backup", "--database", database}), HasSubstr("FILE is required"));
  EXPECT_THAT(run({}), HasSubstr("--database is required"));
}

TEST_F(DaemonTest, ASecondServerOnTheSameDatabaseOrPortSaysSo) {
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

class UnixSocketTest : public GrpcTest {
 protected:
  void SetUp() override {
    listen_ = "unix:" + folder_.file("socket");
    start();
  }
};

TEST_F(UnixSocketTest, ServesOnASocketOfItsOwnerAndTidiesUp) {
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
  start();  // the socket that a kill left behind is no obstacle
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

TEST(Flags, AnyAddressButLoopbackIsRefused) {
  const TemporaryFolder folder;
  for (const char* address : {"0.0.0.0:50651", "192.168.1.5:50651", "[::]:50651", "example.com:80",
                              "10.0.0.1:0", "*:50651"}) {
    std::string log;
    EXPECT_EQ(run_briefly({"--listen", address, "--database", folder.file("db")}, &log), 4);
    EXPECT_THAT(log, HasSubstr("refusing to listen")) << address;
    EXPECT_FALSE(std::filesystem::exists(folder.file("db"))) << "refused before anything is made";
  }
}

TEST(Flags, AddressesAreUnderstood) {
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

TEST(Flags, MistakesAreExplained) {
  std::string log;
  EXPECT_EQ(run_briefly({}, &log), 2);
  EXPECT_THAT(log, HasSubstr("--database"));
  EXPECT_EQ(run_briefly({"--database", "x", "--threads", "many"}, &log), 2);
  EXPECT_EQ(run_briefly({"--database", "/no/such/folder/x.db"}, &log), 3);
  EXPECT_THAT(log, HasSubstr("/no/such/folder/x.db"));
  EXPECT_EQ(run_briefly({"--version"}, &log), 0);
  EXPECT_THAT(log, HasSubstr("tribodyn-model-"));
  EXPECT_EQ(run_briefly({"--help"}, &log), 0);
}

}  // namespace
}  // namespace tribodyn::server
