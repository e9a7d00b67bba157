#pragma once

#include <functional>
#include <vector>

#include "server/simulation/rig_evaluation.h"
#include "tribodyn/v1/rigs.pb.h"

namespace tribodyn::server {

/// Adds the uncertainty that the stated uncertainties of lubricant and surface make of the figures
/// of all conditions. `answer` has the figures by the stated inputs. All rows have the same drawn
/// inputs, of which there are `draws`; a draw that the model refuses in a row is left out there.
/// Throws Cancelled soon after `is_over` returns true.
void add_rig_uncertainties(const RigEvaluation& evaluation,
                           const std::vector<v1::RigCondition>& conditions, int draws,
                           const std::function<bool()>& is_over, v1::EvaluateRigResponse& answer);

}  // namespace tribodyn::server
