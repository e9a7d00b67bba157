#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "client/cpp/commands/command.h"

namespace tribodyn::client {

/// The texts of a command on campaigns.
struct CampaignTexts {
  const char *path, *summary, *about, *example;
};

/// Returns a command without `run` on one campaign, or on several. Their full names go to `name`,
/// which must live as long as the command: its `run` owns it.
Command one_campaign_command(const CampaignTexts& texts, std::string& name);
Command campaigns_command(const CampaignTexts& texts, std::vector<std::string>& names);

/// Adds a check to those that a command has.
void add_check(Command& command, const std::function<void(Complaints&)>& check);

/// Returns the command that prints columns of a campaign.
Command campaign_columns_command();
/// Returns the command that adds candidates to a campaign.
Command campaign_append_command();

}  // namespace tribodyn::client
