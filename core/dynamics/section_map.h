#pragma once

#include <Eigen/LU>
#include <array>
#include <limits>

namespace tribodyn {

/// Derivatives of time and the seven states, in the order of MarchComponent, by the seven states at
/// the section and by the unknown torque.
using Sensitivity = std::array<Eigen::Array<double, 1, 8>, 8>;

/// How the state after a period follows the state at the section and the unknown torque.
class SectionMap {
 public:
  static constexpr int kUnknowns = 8;  // the seven states and the torque
  using Vector = Eigen::Matrix<double, kUnknowns, 1>;

  /// `scale`: of the unknowns. `period`: of the time's residual [s].
  SectionMap(const Sensitivity& sensitivity, const Vector& scale, double period);

  /// Newton's step from a residual, both scaled.
  Vector step(const Vector& residual) const { return factors_.solve(-residual); }
  /// Floquet, modulus; but for the one nearest to 1: the train as a whole runs on at any speed.
  /// Computed once; copies made after that know it.
  double largest_multiplier() const;
  /// Whether that one is negative: disturbances by it change sides every period.
  bool alternates() const;
  /// Whether that is surely below a limit, at a fraction of the price. False where it cannot tell,
  /// mostly within a percent. A proof is remembered like that.
  bool multipliers_are_below(double limit) const;
  /// Not above the distance of any multiplier from -1, where periods double. Computed once, as
  /// largest_multiplier().
  double distance_from_doubling() const;
  /// The disturbance of the section that comes nearest to changing its side every period and
  /// nothing else, of length 1; scaled, without the torque. Of use where a multiplier is near -1.
  Eigen::Matrix<double, kUnknowns - 1, 1> alternating_disturbance() const;

 private:
  double bound_of_multipliers(double enough) const;

  Eigen::PartialPivLU<Eigen::Matrix<double, kUnknowns, kUnknowns>> factors_;
  Eigen::Matrix<double, kUnknowns - 1, kUnknowns - 1> monodromy_;  // scaled
  mutable bool alternates_ = false;
  mutable double largest_multiplier_ = -1;  // not computed yet
  mutable double distance_from_doubling_ = -1;
  mutable double multiplier_bound_ = std::numeric_limits<double>::infinity();
};

}  // namespace tribodyn
