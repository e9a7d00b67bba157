#pragma once

#include <array>
#include <cmath>
#include <numbers>

namespace tribodyn {

/// [m][j]: coefficient of x^j in T_m; 0 unless m - j is even.
template <class Real, int N>
std::array<std::array<Real, N>, N> chebyshev_powers() {
  std::array<std::array<Real, N>, N> out{};
  out[0][0] = 1;
  out[1][1] = 1;
  for (int m = 2; m < N; ++m) {
    for (int j = 0; j <= m; ++j) {
      out[m][j] = (j > 0 ? 2 * out[m - 1][j - 1] : 0) - out[m - 2][j];
    }
  }
  return out;
}

/// N Chebyshev points -cos(pi (i + 1/2)/N), rising, and the polynomials T_0 ... T_{N-1}.
template <int N>
struct Chebyshev {
  using Square = std::array<std::array<double, N>, N>;
  std::array<double, N> point;
  Square to_coefficients;  ///< [m][i]: what the value at point i adds to the coefficient of T_m
  Square in_powers;        ///< see chebyshev_powers

  Chebyshev() : in_powers(chebyshev_powers<double, N>()) {
    for (int i = 0; i < N; ++i) {
      const double angle = std::numbers::pi * (N - i - 0.5) / N;
      point[i] = std::cos(angle);
      for (int m = 0; m < N; ++m) {
        to_coefficients[m][i] = (m == 0 ? 1.0 : 2.0) / N * std::cos(m * angle);
      }
    }
  }
};

/// The rule, computed once; thread-safe.
template <int N>
const Chebyshev<N>& chebyshev() {
  static const Chebyshev<N> rule;
  return rule;
}

}  // namespace tribodyn
