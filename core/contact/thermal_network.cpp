#include "core/contact/thermal_network.h"

#include <cmath>

namespace tribodyn {

double active_length(double semi_x, double semi_y, double velocity_x, double velocity_y) {
  const double speed = std::hypot(velocity_x, velocity_y);
  if (speed == 0) return semi_x;
  return 1 / std::hypot(velocity_x / speed / semi_x, velocity_y / speed / semi_y);
}

double ThermalNetwork::heat_partition() const {
  const double g_p = pinion_conductance, g_g = gear_conductance, r = film_resistance;
  if (g_p + g_g == 0) return 0.5;
  return g_p * (1 + r * g_g) / (g_p + g_g + 2 * r * g_p * g_g);
}

double ThermalNetwork::flash_resistance() const {
  const double g_p = pinion_conductance, g_g = gear_conductance, r = film_resistance;
  return (1 + r * g_g) / (g_p + g_g + 2 * r * g_p * g_g);
}

double moving_source_conductance(double area, double solid_conductivity, double diffusivity,
                                 double length, double speed) {
  return area * solid_conductivity / 1.06 * std::sqrt(speed / (diffusivity * length));
}

double oil_temperature_rise(double sliding_speed, double mean_shear_stress, double film_thickness,
                            double oil_conductivity) {
  return sliding_speed * mean_shear_stress * film_thickness / (8 * oil_conductivity);
}

}  // namespace tribodyn
