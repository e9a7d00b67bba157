// A result depends only on its inputs. It has the same bits on every server, with any number of
// threads, first or again, alone or beside others, from the cache or not.
#include <gtest/gtest.h>

#include <map>

#include "tests/service/grpc_fixture.h"
#include "tests/support/run_length.h"

namespace tribodyn::server {
namespace {

class SameBitsTest : public GrpcTest {
 protected:
  void SetUp() override {}

  /// A server with its own settings and database.
  class Server : public GrpcTest {
   public:
    explicit Server(const std::string& threads) { threads_ = threads; }
    void run() { start(); }
    void TestBody() override {}

    std::string submit(const v1::Simulation& simulation, bool force) {
      grpc::ClientContext context;
      v1::CreateSimulationRequest request;
      *request.mutable_simulation() = simulation;
      request.set_force(force);
      v1::Simulation out;
      const grpc::Status status = simulations_->CreateSimulation(&context, request, &out);
      EXPECT_TRUE(status.ok()) << status.error_message();
      return out.name();
    }

    /// Returns result and history as bytes.
    std::string bits(const std::string& name, bool* cache_hit) {
      EXPECT_TRUE(eventually([&] { return get(name).state() >= v1::Simulation::SUCCEEDED; }));
      const v1::Simulation done = get(name);
      EXPECT_EQ(done.state(), v1::Simulation::SUCCEEDED) << done.error().message();
      *cache_hit = done.cache_hit();
      std::string out = done.result().SerializeAsString();
      grpc::ClientContext context;
      v1::ReadHistoryRequest read;
      read.set_name(name);
      auto reader = simulations_->ReadHistory(&context, read);
      for (v1::ReadHistoryResponse part; reader->Read(&part);) out += part.SerializeAsString();
      reader->Finish();
      return out;
    }
  };
};

std::vector<v1::Simulation> requests() {
  std::vector<v1::Simulation> out;
  for (const double speed : {20, 50, 72, 110}) {
    v1::Simulation point = point_simulation();
    point.mutable_operating_point()->mutable_cruise()->set_speed_kilometres_per_hour(speed);
    point.mutable_operating_point()->mutable_history()->add_columns("mesh_force_newtons");
    out.push_back(point);
    point.mutable_operating_point()->set_model(v1::POINT_MODEL_QUASI_STATIC);
    out.push_back(point);
  }
  out.push_back(curve_simulation());
  out.push_back(curve_simulation());
  out.back().set_lubricant("lubricants/paper-fluid-3");
  out.back().mutable_inefficiency_curve()->set_direction(v1::SWEEP_DIRECTION_DOWN);
  out.push_back(point_simulation());
  out.back().mutable_solver_options()->set_method(v1::STEADY_STATE_METHOD_MARCH);
  out.push_back(point_simulation());
  out.back().mutable_operating_point()->set_start(v1::POINT_START_LARGE_VIBRATION);
  return out;
}

TEST_F(SameBitsTest, WhicheverServerComputesOnHoweverManyThreadsWithAndWithoutCache) {
  std::map<std::size_t, std::string> expected;
  for (const char* threads : {"1", "4"}) {
    Server server(threads);
    server.run();
    for (const bool force : {false, true, false}) {
      if (kUnderSanitizer && force != (threads[0] == '4')) continue;
      std::vector<std::string> names;
      for (const v1::Simulation& each : requests()) names.push_back(server.submit(each, force));
      for (std::size_t i = 0; i < names.size(); ++i) {
        bool cache_hit = false;
        const std::string bits = server.bits(names[i], &cache_hit);
        EXPECT_EQ(expected.emplace(i, bits).first->second, bits)
            << "request " << i << " on " << threads << " threads";
        EXPECT_FALSE(force && cache_hit);
      }
    }
    bool cache_hit = false;
    server.bits(server.submit(requests().front(), false), &cache_hit);
    EXPECT_TRUE(cache_hit);
  }
}

}  // namespace
}  // namespace tribodyn::server
