#include "client/cpp/commands/show_results.h"

#include <algorithm>

#include "client/cpp/report/results.h"

namespace tribodyn::client {
namespace {

/// Returns the gear sets that the simulations used. Omits those that the server does not return:
/// the results are shown in any case.
std::vector<v1::GearSet> gear_sets_of(const std::vector<v1::Simulation>& simulations,
                                      Connection& connection) {
  std::vector<v1::GearSet> gear_sets;
  std::vector<std::string> names;
  for (const v1::Simulation& simulation : simulations) {
    const std::string& name = simulation.gear_set_revision();
    if (name.empty() || std::find(names.begin(), names.end(), name) != names.end()) continue;
    names.push_back(name);
    try {
      gear_sets.push_back(connection.get<v1::GearSet>(name));
      gear_sets.back().set_name(name);
    } catch (const ServiceError&) {
      continue;
    }
  }
  return gear_sets;
}

}  // namespace

std::string shown_results(const std::vector<v1::Simulation>& simulations, Connection& connection,
                          const CommonOptions& options, bool alone, const ResultDetails& details,
                          const CurveUncertainties& uncertainties) {
  TorqueLimits limits;
  if (options.output_format == OutputFormat::kTable) {
    for (const v1::GearSet& gear_set : gear_sets_of(simulations, connection)) {
      limits[gear_set.name()] = largest_torque(gear_set);
    }
  }
  return results_text(simulations, options.output_format, alone, details, limits, uncertainties);
}

}  // namespace tribodyn::client
