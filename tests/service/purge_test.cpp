// Tests of a purge with a real server: what it erases is in no file.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "tests/service/grpc_fixture.h"
#include "tribodyn/v1/campaigns.grpc.pb.h"
#include "tribodyn/v1/lubricants.grpc.pb.h"

namespace tribodyn::server {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

constexpr char kMarker[] = "Grandmother's secret additive 4711";
constexpr char kMarkerDigits[] = "1.9345678901234567";
constexpr double kMarkerNumber = 1.9345678901234567e-8;  // [1/Pa]

class PurgeTest : public GrpcTest {
 protected:
  void SetUp() override {
    start();
    lubricants_ = v1::LubricantService::NewStub(channel_);
  }

  void restart_after_a_kill() {
    process_->signal(SIGKILL);
    process_->wait();
    SetUp();
  }

  /// The names of the files of the folder, the log among them, that contain a text.
  std::vector<std::string> files_with(const std::string& text) const {
    std::vector<std::string> out;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder_.path())) {
      std::ifstream in(entry.path(), std::ios::binary);
      const std::string bytes((std::istreambuf_iterator<char>(in)), {});
      if (bytes.find(text) != std::string::npos) out.push_back(entry.path().filename());
    }
    return out;
  }
  static std::string marker_bytes() {
    std::string out(sizeof kMarkerNumber, '\0');
    std::memcpy(out.data(), &kMarkerNumber, sizeof kMarkerNumber);
    return out;
  }
  void expect_no_trace() const {
    EXPECT_THAT(files_with(kMarker), IsEmpty());
    EXPECT_THAT(files_with(marker_bytes()), IsEmpty());
    EXPECT_THAT(files_with(kMarkerDigits), IsEmpty());
  }

  /// Two revisions with the marks in every kind of field.
  void create_secret() {
    v1::CreateLubricantRequest request;
    v1::Lubricant& fluid = *request.mutable_lubricant();
    fluid = seed<v1::Lubricant>("lubricants/paper-fluid-1");
    fluid.set_name("lubricants/secret");
    fluid.set_display_name(kMarker);
    fluid.set_description(std::string(3000, 'd') + kMarker);
    fluid.set_lims_id(kMarker);
    fluid.set_pressure_viscosity_coefficient_per_pascal(kMarkerNumber);
    fluid.clear_provenance();
    auto& origin = *fluid.add_provenance();
    origin.set_field("pressure_viscosity_coefficient_per_pascal");
    origin.set_provenance(v1::PROVENANCE_MEASURED);
    origin.set_source(kMarker);
    v1::Lubricant stored;
    grpc::ClientContext context;
    grpc::Status status = lubricants_->CreateLubricant(&context, request, &stored);
    ASSERT_TRUE(status.ok()) << status.error_message();
    v1::UpdateLubricantRequest update;
    update.mutable_lubricant()->set_name("lubricants/secret");
    update.mutable_lubricant()->set_description(std::string(2000, 'e') + kMarker);
    grpc::ClientContext second;
    status = lubricants_->UpdateLubricant(&second, update, &stored);
    ASSERT_TRUE(status.ok()) << status.error_message();
    ASSERT_EQ(stored.revision(), 2);
  }

  std::string simulate(v1::Simulation simulation, v1::Simulation::State state) {
    simulation.set_lubricant("lubricants/secret");
    simulation.set_display_name(kMarker);
    v1::Simulation created;
    const grpc::Status status = create(simulation, &created);
    EXPECT_TRUE(status.ok()) << status.error_message();
    EXPECT_TRUE(eventually([&] { return get(created.name()).state() == state; }));
    return created.name();
  }

  /// Screens candidates around the secret; waits for the state.
  void screen(int candidates, v1::Campaign::State state) {
    const auto campaigns = v1::CampaignService::NewStub(channel_);
    v1::CreateCampaignRequest request;
    v1::Campaign& campaign = *request.mutable_campaign();
    campaign.set_lubricant("lubricants/secret");
    campaign.set_display_name(kMarker);
    auto& column = *campaign.add_candidate_columns();
    column.set_path("lubricant.pressure_viscosity_coefficient_per_pascal");
    auto& additive = *campaign.add_candidate_attributes();
    additive.set_name("additive");
    for (int i = 0; i < candidates; ++i) {
      column.add_values(kMarkerNumber);
      additive.add_texts(kMarker);
    }
    campaign.add_conditions()->set_speed_kilometres_per_hour(50);
    v1::Campaign stored;
    grpc::ClientContext context;
    const grpc::Status created = campaigns->CreateCampaign(&context, request, &stored);
    ASSERT_TRUE(created.ok()) << created.error_message();
    v1::GetCampaignRequest get;
    get.set_name(stored.name());
    EXPECT_TRUE(eventually([&] {
      grpc::ClientContext again;
      return campaigns->GetCampaign(&again, get, &stored).ok() && stored.state() == state;
    }));
  }

  grpc::Status purge(const v1::PurgeLubricantRequest& request, v1::PurgeReport* report) {
    grpc::ClientContext context;
    return lubricants_->PurgeLubricant(&context, request, report);
  }

  std::unique_ptr<v1::LubricantService::Stub> lubricants_;
};

