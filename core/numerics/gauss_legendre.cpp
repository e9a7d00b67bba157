#include "core/numerics/gauss_legendre.h"

#include <cmath>
#include <numbers>

namespace tribodyn {

void gauss_legendre(int count, double* node, double* weight) {
  for (int i = 0; i < count; ++i) {
    double x = std::cos(std::numbers::pi * (i + 0.75) / (count + 0.5));
    double slope = 1;
    for (int iteration = 0; iteration < 100; ++iteration) {
      double p = 1, previous = 0;
      for (int k = 1; k <= count; ++k) {
        const double next = ((2 * k - 1) * x * p - (k - 1) * previous) / k;
        previous = p;
        p = next;
      }
      slope = count * (x * p - previous) / (x * x - 1);
      const double step = p / slope;
      x -= step;
      if (std::abs(step) < 1e-16) break;
    }
    node[count - 1 - i] = 0.5 * (1 + x);
    weight[count - 1 - i] = 1 / ((1 - x * x) * slope * slope);
  }
}

}  // namespace tribodyn
