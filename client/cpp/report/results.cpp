#include "client/cpp/report/results.h"

#include <algorithm>
#include <cmath>

#include "client/cpp/report/curve_report.h"
#include "client/cpp/report/point_report.h"
#include "client/cpp/text/colour.h"
#include "client/cpp/text/text.h"

namespace tribodyn::client {
namespace {

/// Ratio of torque to the largest torque of the data above which the caution is shown. A choice: no
/// model predicts where the data cease to be valid.
constexpr double kFarBeyond = 1.5;

}  // namespace

double largest_torque(const v1::GearSet& gear_set) {
  double largest = 0;
  for (const auto& series : gear_set.series_by_torque()) {
    largest = std::max(largest, series.pinion_torque_newton_metres());
  }
  for (const auto& share : gear_set.load_share_by_torque()) {
    largest = std::max(largest, share.pinion_torque_newton_metres());
  }
  return largest;
}

std::string torque_caution(const v1::Simulation& simulation, const TorqueLimits& limits) {
  const auto limit = limits.find(simulation.gear_set_revision());
  if (limit == limits.end() || limit->second <= 0) return "";
  double torque = 0;
  for (const v1::CurvePoint& point : simulation.result().points()) {
    torque = std::max(torque, std::abs(point.result().pinion_torque_newton_metres()));
  }
  const double ratio = torque / limit->second;
  if (ratio < kFarBeyond) return "";
  return std::string(simulation.has_inefficiency_curve() ? "The largest pinion torque, "
                                                         : "This pinion torque, ") +
         significant(torque, 3) + " N m, is " + significant(ratio, 2) +
         " times what the data of gear set " + resource_id(simulation.gear_set_revision()) +
         " reach (" + significant(limit->second, 3) + " N m).";
}

std::string results_text(const std::vector<v1::Simulation>& simulations, OutputFormat format,
                         bool alone, const ResultDetails& details, const TorqueLimits& limits,
                         const CurveUncertainties& uncertainties) {
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
    const std::string sentence = torque_caution(simulation, limits);
    if (!sentence.empty()) text += caution(wrapped("! " + sentence, 0)) + "\n";
    const auto found = uncertainties.find(simulation.name());
    text += simulation.has_operating_point()
                ? point_report(simulation, details)
                : curve_report(simulation, details,
                               found == uncertainties.end() ? nullptr : &found->second);
  }
  return text;
}

}  // namespace tribodyn::client
