#pragma once

#include <string>
#include <vector>

#include "client/cpp/commands/screen_flags.h"
#include "client/cpp/service/interrupt.h"

namespace tribodyn::client {

// `interrupts` says what Ctrl-C leaves behind until the campaign is followed.

/// Screens candidates on the axle: by a campaign of the server, ranked by this program. Returns the
/// exit code.
int run_axle_screen(ScreenFlags& flags, Connection& connection, const CommonOptions& options,
                    InterruptText& interrupts);

/// Screens candidates on a rig: by a campaign that the server ranks. Returns the exit code.
int run_rig_screen(const ScreenFlags& flags, Connection& connection, const CommonOptions& options,
                   InterruptText& interrupts);

// What both have in common.

/// Returns the revisions of the lubricants that are candidates, in their order.
std::vector<std::string> candidate_lubricants(const ScreenFlags& flags, Connection& connection);

/// Sets candidates that the server makes or finds.
void set_made_candidates(const ScreenFlags& flags, const std::vector<std::string>& lubricants,
                         v1::Campaign& campaign);

/// Returns the name of a table without its folder; empty for standard input.
std::string table_title(const std::string& path);

/// Sets the budget that the command line states, and resumes a campaign that is paused; without a
/// budget on the command line it has none from then on.
void go_on(const ScreenFlags& flags, const v1::Campaign& campaign, Connection& connection);

/// Says why a campaign has points that are not computed, and how to go on.
void report_stop(const v1::Campaign& campaign, const Connection& connection);

}  // namespace tribodyn::client
