#pragma once

#include <string>

#include "client/cpp/text/progress.h"
#include "tribodyn/client/connection.h"

namespace tribodyn::client {

/// What Ctrl-C prints while a campaign is created by a command that would find it again.
inline constexpr char kCampaignMayExist[] =
    "interrupted while the campaign was created. If the server has it, it goes on, and the same "
    "command follows it; `tribodyn campaigns list` lists it.";

/// Returns what Ctrl-C prints once the server has the campaign: the commands that follow, pause or
/// cancel it.
std::string interrupted_campaign(const Connection& connection, const std::string& name);

/// Follows a campaign until it has ended or is paused, with progress on standard error, and returns
/// it. Throws Failure: kExitInterrupted on Ctrl-C, kExitCannotConnect when the server is lost. In
/// both cases the server continues the campaign; the message contains the commands that continue or
/// cancel it.
v1::Campaign follow_to_end(Connection& connection, const std::string& name, ProgressForm form);

}  // namespace tribodyn::client
