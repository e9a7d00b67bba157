#include "core/contact/thermal_equilibrium.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/lubricant/viscosity.h"
#include "core/numerics/bracketed_root.h"

namespace tribodyn {
namespace {

/// Whether ln tau falls with temperature at every pressure between two temperatures, from
/// d ln tau/dT <= -(1 - alpha beta) A1/(T - T0)^2 + alpha beta max(0, 1/T + rho'/rho), if the
/// growth of viscosity with pressure falls with temperature. Both
/// terms fall in size with temperature: over a short span the one at its hot end and the other at
/// its cold end are a proof.
bool provably_falling(const ShearedFilm& film, double cold, double hot) {
  if (!laws::pressure_growth_falls(film.law->growth, cold, film.maximum_pressure)) return false;
  if (film.law->newtonian) return true;
  const Lubricant& oil = film.law->lubricant;
  const double product = oil.havriliak_negami_alpha * oil.havriliak_negami_beta;
  constexpr int kMostSpans = 16;
  const double from = cold - oil.vogel_reference_temperature;
  const double widest = std::pow((hot - oil.vogel_reference_temperature) / from, 1.0 / kMostSpans);
  const double widening = std::max(1.1, widest);
  for (double above = from, temperature = cold; temperature < hot;) {
    const double rise = 1 / temperature + oil.density_temperature_slope / density(oil, temperature);
    if (product >= 0 && product < 1 && rise <= 0) return true;  // it falls from here on
    above = std::min(above * widening, hot - oil.vogel_reference_temperature);
    if (!((1 - product) * oil.vogel_temperature_coefficient / (above * above) >
          product * std::max(0.0, rise))) {
      return false;
    }
    const double next = std::min(oil.vogel_reference_temperature + above, hot);
    if (!(next > temperature)) return true;
    temperature = next;
  }
  return true;
}

/// A lower bound of the slope of H(y) between two temperatures, from the same bound of d ln tau/dT;
/// -infinity if the growth of viscosity with pressure may rise with temperature.
double least_slope(const ShearedFilm& film, double base, double cold, double hot) {
  const Lubricant& oil = film.law->lubricant;
  const double product = oil.havriliak_negami_alpha * oil.havriliak_negami_beta;
  if (!laws::pressure_growth_falls(film.law->growth, cold, film.maximum_pressure)) {
    return -std::numeric_limits<double>::infinity();
  }
  if (film.law->newtonian) return 1;
  const double rise = 1 / cold + oil.density_temperature_slope / density(oil, cold);
  const double above = cold - oil.vogel_reference_temperature;
  const double steepest =
      std::max(0.0, product - 1) * oil.vogel_temperature_coefficient / (above * above) +
      product * std::max(0.0, rise);
  return 1 - (hot - base) * steepest;
}

/// w with w e^w = z, z >= 0, to a few digits: the start of the iteration only.
double lambert_start(double z) {
  double w = std::log1p(z) * (1 - std::log1p(std::log1p(z)) / (2 + std::log1p(z)));
  for (int i = 0; i < 2; ++i) w -= (w - z * std::exp(-w)) / (1 + w);
  return w;
}

}  // namespace

ThermalEquilibrium solve_thermal_equilibrium(const ShearedFilm& film, double base, double gain) {
  double guess = 0;
  // Only asperities that pull (eqs 43, 44 as printed) can cool the film out of eq 34's range.
  if (!(base > film.law->lubricant.vogel_reference_temperature)) return {0, base, {}};
  const MeanShearStress cold = mean_shear_stress(film, base, guess);
  if (!(gain > 0)) return {1, base, cold};

  const Lubricant& oil = film.law->lubricant;
  double highest_temperature = std::numeric_limits<double>::infinity();
  if (!film.law->newtonian && oil.density_temperature_slope < 0) {
    highest_temperature = (1 - 1e-9) * -oil.density_at_zero_kelvin / oil.density_temperature_slope;
  }
  if (base >= highest_temperature) return {0, base, cold};

  const double log_gain = std::log(gain);
  // H(y) = y - ln(gain tau_bar(base + e^y)), y = ln(T - base).
  const auto balance = [&](double y, MeanShearStress& stress) {
    const double rise = std::exp(y);
    stress = mean_shear_stress(film, base + rise, guess);
    return ValueAndSlope{y - log_gain - stress.log_value, 1 - stress.slope * rise};
  };
  const auto answer = [&](double y, int roots) {
    const double temperature = base + std::exp(y);
    return ThermalEquilibrium{roots, temperature, mean_shear_stress(film, temperature, guess)};
  };
  MeanShearStress stress{};

  // Where tau_bar falls from base on, the rise is at most gain tau_bar(base).
  const double unheated = log_gain + cold.log_value;
  const double highest = std::min(unheated, std::log(highest_temperature - base));
  if (std::isfinite(highest) && provably_falling(film, base, base + std::exp(highest))) {
    if (highest < unheated && balance(highest, stress).value < 0) return {0, base, cold};
    double lower = -std::numeric_limits<double>::infinity(), upper = highest;
    double y = upper;
    if (cold.slope < 0) {
      y = std::min(y, std::log(lambert_start(-cold.slope * std::exp(unheated)) / -cold.slope));
    }
    for (int i = 0; i < 100; ++i) {
      const ValueAndSlope at = balance(y, stress);
      // The slope of H is at least 1, so a value closes the other side of the bracket too.
      if (at.value >= 0) {
        upper = y;
        lower = std::max(lower, y - at.value);
      } else {
        lower = y;
        upper = std::min(upper, y - at.value);
      }
      double next = y - at.value / at.slope;
      if (!(next >= lower && next <= upper)) next = 0.5 * (lower + upper);
      // Newton's error is the square of the step, but for the last kelvin before the density law
      // ends: there tau_bar changes more within a step of 3e-8 than anywhere else.
      if (std::abs(next - y) <= 3e-8 && std::abs(at.value) <= 1e-7) return answer(next, 1);
      // Bisection now and then, so that no cycle between plateau and tail survives.
      y = i % 8 == 7 ? 0.5 * (lower + upper) : next;
    }
    return answer(0.5 * (lower + upper), 1);
  }

  // Halve ln(T - base), from far below any root to the highest temperature allowed.
  const double top =
      std::isfinite(highest_temperature) ? std::log(highest_temperature - base) : std::log(1e7);
  const double bottom = std::min(top, unheated) - 40;
  struct Place {
    double t, y, value;
  };
  const auto place = [&](double t) {
    // Denser towards the top, where the curve turns.
    const double y = bottom + (top - bottom) * (1 - (1 - t) * (1 - t));
    return Place{t, y, balance(y, stress).value};
  };
  int roots = 0;
  double first = 0;
  const auto search = [&](const auto& self, const Place& left, const Place& right,
                          int halvings) -> void {
    const double least = least_slope(film, base, base + std::exp(left.y), base + std::exp(right.y));
    const double most_fall = std::max(0.0, -least * (right.y - left.y));
    const bool meets = (left.value < 0) != (right.value < 0);
    const double margin = left.value < 0 ? -right.value : left.value;
    if (most_fall > 0 && !(margin > most_fall) && halvings > 0) {
      const Place middle = place(0.5 * (left.t + right.t));
      self(self, left, middle, halvings - 1);
      self(self, middle, right, halvings - 1);
    } else if (meets && ++roots == 1) {
      first = safeguarded_newton([&](double y) { return balance(y, stress); }, left.y, right.y,
                                 0.5 * (left.y + right.y), left.value < 0, 1e-9);
    }
  };
  constexpr int kMostHalvings = 9;
  search(search, place(0), place(1), kMostHalvings);
  if (roots == 0) return {0, base, cold};
  return answer(first, roots);
}

}  // namespace tribodyn
