#include "core/gear/flank_extremes.h"

#include <algorithm>
#include <cmath>

#include "core/numerics/square.h"

namespace tribodyn {

FlankExtremes flank_extremes(const GearSet& gear_set) {
  const ToothContactTables& t = gear_set.tables;
  const double gear_over_pinion = static_cast<double>(gear_set.pinion_teeth) / gear_set.gear_teeth;
  FlankExtremes out;
  double most_heating = -1;
  for (std::size_t k = 0; k < t.load_share.size(); ++k) {
    for (std::size_t i = 0; i < t.load_share[k].size(); ++i) {
      if (!(t.load_share[k][i] > 0)) continue;
      const double x = t.radius_x[k][i], y = t.radius_y[k][i];
      out.radius_ratio = std::max(out.radius_ratio, std::max(x, y) / std::min(x, y));
      const double pinion_x = t.pinion_velocity_x[k][i], pinion_y = t.pinion_velocity_y[k][i];
      const double gear_x = gear_over_pinion * t.gear_velocity_x[k][i];
      const double gear_y = gear_over_pinion * t.gear_velocity_y[k][i];
      const double entrainment =
          square(0.5 * (pinion_x + gear_x)) + square(0.5 * (pinion_y + gear_y));
      const double sliding = square(pinion_x - gear_x) + square(pinion_y - gear_y);
      if (!(entrainment > 0)) continue;
      // The speeds in the denominator of phi_T (film-inl.h).
      const double heating =
          (1 + 2.23 * std::pow(sliding / entrainment, 0.83 / 2)) * std::pow(entrainment, 0.64);
      if (heating <= most_heating) continue;
      most_heating = heating;
      out.entrainment_squared = entrainment;
      out.sliding_squared = sliding;
    }
  }
  return out;
}

}  // namespace tribodyn
