#include "client/cpp/report/results.h"

#include "client/cpp/report/curve_report.h"
#include "client/cpp/report/point_report.h"

namespace tribodyn::client {

std::string results_text(const std::vector<v1::Simulation>& simulations, OutputFormat format,
                         bool alone, bool shows_assumptions) {
  switch (format) {
    case OutputFormat::kJson: {
      if (alone && simulations.size() == 1) return json_text(simulations.front());
      v1::ListSimulationsResponse list;
      for (const v1::Simulation& simulation : simulations) *list.add_simulations() = simulation;
      return json_text(list);
    }
    case OutputFormat::kCsv:
      return points_csv(simulations);
    case OutputFormat::kTable:
      break;
  }
  std::string text;
  for (const v1::Simulation& simulation : simulations) {
    if (simulation.state() != v1::Simulation::SUCCEEDED) continue;
    if (!text.empty()) text += "\n";
    text += simulation.has_operating_point() ? point_report(simulation, shows_assumptions)
                                             : curve_report(simulation, shows_assumptions);
  }
  return text;
}

}  // namespace tribodyn::client
