// A candidate whose computation ends the server is found and refused; all others have their
// figures.
#include <gmock/gmock.h>
#include <grpcpp/client_context.h>
#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "tests/service/server_process.h"
#include "tests/service/support.h"
#include "tests/support/paths.h"
#include "tribodyn/v1/campaigns.grpc.pb.h"

namespace tribodyn::server {
namespace {

constexpr int kConditions = 3;
constexpr int kCandidate = 777;  // as in a_candidate_ends_the_server.patch

class LostCandidates : public testing::Test {
 protected:
  void start() {
    const std::string port = folder_.file("port");
    std::filesystem::remove(port);
    process_ = std::make_unique<ServerProcess>(
        std::vector<std::string>{"TRIBODYN_SEEDED_BUG=a_candidate_ends_the_server",
                                 seeded_server_program(), "--listen", "127.0.0.1:0", "--database",
                                 folder_.file("tribodyn.db"), "--port-file", port, "--threads",
                                 "2"},
        folder_.file("log"), 0, "/usr/bin/env");
    const std::string address = wait_for_address(port, *process_);
    // It may end at once, at the same candidate as before.
    campaigns_ = address.empty() ? nullptr : v1::CampaignService::NewStub(connect(address, true));
  }
  std::string create(int candidates) {
    v1::CreateCampaignRequest request;
    v1::Campaign& campaign = *request.mutable_campaign();
    campaign.set_lubricant("lubricants/paper-fluid-1");
    v1::CandidateColumn& column = *campaign.add_candidate_columns();
    column.set_path("lubricant.relaxation_time_seconds");
    for (int i = 0; i < candidates; ++i) column.add_values(1e-12 * (1 + i));
    for (int i = 0; i < kConditions; ++i) {
      campaign.add_conditions()->set_speed_kilometres_per_hour(40 + 30 * i);
    }
    grpc::ClientContext context;
    v1::Campaign out;
    const grpc::Status status = campaigns_->CreateCampaign(&context, request, &out);
    EXPECT_TRUE(status.ok()) << status.error_message();
    return out.name();
  }
  /// Returns true if the campaign has succeeded. Sets `out`.
  bool has_succeeded(const std::string& name, v1::Campaign& out) {
    if (!campaigns_) return false;
    grpc::ClientContext context;
    v1::GetCampaignRequest request;
    request.set_name(name);
    return campaigns_->GetCampaign(&context, request, &out).ok() &&
           out.state() == v1::Campaign::SUCCEEDED;
  }
  std::vector<double> read(const std::string& name, const std::string& column) {
    grpc::ClientContext context;
    v1::ReadCampaignRequest request;
    request.set_name(name);
    request.add_columns(column);
    const auto reader = campaigns_->ReadCampaign(&context, request);
    std::string bytes;
    for (v1::ReadCampaignResponse part; reader->Read(&part);) bytes += part.chunk().values();
    EXPECT_TRUE(reader->Finish().ok());
    std::vector<double> out(bytes.size() / sizeof(double));
    std::memcpy(out.data(), bytes.data(), bytes.size());
    return out;
  }

  TemporaryFolder folder_;
  std::unique_ptr<ServerProcess> process_;
  std::unique_ptr<v1::CampaignService::Stub> campaigns_;
};

TEST_F(LostCandidates, OnlyTheOneThatEndsTheServerIsRefused) {
  // 2 processes until the rows are noted, 10 halvings at most, 3 attempts of the candidate alone.
  constexpr int kMostStarts = 16;
  start();
  const std::string hurt = create(1000), other = create(900);
  v1::Campaign with_loss, without_loss;
  int starts = 1;
  while (!has_succeeded(hurt, with_loss) || !has_succeeded(other, without_loss)) {
    if (!process_->running()) {
      ASSERT_LT(++starts, kMostStarts) << with_loss.ShortDebugString();
      start();
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  EXPECT_EQ(without_loss.points_refused(), 0);
  ASSERT_EQ(with_loss.points_refused(), kConditions);
  ASSERT_EQ(with_loss.refusals_size(), 1);
  EXPECT_EQ(with_loss.refusals(0).reason(), "WORKER_LOST");
  EXPECT_EQ(with_loss.refusals(0).message(),
            "the server ended 3 times while it computed this candidate");
  const std::vector<double> refusals = read(hurt, "refusal_number");
  ASSERT_EQ(refusals.size(), 1000U * kConditions);
  for (std::size_t i = 0; i < refusals.size(); ++i) {
    ASSERT_EQ(refusals[i], i / kConditions == kCandidate ? 1 : 0) << "row " << i;
  }
  RecordProperty("starts", starts);
}

}  // namespace
}  // namespace tribodyn::server
