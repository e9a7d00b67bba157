#include "core/contact/mean_shear_stress.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/numerics/bracketed_root.h"
#include "core/numerics/gauss_legendre.h"

namespace tribodyn {
namespace {

constexpr double kC = laws::kRoelandsPressureCoefficient;  // c of the formulas [1/Pa]

/// ln tau(s) = base + factor (e^{Z s} - 1) at one temperature, with slopes in temperature.
struct Law : laws::LogStress<double> {
  double index;
  double tau_zero, gamma;  // tau_L = tau_zero + gamma p
  bool all_derivatives;

  double log_stress(double s) const {
    return laws::log_under_pressure(base, factor, std::expm1(index * s));
  }
  double pressure(double s) const { return std::expm1(s) / kC; }
  double limit(double s) const { return laws::limiting_shear_stress(tau_zero, gamma, pressure(s)); }
  /// ln(tau / tau_L): positive where the stress is limited.
  ValueAndSlope excess(double s) const {
    const double growth = std::exp(index * s), u = std::exp(s);
    const double limit = tau_zero + gamma * (u - 1) / kC;
    return {base + factor * (growth - 1) - std::log(limit),
            factor * index * growth - gamma * u / kC / limit};
  }
};

Law law_at(const ShearedFilm& film, double temperature) {
  const Lubricant& oil = film.law->lubricant;
  return {log_stress(*film.law, temperature, film.log_shear_rate), film.law->index,
          oil.limiting_shear_stress_at_zero_pressure, oil.limiting_shear_stress_coefficient,
          film.all_derivatives};
}

/// int tau p dp over [from, to] in s, and the same weighted with d ln tau/d factor and d ln tau/dZ,
/// all over exp(shift).
struct Moment {
  double shift = 0, value = 0, by_factor = 0, by_index = 0;

