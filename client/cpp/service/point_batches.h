#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "client/cpp/resources/candidate_table.h"
#include "tribodyn/client/connection.h"

namespace tribodyn::client {

/// Most points of one call that the server evaluates.
inline constexpr int kMostPointsOfACall = 2000;

/// The points of some candidates, consecutive in the list of evaluate_candidates().
struct PointBatch {
  std::size_t first, count;  ///< positions in that list
  v1::EvaluatePointsResponse answer;
};

/// Evaluates candidates at the conditions of `request`, which names their base, in calls of some
/// hundred points of which several are under way. Calls `use` in the calling thread once for each
/// batch, in order, and `wait` at least ten times a second; ends early if `wait` returns false.
/// Throws ServiceError, and what `use` throws.
void evaluate_candidates(Connection& connection, const v1::EvaluatePointsRequest& request,
                         const std::vector<CandidateParameter>& parameters,
                         const std::vector<std::size_t>& candidates,
                         const std::function<void(const PointBatch&)>& use,
                         const std::function<bool()>& wait);

}  // namespace tribodyn::client
