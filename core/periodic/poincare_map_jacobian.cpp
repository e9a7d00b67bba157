#include "core/periodic/poincare_map_jacobian.h"

#include <Eigen/Dense>
#include <cmath>
#include <limits>

#include "core/driveline/gear_pair_system.h"

namespace tribodyn {

PoincareMapJacobian::PoincareMapJacobian(const Sensitivity& sensitivity, const Vector& scale,
                                         double period) {
  Eigen::Matrix<double, kUnknowns, kUnknowns> jacobian;
  for (int i = 0; i + 1 < kUnknowns; ++i) {
    jacobian.row(i) = sensitivity[i + 1].matrix();
    monodromy_.row(i) = sensitivity[i + 1].head<kUnknowns - 1>().matrix() / scale(i);
    jacobian(i, i) -= 1;
    jacobian.row(i) /= scale(i);
  }
  jacobian.row(kUnknowns - 1) = sensitivity[kTime].matrix() / period;
  factors_.compute(jacobian * scale.asDiagonal());
  monodromy_ *= scale.head<kUnknowns - 1>().asDiagonal();
}

bool PoincareMapJacobian::floquet_radius_below(double limit) const {
  if (!(floquet_radius_bound_ < limit)) floquet_radius_bound_ = bound_of_floquet_radius(limit);
  return floquet_radius_bound_ < limit;
}

double PoincareMapJacobian::flip_margin() const {
  if (flip_margin_ >= 0) return flip_margin_;
  using Square = Eigen::Matrix<double, kUnknowns - 1, kUnknowns - 1>;
  flip_margin_ = 1 / Eigen::PartialPivLU<Square>(monodromy_ + Square::Identity()).inverse().norm();
  return flip_margin_;
}

Eigen::Matrix<double, PoincareMapJacobian::kUnknowns - 1, 1> PoincareMapJacobian::flip_direction()
    const {
  constexpr int kIterations = 3;  // inverse; the others are ten times farther from -1 and more
  using Square = Eigen::Matrix<double, kUnknowns - 1, kUnknowns - 1>;
  const Eigen::PartialPivLU<Square> factors(monodromy_ + Square::Identity());
  Eigen::Matrix<double, kUnknowns - 1, 1> direction =
      monodromy_ * Eigen::Matrix<double, kUnknowns - 1, 1>::Ones();
  for (int i = 0; i < kIterations; ++i) direction = factors.solve(direction).normalized();
  return direction;
}

/// |lambda|^k is at most the norm of the k-th power, once the multiplier nearest to 1 is taken out.
/// A bound below `enough` will do.
double PoincareMapJacobian::bound_of_floquet_radius(double enough) const {
  constexpr double kUnknown = std::numeric_limits<double>::infinity();
  constexpr int kFewestIterations = 3, kMostIterations = 8, kSquarings = 10;
  constexpr double kFound = 1e-6;
  using Square = Eigen::Matrix<double, kUnknowns - 1, kUnknowns - 1>;
  using Direction = Eigen::Matrix<double, kUnknowns - 1, 1>;
  const Eigen::PartialPivLU<Square> factors(monodromy_ - Square::Identity());
  Direction right = Direction::Ones(), left = Direction::Ones();
  double overlap = 0, nearest = 0;
  bool found = false;
  for (int i = 1; !found; ++i) {
    if (i > kMostIterations) return kUnknown;
    right = factors.solve(right).normalized();
    left = factors.transpose().solve(left).normalized();
    if (i < kFewestIterations) continue;
    overlap = left.dot(right);
    nearest = left.dot(monodromy_ * right) / overlap;
    const double missed = (monodromy_ * right - nearest * right).norm() +
                          (monodromy_.transpose() * left - nearest * left).norm();
    found = missed < kFound * std::abs(overlap);
  }
  Square power = monodromy_ - nearest / overlap * right * left.transpose();
  double log_norm = 0, exponent = 1;  // of the power: e^log_norm times the matrix at hand
  for (int i = 0;; ++i) {
    const double norm = power.norm();
    if (norm == 0) return 0;
    log_norm += std::log(norm);
    const double bound = std::exp(log_norm / exponent);
    if (bound < enough || i == kSquarings) return bound;
    power /= norm;
    power = power.lazyProduct(power).eval();
    log_norm *= 2;
    exponent *= 2;
  }
}

const LeadingMultiplier& PoincareMapJacobian::leading() const {
  if (!leading_) leading_ = leading_multiplier(monodromy_);
  return *leading_;
}

}  // namespace tribodyn
