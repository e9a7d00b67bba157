#pragma once

#include <map>
#include <string>
#include <vector>

#include "client/cpp/report/input_uncertainty.h"
#include "client/cpp/report/result_details.h"
#include "client/cpp/text/output.h"
#include "tribodyn/v1/gear_sets.pb.h"
#include "tribodyn/v1/simulations.pb.h"

namespace tribodyn::client {

/// The largest pinion torque [N m] for which each gear set has data, by the name of its revision; 0
/// if its data do not depend on the torque.
using TorqueLimits = std::map<std::string, double>;
double largest_torque(const v1::GearSet& gear_set);

/// Returns a sentence if the pinion torque is far beyond the data of the gear set, else an empty
/// text.
std::string torque_caution(const v1::Simulation& simulation, const TorqueLimits& limits);

/// Returns simulations that have ended in any format. Tables and CSV show those that succeeded;
/// JSON shows all, as one Simulation if `alone`, else as a ListSimulationsResponse. A table begins
/// with torque_caution(), and a table of a curve shows its uncertainty if `uncertainties` has it.
std::string results_text(const std::vector<v1::Simulation>& simulations, OutputFormat format,
                         bool alone, const ResultDetails& details, const TorqueLimits& limits,
                         const CurveUncertainties& uncertainties = {});

}  // namespace tribodyn::client
