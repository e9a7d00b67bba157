#include "core/uncertainty/column_fit.h"

#include <cmath>

#include "core/numerics/square.h"

namespace tribodyn {
namespace {

/// Penalty of the weights: root mean square of an error that counts like a weight of 1, relative to
/// the size of the column [-]. Curves of seven lubricants have the same errors from 0.001 to 0.01.
constexpr double kPenalty = 0.003;

}  // namespace

ColumnBase::ColumnBase(const Eigen::MatrixXd& base)
    : sizes_(base.colwise().norm().transpose() / std::sqrt(static_cast<double>(base.rows()))) {
  sizes_ = (sizes_.array() > 0).select(sizes_, 1.0);
  scaled_ = base * sizes_.cwiseInverse().asDiagonal();
  Eigen::MatrixXd normal = scaled_.transpose() * scaled_;
  normal.diagonal().array() += square(kPenalty) * static_cast<double>(base.rows());
  normal_.compute(normal);
  kept_ =
      1 -
      scaled_.cwiseProduct(normal_.solve(scaled_.transpose()).transpose()).rowwise().sum().array();
}

ColumnFit ColumnBase::fit(const Eigen::VectorXd& column) const {
  const Eigen::VectorXd weights = normal_.solve(scaled_.transpose() * column);
  return {weights.cwiseQuotient(sizes_), (column - scaled_ * weights).cwiseQuotient(kept_)};
}

}  // namespace tribodyn
