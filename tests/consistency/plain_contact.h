#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <queue>
#include <vector>

#include "tests/consistency/contact_case.h"
#include "tests/support/improved_yasutomi.h"

/// The paper's equations written down once more, as plainly as they read, for the tests to hold the
/// model against. Nothing here calls core/contact or core/lubricant.
namespace tribodyn::plain {

inline constexpr double kRoelands = 5.1e-9;  ///< of eqs 31, 32 [1/Pa]

/// Adaptive integral (Gauss 7, Kronrod 15; the worst panel is halved next) to about 1e-14 of itself
/// for integrands of one sign. Kinks cost panels, not accuracy.
template <class Function>
double integral(Function&& f, double from, double to) {
  static constexpr double node[8] = {0,
                                     0.207784955007898467600689403773245,
                                     0.405845151377397166906606412076961,
                                     0.586087235467691130294144691693013,
                                     0.741531185599394439863864773280788,
                                     0.864864423359769072789712788640926,
                                     0.949107912342758524526189684047851,
                                     0.991455371120812639206854697526329};
  static constexpr double kronrod[8] = {
      0.209482141084727828012999174891714, 0.204432940075298892414161999234649,
      0.190350578064785409913256402421014, 0.169004726639267902826583426598550,
      0.140653259715525918745189590510238, 0.104790010322250183839876322541518,
      0.063092092629978553290700663189204, 0.022935322010529224963732008058970};
  static constexpr double gauss[8] = {
      0.417959183673469387755102040816327, 0, 0.381830050505118944950369775488975, 0,
      0.279705391489276667901467771423780, 0, 0.129484966168869693270611432679082, 0};
  struct Panel {
    double from, to, value, error;
    bool operator<(const Panel& other) const { return error < other.error; }
  };
  const auto panel = [&f](double a, double b) {
    const double centre = 0.5 * (a + b), half = 0.5 * (b - a);
    const double middle = f(centre);
    double fine = kronrod[0] * middle, coarse = gauss[0] * middle;
    for (int i = 1; i < 8; ++i) {
      const double pair = f(centre - half * node[i]) + f(centre + half * node[i]);
      fine += kronrod[i] * pair;
      coarse += gauss[i] * pair;
    }
    return Panel{a, b, half * fine, std::abs(half * (fine - coarse))};
  };
  std::priority_queue<Panel> panels;
  double error = 0;
  constexpr int kStart = 8;
  for (int i = 0; i < kStart; ++i) {
    panels.push(panel(from + (to - from) * i / kStart, from + (to - from) * (i + 1) / kStart));
  }
  const auto total = [&panels, &error] {
    std::priority_queue<Panel> rest = panels;
    double sum = 0;
    error = 0;
    for (; !rest.empty(); rest.pop()) {
      sum += rest.top().value;
      error += rest.top().error;
    }
    return sum;
  };
  double sum = total();
  for (int round = 0; round < 40 && error > 1e-14 * std::abs(sum); ++round) {
    for (int i = 0; i < 16 && panels.top().error > 1e-17 * std::abs(sum); ++i) {
      const Panel worst = panels.top();
      panels.pop();
      const double middle = 0.5 * (worst.from + worst.to);
      panels.push(panel(worst.from, middle));
      panels.push(panel(middle, worst.to));
    }
    sum = total();
  }
  return sum;
}

/// Eq 34, logarithm of Pa s.
inline double log_viscosity(const Lubricant& oil, double temperature) {
  return std::log(oil.vogel_viscosity_prefactor) +
         oil.vogel_temperature_coefficient / (temperature - oil.vogel_reference_temperature);
}

/// The factor of eqs 31 and 32.
inline double roelands_factor(double log_viscosity, const AsPublished& as_published) {
  return as_published.eq31_32_logarithm ? std::log(std::exp(log_viscosity) + 9.67)
                                        : log_viscosity + 9.67;
}

/// Eq 33 for eq 31, 1/Pa: the integral over x = ln(1 + 5.1e-9 p).
inline double reciprocal_asymptotic(double factor, double index) {
  const double end = std::log1p(745 / factor) / index;
  return kRoelands /
         integral([&](double x) { return std::exp(x - factor * std::expm1(index * x)); }, 0, end);
}

/// Eqs 24-26.
inline double log_shear_thinning(const Lubricant& oil, double shear_rate, double temperature) {
  const auto density = [&oil](double t) {
    return oil.density_at_zero_kelvin + oil.density_temperature_slope * t;
  };
  const double reference = oil.rheology_reference_temperature;
  const double shift = std::exp(log_viscosity(oil, temperature) - log_viscosity(oil, reference)) *
                       reference / temperature * density(reference) / density(temperature);
  return oil.havriliak_negami_beta *
         std::log1p(std::pow(oil.relaxation_time * shift * shear_rate, oil.havriliak_negami_alpha));
}

/// What the shear stress of eq 23 depends on besides pressure.
struct Shear {
  const ContactCase& contact;
  double index;  ///< Z; of Roelands's law only
  double shear_rate, temperature;