TEST_F(PurgeTest, APurgedFormulationIsInNoFileOfTheDataFolder) {
  create_secret();
  v1::Simulation point = point_simulation();
  point.mutable_operating_point()->mutable_history()->add_columns("mesh_force_newtons");
  simulate(point, v1::Simulation::SUCCEEDED);
  simulate(point, v1::Simulation::SUCCEEDED);  // shares the result
  screen(100, v1::Campaign::SUCCEEDED);
  std::ofstream(folder_.file("tribodyn.db.schema-4")) << kMarker;
  std::ofstream(folder_.file("tribodyn.db.replaced")) << "a former database";
  restart_after_a_kill();  // leaves a write-ahead log
  const std::string running = simulate(long_simulation(), v1::Simulation::RUNNING);
  screen(20'000, v1::Campaign::RUNNING);
  ASSERT_FALSE(files_with(kMarker).empty());
  ASSERT_FALSE(files_with(marker_bytes()).empty());

  v1::PurgeLubricantRequest request;
  request.set_name("lubricants/secret");
  v1::PurgeReport report;
  const grpc::Status in_use = purge(request, &report);
  EXPECT_EQ(in_use.error_code(), grpc::StatusCode::FAILED_PRECONDITION);
  EXPECT_THAT(in_use.error_message(),
              HasSubstr("3 simulations and 2 campaigns used lubricants/secret"));
  request.set_delete_simulations(true);
  request.set_validate_only(true);
  ASSERT_TRUE(purge(request, &report).ok());
  EXPECT_EQ(report.simulations(), 3);
  EXPECT_EQ(get(running).state(), v1::Simulation::RUNNING) << "it was only asked";
  request.set_validate_only(false);
  const grpc::Status done = purge(request, &report);
  ASSERT_TRUE(done.ok()) << done.error_message();
  EXPECT_EQ(report.revisions(), 2);
  EXPECT_EQ(report.simulations(), 3);
  EXPECT_EQ(report.results(), 1);
  EXPECT_EQ(report.campaigns(), 2);
  EXPECT_THAT(report.remaining_files(), testing::ElementsAre("tribodyn.db.replaced"));
  expect_no_trace();

  EXPECT_EQ(purge(request, &report).error_code(), grpc::StatusCode::NOT_FOUND);
  request.set_allow_missing(true);
  EXPECT_TRUE(purge(request, &report).ok());
  EXPECT_EQ(report.revisions(), 0);
  v1::Simulation other;
  ASSERT_TRUE(create(point_simulation(), &other).ok());
  EXPECT_TRUE(eventually([&] { return get(other.name()).state() == v1::Simulation::SUCCEEDED; }));
  expect_no_trace();
  restart_after_a_kill();
  expect_no_trace();
  EXPECT_EQ(get(other.name()).state(), v1::Simulation::SUCCEEDED) << "others stay";
}

TEST_F(PurgeTest, AResultOfAnotherFormulationOfEqualNumbersStays) {
  create_secret();
  v1::Simulation point = point_simulation();
  simulate(point, v1::Simulation::SUCCEEDED);
  v1::CreateLubricantRequest twin;
  {
    grpc::ClientContext context;
    v1::GetLubricantRequest request;
    request.set_name("lubricants/secret");
    ASSERT_TRUE(lubricants_->GetLubricant(&context, request, twin.mutable_lubricant()).ok());
  }
  twin.mutable_lubricant()->set_name("lubricants/twin");
  {
    grpc::ClientContext context;
    v1::Lubricant stored;
    ASSERT_TRUE(lubricants_->CreateLubricant(&context, twin, &stored).ok());
  }
  point.set_lubricant("lubricants/twin");
  v1::Simulation shared;
  ASSERT_TRUE(create(point, &shared).ok());
  ASSERT_TRUE(shared.cache_hit());
  v1::PurgeLubricantRequest request;
  request.set_name("lubricants/secret");
  request.set_delete_simulations(true);
  v1::PurgeReport report;
  ASSERT_TRUE(purge(request, &report).ok());
  EXPECT_EQ(report.simulations(), 1);
  EXPECT_EQ(report.results(), 0) << "the twin's simulation shares it";
  EXPECT_GT(get(shared.name()).result().ByteSizeLong(), 0U);
}

}  // namespace
}  // namespace tribodyn::server
