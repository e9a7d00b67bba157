#include "client/cpp/service/follow.h"

#include <grpcpp/grpcpp.h>
#include <gtest/gtest.h>

#include <atomic>
#include <csignal>
#include <map>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "client/cpp/failure.h"
#include "tribodyn/v1/simulations.grpc.pb.h"

namespace tribodyn::client {
namespace {

using State = v1::Simulation::State;

/// A server with scripted watch streams, to reproduce failures that are rare with a real server.
class ScriptedServer final : public v1::SimulationService::Service {
 public:
  /// The script of one watch: it sends these states, then ends with a status or waits for its
  /// cancellation.
  struct Watch {
    std::vector<State> states;
    grpc::Status end;
    bool hangs = false;
  };

  ScriptedServer() {
    grpc::ServerBuilder builder;
    int port = 0;
    builder.AddListeningPort("127.0.0.1:0", grpc::InsecureServerCredentials(), &port);
    builder.RegisterService(this);
    server_ = builder.BuildAndStart();
    address_ = "127.0.0.1:" + std::to_string(port);
  }
  ~ScriptedServer() override { server_->Shutdown(); }

  const std::string& address() const { return address_; }
  int watches() const { return watches_; }
  bool hanging() const { return hanging_; }
  /// The n-th watch follows the n-th script; later watches follow the last one.
  std::vector<Watch> scripts;
  int ends_at_get = 1;  ///< first call of GetSimulation that returns an ended simulation
  std::atomic<bool> is_frozen = false;  ///< GetSimulation does not answer

