// Campaigns of a real server that is killed: only open tiles are lost, and no bit differs.
#include <gtest/gtest.h>

#include <csignal>
#include <string>

#include "server/simulation/campaign_columns.h"
#include "tests/service/grpc_fixture.h"
#include "tests/support/run_length.h"
#include "tribodyn/v1/campaigns.grpc.pb.h"

namespace tribodyn::server {
namespace {

class CampaignCrashTest : public GrpcTest {
 protected:
  void SetUp() override { restart(); }
  void restart() {
    start();
    campaigns_ = v1::CampaignService::NewStub(channel_);
  }
  void kill_server() {
    process_->signal(SIGKILL);
    process_->wait();
  }

  static v1::CreateCampaignRequest request(const std::string& request_id) {
    v1::CreateCampaignRequest out;
    out.set_request_id(request_id);
    v1::Campaign& campaign = *out.mutable_campaign();
    campaign.set_lubricant("lubricants/paper-fluid-1");
    v1::CandidateColumn& column = *campaign.add_candidate_columns();
    column.set_path("lubricant.relaxation_time_seconds");
    for (int i = 0; i < 2000; ++i) column.add_values(1e-12 * (1 + i));
    for (int speed = 20; speed <= 140; speed += 5) {
      campaign.add_conditions()->set_speed_kilometres_per_hour(speed);
    }
    return out;
  }
  v1::Campaign create(const std::string& request_id) {
    grpc::ClientContext context;
    v1::Campaign out;
    const grpc::Status status = campaigns_->CreateCampaign(&context, request(request_id), &out);
    EXPECT_TRUE(status.ok()) << status.error_message();
    return out;
  }
  v1::Campaign get_campaign(const std::string& name) {
    grpc::ClientContext context;
    v1::GetCampaignRequest request;
    request.set_name(name);
    v1::Campaign out;
    const grpc::Status status = campaigns_->GetCampaign(&context, request, &out);
    EXPECT_TRUE(status.ok()) << status.error_message();
    return out;
  }
  /// All rows of all columns, as bytes.
  std::string bits(const std::string& name) {
    grpc::ClientContext context;
    v1::ReadCampaignRequest request;
    request.set_name(name);
    const auto reader = campaigns_->ReadCampaign(&context, request);
    std::string out;
    for (v1::ReadCampaignResponse part; reader->Read(&part);) out += part.chunk().values();
    EXPECT_TRUE(reader->Finish().ok());
    return out;
  }

