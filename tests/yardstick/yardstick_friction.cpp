#include "yardstick_friction.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

namespace tribodyn::yardstick {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kRoelandsPressure = 5.1e-9;  // 1/Pa, eq 31
constexpr double kRoelandsLogarithm = 9.67;   // eq 31

// G_n(l) = int_0^inf t^n exp(-t^2/2 - l t) dt, so that F_n(l) = exp(-l^2/2) G_n(l) / sqrt(2 pi).
// With t = v^2 the integrand is smooth for half-integer orders too.
double scaled_asperity_integral(double order, double film_parameter) {
  static const GaussLegendreRule rule = make_gauss_legendre_rule(24);
  // Beyond this v the exponential is below exp(-80).
  const double cut_off =
      std::min(std::pow(160.0, 0.25), std::sqrt(80.0 / std::max(film_parameter, 1e-3)));
  const auto integrand = [&](double v) {
    const double t = v * v;
    return 2.0 * std::pow(v, 2.0 * order + 1.0) * std::exp(-0.5 * t * t - film_parameter * t);
  };
  return integrate(rule, integrand, 0.0, cut_off, 8);
}

// Quintic Hermite table of G_n on [0, 12], from G_n' = -G_(n+1) and G_n'' = G_(n+2).
class AsperityTable {
 public:
  explicit AsperityTable(double order) : order_(order) {
    for (int i = 0; i <= kIntervals; ++i) {
      const double film_parameter = i * kStep;
      nodes_[i] = {scaled_asperity_integral(order, film_parameter),
                   -kStep * scaled_asperity_integral(order + 1.0, film_parameter),
                   kStep * kStep * scaled_asperity_integral(order + 2.0, film_parameter)};
    }
  }

  double operator()(double film_parameter) const {
    const double gaussian = std::exp(-0.5 * film_parameter * film_parameter) / std::sqrt(2.0 * kPi);
    const double position = film_parameter / kStep;
    if (position >= kIntervals) {
      return gaussian == 0.0 ? 0.0 : gaussian * scaled_asperity_integral(order_, film_parameter);
    }
    const int i = static_cast<int>(position);
    const double s = position - i;
    const auto& left = nodes_[i];
    const auto& right = nodes_[i + 1];
    // Taylor polynomial at the left node plus the three terms that match the right node.
    const double value = right[0] - left[0] - left[1] - 0.5 * left[2];
    const double slope = right[1] - left[1] - left[2];
    const double curvature = right[2] - left[2];
    const double c3 = 10.0 * value - 4.0 * slope + 0.5 * curvature;
    const double c4 = -15.0 * value + 7.0 * slope - curvature;
    const double c5 = 6.0 * value - 3.0 * slope + 0.5 * curvature;
    return gaussian *
           (left[0] + s * (left[1] + s * (0.5 * left[2] + s * (c3 + s * (c4 + s * c5)))));
  }

 private:
  static constexpr int kIntervals = 768;
  static constexpr double kStep = 1.0 / 64.0;
  double order_;
  std::array<std::array<double, 3>, kIntervals + 1> nodes_;
};

double asperity_area_function(double film_parameter) {  // F_2
  static const AsperityTable table(2.0);
  return table(film_parameter);
}

double asperity_load_function(double film_parameter) {  // F_5/2
  static const AsperityTable table(2.5);
  return table(film_parameter);
}

// alpha* of eq 33 for Roelands' law with index Z; B = ln eta0 + 9.67. Substituting
// q = (1 + 5.1e-9 p)^Z - 1 makes the integrand exp(-B q) (1 + q)^(1/Z - 1) / (5.1e-9 Z).
double reciprocal_asymptotic_coefficient(double index, double log_viscosity) {
  static const GaussLegendreRule rule = make_gauss_legendre_rule(24);
  const auto integrand = [&](double q) {
    return std::exp(-log_viscosity * q + (1.0 / index - 1.0) * std::log1p(q));
  };
  const double integral = integrate(rule, integrand, 0.0, 80.0 / log_viscosity, 64);
  return kRoelandsPressure * index / integral;
}

struct HertzShape {
  double ellipticity;        // k = a_c / b_c
  double elliptic_integral;  // eps, second kind
};

// Eqs 21 and 22 (ratio inverted in eq 22); `ratio` = larger radius over smaller.
HertzShape simplified_hertz(double ratio) {
  return {1.0339 * std::pow(ratio, 0.636), 1.0003 + 0.5968 / ratio};
}

// Exact: ratio = (k^2 E(m) - K(m)) / (K(m) - E(m)), modulus m = sqrt(1 - 1/k^2).
HertzShape exact_hertz(double ratio) {
  if (ratio < 1.0 + 1e-6) return {1.0, kPi / 2.0};
  const auto modulus = [](double k) { return std::sqrt(1.0 - 1.0 / (k * k)); };
  const auto mismatch = [&](double k) {
    const double first = std::comp_ellint_1(modulus(k));
    const double second = std::comp_ellint_2(modulus(k));
    return (k * k * second - first) - ratio * (first - second);
  };
  const double ellipticity = find_root(mismatch, 1.0 + 1e-7, 2.0 * std::sqrt(ratio) * ratio);
  return {ellipticity, std::comp_ellint_2(modulus(ellipticity))};
}

// (1 - nu^2)/E of eq 13.
double plane_compliance(const Solid& solid) {
  return (1.0 - solid.poisson_ratio * solid.poisson_ratio) / solid.youngs_modulus;
}

// Eq 36 written with the velocity components: half length of the ellipse along the motion.
double active_length(double semi_x, double semi_y, double velocity_x, double velocity_y) {
  return semi_x * semi_y * std::hypot(velocity_x, velocity_y) /
         std::hypot(semi_y * velocity_x, semi_x * velocity_y);
}

}  // namespace

