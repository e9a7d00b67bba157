#pragma once

#include <Eigen/LU>
#include <limits>
#include <optional>

#include "core/integrate/step_sensitivity.h"
#include "core/periodic/leading_multiplier.h"

namespace tribodyn {

/// The linearised Poincare map of an orbit: derivatives of the state and the time after a period by
/// the state at mesh phase 0 and the unknown torque. Its eigenvalues without the torque are the
/// Floquet multipliers. One multiplier is 1, because the train as a whole runs on at any speed: all
/// bounds and moduli leave out the multiplier nearest to 1.
///  - Newton's steps solve with the LU factors of the Jacobian of the residual, map minus identity.
///  - All multipliers are eigenvalues by the QR algorithm. Cheaper, |lambda| <= ||M^k||^(1/k) for
///    k = 1, 2, 4 ... 1024 by squaring, after inverse iteration from both sides has found the
///    multiplier nearest to 1 and its eigenvectors, and M has been deflated by them.
///  - 1 / ||(M + I)^-1|| bounds the distance of the multipliers from -1 from below; three inverse
///    iterations with the shift -1 give the eigenvector there.
/// (R. Seydel, Practical Bifurcation and Stability Analysis, 3rd ed., 2010, chapter 7; G. H. Golub
/// and C. F. Van Loan, Matrix Computations, 4th ed., 2013, chapter 7.)
///
/// Not safe for concurrent access: const methods too store results in mutable members.
class PoincareMapJacobian {
 public:
  static constexpr int kUnknowns = 8;  // the seven states and the torque
  using Vector = Eigen::Matrix<double, kUnknowns, 1>;

  /// `scale`: of the unknowns. `period`: of the time's residual [s].
  PoincareMapJacobian(const Sensitivity& sensitivity, const Vector& scale, double period);

  /// Newton's step from a residual, both scaled.
  Vector step(const Vector& residual) const { return factors_.solve(-residual); }
  /// Of the Floquet multipliers. Computed once; later copies hold it.
  const LeadingMultiplier& leading() const;
  double largest_multiplier() const { return leading().modulus; }
  bool leading_multiplier_is_negative() const { return leading().is_negative; }
  /// Whether the largest modulus is proven to be below a limit, by norms of powers: cheaper than
  /// eigenvalues. Returns false if there is no proof, mostly within a percent of the limit. The
  /// bound is kept for the next call.
  bool floquet_radius_below(double limit) const;
  /// Lower bound of the distance of every multiplier from -1, where the period doubles (flip).
  /// Computed once.
  double flip_margin() const;
  /// The eigenvector of the multiplier nearest to -1, of length 1; scaled, without the torque.
  /// Requires a multiplier near -1.
  Eigen::Matrix<double, kUnknowns - 1, 1> flip_direction() const;

 private:
  double bound_of_floquet_radius(double enough) const;

  Eigen::PartialPivLU<Eigen::Matrix<double, kUnknowns, kUnknowns>> factors_;
  Eigen::Matrix<double, kUnknowns - 1, kUnknowns - 1> monodromy_;  // scaled
  mutable std::optional<LeadingMultiplier> leading_;               // not computed yet
  mutable double flip_margin_ = -1;
  mutable double floquet_radius_bound_ = std::numeric_limits<double>::infinity();
};

}  // namespace tribodyn
