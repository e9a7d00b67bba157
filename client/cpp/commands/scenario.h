#pragma once

#include <string>
#include <vector>

#include "client/cpp/commands/command.h"
#include "client/cpp/report/result_details.h"
#include "tribodyn/v1/simulations.pb.h"

namespace tribodyn::client {

/// The options that point, curve and history have in common: fluid, hardware, temperatures, model
/// and solver. The flags fill a Simulation except for its lubricant and its study.
struct Scenario {
  std::vector<std::string> lubricants;  ///< as typed: "my-oil" or "lubricants/my-oil"
  std::vector<double> sumps;            ///< [C]; several for curves alone; empty: the default
  std::vector<std::string> surfaces;    ///< as typed; several for curves alone; empty: the default
  /// What else each curve is computed with: a word of compared_words() each.
  std::vector<std::string> compared;
  v1::Simulation simulation;
  bool detach = false;  ///< submit, print how to watch the jobs, and return
  CreateOptions create;
  ResultDetails details;
};

/// Adds the flags; they write to `scenario`, which must outlive them. Solver and model flags come
/// last, below their own headings.
void add_scenario_flags(FlagList& flags, Scenario& scenario);
void check_scenario(const Scenario& scenario, bool several_lubricants, Complaints& complaints);

/// Returns for each lubricant, surface and sump temperature one Simulation, followed by one for
/// each word of `compared`.
std::vector<v1::Simulation> simulations_of(const Scenario& scenario);

/// Submits all simulations, watches them in parallel and returns them when all have ended. With
/// `detach` or `validate_only` prints the outcome of the submission and returns none.
std::vector<v1::Simulation> run_scenario(const Scenario& scenario, Connection& connection,
                                         const CommonOptions& options);

/// Prints the simulations without results and the reasons on standard error; returns kExitFailed if
/// there are any.
int report_failures(const std::vector<v1::Simulation>& simulations);

/// Adds a flag for each switch of the model, e.g. "--no-limiting-shear-stress" for
/// "no_limiting_shear_stress".
void add_model_flags(FlagList& flags, v1::ModelOptions& options);

/// Returns the words for variants of a curve, separated by '|', e.g. "isothermal|newtonian".
std::string compared_words();
/// Changes a curve to the variant of that word. Returns false if there is no such word.
bool apply_variant(const std::string& word, v1::Simulation& simulation);

}  // namespace tribodyn::client