  /// ln of eq 23 with eq 31, without the limit.
  double log_unlimited(double pressure) const {
    const double thinning = contact.options.newtonian
                                ? 0
                                : log_shear_thinning(contact.lubricant, shear_rate, temperature);
    return log_viscosity_at(pressure) + std::log(shear_rate) - thinning;
  }
  double log_viscosity_at(double pressure) const {
    const Lubricant& oil = contact.lubricant;
    if (oil.pressure_viscosity_law == PressureViscosityLaw::kImprovedYasutomi) {
      return printed_yasutomi(oil).log_viscosity(pressure, temperature);
    }
    const double log_eta = plain::log_viscosity(oil, temperature);
    const double factor = plain::roelands_factor(log_eta, contact.options.as_published);
    return log_eta + factor * (std::pow(1 + kRoelands * pressure, index) - 1);
  }
  double limit(double pressure) const {
    return contact.lubricant.limiting_shear_stress_at_zero_pressure +
           contact.lubricant.limiting_shear_stress_coefficient * pressure;
  }
  double stress(double pressure) const {
    const double unlimited = std::exp(log_unlimited(pressure));
    return contact.options.no_limiting_shear_stress ? unlimited
                                                    : std::min(unlimited, limit(pressure));
  }
};

/// Radii at which the stress meets the limit, and the share of the area on it, by a scan in
/// xi = p/p_max.
struct Limited {
  std::vector<double> switches;
  double area_share = 0;
  bool centre = false;
};

inline Limited limited(const Shear& shear, double maximum_pressure, int scan = 4000) {
  Limited out;
  if (shear.contact.options.no_limiting_shear_stress) return out;
  const auto excess = [&](double xi) {
    const double p = maximum_pressure * xi;
    return shear.log_unlimited(p) - std::log(shear.limit(p));
  };
  bool on = excess(0) > 0;
  double entered = 0;  // xi where the current stretch on the limit began
  for (int i = 1; i <= scan; ++i) {
    double low = static_cast<double>(i - 1) / scan, high = static_cast<double>(i) / scan;
    if ((excess(high) > 0) == on) continue;
    for (int k = 0; k < 60; ++k) {
      const double middle = 0.5 * (low + high);
      ((excess(middle) > 0) == on ? low : high) = middle;
    }
    out.switches.push_back(low);
    if (on) out.area_share += low * low - entered * entered;
    entered = low;
    on = !on;
  }
  out.centre = on;
  if (on) out.area_share += 1 - entered * entered;
  return out;
}

/// The mean of the stress over the footprint by quadrature over position: t = r^2 is the share of
/// the area within a radius, eq 19 gives p = p_max sqrt(1 - t). Cut where the stress has kinks.
inline double mean_stress(const Shear& shear, double maximum_pressure) {
  std::vector<double> cuts{0};
  const Limited kinks = limited(shear, maximum_pressure);
  for (auto xi = kinks.switches.rbegin(); xi != kinks.switches.rend(); ++xi) {
    cuts.push_back((1 - *xi) * (1 + *xi));
  }
  cuts.push_back(1);
  double mean = 0;
  for (std::size_t i = 1; i < cuts.size(); ++i) {
    mean += integral(
        [&](double t) { return shear.stress(maximum_pressure * std::sqrt(std::max(0.0, 1 - t))); },
        cuts[i - 1], cuts[i]);
  }
  return mean;
}

/// |a - b| relative to the larger; 0 for equal infinities.
inline double difference(double a, double b) {
  if (a == b) return 0;
  return std::abs(a - b) / std::max({std::abs(a), std::abs(b), std::numeric_limits<double>::min()});
}

}  // namespace tribodyn::plain
