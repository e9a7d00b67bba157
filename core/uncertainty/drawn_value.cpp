#include "core/uncertainty/drawn_value.h"

#include <algorithm>
#include <cmath>

#include "core/numerics/square.h"

namespace tribodyn {

double drawn_value(double value, double standard_uncertainty, double deviation) {
  if (!(standard_uncertainty > 0)) return value;
  if (!(value > 0)) return value + standard_uncertainty * deviation;
  const double relative = std::min(standard_uncertainty / value, 10.0);
  return value * std::exp(std::sqrt(std::log1p(square(relative))) * deviation);
}

}  // namespace tribodyn
