#pragma once

#include <Eigen/Core>

namespace tribodyn {

/// Gauss-Legendre rule of N points on [0, 1]; exact for polynomials of degree 2N - 1.
template <int N>
struct GaussLegendre {
  Eigen::Array<double, N, 1> node;
  Eigen::Array<double, N, 1> weight;
};

/// Nodes by Newton on the Legendre recurrence from the Chebyshev guess, to machine precision.
void gauss_legendre(int count, double* node, double* weight);

/// The rule, computed once; thread-safe.
template <int N>
const GaussLegendre<N>& gauss_legendre() {
  static const GaussLegendre<N> rule = [] {
    GaussLegendre<N> r;
    gauss_legendre(N, r.node.data(), r.weight.data());
    return r;
  }();
  return rule;
}

}  // namespace tribodyn
