#pragma once

#include <grpcpp/client_context.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "tests/service/server_process.h"
#include "tests/service/support.h"
#include "tribodyn/v1/simulations.grpc.pb.h"

namespace tribodyn::server {

/// A tribodynd on a free port over a temporary database, with a client.
class GrpcTest : public testing::Test {
 protected:
  void SetUp() override { start(); }

  std::vector<std::string> flags() const {
    std::vector<std::string> out = more_flags_;
    for (const std::string& each : common_flags()) out.push_back(each);
    return out;
  }

  std::vector<std::string> common_flags() const {
    return {"--listen",        listen_,
            "--database",      folder_.file("tribodyn.db"),
            "--port-file",     folder_.file("port"),
            "--log-level",     "debug",
            "--threads",       threads_,
            "--drain-seconds", drain_seconds_};
  }

  void start() {
    std::filesystem::remove(folder_.file("port"));
    process_ = std::make_unique<ServerProcess>(flags(), folder_.file("log"), maximum_files_);
    address_ = wait_for_address(folder_.file("port"), *process_);
    ASSERT_FALSE(address_.empty()) << process_->log();
    channel_ = connect(address_);
    simulations_ = v1::SimulationService::NewStub(channel_);
  }

  grpc::Status create(const v1::Simulation& simulation, v1::Simulation* out) {
    grpc::ClientContext context;
    v1::CreateSimulationRequest request;
    *request.mutable_simulation() = simulation;
    return simulations_->CreateSimulation(&context, request, out);
  }

  v1::Simulation get(const std::string& name) {
    grpc::ClientContext context;
    v1::GetSimulationRequest request;
    request.set_name(name);
    v1::Simulation out;
    const grpc::Status status = simulations_->GetSimulation(&context, request, &out);
    EXPECT_TRUE(status.ok()) << status.error_message();
    return out;
  }

  v1::Simulation cancel(const std::string& name) {
    grpc::ClientContext context;
    v1::CancelSimulationRequest request;
    request.set_name(name);
    v1::Simulation out;
    const grpc::Status status = simulations_->CancelSimulation(&context, request, &out);
    EXPECT_TRUE(status.ok()) << status.error_message();
    return out;
  }

  std::vector<v1::SimulationEvent> watch(const std::string& name, grpc::Status* status) {
    grpc::ClientContext context;
    v1::WatchSimulationRequest request;
    request.set_name(name);
    auto reader = simulations_->WatchSimulation(&context, request);
    std::vector<v1::SimulationEvent> events;
    for (v1::SimulationEvent event; reader->Read(&event);) events.push_back(event);
    *status = reader->Finish();
    return events;
  }

  TemporaryFolder folder_;
  std::string listen_ = "127.0.0.1:0";
  std::string threads_ = "2";
  std::string drain_seconds_ = "0.3";  // long enough for a point
  std::vector<std::string> more_flags_;
  int maximum_files_ = 0;  // 0: no limit
  std::unique_ptr<ServerProcess> process_;
  std::string address_;
  std::shared_ptr<grpc::Channel> channel_;
  std::unique_ptr<v1::SimulationService::Stub> simulations_;
};

}  // namespace tribodyn::server
