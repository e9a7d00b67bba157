#pragma once

namespace tribodyn::client {

/// What a table of a result shows beyond its figures.
struct ResultDetails {
  bool assumptions = false;  ///< lists the assumptions instead of counting them
  bool solver = false;       ///< of a point: steps, evaluations, multipliers and energy balance
};

/// Help of the flag that sets `solver`.
inline constexpr const char* kSolverDetailsHelp =
    "Print the solver's steps, evaluations, Floquet multiplier and energy balance of a point.";

}  // namespace tribodyn::client