  void add(double scale, const Moment& part) {
    value += scale * part.value;
    by_factor += scale * part.by_factor;
    by_index += scale * part.by_index;
  }
};

template <int N>
void add_panel(const Law& law, double from, double to, Moment& out) {
  const auto& rule = gauss_legendre<N>();
  using Array = Eigen::Array<double, N, 1>;
  const Array s = from + (to - from) * rule.node;
  const Array u = s.exp();
  const Array growth = (law.index * s).exp() - 1;
  // e^s - 1 loses digits only where p is so small that the stress does not depend on it.
  const Array q = s(N - 1) > 1e-3 ? Array(u - 1) : Array(s * (1 + s * (0.5 + s / 6 * (1 + s / 4))));
  const Array weighted = (to - from) / (kC * kC) * rule.weight *
                         (law.base - out.shift + law.factor * growth).exp() * q * u;
  out.value += weighted.sum();
  out.by_factor += (weighted * growth).sum();
  if (law.all_derivatives) out.by_index += law.factor * (weighted * s * (growth + 1)).sum();
}

Moment moment(const Law& law, double from, double to) {
  Moment out;
  const double start = law.log_stress(from), end = law.log_stress(to);
  out.shift = std::max(start, end);
  // E-folds of the integrand if it grew all along as it does at its end, where it is steepest:
  // d ln tau/ds there, and two per unit of s from p dp.
  const double steepest = law.index * std::abs(end - law.base + law.factor) + 2;
  const double folds = steepest * (to - from);
  if (folds <= 7.5) {
    add_panel<12>(law, from, to, out);
  } else if (folds <= 15) {
    add_panel<16>(law, from, to, out);
  } else {
    // Panels of at most 20 such e-folds, laid out evenly in ln tau.
    const int panels = static_cast<int>(std::min(64.0, std::ceil(folds / 20)));
    double left = from;
    for (int i = 1; i <= panels; ++i) {
      const double growth = ((i * end + (panels - i) * start) / panels - law.base) / law.factor;
      const double right = i == panels ? to : std::clamp(std::log1p(growth) / law.index, left, to);
      add_panel<20>(law, left, right, out);
      left = right;
    }
  }
  return out;
}

/// Points of [0, end] in s between which ln(tau/tau_L) is monotone. Its slope has the sign of
/// psi(u) = L Z ((tau_0 c - gamma) u^{Z-1} + gamma u^Z) - gamma, u = e^s, which has one extremum.
int monotone_pieces(const Law& law, double end, std::array<double, 5>& points) {
  const auto psi = [&](double s) {
    const double power = std::exp((law.index - 1) * s), u = std::exp(s);
    return law.factor * law.index * power * ((law.tau_zero * kC - law.gamma) + law.gamma * u) -
           law.gamma;
  };
  int count = 0;
  points[count++] = 0;
  double turn = -1;
  if (law.gamma > 0) {
    const double u = (1 - law.index) * (law.tau_zero * kC - law.gamma) / (law.index * law.gamma);
    if (u > 1) turn = std::log(u);
  }
  double left = 0, psi_left = psi(0);
  const auto visit = [&](double right) {
    const double psi_right = psi(right);
    if ((psi_left < 0 && psi_right > 0) || (psi_left > 0 && psi_right < 0)) {
      points[count++] = bracketed_root(psi, left, right, psi_left, psi_right);
    }
    left = right;
    psi_left = psi_right;
  };
  if (turn > 0 && turn < end) visit(turn);
  visit(end);
  points[count++] = end;
  return count;
}

/// int tau_L p dp over what sits on the limit, by tau_L0 and by gamma_L.
struct OnLimit {
  double by_zero = 0, by_coefficient = 0;
};

MeanShearStress mean_of(const Law& law, double pressure, const Moment& sheared, const OnLimit& on,
                        bool limited_at_centre) {
  const double integral = sheared.value + law.tau_zero * on.by_zero + law.gamma * on.by_coefficient;
  MeanShearStress out{};
  out.log_value = std::log(2.0) - 2 * std::log(pressure) + sheared.shift + std::log(integral);
  out.by_base = sheared.value / integral;
  out.by_factor = sheared.by_factor / integral;
  out.slope = law.base_slope * out.by_base + law.factor_slope * out.by_factor;
  out.limited_area_share = std::min(1.0, 2 * on.by_zero / (pressure * pressure));
  out.limited_at_centre = limited_at_centre;
  if (!law.all_derivatives) return out;
  const double centre = std::log1p(kC * pressure);
  const double log_stress =
      limited_at_centre ? std::log(law.limit(centre)) : law.log_stress(centre);
  out.by_index = sheared.by_index / integral;
  out.by_log_pressure = 2 * std::exp(log_stress - out.log_value) - 2;
  out.by_limit_at_zero_pressure = on.by_zero / integral;
  out.by_limit_coefficient = on.by_coefficient / integral;
  return out;
}

}  // namespace

MeanShearStress mean_shear_stress(const ShearedFilm& film, double temperature,
                                  double& switch_guess) {
  const Law law = law_at(film, temperature);
  const double end = std::log1p(kC * film.maximum_pressure);
  const auto unlimited = [&] {
    return mean_of(law, film.maximum_pressure, moment(law, 0, end), {}, false);
  };
  if (!film.limited) return unlimited();

  std::array<double, 5> pieces{};
  const int points = monotone_pieces(law, end, pieces);
  std::array<double, 6> cuts{};
  int cut_count = 0;
  cuts[cut_count++] = 0;
  double excess_left = law.excess(0).value;
  bool limited = excess_left > 0;
  const bool limited_at_rim = limited;
  for (int i = 1; i < points; ++i) {
    const double excess_right = law.excess(pieces[i]).value;
    if ((excess_left > 0) != (excess_right > 0)) {
      const bool rising = excess_right > 0;
      const double guess =
          switch_guess > pieces[i - 1] && switch_guess < pieces[i]
              ? switch_guess
              : pieces[i - 1] +
                    (pieces[i] - pieces[i - 1]) * (std::isfinite(excess_left)
                                                       ? excess_left / (excess_left - excess_right)
                                                       : 0.5);
      // The integrand is continuous across the cut: an error d of it costs the integral d^2.
      const double cut = safeguarded_newton([&](double s) { return law.excess(s); }, pieces[i - 1],
                                            pieces[i], guess, rising, 1e-8);
      switch_guess = cut;
      cuts[cut_count++] = cut;
      limited = !limited;
    }
    excess_left = excess_right;
  }
  const int switches = cut_count - 1;
  cuts[cut_count] = end;

  if (switches == 0 && !limited_at_rim) return unlimited();
  Moment sheared;
  OnLimit on;
  bool on_limit = limited_at_rim;
  for (int i = 0; i < cut_count; ++i, on_limit = !on_limit) {
    if (on_limit) {
      const double p0 = law.pressure(cuts[i]);
      const double p1 = i == switches ? film.maximum_pressure : law.pressure(cuts[i + 1]);
      on.by_zero += 0.5 * (p1 - p0) * (p1 + p0);
      on.by_coefficient += (p1 - p0) * (p1 * p1 + p1 * p0 + p0 * p0) / 3;
    } else {
      const Moment part = moment(law, cuts[i], cuts[i + 1]);
      sheared.add(std::exp(part.shift), part);
    }
  }
  MeanShearStress out = mean_of(law, film.maximum_pressure, sheared, on, limited);
  out.switches = switches;
  return out;
}

}  // namespace tribodyn
