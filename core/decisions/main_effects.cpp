#include "core/decisions/main_effects.h"

#include <cmath>

#include "core/numerics/square.h"
#include "core/numerics/students_t.h"

namespace tribodyn {
namespace {

/// Share of the length of a column about its mean that must remain apart from earlier columns:
/// below it the column is a sum of multiples of them, to within rounding.
constexpr double kIndependentShare = 1e-8;
/// Share of its length by which a column must differ from its mean: below it, the rest is rounding.
constexpr double kVaryingShare = 1e-12;

// Loops instead of Eigen's decompositions and products of matrices: they take a third of the time
// to compile.

/// The independent columns less their means, as the product of orthonormal vectors and an upper
/// triangular matrix (Gram and Schmidt).
struct Factors {
  std::vector<Eigen::Index> columns;         // of the model
  std::vector<Eigen::VectorXd> vectors;      // Q
  std::vector<std::vector<double>> entries;  // R by column: entries[j][i] with i <= j

  std::size_t size() const { return columns.size(); }
};

Factors factors_of(const Eigen::MatrixXd& columns) {
  Factors out;
  for (Eigen::Index k = 0; k < columns.cols(); ++k) {
    Eigen::VectorXd rest = (columns.col(k).array() - columns.col(k).mean()).matrix();
    const double length = rest.norm();
    if (!(length > kVaryingShare * columns.col(k).norm())) continue;
    std::vector<double> entries(out.size() + 1);
    for (int pass = 0; pass < 2; ++pass) {  // the second one removes the rounding of the first
      for (std::size_t i = 0; i < out.size(); ++i) {
        const double part = out.vectors[i].dot(rest);
        entries[i] += part;
        rest -= part * out.vectors[i];
      }
    }
    entries.back() = rest.norm();
    if (!(entries.back() > kIndependentShare * length)) continue;
    out.vectors.emplace_back(rest / entries.back());
    out.entries.push_back(std::move(entries));
    out.columns.push_back(k);
  }
  return out;
}

/// Solves R x = right.
std::vector<double> solved(const Factors& factors, std::vector<double> right) {
  for (std::size_t j = factors.size(); j-- > 0;) {
    right[j] /= factors.entries[j][j];
    for (std::size_t i = 0; i < j; ++i) right[i] -= factors.entries[j][i] * right[j];
  }
  return right;
}

/// The diagonal of the inverse of R' R: variances of the coefficients over that of the response.
std::vector<double> relative_variances(const Factors& factors) {
  std::vector<double> out(factors.size());
  for (std::size_t k = 0; k < factors.size(); ++k) {
    std::vector<double> unit(factors.size());
    unit[k] = 1;
    const std::vector<double> column = solved(factors, unit);  // of the inverse of R
    for (std::size_t j = 0; j < factors.size(); ++j) out[j] += square(column[j]);
  }
  return out;
}

}  // namespace

std::optional<MainEffects> main_effects(const Eigen::MatrixXd& columns,
                                        const Eigen::VectorXd& response, double coverage) {
  const Factors factors = factors_of(columns);
  MainEffects out{};
  out.effects.resize(static_cast<std::size_t>(columns.cols()));
  out.degrees_of_freedom =
      static_cast<int>(response.size() - static_cast<Eigen::Index>(factors.size())) - 1;
  if (out.degrees_of_freedom < 1) return std::nullopt;
  Eigen::VectorXd rest = (response.array() - response.mean()).matrix();
  const double whole = rest.squaredNorm();
  std::vector<double> parts;
  for (const Eigen::VectorXd& each : factors.vectors) {
    parts.push_back(each.dot(rest));
    rest -= parts.back() * each;
  }
  const double variance = rest.squaredNorm() / out.degrees_of_freedom;
  out.residual_standard_deviation = std::sqrt(variance);
  out.explained_share = whole > 0 ? 1 - rest.squaredNorm() / whole : 0;
  const std::vector<double> coefficients = solved(factors, parts);
  const std::vector<double> variances = relative_variances(factors);
  const double reach = students_t_quantile(out.degrees_of_freedom, 0.5 * (1 + coverage));
  for (std::size_t j = 0; j < factors.size(); ++j) {
    const double error = std::sqrt(variance * variances[j]);
    out.effects[static_cast<std::size_t>(factors.columns[j])] = MainEffect{
        coefficients[j], error, coefficients[j] - reach * error, coefficients[j] + reach * error};
  }
  return out;
}

}  // namespace tribodyn