double asperity_integral(double order, double film_parameter) {
  return std::exp(-0.5 * film_parameter * film_parameter) / std::sqrt(2.0 * kPi) *
         scaled_asperity_integral(order, film_parameter);
}

ContactFriction::ContactFriction(const Lubricant& lubricant, const Solid& pinion_solid,
                                 const Solid& gear_solid, const Surface& surface,
                                 double sump_temperature, double inlet_temperature_rise,
                                 const FrictionOptions& options)
    : lubricant_(lubricant),
      pinion_solid_(pinion_solid),
      gear_solid_(gear_solid),
      surface_(surface),
      options_(options),
      rule_(make_gauss_legendre_rule(options.quadrature_nodes)),
      inlet_temperature_(sump_temperature + inlet_temperature_rise),
      reduced_modulus_(2.0 / (plane_compliance(pinion_solid) + plane_compliance(gear_solid))),
      inlet_viscosity_(ambient_viscosity(inlet_temperature_)) {
  const double log_viscosity =
      std::log(ambient_viscosity(lubricant.pressure_viscosity_temperature)) + kRoelandsLogarithm;
  const double inlet_log_viscosity = std::log(inlet_viscosity_) + kRoelandsLogarithm;
  if (!(log_viscosity > 0.0) || !(inlet_log_viscosity > 0.0)) {
    throw std::invalid_argument("ambient viscosity below exp(-9.67) Pa s");
  }
  const double alpha = lubricant.pressure_viscosity_coefficient;
  if (options.houpert_pressure_index) {  // eq 32
    pressure_index_ = alpha / (kRoelandsPressure * log_viscosity);
    inlet_alpha_ = kRoelandsPressure * pressure_index_ * inlet_log_viscosity;
    return;
  }
  const auto mismatch = [&](double index) {
    return std::log(reciprocal_asymptotic_coefficient(index, log_viscosity) / alpha);
  };
  if (!(mismatch(0.05) < 0.0 && mismatch(2.0) > 0.0)) {
    throw std::invalid_argument("no pressure-viscosity index reproduces alpha*");
  }
  pressure_index_ = find_root(mismatch, 0.05, 2.0);
  inlet_alpha_ = reciprocal_asymptotic_coefficient(pressure_index_, inlet_log_viscosity);
}

double ContactFriction::ambient_viscosity(double temperature) const {  // eq 34
  return lubricant_.vogel_prefactor *
         std::exp(lubricant_.vogel_temperature_parameter /
                  (temperature - lubricant_.vogel_reference_temperature));
}

double ContactFriction::shear_thinning(double shear_rate, double temperature) const {
  if (options_.newtonian) return 1.0;
  const auto density = [this](double kelvin) {  // eq 26
    return lubricant_.density_slope * kelvin + lubricant_.density_intercept;
  };
  const double reference = lubricant_.shear_reference_temperature;
  const double shift = ambient_viscosity(temperature) / ambient_viscosity(reference) * reference /
                       temperature * density(reference) / density(temperature);  // eq 25
  const double reduced_rate = lubricant_.relaxation_time * shift * shear_rate;
  return std::pow(1.0 + std::pow(reduced_rate, lubricant_.havriliak_negami_alpha),
                  lubricant_.havriliak_negami_beta);  // eq 24
}

double ContactFriction::mean_limiting_shear_stress(double maximum_pressure) const {
  return lubricant_.limiting_shear_stress_at_zero_pressure +
         2.0 / 3.0 * lubricant_.limiting_shear_stress_slope * maximum_pressure;
}

