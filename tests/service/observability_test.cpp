// Tests of metrics, and of a log that connects request, job and result and contains no formulation.
#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <ctime>
#include <filesystem>
#include <string>
#include <thread>

#include "tests/service/grpc_fixture.h"
#include "tests/service/raw_client.h"
#include "tests/support/run_length.h"
#include "tribodyn/v1/lubricants.grpc.pb.h"

namespace tribodyn::server {
namespace {

using testing::HasSubstr;
using testing::Not;

/// Returns head and body of the answer to a request.
std::string http(const std::string& method, int port, const std::string& path) {
  const int connection = socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in name{};
  name.sin_family = AF_INET;
  name.sin_port = htons(static_cast<std::uint16_t>(port));
  name.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  EXPECT_EQ(connect(connection, reinterpret_cast<const sockaddr*>(&name), sizeof(name)), 0);
  const std::string request = method + " " + path +
                              " HTTP/1.1\r\nHost: localhost\r\nAuthorization: Bearer " +
                              owner_token() + "\r\nConnection: close\r\n\r\n";
  EXPECT_EQ(send(connection, request.data(), request.size(), 0),
            static_cast<ssize_t>(request.size()));
  std::string out;
  char part[4096];
  for (ssize_t count = 0; (count = recv(connection, part, sizeof(part), 0)) > 0;) {
    out.append(part, static_cast<std::size_t>(count));
  }
  close(connection);
  return out;
}

std::string http_get(int port, const std::string& path) { return http("GET", port, path); }

class ObservabilityTest : public GrpcTest {
 protected:
  void SetUp() override {
    more_flags_ = {"--http-listen", "127.0.0.1:0"};
    start();
    const std::string log = process_->log();
    const std::string before = "REST at http://127.0.0.1:";
    const auto found = log.rfind(before);  // of the last start
    ASSERT_NE(found, std::string::npos) << log;
    port_ = std::stoi(log.substr(found + before.size()));
  }

  v1::Simulation run(const v1::CreateSimulationRequest& request) {
    grpc::ClientContext context;
    context.AddMetadata("tribodyn-client", "bench 7=x");
    v1::Simulation out;
    const grpc::Status status = simulations_->CreateSimulation(&context, request, &out);
    EXPECT_TRUE(status.ok()) << status.error_message();
    EXPECT_TRUE(eventually([&] { return get(out.name()).state() == v1::Simulation::SUCCEEDED; }));
    return get(out.name());
  }

