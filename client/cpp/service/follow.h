#pragma once

#include <string>
#include <vector>

#include "client/cpp/text/progress.h"
#include "tribodyn/client/connection.h"

namespace tribodyn::client {

/// "queued", "running", "succeeded", ...
std::string state_text(v1::Simulation::State state);

/// Waits for simulations side by side until every one has ended, with one progress display on
/// standard error, and returns them with their results, in the same order. Throws Failure:
/// kExitInterrupted on Ctrl-C, kExitCannotConnect when the server is lost; either says how to
/// resume or cancel, for the simulations themselves go on.
std::vector<v1::Simulation> follow(Connection& connection,
                                   const std::vector<v1::Simulation>& simulations,
                                   const std::vector<std::string>& labels, ProgressForm form);

}  // namespace tribodyn::client
