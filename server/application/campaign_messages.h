#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "google/rpc/status.pb.h"
#include "server/application/application.h"
#include "server/storage/stored_campaign.h"
#include "tribodyn/v1/campaigns.pb.h"

namespace tribodyn::server {

// Stored campaigns as messages, and the errors that several methods of campaigns return.

inline constexpr char kCampaignType[] = "tribodyn.v1.Campaign";
/// Attempts to change a campaign against other writers.
inline constexpr int kCampaignWrites = 10;

/// Returns the stored campaign as a message, without what only GetCampaign answers.
v1::Campaign to_message(Application& application, const StoredCampaign& stored);
/// Returns why a campaign makes no progress; nullopt if it is not stalled.
std::optional<v1::CampaignStop> stall_of(CampaignJobs& campaigns, std::int64_t campaign);
CampaignBudget to_budget(const v1::CampaignBudget& budget);

/// Returns NOT_FOUND.
google::rpc::Status no_campaign(const std::string& name);
/// Returns the error of a campaign for which there is no place beside those that run.
google::rpc::Status campaign_turned_away(Application& application);

}  // namespace tribodyn::server