  std::unique_ptr<v1::CampaignService::Stub> campaigns_;
};

TEST_F(CampaignCrashTest, AKilledServerContinuesAtTheMissingRowsWithTheSameBits) {
  const std::string name = create("one").name();
  std::int32_t done = 0;
  for (int kill = 0; kill < 2; ++kill) {
    ASSERT_TRUE(eventually([&] { return get_campaign(name).points_done() > done + 2000; }));
    done = get_campaign(name).points_done();
    kill_server();
    restart();
    const v1::Campaign after = get_campaign(name);
    EXPECT_GE(after.points_done(), done) << "what was told is on disk";
    EXPECT_LT(after.points_done(), 50'000);
    EXPECT_EQ(after.state(), v1::Campaign::RUNNING);
    done = after.points_done();
  }
  EXPECT_EQ(create("one").name(), name) << "a request that is sent again makes nothing";
  ASSERT_TRUE(eventually([&] { return get_campaign(name).state() == v1::Campaign::SUCCEEDED; }));
  const v1::Campaign finished = get_campaign(name);
  EXPECT_EQ(finished.points_done(), 50'000);
  EXPECT_EQ(finished.points_refused(), 0);
  const std::string undisturbed = create("two").name();
  ASSERT_TRUE(
      eventually([&] { return get_campaign(undisturbed).state() == v1::Campaign::SUCCEEDED; }));
  const std::string expected = bits(undisturbed);
  EXPECT_EQ(expected.size(), std::size_t{50'000} * kCampaignColumns.size() * sizeof(double));
  EXPECT_TRUE(bits(name) == expected);
}

TEST_F(CampaignCrashTest, ACampaignOfARigContinuesAtTheMissingRowsWithTheSameBits) {
  v1::CreateCampaignRequest on_rig = request("rig");
  v1::Campaign& campaign = *on_rig.mutable_campaign();
  campaign.clear_conditions();
  v1::CampaignRig& rig = *campaign.mutable_rig();
  rig.set_radius_x_metres(0.0127);
  v1::RigGrid& grid = *rig.mutable_grid();
  grid.add_supply_temperatures_celsius(40);
  grid.add_loads_newtons(35);
  grid.add_entrainment_speeds_metres_per_second(2);
  for (int i = 0; i < 150; ++i) grid.add_slide_roll_ratios_percent(0.2 * i);
  const auto create_rig = [&](const std::string& request_id) {
    on_rig.set_request_id(request_id);
    grpc::ClientContext context;
    v1::Campaign out;
    EXPECT_TRUE(campaigns_->CreateCampaign(&context, on_rig, &out).ok());
    return out.name();
  };
  const std::string name = create_rig("rig");
  ASSERT_TRUE(eventually([&] { return get_campaign(name).points_done() > 2000; }));
  const std::int32_t done = get_campaign(name).points_done();
  kill_server();
  restart();
  EXPECT_GE(get_campaign(name).points_done(), done) << "what was told is on disk";
  ASSERT_TRUE(eventually([&] { return get_campaign(name).state() == v1::Campaign::SUCCEEDED; }));
  EXPECT_EQ(get_campaign(name).points_done(), 300'000);
  EXPECT_EQ(get_campaign(name).points_refused(), 0);
  const std::string undisturbed = create_rig("undisturbed");
  ASSERT_TRUE(
      eventually([&] { return get_campaign(undisturbed).state() == v1::Campaign::SUCCEEDED; }));
  const std::string expected = bits(undisturbed);
  EXPECT_EQ(expected.size(), std::size_t{300'000} * 13 * sizeof(double));
  EXPECT_TRUE(bits(name) == expected);
}

/// Ten million points, of which the first few are computed.
TEST_F(CampaignCrashTest, AHugeCampaignTakesNoMoreMemoryTheLongerItRuns) {
  v1::CreateCampaignRequest huge = request("huge");
  v1::Campaign& campaign = *huge.mutable_campaign();
  campaign.mutable_candidate_columns(0)->clear_values();
  for (int i = 0; i < 100'000; ++i) {
    campaign.mutable_candidate_columns(0)->add_values(1e-12 * (1 + 1e-4 * i));
  }
  campaign.clear_conditions();
  for (int i = 0; i < 100; ++i) {
    campaign.add_conditions()->set_speed_kilometres_per_hour(20 + 1.2 * i);
  }
  campaign.mutable_budget()->set_points(4000);
  v1::Campaign created;
  {
    grpc::ClientContext context;
    const grpc::Status status = campaigns_->CreateCampaign(&context, huge, &created);
    ASSERT_TRUE(status.ok()) << status.error_message();
  }
  EXPECT_EQ(created.points(), 10'000'000);
  const auto is_paused = [&] {
    return get_campaign(created.name()).state() == v1::Campaign::PAUSED;
  };
  ASSERT_TRUE(eventually(is_paused));
  const long before = process_->peak_memory_kibibytes();
  grpc::ClientContext context;
  v1::ResumeCampaignRequest more;
  more.set_name(created.name());
  more.mutable_budget()->set_points(24'000);
  v1::Campaign resumed;
  ASSERT_TRUE(campaigns_->ResumeCampaign(&context, more, &resumed).ok());
  ASSERT_TRUE(eventually(is_paused));
  EXPECT_GE(get_campaign(created.name()).points_done(), 24'000);
  if (!kUnderSanitizer) {  // a sanitizer's own memory is counted too
    EXPECT_LT(process_->peak_memory_kibibytes() - before, 16 << 10);
  }
}

}  // namespace
}  // namespace tribodyn::server