double ContactFriction::mean_shear_stress(double maximum_pressure, double shear_rate,
                                          double temperature, int* switches) const {
  if (switches != nullptr) *switches = 0;
  if (shear_rate == 0.0) return 0.0;
  if (std::isinf(shear_rate)) return mean_limiting_shear_stress(maximum_pressure);

  const double limit = lubricant_.limiting_shear_stress_at_zero_pressure;
  const double slope = lubricant_.limiting_shear_stress_slope;
  const double index = pressure_index_;
  const double viscosity = ambient_viscosity(temperature);
  const double log_viscosity = std::log(viscosity) + kRoelandsLogarithm;
  const double ambient_stress = viscosity * shear_rate / shear_thinning(shear_rate, temperature);
  const auto exponent = [&](double pressure) {  // eq 31
    return log_viscosity * std::expm1(index * std::log1p(kRoelandsPressure * pressure));
  };
  const auto log_excess = [&](double pressure) {  // ln(tau / tau_L)
    return exponent(pressure) + std::log(ambient_stress / (limit + slope * pressure));
  };
  // Same sign as the derivative of log_excess, up to the positive factor tau_L.
  const auto excess_slope = [&](double pressure) {
    return log_viscosity * index * kRoelandsPressure *
               std::pow(1.0 + kRoelandsPressure * pressure, index - 1.0) *
               (limit + slope * pressure) -
           slope;
  };
  // Between consecutive marks the function is monotone: first excess_slope (it has at most one
  // stationary point, known in closed form), then log_excess.
  struct Marks {
    std::array<double, 8> pressure;
    int count = 0;
    void add(double value) { pressure[count++] = value; }
  };
  const auto insert_roots = [](const Marks& marks, const auto& function) {
    Marks refined;
    refined.add(marks.pressure[0]);
    double left_value = function(marks.pressure[0]);
    for (int i = 1; i < marks.count; ++i) {
      const double right_value = function(marks.pressure[i]);
      if (left_value * right_value < 0.0) {
        refined.add(
            find_root(function, marks.pressure[i - 1], marks.pressure[i], left_value, right_value));
      }
      refined.add(marks.pressure[i]);
      left_value = right_value;
    }
    return refined;
  };
  Marks marks;
  marks.add(0.0);
  const double stationary =
      ((1.0 - index) * kRoelandsPressure * limit - slope) / (slope * kRoelandsPressure * index);
  if (stationary > 0.0 && stationary < maximum_pressure) marks.add(stationary);
  marks.add(maximum_pressure);
  const Marks monotone = insert_roots(marks, excess_slope);
  const Marks pieces = insert_roots(monotone, log_excess);
  if (switches != nullptr) *switches = pieces.count - monotone.count;

  // Mean over the ellipse: 2 int_0^1 tau(p_max xi) xi d(xi), with p = p_max xi.
  double mean = 0.0;
  for (int i = 1; i < pieces.count; ++i) {
    const double lower = pieces.pressure[i - 1];
    const double upper = pieces.pressure[i];
    if (log_excess(0.5 * (lower + upper)) >= 0.0) {  // tau = tau_L: exact
      mean += limit * (upper * upper - lower * lower) +
              2.0 / 3.0 * slope * (upper * upper * upper - lower * lower * lower);
    } else {
      mean += 2.0 * integrate(
                        rule_,
                        [&](double pressure) {
                          return ambient_stress * std::exp(exponent(pressure)) * pressure;
                        },
                        lower, upper);
    }
  }
  return mean / (maximum_pressure * maximum_pressure);
}

void ContactFriction::set_ellipse(const ContactInput& input, double film_load,
                                  ContactResult* result) const {
  const double larger = std::max(input.radius_x, input.radius_y);
  const double smaller = std::min(input.radius_x, input.radius_y);
  const double ratio = larger / smaller;
  const HertzShape shape =
      options_.elliptic_integral_hertz ? exact_hertz(ratio) : simplified_hertz(ratio);
  const double radius = larger * smaller / (larger + smaller);
  result->semi_major_axis =
      std::cbrt(6.0 * shape.ellipticity * shape.ellipticity * shape.elliptic_integral * film_load *
                radius / (kPi * reduced_modulus_));  // eq 20
  result->semi_minor_axis = result->semi_major_axis / shape.ellipticity;
  result->film_area = kPi * result->semi_major_axis * result->semi_minor_axis;
  result->maximum_pressure = 1.5 * film_load / result->film_area;  // eq 19
}

