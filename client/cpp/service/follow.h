#pragma once

#include <string>
#include <vector>

#include "client/cpp/text/progress.h"
#include "tribodyn/client/connection.h"

namespace tribodyn::client {

/// Returns how the command line is called for the project of a connection: "tribodyn" or
/// "tribodyn --project acme".
std::string program_of(const Connection& connection);

/// Returns "queued", "running", "succeeded", ...
std::string state_text(v1::Simulation::State state);

/// Returns what Ctrl-C prints while simulations are submitted one after the other, and once all
/// are: the commands that watch or cancel those that the server has.
std::string interrupted_submission(const Connection& connection,
                                   const std::vector<v1::Simulation>& submitted, bool are_all);

/// Watches simulations in one stream until all have ended and returns them with their results, in
/// the given order. Shows one progress display on standard error. Throws Failure: kExitInterrupted
/// on Ctrl-C, kExitCannotConnect when the server is lost. The simulations go on in both cases; the
/// message contains the commands that watch or cancel them.
std::vector<v1::Simulation> follow(Connection& connection,
                                   const std::vector<v1::Simulation>& simulations,
                                   const std::vector<std::string>& labels, ProgressForm form);

}  // namespace tribodyn::client
