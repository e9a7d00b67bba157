// Tests of tribodynd over gRPC: every method, invalid input, streams that nobody reads.
#include <gmock/gmock.h>
#include <grpcpp/client_context.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <limits>
#include <optional>
#include <random>
#include <regex>
#include <set>
#include <string>
#include <thread>

#include "google/rpc/error_details.pb.h"
#include "google/rpc/status.pb.h"
#include "server/contract/output_only.h"
#include "server/resources/provenance.h"
#include "tests/service/contract_methods.h"
#include "tests/service/grpc_fixture.h"
#include "tests/service/raw_client.h"
#include "tests/support/run_length.h"
#include "tribodyn/v1/contacts.grpc.pb.h"
#include "tribodyn/v1/gear_sets.grpc.pb.h"
#include "tribodyn/v1/lubricants.grpc.pb.h"
#include "tribodyn/v1/surfaces.grpc.pb.h"
#include "tribodyn/v1/vehicles.grpc.pb.h"

namespace tribodyn::server {
namespace {

using testing::HasSubstr;
using testing::Not;

template <class Detail>
std::optional<Detail> detail(const grpc::Status& status) {
  google::rpc::Status parsed;
  parsed.ParseFromString(status.error_details());
  for (const auto& any : parsed.details()) {
    Detail out;
    if (any.UnpackTo(&out)) return out;
  }
  return std::nullopt;
}

TEST_F(GrpcTest, HealthAndReflectionAnswer) {
  RawClient client(channel_);
  const auto [status, health] = client.call("/grpc.health.v1.Health/Check", "");
  EXPECT_TRUE(status.ok());
  EXPECT_EQ(health, std::string("\x08\x01", 2)) << "SERVING";
}

TEST_F(GrpcTest, ReflectionListsEveryServiceAndNoOther) {
  std::set<std::string> expected = {"grpc.health.v1.Health",
                                    "grpc.reflection.v1alpha.ServerReflection"};
  for (const auto* method : all_methods()) expected.insert(method->service()->full_name());
  const std::string answer = RawClient(channel_).list_services();
  const std::regex name(R"((tribodyn|grpc)\.[A-Za-z0-9_.]+)");
  std::set<std::string> listed;
  for (std::sregex_iterator each(answer.begin(), answer.end(), name), end; each != end; ++each) {
    listed.insert(each->str());
  }
  EXPECT_EQ(listed, expected);
}

TEST_F(GrpcTest, ResourcesAreServed) {
  {
    grpc::ClientContext context;
    v1::ListLubricantsResponse response;
    ASSERT_TRUE(
        v1::LubricantService::NewStub(channel_)->ListLubricants(&context, {}, &response).ok());
    EXPECT_EQ(response.lubricants_size(), 4);
  }
  {
    grpc::ClientContext context;
    v1::ListGearSetsResponse response;
    ASSERT_TRUE(v1::GearSetService::NewStub(channel_)->ListGearSets(&context, {}, &response).ok());
    EXPECT_EQ(response.gear_sets_size(), 3);
  }
  {
    grpc::ClientContext context;
    v1::GetLubricantRequest request;
    request.set_name("lubricants/paper-fluid-1");
    v1::Lubricant response;
    ASSERT_TRUE(
        v1::LubricantService::NewStub(channel_)->GetLubricant(&context, request, &response).ok());
    EXPECT_EQ(response.pressure_viscosity_coefficient_per_pascal(), 1.609e-8);
  }
  {
    grpc::ClientContext context;
    v1::GetGearSetRequest request;
    request.set_name("gearSets/reference-axle");
    v1::GearSet response;
    ASSERT_TRUE(
        v1::GearSetService::NewStub(channel_)->GetGearSet(&context, request, &response).ok());
    EXPECT_EQ(response.revision(), 1);
    keep_client_part(response);
    clear_units(*response.mutable_provenance());
    EXPECT_EQ(response.SerializeAsString(),
              seed<v1::GearSet>("gearSets/reference-axle").SerializeAsString());
  }
  {
    grpc::ClientContext context;
    v1::GetSurfaceRequest request;
    request.set_name("surfaces/run-in");
    v1::Surface response;
    EXPECT_TRUE(
        v1::SurfaceService::NewStub(channel_)->GetSurface(&context, request, &response).ok());
  }
  {
    grpc::ClientContext context;
    v1::ListSurfacesResponse response;
    ASSERT_TRUE(v1::SurfaceService::NewStub(channel_)->ListSurfaces(&context, {}, &response).ok());
    EXPECT_EQ(response.surfaces_size(), 1);
  }
  {
    grpc::ClientContext context;
    v1::GetVehicleRequest request;
    request.set_name("vehicles/passenger-car");
    v1::Vehicle response;
    EXPECT_TRUE(
        v1::VehicleService::NewStub(channel_)->GetVehicle(&context, request, &response).ok());
  }
  {
    grpc::ClientContext context;
    v1::ListVehiclesResponse response;
    ASSERT_TRUE(v1::VehicleService::NewStub(channel_)->ListVehicles(&context, {}, &response).ok());
    EXPECT_EQ(response.vehicles_size(), 1);
  }
}

TEST_F(GrpcTest, AContactIsEvaluated) {
  grpc::ClientContext context;
  v1::EvaluateContactResponse response;
  const grpc::Status status = v1::ContactService::NewStub(channel_)->EvaluateContact(
      &context, contact_request(), &response);
  ASSERT_TRUE(status.ok()) << status.error_message();
  EXPECT_EQ(response.status(), v1::CONTACT_STATUS_OK);
  EXPECT_GT(response.friction_newtons(), 0);
  EXPECT_NEAR(response.film_load_newtons() + response.asperity_load_newtons(), 2000, 1e-6);
  EXPECT_FALSE(response.model_version().empty());
}

TEST_F(GrpcTest, AllViolationsOfAContactAreInOneAnswer) {
  v1::EvaluateContactRequest request;
  const auto spoil = [](google::protobuf::Message* message) {
    const auto& descriptor = *message->GetDescriptor();
    for (int i = 0; i < descriptor.field_count(); ++i) {
      if (descriptor.field(i)->cpp_type() == google::protobuf::FieldDescriptor::CPPTYPE_DOUBLE) {
        message->GetReflection()->SetDouble(message, descriptor.field(i), -1.2345678901234567e300);
      }
    }
  };
  spoil(&request);
  spoil(request.mutable_lubricant_parameters());
  grpc::ClientContext context;
  v1::EvaluateContactResponse response;
  const grpc::Status status =
      v1::ContactService::NewStub(channel_)->EvaluateContact(&context, request, &response);
  EXPECT_EQ(status.error_code(), grpc::StatusCode::INVALID_ARGUMENT) << status.error_message();
  EXPECT_EQ(detail<google::rpc::ErrorInfo>(status)->reason(), "INVALID_FIELDS");
  const auto bad = detail<google::rpc::BadRequest>(status);
  ASSERT_TRUE(bad);
  EXPECT_GE(bad->field_violations_size(), 33);
}

TEST_F(GrpcTest, ASimulationIsCreatedWatchedReadAndListed) {
  v1::Simulation request = point_simulation();
  request.mutable_operating_point()->mutable_history()->add_columns("mesh_force_newtons");
  request.mutable_operating_point()->mutable_history()->add_columns("flank_load_newtons");
  v1::Simulation created;
  ASSERT_TRUE(create(request, &created).ok());
  EXPECT_EQ(created.name(), "simulations/1");
  grpc::Status status;
  const auto events = watch(created.name(), &status);
  EXPECT_TRUE(status.ok()) << status.error_message();
  ASSERT_FALSE(events.empty());
  ASSERT_EQ(events.back().state(), v1::Simulation::SUCCEEDED) << events.back().error().message();
  double progress = 0;
  for (const auto& event : events) {
    EXPECT_GE(event.progress_fraction(), progress);
    progress = event.progress_fraction();
  }
  const v1::Simulation done = get(created.name());
  EXPECT_EQ(done.result().points_size(), 1);
  EXPECT_GT(done.result().points(0).result().inefficiency_rms_percent(), 0);
  EXPECT_EQ(done.result().history_rows(), 192);

  grpc::ClientContext context;
  v1::ReadHistoryRequest read;
  read.set_name(created.name());
  auto reader = simulations_->ReadHistory(&context, read);
  std::size_t rows = 0;
  for (v1::ReadHistoryResponse part; reader->Read(&part);) {
    EXPECT_TRUE(!part.has_schema() || part.schema().columns_size() == 4);
    rows += part.chunk().values().size() / sizeof(double) / 4;
  }
  EXPECT_TRUE(reader->Finish().ok());
  EXPECT_EQ(rows, 192);

  grpc::ClientContext list_context;
  v1::ListSimulationsResponse list;
  EXPECT_TRUE(simulations_->ListSimulations(&list_context, {}, &list).ok());
  EXPECT_EQ(list.simulations_size(), 1);
}

TEST_F(GrpcTest, ShootingIsUsedOrFailsWithItsReasonAndValues) {
  v1::Simulation request = point_simulation();
  request.mutable_solver_options()->set_method(v1::STEADY_STATE_METHOD_SHOOTING);
  const auto ended = [&](double speed) {
    request.mutable_operating_point()->mutable_cruise()->set_speed_kilometres_per_hour(speed);
    v1::Simulation created;
    EXPECT_TRUE(create(request, &created).ok());
    EXPECT_TRUE(
        eventually([&] { return get(created.name()).state() >= v1::Simulation::SUCCEEDED; }));
    return get(created.name());
  };
  const v1::Simulation found = ended(100);
  ASSERT_EQ(found.state(), v1::Simulation::SUCCEEDED) << found.error().message();
  EXPECT_EQ(found.result().points(0).result().steady_state_method(),
            v1::STEADY_STATE_METHOD_SHOOTING);
  // the response with the period of one mesh cycle is unstable
  const v1::Simulation refused = ended(150);
  ASSERT_EQ(refused.state(), v1::Simulation::FAILED);
  EXPECT_EQ(refused.error().reason(), "NOT_FOUND_BY_SHOOTING");
  EXPECT_THAT(refused.error().message(), HasSubstr("method = SHOOTING"));
  EXPECT_THAT(refused.error().message(), HasSubstr("412.088 rad/s"));
  EXPECT_THAT(refused.error().message(), HasSubstr("AUTOMATIC or MARCH"));
}

TEST_F(GrpcTest, ACurveByShootingNamesItsMissingPoints) {
  v1::Simulation request = curve_simulation();
  request.set_lubricant("lubricants/paper-fluid-1");
  request.mutable_solver_options()->set_method(v1::STEADY_STATE_METHOD_SHOOTING);
  v1::InefficiencyCurveStudy* curve = request.mutable_inefficiency_curve();
  curve->Clear();
  curve->add_speeds_kilometres_per_hour(100);
  curve->add_speeds_kilometres_per_hour(150);
  curve->set_independent_points(true);  // along a branch it is found
  v1::Simulation created;
  ASSERT_TRUE(create(request, &created).ok());
  ASSERT_TRUE(eventually([&] { return get(created.name()).state() >= v1::Simulation::SUCCEEDED; }));
  const v1::Simulation done = get(created.name());
  ASSERT_EQ(done.result().points_size(), 2) << done.error().message();
  EXPECT_TRUE(done.result().points(0).has_result());
  EXPECT_EQ(done.result().points(1).refusal_reason(), "NOT_FOUND_BY_SHOOTING");
  EXPECT_THAT(done.result().points(1).refusal_message(), HasSubstr("method = SHOOTING"));
}

TEST_F(GrpcTest, InvalidSimulationsAreRefusedWithAllViolations) {
  v1::Simulation request;
  request.set_lubricant("lubricants/paper-fluid-4");
  request.set_sump_temperature_celsius(std::numeric_limits<double>::quiet_NaN());
  v1::Simulation created;
  const grpc::Status status = create(request, &created);
  EXPECT_EQ(status.error_code(), grpc::StatusCode::INVALID_ARGUMENT);
  const auto bad = detail<google::rpc::BadRequest>(status);
  ASSERT_TRUE(bad);
  EXPECT_EQ(bad->field_violations_size(), 3);
}

TEST_F(GrpcTest, ARunningSimulationIsCancelledAndItsWatcherSeesTheEnd) {
  v1::Simulation created;
  ASSERT_TRUE(create(long_simulation(), &created).ok());
  ASSERT_TRUE(eventually([&] { return get(created.name()).state() == v1::Simulation::RUNNING; }));
  std::thread canceller([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(600));
    EXPECT_EQ(cancel(created.name()).state(), v1::Simulation::CANCELLED);
  });
  grpc::Status status;
  const auto events = watch(created.name(), &status);
  canceller.join();
  EXPECT_TRUE(status.ok());
  EXPECT_EQ(events.back().state(), v1::Simulation::CANCELLED);
  EXPECT_EQ(cancel(created.name()).state(), v1::Simulation::CANCELLED) << "idempotent";
  grpc::Status again;
  EXPECT_EQ(watch(created.name(), &again).back().state(), v1::Simulation::CANCELLED);
  v1::Simulation next;
  ASSERT_TRUE(create(point_simulation(), &next).ok());
  EXPECT_TRUE(eventually([&] { return get(next.name()).state() == v1::Simulation::SUCCEEDED; }));
}

class HastyStreamsTest : public GrpcTest {
 protected:
  void SetUp() override {
    more_flags_ = {"--stream-limit-seconds", "0.5"};
    start();
  }
};

TEST_F(HastyStreamsTest, AWatchEndsAtItsDeadlineAndCanBeResumed) {
  v1::Simulation running;
  ASSERT_TRUE(create(long_simulation(), &running).ok());
  for (int again = 0; again < 2; ++again) {
    grpc::Status status;
    const auto begin = std::chrono::steady_clock::now();
    EXPECT_FALSE(watch(running.name(), &status).empty());
    EXPECT_EQ(status.error_code(), grpc::StatusCode::DEADLINE_EXCEEDED) << status.error_message();
    EXPECT_GE(std::chrono::steady_clock::now() - begin, std::chrono::milliseconds(450));
  }
  EXPECT_EQ(get(running.name()).state(), v1::Simulation::RUNNING);
  cancel(running.name());
}

class UnreadStreamsTest : public GrpcTest {
 protected:
  void SetUp() override {
    more_flags_ = {"--unread-limit-seconds", "0.5"};
    start();
    v1::Simulation request = point_simulation();
    auto* history = request.mutable_operating_point()->mutable_history();
    history->add_columns("mesh_force_newtons");
    history->set_mesh_cycles(50);
    history->set_samples_per_mesh_cycle(8000);
    v1::Simulation created;
    ASSERT_TRUE(create(request, &created).ok());
    ASSERT_TRUE(
        eventually([&] { return get(created.name()).state() == v1::Simulation::SUCCEEDED; }));
    request_.set_name(created.name());
  }