void ContactFriction::share_load(const ContactInput& input, ContactResult* result) const {
  const double u = 0.5 * (input.pinion_velocity_x + input.gear_velocity_x);
  const double v = 0.5 * (input.pinion_velocity_y + input.gear_velocity_y);
  result->entrainment_angle = std::atan2(v, u);
  result->entrainment_speed = std::hypot(u, v);  // eq 17
  const double cosine = std::cos(result->entrainment_angle);
  const double sine = std::sin(result->entrainment_angle);
  const double radius =
      1.0 / (cosine * cosine / input.radius_x + sine * sine / input.radius_y);  // eq 15
  const double side_radius =
      1.0 / (sine * sine / input.radius_x + cosine * cosine / input.radius_y);  // eq 16
  result->entrainment_radius = radius;
  result->side_radius = side_radius;

  // Film and area for the whole load; they scale with W_EHL^-0.073 and W_EHL^(2/3).
  const double speed_parameter =
      inlet_viscosity_ * result->entrainment_speed / (reduced_modulus_ * radius);  // eq 13
  const double load_parameter = input.load / (reduced_modulus_ * radius * radius);
  double full_load_film = 4.31 * radius * std::pow(speed_parameter, 0.68) *
                          std::pow(inlet_alpha_ * reduced_modulus_, 0.49) *
                          std::pow(load_parameter, -0.073) *
                          -std::expm1(-1.23 * std::pow(side_radius / radius, 2.0 / 3.0));  // eq 12
  set_ellipse(input, input.load, result);
  const double full_load_area = result->film_area;
  if (options_.inlet_shear_heating) {
    // Viscosity falls by A_1/(T - T_0)^2 per kelvin.
    const double above = inlet_temperature_ - lubricant_.vogel_reference_temperature;
    const double loading = lubricant_.vogel_temperature_parameter / (above * above) *
                           inlet_viscosity_ * result->entrainment_speed *
                           result->entrainment_speed / lubricant_.thermal_conductivity;
    const double slide_roll_ratio = std::hypot(input.pinion_velocity_x - input.gear_velocity_x,
                                               input.pinion_velocity_y - input.gear_velocity_y) /
                                    result->entrainment_speed;
    const double numerator =
        1.0 - 13.2 * result->maximum_pressure / reduced_modulus_ * std::pow(loading, 0.42);
    full_load_film *=
        std::max(numerator, 0.5) /
        (1.0 + 0.213 * (1.0 + 2.23 * std::pow(slide_roll_ratio, 0.83)) * std::pow(loading, 0.64));
  }

  const double asperity_number =
      surface_.asperity_density * surface_.asperity_radius * surface_.roughness;
  const double load_factor =
      8.0 * std::numbers::sqrt2 / 15.0 * kPi * asperity_number * asperity_number *
      std::sqrt(surface_.roughness / surface_.asperity_radius) * reduced_modulus_;  // eq 41
  // Unknown: s = ln(W_EHL / W) <= 0.
  const auto asperity_load = [&](double s) {
    return load_factor * full_load_area * std::exp(2.0 / 3.0 * s) *
           asperity_load_function(full_load_film * std::exp(-0.073 * s) / surface_.roughness);
  };
  const auto imbalance = [&](double s) { return std::expm1(s) + asperity_load(s) / input.load; };
  double share = 0.0;
  const double largest = asperity_load(0.0) / input.load;
  if (largest > 0.0) {
    // W_asp falls with s, so W_EHL >= W - W_asp(s = 0); otherwise search downwards.
    double lower = largest < 1.0 ? std::log1p(-largest) : -1.0;
    lower = std::min(lower, -std::numeric_limits<double>::min());
    double imbalance_at_lower = imbalance(lower);
    while (imbalance_at_lower > 0.0) imbalance_at_lower = imbalance(lower *= 2.0);
    share = find_root(imbalance, lower, 0.0, imbalance_at_lower, largest);
  }
  result->film_load = input.load * std::exp(share);
  result->asperity_load = asperity_load(share);
  set_ellipse(input, result->film_load, result);
  result->central_film_thickness = full_load_film * std::exp(-0.073 * share);
  result->film_parameter = result->central_film_thickness / surface_.roughness;
  result->asperity_area = kPi * kPi * result->film_area * asperity_number * asperity_number *
                          asperity_area_function(result->film_parameter);  // eq 42
}

