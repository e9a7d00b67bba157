#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace tribodyn {

/// Change of a response when one column of the model rises by 1.
struct MainEffect {
  double effect;          ///< in the unit of the response over that of the column
  double standard_error;  ///< from the scatter about the model
  double low, high;       ///< interval of the coverage, by Student's t distribution
};

/// A linear model of a response with an intercept and without interactions, by least squares.
struct MainEffects {
  /// By column; absent for a column that is constant or a sum of multiples of earlier ones.
  std::vector<std::optional<MainEffect>> effects;
  int degrees_of_freedom;              ///< rows less coefficients
  double residual_standard_deviation;  ///< in the unit of the response
  double explained_share;              ///< of the variance of the response, 0 to 1 (R squared)
};

/// Returns the main effects of the columns on the response; nullopt if no degree of freedom is left
/// for the scatter. Requires finite values, as many rows as responses and 0 < coverage < 1. Scales
/// of the columns do not matter. Source: N. R. Draper and H. Smith, Applied Regression Analysis,
/// 3rd ed., Wiley 1998, chapter 5.
std::optional<MainEffects> main_effects(const Eigen::MatrixXd& columns,
                                        const Eigen::VectorXd& response, double coverage);

}  // namespace tribodyn
