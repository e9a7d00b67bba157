#include "core/decisions/main_effects.h"

#include <Eigen/Cholesky>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>

namespace tribodyn {
namespace {

/// Share of the length of a column about its mean that must remain apart from earlier columns:
/// below it the column is a sum of multiples of them, to within rounding.
constexpr double kIndependentShare = 1e-8;

/// The columns that are independent, each less its mean and of unit length.
struct IndependentColumns {
  std::vector<Eigen::Index> indices;
  std::vector<double> lengths;  // of the columns less their means
  Eigen::MatrixXd columns;
};

IndependentColumns independent_columns(const Eigen::MatrixXd& columns) {
  IndependentColumns out;
  const Eigen::Index rows = columns.rows();
  out.columns.resize(rows, columns.cols());
  Eigen::MatrixXd basis(rows, columns.cols());  // orthonormal, by Gram and Schmidt
  Eigen::Index count = 0;
  for (Eigen::Index k = 0; k < columns.cols(); ++k) {
    const Eigen::VectorXd centred = (columns.col(k).array() - columns.col(k).mean()).matrix();
    const double length = centred.norm();
    // A constant column: what is left about its mean is rounding.
    if (!(length > 1e-12 * columns.col(k).norm())) continue;
    Eigen::VectorXd rest = centred / length;
    for (int pass = 0; pass < 2; ++pass) {  // twice is enough
      rest -= basis.leftCols(count) * (basis.leftCols(count).transpose() * rest);
    }
    if (!(rest.norm() > kIndependentShare)) continue;
    basis.col(count) = rest.normalized();
    out.columns.col(count) = centred / length;
    out.indices.push_back(k);
    out.lengths.push_back(length);
    ++count;
  }
  out.columns.conservativeResize(rows, count);
  return out;
}

}  // namespace

std::optional<MainEffects> main_effects(const Eigen::MatrixXd& columns,
                                        const Eigen::VectorXd& response, double coverage) {
  const IndependentColumns model = independent_columns(columns);
  const auto count = static_cast<Eigen::Index>(model.indices.size());
  MainEffects out{};
  out.effects.resize(static_cast<std::size_t>(columns.cols()));
  out.degrees_of_freedom = static_cast<int>(response.size() - count) - 1;
  if (out.degrees_of_freedom < 1) return std::nullopt;
  const Eigen::VectorXd centred = (response.array() - response.mean()).matrix();
  const Eigen::LDLT<Eigen::MatrixXd> normal((model.columns.transpose() * model.columns).eval());
  const Eigen::VectorXd coefficients = normal.solve(model.columns.transpose() * centred);
  const Eigen::VectorXd residuals = centred - model.columns * coefficients;
  const double variance = residuals.squaredNorm() / out.degrees_of_freedom;
  out.residual_standard_deviation = std::sqrt(variance);
  const double whole = centred.squaredNorm();
  out.explained_share = whole > 0 ? 1 - residuals.squaredNorm() / whole : 0;
  const Eigen::MatrixXd inverse = normal.solve(Eigen::MatrixXd::Identity(count, count));
  const double reach =
      quantile(boost::math::students_t(out.degrees_of_freedom), 0.5 * (1 + coverage));
  for (Eigen::Index j = 0; j < count; ++j) {
    const auto position = static_cast<std::size_t>(j);
    const double length = model.lengths[position];
    const double effect = coefficients(j) / length;
    const double error = std::sqrt(variance * inverse(j, j)) / length;
    out.effects[static_cast<std::size_t>(model.indices[position])] =
        MainEffect{effect, error, effect - reach * error, effect + reach * error};
  }
  return out;
}

}  // namespace tribodyn
