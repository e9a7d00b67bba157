// Who reaches a running server: tokens, the commands that change them, and its Unix socket.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <thread>

#include "tests/service/contract_methods.h"
#include "tests/service/grpc_fixture.h"
#include "tests/service/raw_client.h"
#include "tribodyn/v1/lubricants.grpc.pb.h"

namespace tribodyn::server {
namespace {

using grpc::StatusCode;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

class AccessTest : public GrpcTest {
 protected:
  void SetUp() override {
    listen_ = "127.0.0.1:0,unix:" + folder_.file("socket");
    more_flags_ = {"--projects", "axles"};
    start();
  }

  /// Runs `tribodynd tokens` on the database. Returns what it prints, without the line feed.
  std::string tokens(std::vector<std::string> words, int expected_code = 0) {
    words.insert(words.begin(), "tokens");
    words.insert(words.end(), {"--database", folder_.file("tribodyn.db")});
    const std::string log = folder_.file("tokens." + std::to_string(++commands_));
    ServerProcess command(words, log);
    EXPECT_EQ(command.wait(), expected_code) << command.log();
    std::string out = command.log();
    if (!out.empty()) out.pop_back();
    return out;
  }
  StatusCode get_with(const std::string& token, const std::string& name = "lubricants/x") const {
    grpc::ClientContext context;
    v1::GetLubricantRequest request;
    request.set_name(name);
    v1::Lubricant answer;
    return v1::LubricantService::NewStub(connect_with(address_, token))
        ->GetLubricant(&context, request, &answer)
        .error_code();
  }
  StatusCode create_with(const std::string& token) const {
    grpc::ClientContext context;
    v1::Lubricant answer;
    return v1::LubricantService::NewStub(connect_with(address_, token))
        ->CreateLubricant(&context, {}, &answer)
        .error_code();
  }
  std::string file_text(const std::string& name) const {
    std::stringstream out;
    out << std::ifstream(folder_.file(name)).rdbuf();
    return out.str();
  }

