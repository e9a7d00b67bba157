#include "core/contact/film_thickness.h"

#include <cmath>

namespace tribodyn {
namespace {

constexpr double kSpeedExponent = 0.68;
constexpr double kMaterialExponent = 0.49;
constexpr double kLoadExponent = -0.073;

// R_e U_e^0.68 G^0.49 W_e^-0.073 as one exponential of a sum of logarithms (three calls of pow cost
// twice as much). ln 0 = -inf at zero speed gives the film 0.
double dimensional_product(const FilmConditions& c, double load) {
  const double modulus_radius = c.reduced_modulus * c.entrainment_radius;
  const double speed = c.viscosity * c.entrainment_speed / modulus_radius;
  const double material = c.pressure_viscosity_coefficient * c.reduced_modulus;
  const double dimensionless_load = load / (modulus_radius * c.entrainment_radius);
  return c.entrainment_radius *
         std::exp(kSpeedExponent * std::log(speed) + kMaterialExponent * std::log(material) +
                  kLoadExponent * std::log(dimensionless_load));
}

}  // namespace

double entrainment_radius(double radius_x, double radius_y, double entrainment_angle) {
  const double c = std::cos(entrainment_angle);
  const double s = std::sin(entrainment_angle);
  return 1 / (c * c / radius_x + s * s / radius_y);
}

double side_leakage_radius(double radius_x, double radius_y, double entrainment_angle) {
  return entrainment_radius(radius_y, radius_x, entrainment_angle);
}

double chittenden_dowson_central_film(const FilmConditions& conditions, double load) {
  const double ratio = conditions.side_leakage_radius / conditions.entrainment_radius;
  const double side_leakage = -std::expm1(-1.23 * std::cbrt(ratio * ratio));
  return 4.31 * dimensional_product(conditions, load) * side_leakage;
}

double chittenden_dowson_film_under_load(double unit_load_film, double load) {
  return unit_load_film * std::exp(kLoadExponent * std::log(load));
}

double hamrock_dowson_minimum_film(const FilmConditions& conditions, double ellipticity,
                                   double load) {
  return 3.63 * dimensional_product(conditions, load) * -std::expm1(-0.68 * ellipticity);
}

}  // namespace tribodyn
