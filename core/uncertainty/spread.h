#pragma once

#include <optional>
#include <span>
#include <vector>

namespace tribodyn {

/// What draws of a figure say of it.
struct Spread {
  double standard_deviation;  ///< in the unit of the figure
  double low, high;           ///< interval of the coverage, in the unit of the figure
};

/// Share of probability in an interval that is stated without another [-].
inline constexpr double kIntervalCoverage = 0.95;

/// The spread of at least two draws. The interval leaves out equal shares below and above; its ends
/// lie between the sorted draws, the i-th of n (from 0) at the probability (i + 1/2)/n.
Spread spread_of(std::vector<double> draws, double coverage = kIntervalCoverage);

/// Share of draws below zero; draws that are zero count half [-]. Requires one draw at least.
double share_below_zero(std::span<const double> draws);

}  // namespace tribodyn
