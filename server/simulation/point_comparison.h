#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "server/simulation/input_errors.h"
#include "server/simulation/point_evaluation.h"
#include "tribodyn/v1/points.pb.h"

namespace tribodyn::server {

/// Largest number of points of one comparison: lubricants times conditions times (draws + 1). If
/// all of them are solved, they take 1 to 10 s.
inline constexpr int kMaximumComparedPoints = 10'000;
inline constexpr int kMostComparedLubricants = 8;
/// Draws by default. The 95 % interval then ends at the fifth draw from either end.
inline constexpr int kDefaultDraws = 199;
/// Correlation of estimates by one estimator (assumed): half of their variance is the estimator's,
/// half the scatter of lubricants about it.
inline constexpr double kDefaultEstimateCorrelation = 0.5;

/// Lubricants to compare, the first with each of the others.
struct PointComparison {
  struct Fluid {
    PointEvaluation evaluation;  ///< the lubricant as it is stated, at all conditions
    InputErrors errors;
  };
  std::vector<Fluid> fluids;
  InputErrors scene_errors;
  std::vector<double> weights;  ///< of the conditions, their sum 1
  int draws = kDefaultDraws;
  double estimate_correlation = kDefaultEstimateCorrelation;
};

/// Checks the request and finds its resources. Returns nullopt and adds all violations if the
/// request is invalid.
std::optional<PointComparison> read_comparison(const v1::ComparePointsRequest& request,
                                               const ResourceLookup& lookup,
                                               Violations& violations);

/// Computes every lubricant at every condition by compute_drawn_figures(); the draws of a common
/// error are the same for all lubricants. Equal requests give equal answers. Throws Cancelled soon
/// after `is_over` returns true.
v1::ComparePointsResponse compare_points(const PointComparison& comparison,
                                         PreparedGearSets& gear_sets,
                                         const std::function<bool()>& is_over);

}  // namespace tribodyn::server
