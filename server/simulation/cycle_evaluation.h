#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "core/study/cycle_loss.h"
#include "server/contract/resource_names.h"
#include "server/contract/violations.h"
#include "server/simulation/point_evaluation.h"
#include "tribodyn/v1/cycles.pb.h"

namespace tribodyn::server {

/// Largest number of pieces of a cycle.
inline constexpr int kMaximumCyclePieces = 20'000;
/// Number of points after which maps are not refined further, for all lubricants together. They
/// take about 10 s. A request that solves every piece has no more.
inline constexpr int kMaximumCyclePoints = 20'000;
inline constexpr int kMostCycleLubricants = 8;

/// A cycle to drive.
struct CycleEvaluation {
  DrivenCycle cycle;
  std::vector<PointEvaluation> fluids;  ///< the lubricants; their conditions are not used
  LossMapOptions options;               ///< of each fluid
};

/// Checks the request and finds its resources. Returns nullopt and adds all violations if the
/// request is invalid.
std::optional<CycleEvaluation> read_cycle(const v1::EvaluateCycleRequest& request,
                                          const ResourceLookup& lookup, Violations& violations);

/// Computes the losses of all lubricants. A lubricant of which the core refuses a point has no
/// figures. Throws Cancelled soon after `is_over` returns true.
v1::EvaluateCycleResponse evaluate_cycle(const v1::EvaluateCycleRequest& request,
                                         const CycleEvaluation& evaluation,
                                         PreparedGearSets& gear_sets,
                                         const std::function<bool()>& is_over);

}  // namespace tribodyn::server
