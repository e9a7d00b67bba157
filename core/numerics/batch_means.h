#pragma once

#include <cstddef>
#include <optional>
#include <span>

namespace tribodyn {

/// Returns how many leading values the mean of a series should leave out because they still depend
/// on where the series started:
///  1. The d that minimises the estimated variance of the mean of the rest,
///       sum_{i >= d} (x_i - mean_d)^2 / (n - d)^2,   0 <= d <= n/2.
///     (MSER: K. P. White, Simulation 69, 1997, 323; of means of blocks, as here, K. P. White,
///     M. J. Cobb and S. C. Spratt, Proc. Winter Simulation Conference 2000, 755.)
///  2. None, if the mean of the first d values is as near to that of the rest as the scatter of the
///     rest explains: MSER alone takes from a stationary series what scatters most. (Comparison of
///     the means of two parts: J. Geweke, in Bayesian Statistics 4, 1992, 169.)
std::size_t initial_transient(std::span<const double> series);

/// Returns half of the width of the confidence interval of a stationary series' mean, whose values
/// may depend on their predecessors, by nonoverlapping batch means:
///  1. Neighbours are averaged in pairs, and these again, while batch means are correlated and
///     twenty or more of them are left.
///  2. The correlation r that remains from one batch to the next counts as that of a first-order
///     autoregression: k batches are worth k (1 - r)/(1 + r) independent ones. r is corrected for
///     its bias in short series, and at least 0.
///  3. The interval is Student's t of as many independent batches.
/// Returns nullopt if the series is worth fewer than three of them, as one that still drifts is.
/// (Batch means: B. Schmeiser, Operations Research 30, 1982, 556, and J. M. Flegal and G. L. Jones,
/// Annals of Statistics 38, 2010, 1034; correlation left in them: A. Tafazzoli, J. R. Wilson,
/// E. K. Lada and N. M. Steiger, INFORMS J. Computing 23, 2011, 297; bias of r: F. H. C. Marriott
/// and J. A. Pope, Biometrika 41, 1954, 390.)
/// Requires 0 < coverage < 1, the probability with which the interval holds the true mean.
std::optional<double> half_width_of_mean(std::span<const double> series, double coverage);

}  // namespace tribodyn