  /// Reads to the end with a pause before each message. Returns the number of rows and the status.
  std::pair<int, grpc::Status> read(std::chrono::milliseconds first_pause,
                                    std::chrono::milliseconds pause) {
    grpc::ClientContext context;
    const auto reader = simulations_->ReadHistory(&context, request_);
    std::this_thread::sleep_for(first_pause);
    int rows = 0;
    for (v1::ReadHistoryResponse part; reader->Read(&part);) {
      rows += static_cast<int>(part.chunk().values().size() / sizeof(double));
      std::this_thread::sleep_for(pause);
    }
    return {rows, reader->Finish()};
  }

  v1::ReadHistoryRequest request_;
};

TEST_F(UnreadStreamsTest, AStreamWhoseClientReadsNothingIsCutOff) {
  using std::chrono::milliseconds;
  const auto [all_rows, well] = read(milliseconds(0), milliseconds(20));
  EXPECT_TRUE(well.ok()) << "a slow reader is none: " << well.error_message();
  EXPECT_EQ(all_rows, 400'000);
  const auto [some_rows, cut_off] = read(milliseconds(2500), milliseconds(0));
  EXPECT_EQ(cut_off.error_code(), grpc::StatusCode::CANCELLED) << cut_off.error_message();
  EXPECT_LT(some_rows, all_rows);
}

TEST_F(UnreadStreamsTest, AWatchWithoutEventsContinues) {
  v1::Simulation running;
  ASSERT_TRUE(create(long_simulation(), &running).ok());
  std::thread canceller([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(1500));
    cancel(running.name());
  });
  grpc::Status status;
  const auto events = watch(running.name(), &status);
  canceller.join();
  EXPECT_TRUE(status.ok()) << status.error_message();
  EXPECT_EQ(events.back().state(), v1::Simulation::CANCELLED);
}

TEST_F(GrpcTest, AWatcherThatNeverReadsDelaysNobody) {
  v1::Simulation running;
  ASSERT_TRUE(create(long_simulation(), &running).ok());
  RawClient client(channel_);
  std::vector<std::shared_ptr<RawClient::Stream>> streams;
  v1::WatchSimulationRequest request;
  request.set_name(running.name());
  streams.reserve(200);
  for (int i = 0; i < 200; ++i) {
    streams.push_back(
        client.open("/tribodyn.v1.SimulationService/WatchSimulation", request.SerializeAsString()));
  }
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  EXPECT_EQ(cancel(running.name()).state(), v1::Simulation::CANCELLED);
  process_->signal(SIGTERM);
  EXPECT_EQ(process_->wait(std::chrono::seconds(8)), 0) << process_->log();
}

TEST_F(GrpcTest, OpenReflectionStreamsDelayNobody) {
  RawClient client(channel_);
  std::vector<std::shared_ptr<RawClient::Stream>> streams;
  streams.reserve(60);
  for (int i = 0; i < 60; ++i) {
    streams.push_back(client.open("/grpc.reflection.v1alpha.ServerReflection/ServerReflectionInfo",
                                  std::string("\x3a\x00", 2)));
  }
  v1::Simulation created;
  EXPECT_TRUE(create(point_simulation(), &created).ok());
  streams.clear();
  EXPECT_TRUE(eventually([&] { return !client.list_services().empty(); })) << "and it recovers";
}

TEST_F(GrpcTest, ACallWithoutARequestIsNotOneWithAnEmptyRequest) {
  RawClient client(channel_);
  for (const char* method :
       {"LubricantService/ListLubricants", "SimulationService/WatchSimulations",
        "SimulationService/CreateSimulation"}) {
    const auto [status, answers] = client.read_all(std::string("/tribodyn.v1.") + method, {});
    EXPECT_EQ(status.error_code(), grpc::StatusCode::CANCELLED) << method;
    EXPECT_TRUE(answers.empty()) << method;
  }
  const auto [status, answers] =
      client.read_all("/tribodyn.v1.LubricantService/ListLubricants", "");
  EXPECT_TRUE(status.ok());
  EXPECT_EQ(answers.size(), 1U);
}

TEST_F(GrpcTest, HeavyBatchesDelayNoNewConnection) {
  v1::BatchCreateLubricantsRequest batch;
  batch.set_validate_only(true);
  batch.mutable_read_mask()->add_paths("name");
  v1::Lubricant fluid = seed<v1::Lubricant>("lubricants/paper-fluid-1");
  const int fluids = kUnderSanitizer ? 500 : 2000;  // the batches end within a call's 30 s
  for (int i = 0; i < fluids; ++i) {
    fluid.set_name("lubricants/many-" + std::to_string(i));
    *batch.add_requests()->mutable_lubricant() = fluid;
  }
  std::atomic<int> answered = 0;
  const StopWatch batches;
  std::vector<std::jthread> callers;
  for (int i = 0; i < 4; ++i) {  // more than threads of their lane, and of gRPC
    callers.emplace_back([&] {
      grpc::ClientContext context;
      v1::BatchCreateLubricantsResponse response;
      const grpc::Status status = v1::LubricantService::NewStub(connect(address_, true))
                                      ->BatchCreateLubricants(&context, batch, &response);
      ++answered;
      EXPECT_TRUE(status.ok()) << status.error_message();  // no connection is closed meanwhile
    });
  }
  std::vector<double> seconds;  // of a connection with two calls
  while (answered < 4) {
    const auto channel = connect(address_, true);
    const StopWatch watch;
    grpc::ClientContext context;
    v1::GetLubricantRequest request;
    request.set_name("lubricants/paper-fluid-1");
    v1::Lubricant read;
    EXPECT_TRUE(
        v1::LubricantService::NewStub(channel)->GetLubricant(&context, request, &read).ok());
    EXPECT_TRUE(RawClient(channel).call("/grpc.health.v1.Health/Check", "").first.ok());
    seconds.push_back(watch.seconds());
  }
  callers.clear();
  EXPECT_LT(*std::max_element(seconds.begin(), seconds.end()), batches.seconds() / 2)
      << "a connection waited for batches";
}

TEST_F(GrpcTest, RandomBytesNeitherCrashNorHangTheServer) {
  RawClient client(channel_);
  std::mt19937 random(20261121);
  for (const char* method :
       {"LubricantService/GetLubricant", "LubricantService/ListLubricants",
        "GearSetService/GetGearSet", "ContactService/EvaluateContact",
        "SimulationService/CreateSimulation", "SimulationService/GetSimulation",
        "SimulationService/ListSimulations", "SimulationService/CancelSimulation"}) {
    for (int i = 0; i < 50; ++i) {
      std::string bytes(random() % 300, '\0');
      for (char& byte : bytes) byte = static_cast<char>(random());
      client.call("/tribodyn.v1." + std::string(method), bytes);
    }
  }
  std::string huge;
  huge.resize(70'000'000, 'x');
  EXPECT_EQ(client.call("/tribodyn.v1.ContactService/EvaluateContact", huge).first.error_code(),
            grpc::StatusCode::RESOURCE_EXHAUSTED);
  const grpc::Status unknown = client.call("/tribodyn.v1.ContactService/NoSuchMethod", "").first;
  EXPECT_EQ(unknown.error_code(), grpc::StatusCode::UNIMPLEMENTED);
  EXPECT_EQ(detail<google::rpc::ErrorInfo>(unknown)->reason(), "UNKNOWN_METHOD");
  if (const auto port = address_.rfind(':'); port != std::string::npos) {
    send_raw_bytes(std::stoi(address_.substr(port + 1)), "GET / HTTP/1.1\r\n\r\n");
    send_raw_bytes(std::stoi(address_.substr(port + 1)), std::string(100'000, '\xff'));
  }
  EXPECT_TRUE(process_->running());
  grpc::ClientContext context;
  v1::ListVehiclesResponse response;
  EXPECT_TRUE(v1::VehicleService::NewStub(channel_)->ListVehicles(&context, {}, &response).ok());
}

class FewFilesTest : public GrpcTest {
 protected:
  void SetUp() override {
    maximum_files_ = 200;
    start();
  }
  grpc::Status list_vehicles(const std::shared_ptr<grpc::Channel>& channel) {
    grpc::ClientContext context;
    v1::ListVehiclesResponse response;
    return v1::VehicleService::NewStub(channel)->ListVehicles(&context, {}, &response);
  }
};

TEST_F(FewFilesTest, AfterConnectionsThatUsedAllFilesTheServerAcceptsAgain) {
  const int port = std::stoi(address_.substr(address_.rfind(':') + 1));
  EXPECT_TRUE(list_vehicles(channel_).ok());
  {
    const SilentConnections flood(port, 400);
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    EXPECT_TRUE(list_vehicles(channel_).ok()) << "who is connected is served";
    v1::Simulation created;
    EXPECT_TRUE(create(point_simulation(), &created).ok());
  }
  EXPECT_TRUE(eventually([&] { return list_vehicles(connect(address_)).ok(); }));
}

TEST_F(GrpcTest, NoFormulationAppearsInTheLog) {
  v1::EvaluateContactRequest request = contact_request();
  *request.mutable_lubricant_parameters() = seed<v1::Lubricant>("lubricants/paper-fluid-1");
  request.mutable_lubricant_parameters()->set_display_name("SecretFluid");
  request.mutable_lubricant_parameters()->set_relaxation_time_seconds(-1.23454321);
  grpc::ClientContext context;
  v1::EvaluateContactResponse response;
  EXPECT_FALSE(
      v1::ContactService::NewStub(channel_)->EvaluateContact(&context, request, &response).ok());
  v1::Simulation simulation = point_simulation();
  simulation.set_display_name("SecretFluid");
  simulation.set_sump_temperature_celsius(12.345);
  v1::Simulation created;
  ASSERT_TRUE(create(simulation, &created).ok());
  ASSERT_TRUE(eventually([&] { return get(created.name()).state() >= v1::Simulation::SUCCEEDED; }));
  EXPECT_FALSE(process_->log().empty());
  for (const char* secret : {"SecretFluid", "1.23454321", "12.345", "lubricants/", "1.609e-08"}) {
    EXPECT_THAT(process_->log(), Not(HasSubstr(secret)));
  }
}

}  // namespace
}  // namespace tribodyn::server
