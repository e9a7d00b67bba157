#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "server/simulation/input_errors.h"
#include "server/simulation/point_evaluation.h"
#include "tribodyn/v1/points.pb.h"

namespace tribodyn::server {

/// Largest number of points of one explanation: 64 combinations times conditions times (draws + 1).
/// They take 2 to 10 s.
inline constexpr int kMaximumExplainedPoints = 64'000;
/// Draws by default: the 95 % interval then ends between the second and third draw from either end.
inline constexpr int kDefaultExplanationDraws = 99;
/// Relative tolerance by default. Differences of 10 % then have an error of 0.1 % or so.
inline constexpr double kDefaultExplanationTolerance = 1e-4;

/// Two lubricants, each on its surface, at the same conditions.
struct PointExplanation {
  struct Side {
    PointEvaluation evaluation;
    InputErrors lubricant_errors, scene_errors;
  };
  Side first, other;
  std::vector<double> weights;           ///< of the conditions, their sum 1
  int draws = kDefaultExplanationDraws;  ///< 0 if no input has an uncertainty
  double estimate_correlation;
};

/// Checks the request and finds its resources. Returns nullopt and adds all violations if the
/// request is invalid.
std::optional<PointExplanation> read_explanation(const v1::ExplainPointsRequest& request,
                                                 const ResourceLookup& lookup,
                                                 Violations& violations);

/// Computes all combinations of the six groups of parameters of both lubricants, with the stated
/// inputs and with drawn ones, and the Shapley values of the groups. Groups that are equal in both
/// lubricants are not exchanged: their Shapley values are exactly 0. Equal requests give equal
/// answers. Throws Cancelled soon after `is_over` returns true.
v1::ExplainPointsResponse explain_points(const PointExplanation& explanation,
                                         PreparedGearSets& gear_sets,
                                         const std::function<bool()>& is_over);

}  // namespace tribodyn::server
