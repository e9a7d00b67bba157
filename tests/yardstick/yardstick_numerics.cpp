#include "yardstick_numerics.h"

#include <numbers>
#include <utility>

namespace tribodyn::yardstick {

GaussLegendreRule make_gauss_legendre_rule(int node_count) {
  GaussLegendreRule rule{std::vector<double>(node_count), std::vector<double>(node_count)};
  for (int node = 0; node < node_count; ++node) {
    double x = std::cos(std::numbers::pi * (node + 0.75) / (node_count + 0.5));
    double derivative = 1.0;
    for (int iteration = 0; iteration < 100; ++iteration) {
      double previous = 1.0;
      double polynomial = x;
      for (int degree = 2; degree <= node_count; ++degree) {
        const double next = ((2 * degree - 1) * x * polynomial - (degree - 1) * previous) / degree;
        previous = polynomial;
        polynomial = next;
      }
      derivative = node_count * (x * polynomial - previous) / (x * x - 1.0);
      const double correction = polynomial / derivative;
      x -= correction;
      if (std::abs(correction) < 1e-16) break;
    }
    rule.abscissae[node] = 0.5 * (1.0 - x);
    rule.weights[node] = 1.0 / ((1.0 - x * x) * derivative * derivative);
  }
  return rule;
}

std::vector<double> solve_linear_system(std::vector<std::vector<double>> matrix,
                                        std::vector<double> right_side) {
  const std::size_t size = right_side.size();
  for (std::size_t column = 0; column < size; ++column) {
    std::size_t pivot = column;
    for (std::size_t row = column + 1; row < size; ++row) {
      if (std::abs(matrix[row][column]) > std::abs(matrix[pivot][column])) pivot = row;
    }
    std::swap(matrix[column], matrix[pivot]);
    std::swap(right_side[column], right_side[pivot]);
    if (matrix[column][column] == 0.0) throw std::runtime_error("SolveLinearSystem: singular");
    for (std::size_t row = column + 1; row < size; ++row) {
      const double factor = matrix[row][column] / matrix[column][column];
      for (std::size_t k = column; k < size; ++k) matrix[row][k] -= factor * matrix[column][k];
      right_side[row] -= factor * right_side[column];
    }
  }
  for (std::size_t row = size; row-- > 0;) {
    for (std::size_t k = row + 1; k < size; ++k) right_side[row] -= matrix[row][k] * right_side[k];
    right_side[row] /= matrix[row][row];
  }
  return right_side;
}

}  // namespace tribodyn::yardstick