void ContactFriction::set_thermal_network(const ContactInput& input, ContactResult* result) const {
  const bool major_along_x = input.radius_x > input.radius_y;
  const double semi_x = major_along_x ? result->semi_major_axis : result->semi_minor_axis;
  const double semi_y = major_along_x ? result->semi_minor_axis : result->semi_major_axis;
  const auto resistance = [&](const Solid& solid, double length, double speed) {  // eq 35
    const double diffusivity = solid.thermal_conductivity / (solid.density * solid.specific_heat);
    return 1.06 / (result->film_area * solid.thermal_conductivity) *
           std::sqrt(diffusivity * length / speed);
  };
  result->pinion_active_length =
      active_length(semi_x, semi_y, input.pinion_velocity_x, input.pinion_velocity_y);
  result->gear_active_length =
      active_length(semi_x, semi_y, input.gear_velocity_x, input.gear_velocity_y);
  result->pinion_thermal_resistance =
      resistance(pinion_solid_, result->pinion_active_length,
                 std::hypot(input.pinion_velocity_x, input.pinion_velocity_y));
  result->gear_thermal_resistance =
      resistance(gear_solid_, result->gear_active_length,
                 std::hypot(input.gear_velocity_x, input.gear_velocity_y));
  result->film_thermal_resistance =
      result->central_film_thickness / (2.0 * lubricant_.thermal_conductivity * result->film_area);
  result->heat_partition = (result->gear_thermal_resistance + result->film_thermal_resistance) /
                           (result->pinion_thermal_resistance + result->gear_thermal_resistance +
                            2.0 * result->film_thermal_resistance);  // eq 37
}

void ContactFriction::solve_temperature(ContactResult* result) const {
  const double p_max = result->maximum_pressure;
  const double sliding = result->sliding_speed;
  const double flash_factor = result->pinion_thermal_resistance * result->heat_partition * sliding;
  const double film_factor =
      sliding * result->central_film_thickness / (8.0 * lubricant_.thermal_conductivity);
  // T_c = T_in + boundary_rise + kelvin_per_pascal * mean stress(T_c): eqs 38-39.
  const double boundary_rise = flash_factor * result->boundary_friction;
  const double kelvin_per_pascal =
      flash_factor * (result->film_area - result->asperity_area) + film_factor;
  double temperature = inlet_temperature_;
  if (!options_.isothermal && kelvin_per_pascal > 0.0) {
    const auto temperature_at = [&](double s) {
      return inlet_temperature_ + boundary_rise + std::exp(s);
    };
    const auto mismatch = [&](double s) {
      return std::log(kelvin_per_pascal *
                      mean_shear_stress(p_max, result->shear_rate, temperature_at(s))) -
             s;
    };
    // The limiting stress bounds the rise from above; the stress falls with temperature, so the
    // rise at that bound bounds it from below (the loop covers laws for which it does not fall).
    const double upper = std::log(kelvin_per_pascal * mean_limiting_shear_stress(p_max));
    const double mismatch_at_upper = mismatch(upper);
    if (mismatch_at_upper >= 0.0) {
      temperature = temperature_at(upper);
    } else {
      double lower = upper + mismatch_at_upper;
      double mismatch_at_lower = mismatch(lower);
      while (mismatch_at_lower < 0.0) mismatch_at_lower = mismatch(lower -= 0.5);
      temperature =
          temperature_at(find_root(mismatch, lower, upper, mismatch_at_lower, mismatch_at_upper));
    }
  }
  result->mean_shear_stress =
      mean_shear_stress(p_max, result->shear_rate, temperature, &result->limiting_stress_switches);
  result->viscous_friction =
      (result->film_area - result->asperity_area) * result->mean_shear_stress;  // eq 27
  result->friction = result->viscous_friction + result->boundary_friction;      // eq 28
  result->heat_rate = result->friction * sliding;
  result->temperature = temperature;
  if (!options_.isothermal) {
    result->flash_temperature_rise = flash_factor * result->friction;
    result->film_temperature_rise = film_factor * result->mean_shear_stress;
  }
}

ContactResult ContactFriction::evaluate(const ContactInput& input) const {
  ContactResult result;
  result.temperature = inlet_temperature_;
  if (!(input.load > 0.0)) return result;
  share_load(input, &result);
  result.sliding_speed = std::hypot(input.pinion_velocity_x - input.gear_velocity_x,
                                    input.pinion_velocity_y - input.gear_velocity_y);
  result.shear_rate =
      result.sliding_speed == 0.0 ? 0.0 : result.sliding_speed / result.central_film_thickness;
  result.boundary_friction =
      surface_.tribofilm_shear_strength * result.asperity_area +
      surface_.boundary_friction_coefficient * result.asperity_load;  // eq 40
  set_thermal_network(input, &result);
  solve_temperature(&result);
  return result;
}

}  // namespace tribodyn::yardstick
