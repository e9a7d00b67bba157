#pragma once

#include <string>
#include <vector>

#include "client/cpp/text/output.h"
#include "tribodyn/v1/campaigns.pb.h"

namespace tribodyn::client {

/// Returns "running", "paused", "succeeded", ...; "stalled" for one that runs without progress.
std::string state_text(const v1::Campaign& campaign);

/// Returns why a campaign is stalled, paused or failed; empty if it is none of these.
v1::CampaignStop reason_for_state(const v1::Campaign& campaign);

/// Returns e.g. "12000 of 39000 points".
std::string points_text(const v1::Campaign& campaign);

/// Returns campaigns as a table of one row each, as CSV or as JSON.
std::string campaigns_text(const std::vector<v1::Campaign>& campaigns, OutputFormat format);

/// Returns the state of one campaign: its progress, its inputs, and the reasons why points have no
/// figures; or as campaigns_text() in CSV, or as the message in JSON.
std::string campaign_text(const v1::Campaign& campaign, OutputFormat format);

}  // namespace tribodyn::client
