#include "core/contact/specific_sliding.h"

#include <cmath>

namespace tribodyn {

SpecificSliding specific_sliding(const ContactConditionsOf<double>& k) {
  const double slide = sliding_speed(k);
  if (slide == 0) return {};
  const auto over = [slide](double x, double y) {
    return slide / std::sqrt(laws::square(x) + laws::square(y));
  };
  return {over(k.velocity_1_x, k.velocity_1_y), over(k.velocity_2_x, k.velocity_2_y)};
}

}  // namespace tribodyn