  int commands_ = 0;
};

TEST_F(AccessTest, TheFirstStartMakesATokenThatOnlyTheOwnerReads) {
  struct stat found {};
  ASSERT_EQ(stat(folder_.file("tribodyn.db.token").c_str(), &found), 0);
  EXPECT_EQ(found.st_mode & 0777, 0600U);
  const std::string secret = owner_token();
  EXPECT_THAT(secret, StartsWith("tribodyn_"));
  EXPECT_EQ(secret.size(), 9 + 64U);
  EXPECT_EQ(get_with(secret), StatusCode::NOT_FOUND);
  process_->signal(SIGTERM);
  ASSERT_EQ(process_->wait(), 0);
  start();
  EXPECT_EQ(owner_token(), secret) << "the second start keeps it";
  EXPECT_EQ(get_with(secret), StatusCode::NOT_FOUND);
  EXPECT_THAT(process_->log(), Not(HasSubstr(secret)));
  EXPECT_THAT(file_text("tribodyn.db"), Not(HasSubstr(secret))) << "only its hash is stored";
}

TEST_F(AccessTest, ANewOwnersTokenReplacesALostOne) {
  const std::string lost = owner_token();
  process_->signal(SIGTERM);
  ASSERT_EQ(process_->wait(), 0);
  std::filesystem::remove(folder_.file("tribodyn.db.token"));
  start();
  EXPECT_NE(owner_token(), lost);
  EXPECT_EQ(get_with(owner_token()), StatusCode::NOT_FOUND);
  EXPECT_EQ(get_with(lost), StatusCode::UNAUTHENTICATED);
}

TEST_F(AccessTest, ATokenFileThatOthersReadPreventsTheStart) {
  process_->signal(SIGTERM);
  ASSERT_EQ(process_->wait(), 0);
  std::filesystem::permissions(
      folder_.file("tribodyn.db.token"),
      std::filesystem::perms::owner_all | std::filesystem::perms::others_read);
  ServerProcess again(flags(), folder_.file("again.log"));
  EXPECT_EQ(again.wait(), 3);
  EXPECT_THAT(again.log(), HasSubstr("may be read or written by others"));
}

TEST_F(AccessTest, LoopbackNeedsATokenAndTheOwnersSocketDoesNot) {
  EXPECT_EQ(get_with(""), StatusCode::UNAUTHENTICATED);
  EXPECT_EQ(get_with("tribodyn_" + std::string(64, '0')), StatusCode::UNAUTHENTICATED);
  address_ = "unix:" + folder_.file("socket");
  EXPECT_EQ(get_with(""), StatusCode::NOT_FOUND);
}

TEST_F(AccessTest, EveryMethodIsRefusedToNobody) {
  RawClient nobody(connect_with(address_, ""));
  for (const auto* method : all_methods()) {
    if (method->server_streaming()) continue;  // RawClient makes unary calls
    const grpc::Status status = nobody.call(path_of(*method), "").first;
    EXPECT_EQ(status.error_code(), StatusCode::UNAUTHENTICATED) << method->name();
    EXPECT_THAT(status.error_message(), HasSubstr("TRIBODYN_TOKEN_FILE"));
  }
}

TEST_F(AccessTest, ATokenHoldsFromTheEndOfItsCreationToTheEndOfItsRevocation) {
  const std::string secret = tokens({"create", "anna-laptop", "--scope", "read"});
  EXPECT_EQ(get_with(secret), StatusCode::NOT_FOUND);
  EXPECT_EQ(create_with(secret), StatusCode::PERMISSION_DENIED);
  EXPECT_THAT(tokens({"create", "anna-laptop"}, 1), HasSubstr("anna-laptop has a valid token"));
  EXPECT_THAT(tokens({"list"}), HasSubstr("anna-laptop"));
  EXPECT_THAT(tokens({"list"}), Not(HasSubstr(secret)));
  EXPECT_EQ(tokens({"revoke", "anna-laptop"}), "");
  EXPECT_EQ(get_with(secret), StatusCode::UNAUTHENTICATED);
  EXPECT_THAT(tokens({"revoke", "anna-laptop"}, 1), HasSubstr("has no valid token"));
  EXPECT_THAT(tokens({"list"}), HasSubstr("revoked"));
  process_->signal(SIGTERM);
  ASSERT_EQ(process_->wait(), 0);
  const std::string other = tokens({"create", "bert", "--projects", "axles"});
  start();
  EXPECT_EQ(get_with(secret), StatusCode::UNAUTHENTICATED) << "a restart revives no token";
  EXPECT_EQ(get_with(other), StatusCode::PERMISSION_DENIED) << "made without a server";
  EXPECT_EQ(get_with(other, "projects/axles/lubricants/x"), StatusCode::NOT_FOUND);
  EXPECT_THAT(process_->log(), Not(HasSubstr(secret)));
}

TEST_F(AccessTest, ARotatedTokenIsReplacedAtOnceOrAfterAnOverlap) {
  const std::string first = tokens({"create", "anna", "--expire-days", "0"});
  const std::string second = tokens({"rotate", "anna"});
  EXPECT_EQ(get_with(first), StatusCode::UNAUTHENTICATED);
  EXPECT_EQ(get_with(second), StatusCode::NOT_FOUND);
  const std::string third = tokens({"rotate", "anna", "--overlap-hours", "1"});
  EXPECT_EQ(get_with(second), StatusCode::NOT_FOUND);
  EXPECT_EQ(get_with(third), StatusCode::NOT_FOUND);
  tokens({"revoke", "anna"});
  EXPECT_EQ(get_with(second), StatusCode::UNAUTHENTICATED) << "revoked with the name";
  EXPECT_EQ(get_with(third), StatusCode::UNAUTHENTICATED);
  const std::string owner = owner_token();
  EXPECT_EQ(tokens({"rotate", "owner"}), "");
  EXPECT_NE(owner_token(), owner);
  EXPECT_EQ(get_with(owner), StatusCode::UNAUTHENTICATED);
  EXPECT_EQ(get_with(owner_token()), StatusCode::NOT_FOUND);
}

TEST_F(AccessTest, OneCommandClosesEveryWayInOfALostLaptop) {
  v1::Simulation running;
  ASSERT_TRUE(create(long_simulation(), &running).ok());
  const std::string secret = tokens({"create", "laptop"});
  const auto stub = v1::SimulationService::NewStub(connect_with(address_, secret));
  grpc::ClientContext one, many;
  v1::WatchSimulationRequest watch_one;
  watch_one.set_name(running.name());
  const auto first = stub->WatchSimulation(&one, watch_one);
  v1::WatchSimulationsRequest watch_many;
  watch_many.add_names(running.name());
  const auto second = stub->WatchSimulations(&many, watch_many);
  v1::SimulationEvent event;
  ASSERT_TRUE(first->Read(&event));
  ASSERT_TRUE(second->Read(&event));
  tokens({"revoke", "laptop"});
  const auto begin = std::chrono::steady_clock::now();
  while (first->Read(&event)) {
  }
  while (second->Read(&event)) {
  }
  EXPECT_EQ(first->Finish().error_code(), StatusCode::UNAUTHENTICATED);
  EXPECT_EQ(second->Finish().error_code(), StatusCode::UNAUTHENTICATED);
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(10))
      << "before the next heartbeat";
  EXPECT_EQ(get_with(secret), StatusCode::UNAUTHENTICATED);
  EXPECT_EQ(get(running.name()).state(), v1::Simulation::RUNNING) << "the owner goes on";
  cancel(running.name());
}

TEST_F(AccessTest, TheAuditSaysWhoDidWhatToWhichNameAndNothingElse) {
  const std::string secret = tokens({"create", "anna"});
  const std::string reader = tokens({"create", "bert", "--scope", "read"});
  const auto create_fluid = [&](const std::string& token, const std::string& name) {
    v1::CreateLubricantRequest request;
    request.mutable_lubricant()->set_name("lubricants/" + name);
    request.mutable_lubricant()->set_display_name("the-secret-formulation");
    auto& measured = *request.mutable_lubricant()->mutable_measurements();
    measured.set_kinematic_viscosity_40_celsius_square_millimetres_per_second(73.3);
    measured.set_kinematic_viscosity_100_celsius_square_millimetres_per_second(8.86);
    measured.set_density_15_celsius_kilograms_per_cubic_metre(870);
    grpc::ClientContext context;
    v1::Lubricant answer;
    return v1::LubricantService::NewStub(connect_with(address_, token))
        ->CreateLubricant(&context, request, &answer)
        .error_code();
  };
  EXPECT_EQ(create_fluid(secret, "annas-oil"), StatusCode::OK);
  EXPECT_EQ(create_fluid(secret, "annas-oil"), StatusCode::ALREADY_EXISTS);
  EXPECT_EQ(create_fluid(secret, "x\ny z=1"), StatusCode::INVALID_ARGUMENT);
  EXPECT_EQ(create_fluid(reader, "berts-oil"), StatusCode::PERMISSION_DENIED);
  v1::Simulation simulation;
  EXPECT_TRUE(create(point_simulation(), &simulation).ok());
  get(simulation.name());
  tokens({"revoke", "anna"});
  const std::string audit = file_text("tribodyn.db.audit");
  for (const char* part :
       {"principal=owner project=default method=tokens-create code=OK names=anna ",
        "principal=anna project=default method=CreateLubricant code=OK names=lubricants/annas-oil ",
        "method=CreateLubricant code=ALREADY_EXISTS names=lubricants/annas-oil ",
        "principal=bert project=default method=CreateLubricant code=PERMISSION_DENIED names=- ",
        "principal=owner project=default method=CreateSimulation code=OK names=simulations/1 ",
        "method=tokens-revoke code=OK names=anna "}) {
    EXPECT_THAT(audit, HasSubstr(part));
  }
  EXPECT_EQ(std::count(audit.begin(), audit.end(), '\n'), 8) << audit;
  struct stat found {};
  ASSERT_EQ(stat(folder_.file("tribodyn.db.audit").c_str(), &found), 0);
  EXPECT_EQ(found.st_mode & 0777, 0600U);
  for (const std::string& text : {audit, process_->log()}) {
    for (const std::string& unwanted :
         {secret, reader, owner_token(), std::string("the-secret-formulation"),
          std::string("73.3")}) {
      EXPECT_THAT(text, Not(HasSubstr(unwanted)));
    }
  }
  // As by a program that rotates logs.
  std::filesystem::rename(folder_.file("tribodyn.db.audit"), folder_.file("tribodyn.db.audit.1"));
  EXPECT_EQ(create_fluid(reader, "carls-oil"), StatusCode::PERMISSION_DENIED);
  const std::string after = file_text("tribodyn.db.audit");
  EXPECT_THAT(after, HasSubstr("principal=bert project=default method=CreateLubricant"));
  EXPECT_EQ(std::count(after.begin(), after.end(), '\n'), 1) << after;
}

TEST_F(AccessTest, TheSocketIsClosedToOtherUsersWhateverItsMode) {
  if (geteuid() != 0) GTEST_SKIP() << "only root can become another user";
  const std::string path = folder_.file("socket");
  ASSERT_EQ(chmod(folder_.path().c_str(), 0777), 0);
  ASSERT_EQ(chmod(path.c_str(), 0777), 0);
  const pid_t child = fork();
  if (child == 0) {
    // The preface of HTTP/2 is answered by a server that keeps the connection.
    constexpr char kPreface[] = "PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n\0\0\0\4\0\0\0\0\0";
    sockaddr_un name{};
    name.sun_family = AF_UNIX;
    std::strncpy(name.sun_path, path.c_str(), sizeof(name.sun_path) - 1);
    const int connection = socket(AF_UNIX, SOCK_STREAM, 0);
    if (setuid(65534) != 0) _exit(3);
    if (connect(connection, reinterpret_cast<const sockaddr*>(&name), sizeof(name)) != 0) _exit(4);
    send(connection, kPreface, sizeof(kPreface) - 1, MSG_NOSIGNAL);
    char byte = 0;
    _exit(recv(connection, &byte, 1, 0) <= 0 ? 0 : 5);
  }
  int status = -1;
  waitpid(child, &status, 0);
  EXPECT_EQ(WEXITSTATUS(status), 0);
  EXPECT_TRUE(eventually(
      [&] { return process_->log().find("cause=\"another user\"") != std::string::npos; }));
}

}  // namespace
}  // namespace tribodyn::server