  int port_ = 0;
};

TEST_F(ObservabilityTest, SilentConnectionsDoNotStarveAScraper) {
  const SilentConnections silent(port_, 10);
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_THAT(http_get(port_, "/metrics"), HasSubstr("tribodyn"));
  // It would be ten seconds if each connection could stay silent for the time limit of a request.
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(8));
}

TEST_F(ObservabilityTest, MetricsCountPhasesOutcomesCacheHitsAndTheBuild) {
  v1::CreateSimulationRequest request;
  *request.mutable_simulation() = point_simulation();
  run(request);
  EXPECT_TRUE(run(request).cache_hit());
  const std::string text = http_get(port_, "/metrics");
  EXPECT_THAT(text, HasSubstr("200 OK"));
  for (const char* phase : {"queue", "validation", "orbit", "friction", "store"}) {
    EXPECT_THAT(text, HasSubstr(std::string("tribodyn_phase_seconds_bucket{phase=\"") + phase));
  }
  EXPECT_THAT(text, HasSubstr("tribodyn_phase_seconds_count{phase=\"orbit\"} 1\n"));
  EXPECT_THAT(text, HasSubstr("tribodyn_submissions_total{outcome=\"queued\"} 1\n"));
  EXPECT_THAT(text, HasSubstr("tribodyn_submissions_total{outcome=\"cache_hit\"} 1\n"));
  EXPECT_THAT(text, HasSubstr("tribodyn_simulations_ended_total{outcome=\"succeeded\"} 1\n"));
  EXPECT_THAT(text, HasSubstr("tribodyn_simulations_waiting 0\n"));
  EXPECT_THAT(text, HasSubstr("tribodyn_build_info{"));
  EXPECT_THAT(http_get(port_, "/other"), HasSubstr("404"));
}

TEST_F(ObservabilityTest, MetricsTellWhatTheProcessAndItsFilesTake) {
  const std::string text = http_get(port_, "/metrics");
  const auto value = [&](const std::string& name) {
    const auto found = text.find("\n" + name + " ");
    if (found == std::string::npos) return -1.0;
    return std::stod(text.substr(found + name.size() + 2));
  };
  EXPECT_GT(value("process_cpu_seconds_total"), 0);
  EXPECT_GT(value("process_resident_memory_bytes"), 1e6);
  EXPECT_GT(value("process_open_fds"), 3);
  EXPECT_GT(value("process_max_fds"), value("process_open_fds"));
  EXPECT_GT(value("process_threads"), 2);
  EXPECT_NEAR(value("process_start_time_seconds"), static_cast<double>(std::time(nullptr)), 60);
  EXPECT_GT(value("tribodyn_disk_free_bytes"), 0);
  EXPECT_GE(value("tribodyn_disk_size_bytes"), value("tribodyn_disk_free_bytes"));
  const auto size = [&](const std::string& file) {
    return value("tribodyn_file_bytes{file=\"" + file + "\"}");
  };
  EXPECT_EQ(size("database"),
            static_cast<double>(std::filesystem::file_size(folder_.file("tribodyn.db"))));
  EXPECT_GT(size("write_ahead_log"), 0);
  EXPECT_GT(size("log"), 0);
}

TEST_F(ObservabilityTest, MetricsAreThereWhileTheDatabaseIsMisplaced) {
  const std::string database = folder_.file("tribodyn.db");
  std::filesystem::rename(database, database + ".elsewhere");
  const std::string text = http_get(port_, "/metrics");
  EXPECT_THAT(text, HasSubstr("tribodyn_disk_free_bytes "));
  EXPECT_THAT(text, Not(HasSubstr("file=\"database\"")));
  std::filesystem::rename(database + ".elsewhere", database);
}

TEST_F(ObservabilityTest, HealthIsUnavailableWhileTheDatabaseIsMisplacedOrTheServerDrains) {
  EXPECT_THAT(http_get(port_, "/healthz"), HasSubstr("200 OK"));
  const std::string database = folder_.file("tribodyn.db");
  std::filesystem::rename(database, database + ".elsewhere");
  EXPECT_TRUE(eventually([&] { return http_get(port_, "/healthz").starts_with("HTTP/1.1 503"); }));
  EXPECT_THAT(http_get(port_, "/healthz"), HasSubstr("not serving"));
  std::filesystem::rename(database + ".elsewhere", database);
  EXPECT_TRUE(eventually([&] { return http_get(port_, "/healthz").starts_with("HTTP/1.1 200"); }));
  process_->signal(SIGKILL);
  process_->wait();
  drain_seconds_ = "20";
  SetUp();
  v1::Simulation running;
  ASSERT_TRUE(create(long_simulation(), &running).ok());
  ASSERT_TRUE(eventually([&] { return get(running.name()).state() == v1::Simulation::RUNNING; }));
  process_->signal(SIGTERM);
  EXPECT_TRUE(eventually([&] { return http_get(port_, "/healthz").starts_with("HTTP/1.1 503"); }));
  process_->signal(SIGKILL);
  process_->wait();
}

TEST_F(ObservabilityTest, HeadOfMetricsEqualsGetWithoutABody) {
  const std::string head = http("HEAD", port_, "/metrics"), whole = http_get(port_, "/metrics");
  EXPECT_THAT(head, testing::StartsWith("HTTP/1.1 200 OK\r\n"));
  EXPECT_THAT(head, HasSubstr("Content-Length: "));
  EXPECT_THAT(head, testing::EndsWith("\r\n\r\n"));
  EXPECT_EQ(head.find("\r\n\r\n"), head.size() - 4) << "no body";
  EXPECT_GT(whole.size(), head.size());
  EXPECT_THAT(http("HEAD", port_, "/other"), testing::StartsWith("HTTP/1.1 404"));
}

TEST_F(ObservabilityTest, OneIdJoinsRequestJobAndResultInTheLog) {
  v1::CreateSimulationRequest request;
  *request.mutable_simulation() = point_simulation();
  request.set_request_id("req-4711");
  const v1::Simulation done = run(request);
  EXPECT_EQ(done.request_id(), "req-4711");
  const std::string hash = done.result().input_hash();
  EXPECT_THAT(process_->log(),
              HasSubstr("event=simulation_queued simulation=" + done.name() +
                        " request_id=req-4711 client=bench_7_x input_hash=" + hash));
  EXPECT_TRUE(eventually([&] {
    return process_->log().find("event=simulation_computed simulation=" + done.name() +
                                " request_id=req-4711 input_hash=" + hash) != std::string::npos;
  }));
}

TEST_F(ObservabilityTest, ACallThatItsClientCancelsEndsEarlyAndIsCounted) {
  v1::BatchCreateLubricantsRequest batch;
  v1::Lubricant fluid = seed<v1::Lubricant>("lubricants/paper-fluid-1");
  for (int i = 0; i < 4000; ++i) {
    fluid.set_name("lubricants/many-" + std::to_string(i));
    *batch.add_requests()->mutable_lubricant() = fluid;
  }
  const auto lubricants = v1::LubricantService::NewStub(channel_);
  grpc::ClientContext context;
  context.AddMetadata("tribodyn-request-id", "to-be-cancelled");
  std::thread client([&] {
    // By then the request has arrived; the batch takes longer.
    std::this_thread::sleep_for(std::chrono::milliseconds(kUnderSanitizer ? 1000 : 200));
    context.TryCancel();
  });
  v1::BatchCreateLubricantsResponse response;
  const grpc::Status status = lubricants->BatchCreateLubricants(&context, batch, &response);
  client.join();
  EXPECT_EQ(status.error_code(), grpc::StatusCode::CANCELLED);
  EXPECT_TRUE(eventually([&] {
    return http_get(port_, "/metrics")
               .find(
                   "tribodyn_calls_total{code=\"CANCELLED\",method=\"tribodyn.v1."
                   "LubricantService.BatchCreateLubricants\"} 1\n") != std::string::npos;
  }));
  EXPECT_THAT(process_->log(), HasSubstr("event=call method=BatchCreateLubricants code=CANCELLED "
                                         "reason=CANCELLED"));
  EXPECT_THAT(process_->log(), HasSubstr("call=to-be-cancelled"));
  v1::ListLubricantsRequest request;
  request.set_filter("name:many");
  grpc::ClientContext after;
  v1::ListLubricantsResponse left;
  EXPECT_TRUE(lubricants->ListLubricants(&after, request, &left).ok());
  EXPECT_TRUE(left.lubricants().empty()) << "nothing is written";
}

TEST_F(ObservabilityTest, NoFormulationIsLogged) {
  auto lubricants = v1::LubricantService::NewStub(channel_);
  v1::CreateLubricantRequest fresh;
  fresh.set_lubricant_id("hushed-blend");
  v1::Lubricant& fluid = *fresh.mutable_lubricant();
  fluid = seed<v1::Lubricant>("lubricants/paper-fluid-1");
  fluid.clear_name();
  fluid.set_display_name("Whispered Ester");
  fluid.set_description("clandestine polymer");
  fluid.set_thermal_conductivity_watts_per_metre_kelvin(0.1539137);
  v1::Label* label = fluid.add_labels();
  label->set_key("recipe");
  label->set_value("unspoken");
  v1::Lubricant created;
  grpc::ClientContext context;
  const grpc::Status status = lubricants->CreateLubricant(&context, fresh, &created);
  ASSERT_TRUE(status.ok()) << status.error_message();

  v1::CreateSimulationRequest request;
  *request.mutable_simulation() = point_simulation();
  request.mutable_simulation()->set_lubricant("lubricants/hushed-blend");
  request.mutable_simulation()->set_display_name("veiled title");
  request.mutable_simulation()->set_sump_temperature_celsius(41.5937);
  run(request);
  v1::Simulation wrong = request.simulation();
  wrong.set_sump_temperature_celsius(-3971.5);
  v1::Simulation refused;
  EXPECT_FALSE(GrpcTest::create(wrong, &refused).ok());
  for (const char* word : {"hushed", "Whispered", "clandestine", "0.15391", "unspoken", "recipe",
                           "veiled", "41.59", "3971"}) {
    EXPECT_THAT(process_->log(), Not(HasSubstr(word)));
  }
}

}  // namespace
}  // namespace tribodyn::server
