#pragma once

#include <string>
#include <vector>

#include "client/cpp/commands/command.h"
#include "tribodyn/v1/simulations.pb.h"

namespace tribodyn::client {

/// What point, curve and history have in common: fluid, hardware, temperatures, model and solver.
/// The flags write into a Simulation that misses only its lubricant and its study.
struct Scenario {
  std::vector<std::string> lubricants;  ///< as given: "1" or "lubricants/1"
  v1::Simulation simulation;
  bool detach = false;  ///< submit, say how to follow, and return
  CreateOptions create;
  bool shows_assumptions = false;  ///< print the whole ledger
};

/// Writes to `scenario`, which must outlive the flags. Solver and model flags come last, under
/// their own headings.
void add_scenario_flags(FlagList& flags, Scenario& scenario);
void check_scenario(const Scenario& scenario, bool several_lubricants, Complaints& complaints);

/// One Simulation per lubricant.
std::vector<v1::Simulation> simulations_of(const Scenario& scenario);

/// Submits all, follows them together and returns them as they ended. Detached or only to be
/// validated, it says so on standard output and returns nothing.
std::vector<v1::Simulation> run_scenario(const Scenario& scenario, Connection& connection,
                                         const CommonOptions& options);

/// Prints on standard error which simulations have nothing to show and why; kExitFailed if any has.
int report_failures(const std::vector<v1::Simulation>& simulations);

/// A flag for each switch of the model: "--no-limiting-shear-stress" of "no_limiting_shear_stress".
void add_model_flags(FlagList& flags, v1::ModelOptions& options);

}  // namespace tribodyn::client
