#pragma once

#include <string>

#include "client/cpp/text/progress.h"
#include "tribodyn/client/connection.h"

namespace tribodyn::client {

/// Returns "running", "paused", "succeeded", ...
std::string state_text(v1::Campaign::State state);

/// Returns e.g. "12000 of 39000 points".
std::string points_text(const v1::Campaign& campaign);

/// Follows a campaign until it has ended or is paused, with progress on standard error, and returns
/// it. Throws Failure: kExitInterrupted on Ctrl-C, kExitCannotConnect when the server is lost. In
/// both cases the server continues the campaign; the message contains the commands that continue or
/// cancel it.
v1::Campaign follow_to_end(Connection& connection, const std::string& name, ProgressForm form);

}  // namespace tribodyn::client
