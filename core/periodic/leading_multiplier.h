#pragma once

#include <Eigen/Core>

namespace tribodyn {

/// The Floquet multiplier of the largest modulus, but for the one nearest to 1: the train as a
/// whole runs on at any speed.
struct LeadingMultiplier {
  double modulus = 0;
  bool is_negative = false;  ///< its real part: a disturbance then changes its side every period
  /// Distance from -1, where the period doubles, of the multiplier nearest to it; and from 1, where
  /// the branch folds.
  double to_flip = 0, to_fold = 0;
};

/// Of the derivatives of the seven states of the section by themselves a period earlier.
LeadingMultiplier leading_multiplier(const Eigen::Matrix<double, 7, 7>& monodromy);

}  // namespace tribodyn