  grpc::Status WatchSimulations(grpc::ServerContext* context,
                                const v1::WatchSimulationsRequest* request,
                                grpc::ServerWriter<v1::SimulationEvent>* writer) override {
    const std::size_t index = std::min<std::size_t>(watches_++, scripts.size() - 1);
    const Watch& script = scripts[index];
    for (const State state : script.states) {
      for (const std::string& name : request->names()) {
        v1::SimulationEvent event;
        // As the server: the project `default` is left out.
        event.set_name(request->parent() == "projects/default" ? name
                                                               : request->parent() + "/" + name);
        event.set_state(state);
        writer->Write(event);
      }
    }
    while (script.hangs && !context->IsCancelled()) {
      hanging_ = true;
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return script.end;
  }

  grpc::Status GetSimulation(grpc::ServerContext* context, const v1::GetSimulationRequest* request,
                             v1::Simulation* simulation) override {
    while (is_frozen && !context->IsCancelled()) {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    simulation->set_name(request->name());
    simulation->set_state(++gets_ < ends_at_get ? v1::Simulation::RUNNING
                                                : v1::Simulation::SUCCEEDED);
    return grpc::Status::OK;
  }

 private:
  std::unique_ptr<grpc::Server> server_;
  std::string address_;
  std::atomic<int> watches_ = 0;
  std::atomic<int> gets_ = 0;
  std::atomic<bool> hanging_ = false;
};

std::vector<v1::Simulation> queued(const std::vector<std::string>& names) {
  std::vector<v1::Simulation> simulations;
  for (const std::string& name : names) {
    simulations.emplace_back().set_name("simulations/" + name);
    simulations.back().set_state(v1::Simulation::QUEUED);
  }
  return simulations;
}

TEST(Follow, ReturnsEverySimulationWhenAllHaveEnded) {
  ScriptedServer server;
  server.scripts = {{{v1::Simulation::RUNNING, v1::Simulation::SUCCEEDED}, grpc::Status::OK}};
  Connection connection(server.address(), std::chrono::seconds(10));
  const auto ended = follow(connection, queued({"a", "b"}), {"a", "b"}, ProgressForm::kNone);
  ASSERT_EQ(ended.size(), 2U);
  EXPECT_EQ(ended[1].name(), "simulations/b");
  EXPECT_EQ(server.watches(), 1) << "one stream for all";
}

TEST(Follow, OneStreamIsOfOneProject) {
  ScriptedServer server;
  server.scripts = {{{v1::Simulation::RUNNING, v1::Simulation::SUCCEEDED}, grpc::Status::OK}};
  Connection connection(server.address(), std::chrono::seconds(10), "acme");
  std::vector<std::string> told;
  connection.watch({"simulations/a", "projects/acme/simulations/b", "projects/other/simulations/a"},
                   [&](const v1::SimulationEvent& event) {
                     if (event.state() == v1::Simulation::SUCCEEDED) told.push_back(event.name());
                   });
  EXPECT_EQ(told, (std::vector<std::string>{"simulations/a", "simulations/b",
                                            "projects/other/simulations/a"}));
  EXPECT_EQ(server.watches(), 2);
}

TEST(Follow, ResumesABrokenStream) {
  ScriptedServer server;
  server.scripts = {{{v1::Simulation::RUNNING}, {grpc::StatusCode::UNAVAILABLE, "restarting"}},
                    {{}, grpc::Status::OK},
                    {{v1::Simulation::SUCCEEDED}, grpc::Status::OK}};
  Connection connection(server.address(), std::chrono::seconds(10));
  EXPECT_EQ(follow(connection, queued({"a"}), {"a"}, ProgressForm::kNone).size(), 1U);
  EXPECT_EQ(server.watches(), 3);
}

TEST(Follow, PausesBetweenWatchesThatTheServerEndsAtOnce) {
  ScriptedServer server;
  server.scripts = {{{}, {grpc::StatusCode::DEADLINE_EXCEEDED, "no stream may stay open"}}};
  server.ends_at_get = 3;
  Connection connection(server.address(), std::chrono::seconds(10));
  const auto start = std::chrono::steady_clock::now();
  EXPECT_EQ(follow(connection, queued({"a"}), {"a"}, ProgressForm::kNone).size(), 1U);
  EXPECT_EQ(server.watches(), 3) << "one GetSimulation follows each silent watch";
  // Two pauses of 250 ms or more.
  EXPECT_GE(std::chrono::steady_clock::now() - start, std::chrono::milliseconds(490));
}

TEST(Follow, StopsWaitingForAFrozenServer) {
  ScriptedServer server;
  server.scripts = {{{v1::Simulation::RUNNING}, grpc::Status::CANCELLED, true},
                    {{}, grpc::Status::CANCELLED, true}};
  server.is_frozen = true;
  Connection connection(server.address(), std::chrono::milliseconds(200));
  try {
    follow(connection, queued({"a"}), {"a"}, ProgressForm::kNone);
    FAIL() << "waited for a frozen server";
  } catch (const Failure& failure) {
    EXPECT_EQ(failure.exit_code(), kExitCannotConnect);
    EXPECT_NE(std::string(failure.what()).find("tribodyn jobs watch a"), std::string::npos);
  }
}

TEST(Follow, EndsOnAnErrorOfTheServer) {
  ScriptedServer server;
  server.scripts = {{{}, {grpc::StatusCode::NOT_FOUND, "no such simulation"}}};
  Connection connection(server.address(), std::chrono::seconds(10));
  try {
    follow(connection, queued({"a"}), {"a"}, ProgressForm::kNone);
    FAIL() << "an error was ignored";
  } catch (const Failure& failure) {
    EXPECT_EQ(failure.exit_code(), kExitFailed);
    EXPECT_NE(std::string(failure.what()).find("no such simulation"), std::string::npos);
  }
}

TEST(Follow, CtrlCPrintsTheCommandsThatWatchAndCancel) {
  ScriptedServer server;
  server.scripts = {{{v1::Simulation::RUNNING}, grpc::Status::CANCELLED, true}};
  Connection connection(server.address(), std::chrono::seconds(10));
  std::thread user([&] {
    while (!server.hanging()) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    std::raise(SIGINT);
  });
  try {
    follow(connection, queued({"job1"}), {"lubricants/paper-fluid-1"}, ProgressForm::kNone);
    ADD_FAILURE() << "Ctrl-C was ignored";
  } catch (const Failure& failure) {
    EXPECT_EQ(failure.exit_code(), kExitInterrupted);
    EXPECT_NE(std::string(failure.what()).find("tribodyn jobs watch job1"), std::string::npos);
    EXPECT_NE(std::string(failure.what()).find("tribodyn jobs cancel job1"), std::string::npos);
  }
  user.join();
}

}  // namespace
}  // namespace tribodyn::client
