#include "core/contact/specific_sliding.h"

#include <cmath>

namespace tribodyn {

SpecificSliding specific_sliding(const ContactConditionsOf<double>& k) {
  const double slide = std::hypot(k.velocity_1_x - k.velocity_2_x, k.velocity_1_y - k.velocity_2_y);
  if (slide == 0) return {};
  return {slide / std::hypot(k.velocity_1_x, k.velocity_1_y),
          slide / std::hypot(k.velocity_2_x, k.velocity_2_y)};
}

}  // namespace tribodyn
