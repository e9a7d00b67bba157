#include "core/contact/mean_shear_stress.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <type_traits>

#include "core/numerics/bracketed_root.h"
#include "core/numerics/gauss_legendre.h"

namespace tribodyn {
namespace {

constexpr double kC = laws::kRoelandsPressureCoefficient;  // c of the formulas [1/Pa]

double pressure_at(double s) { return std::expm1(s) / kC; }

/// How ln tau(s) at one temperature grows from its value `base` at p = 0 under a
/// pressure-viscosity law: a policy of Law.
template <class G>
concept StressGrowth = requires(const G& growth, double base, double s,
                                const std::array<double, kGrowthArguments>& by_growth) {
  { growth.log_stress(base, s) } -> std::same_as<double>;
  { growth.by_depth(s) } -> std::same_as<double>;  // d ln tau/ds
  // d ln tau_bar/dT from the derivatives by the arguments of the growth.
  { growth.temperature_slope(by_growth) } -> std::same_as<double>;
};

/// L (e^(Z s) - 1).
struct RoelandsStress {
  double factor, factor_slope, index;

  RoelandsStress(const ShearLaw<double>& law, const laws::LogStress<double>& at, double)
      : factor(at.factor), factor_slope(at.factor_slope), index(law.index) {}

  double log_stress(double base, double s) const {
    return laws::log_under_pressure(base, factor, std::expm1(index * s));
  }
  double by_depth(double s) const { return factor * index * std::exp(index * s); }
  /// The greatest slope in s before an end at which ln tau has grown by `growth`.
  double steepest(double growth) const { return index * std::abs(growth + factor); }
  double depth_of(double growth) const { return std::log1p(growth / factor) / index; }
  double temperature_slope(const std::array<double, kGrowthArguments>& by_growth) const {
    return factor_slope * by_growth[0];
  }
};

/// Of any other law.
struct LawStress {
  const ShearLaw<double>* law;
  double temperature;

  LawStress(const ShearLaw<double>& of, const laws::LogStress<double>&, double at)
      : law(&of), temperature(at) {}

  ValueAndSlope growth(double s) const {
    using Number = laws::Dual<double, 1>;
    const Number pressure = laws::exponential_less_one(Number::variable(s, 0)) / kC;
    const Number out = laws::pressure_growth(law->growth, Number(temperature), pressure);
    return {out.value, out.slope[0]};
  }
  double log_stress(double base, double s) const { return base + growth(s).value; }
  double by_depth(double s) const { return growth(s).slope; }
  double temperature_slope(const std::array<double, kGrowthArguments>& by_growth) const {
    return by_growth[0];
  }
};

template <StressGrowth Growth>
struct Law {
  Growth growth;
  double base, base_slope;
  double tau_zero, gamma;  // tau_L = tau_zero + gamma p
  bool all_derivatives;

  Law(const ShearedFilm& film, double temperature)
      : Law(film, temperature, tribodyn::log_stress(*film.law, temperature, film.log_shear_rate)) {}
  Law(const ShearedFilm& film, double temperature, const laws::LogStress<double>& at)
      : growth(*film.law, at, temperature),
        base(at.base),
        base_slope(at.base_slope),
        tau_zero(film.law->lubricant.limiting_shear_stress_at_zero_pressure),
        gamma(film.law->lubricant.limiting_shear_stress_coefficient),
        all_derivatives(film.all_derivatives) {}

  double log_stress(double s) const { return growth.log_stress(base, s); }
  double limit(double s) const {
    return laws::limiting_shear_stress(tau_zero, gamma, pressure_at(s));
  }
  /// ln(tau / tau_L): positive where the stress is limited.
  ValueAndSlope excess(double s) const {
    const double limit_there = limit(s);
    return {log_stress(s) - std::log(limit_there),
            growth.by_depth(s) - gamma * std::exp(s) / kC / limit_there};
  }
};

/// int tau p dp over [from, to] in s, and the same weighted with the derivatives of ln tau by the
/// arguments of its growth, all over exp(shift).
struct Moment {
  double shift = 0, value = 0;
  std::array<double, kGrowthArguments> by_growth{};

  void add(double scale, const Moment& part) {
    value += scale * part.value;
    for (int k = 0; k < kGrowthArguments; ++k) by_growth[k] += scale * part.by_growth[k];
  }
};

/// e^s - 1 loses digits only where p is so small that the stress does not depend on it.
template <class Array>
Array scaled_pressure(const Array& s, const Array& u) {
  return s(s.size() - 1) > 1e-3 ? Array(u - 1) : Array(s * (1 + s * (0.5 + s / 6 * (1 + s / 4))));
}

template <int N>
void add_panel(const Law<RoelandsStress>& law, double from, double to, Moment& out) {
  const auto& rule = gauss_legendre<N>();
  using Array = Eigen::Array<double, N, 1>;
  const double factor = law.growth.factor, index = law.growth.index;
  const Array s = from + (to - from) * rule.node;
  const Array u = s.exp();
  const Array growth = (index * s).exp() - 1;
  const Array weighted = (to - from) / (kC * kC) * rule.weight *
                         (law.base - out.shift + factor * growth).exp() * scaled_pressure(s, u) * u;
  out.value += weighted.sum();
  out.by_growth[0] += (weighted * growth).sum();
  if (law.all_derivatives) out.by_growth[1] += factor * (weighted * s * (growth + 1)).sum();
}

/// With derivatives by kCount arguments of the growth, the temperature the first one.
template <int N, int kCount>
void add_nodes(const Law<LawStress>& law, const GrowthLaw<laws::Dual<double, kCount>>& by_arguments,
               double from, double to, Moment& out) {
  using Number = laws::Dual<double, kCount>;
  const auto& rule = gauss_legendre<N>();
  const Number temperature = Number::variable(law.growth.temperature, 0);
  for (int n = 0; n < N; ++n) {
    const double s = from + (to - from) * rule.node(n), q = std::expm1(s);
    const Number growth = laws::pressure_growth(by_arguments, temperature, Number(q / kC));
    const double weighted = (to - from) / (kC * kC) * rule.weight(n) *
                            std::exp(law.base - out.shift + growth.value) * q * (q + 1);
    out.value += weighted;
    for (int k = 0; k < kCount; ++k) out.by_growth[k] += weighted * growth.slope[k];
  }
}

/// Panels of at most 20 e-folds, laid out evenly in ln tau.
Moment moment(const Law<RoelandsStress>& law, double from, double to) {
  Moment out;
  const double start = law.log_stress(from), end = law.log_stress(to);
  out.shift = std::max(start, end);
  // E-folds of the integrand if it grew all along as it does at its end, where it is steepest:
  // d ln tau/ds there, and two per unit of s from p dp.
  const double steepest = law.growth.steepest(end - law.base) + 2;
  const double log_growth = steepest * (to - from);
  if (log_growth <= 7.5) {
    add_panel<12>(law, from, to, out);
  } else if (log_growth <= 15) {
    add_panel<16>(law, from, to, out);
  } else {
    const int panels = static_cast<int>(std::min(64.0, std::ceil(log_growth / 20)));
    double left = from;
    for (int i = 1; i <= panels; ++i) {
      const double growth = (i * end + (panels - i) * start) / panels - law.base;
      const double right = i == panels ? to : std::clamp(law.growth.depth_of(growth), left, to);
      add_panel<20>(law, left, right, out);
      left = right;
    }
  }
  return out;
}

/// Panels of at most 6 e-folds and 0.5 in s, of equal length in s.
Moment moment(const Law<LawStress>& law, double from, double to) {
  constexpr double kLogGrowth = 6, kLongest = 0.5;
  Moment out;
  const double start = law.log_stress(from), end = law.log_stress(to);
  out.shift = std::max(start, end);
  const double log_growth = std::abs(end - start) + 2 * (to - from);
  const int panels = static_cast<int>(
      std::clamp(std::ceil(std::max(log_growth / kLogGrowth, (to - from) / kLongest)), 1.0, 64.0));
  const auto add_all = [&]<int kCount>(std::integral_constant<int, kCount>) {
    const auto by_arguments =
        laws::by_its_parameters<laws::Dual<double, kCount>>(law.growth.law->growth);
    const double step = (to - from) / panels;
    for (int i = 0; i < panels; ++i) {
      add_nodes<16>(law, by_arguments, from + i * step, from + (i + 1) * step, out);
    }
  };
  if (law.all_derivatives) {
    add_all(std::integral_constant<int, kGrowthArguments>());
  } else {
    add_all(std::integral_constant<int, 1>());
  }
  return out;
}

/// Points of [0, end] in s between which ln(tau/tau_L) is monotone, in rising order.
struct Pieces {
  std::array<double, 5> point;
  int count = 0;

  void add(double s) { point[count++] = s; }
};

/// The slope of ln(tau/tau_L) has the sign of
/// psi(u) = L Z ((tau_0 c - gamma) u^{Z-1} + gamma u^Z) - gamma, u = e^s, which has one extremum.
Pieces monotone_pieces(const Law<RoelandsStress>& law, double end) {
  const double factor = law.growth.factor, index = law.growth.index;
  const auto psi = [&](double s) {
    const double power = std::exp((index - 1) * s), u = std::exp(s);
    return factor * index * power * ((law.tau_zero * kC - law.gamma) + law.gamma * u) - law.gamma;
  };
  Pieces pieces;
  pieces.add(0);
  double turn = -1;
  if (law.gamma > 0) {
    const double u = (1 - index) * (law.tau_zero * kC - law.gamma) / (index * law.gamma);
    if (u > 1) turn = std::log(u);
  }
  double left = 0, psi_left = psi(0);
  const auto visit = [&](double right) {
    const double psi_right = psi(right);
    if ((psi_left < 0 && psi_right > 0) || (psi_left > 0 && psi_right < 0)) {
      pieces.add(bracketed_root(psi, left, right, psi_left, psi_right));
    }
    left = right;
    psi_left = psi_right;
  };
  if (turn > 0 && turn < end) visit(turn);
  visit(end);
  pieces.add(end);
  return pieces;
}

/// Up to three changes of sign of the slope of ln(tau/tau_L) over 32 equal parts of [0, end].
Pieces monotone_pieces(const Law<LawStress>& law, double end) {
  constexpr int kParts = 32, kMostTurns = 3;
  const auto slope = [&](double s) { return law.excess(s).slope; };
  Pieces pieces;
  pieces.add(0);
  double slope_left = slope(0);
  for (int i = 0; i < kParts && pieces.count <= kMostTurns; ++i) {
    const double left = end * i / kParts, right = end * (i + 1) / kParts;
    const double slope_right = slope(right);
    if ((slope_left < 0 && slope_right > 0) || (slope_left > 0 && slope_right < 0)) {
      pieces.add(bracketed_root(slope, left, right, slope_left, slope_right));
    }
    slope_left = slope_right;
  }
  pieces.add(end);
  return pieces;
}

/// int tau_L p dp over what sits on the limit, by tau_L0 and by gamma_L.
struct OnLimit {
  double by_zero = 0, by_coefficient = 0;
};

template <StressGrowth Growth>
MeanShearStress mean_of(const Law<Growth>& law, double pressure, const Moment& sheared,
                        const OnLimit& on, bool limited_at_centre) {
  const double integral = sheared.value + law.tau_zero * on.by_zero + law.gamma * on.by_coefficient;
  MeanShearStress out{};
  out.log_value = std::log(2.0) - 2 * std::log(pressure) + sheared.shift + std::log(integral);
  out.by_base = sheared.value / integral;
  for (int k = 0; k < kGrowthArguments; ++k) out.by_growth[k] = sheared.by_growth[k] / integral;
  out.slope = law.base_slope * out.by_base + law.growth.temperature_slope(out.by_growth);
  out.limited_area_share = std::min(1.0, 2 * on.by_zero / (pressure * pressure));
  out.limited_at_centre = limited_at_centre;
  if (!law.all_derivatives) return out;
  const double centre = std::log1p(kC * pressure);
  const double log_stress =
      limited_at_centre ? std::log(law.limit(centre)) : law.log_stress(centre);
  out.by_log_pressure = 2 * std::exp(log_stress - out.log_value) - 2;
  out.by_limit_at_zero_pressure = on.by_zero / integral;
  out.by_limit_coefficient = on.by_coefficient / integral;
  return out;
}

template <StressGrowth Growth>
MeanShearStress mean_with(const ShearedFilm& film, double temperature, double& switch_guess) {
  const Law<Growth> law(film, temperature);
  const double end = std::log1p(kC * film.maximum_pressure);
  const auto unlimited = [&] {
    return mean_of(law, film.maximum_pressure, moment(law, 0, end), {}, false);
  };
  if (!film.limited) return unlimited();

  const Pieces monotone = monotone_pieces(law, end);
  const std::array<double, 5>& pieces = monotone.point;
  std::array<double, 6> cuts{};
  int cut_count = 0;
  cuts[cut_count++] = 0;
  double excess_left = law.excess(0).value;
  bool limited = excess_left > 0;
  const bool limited_at_edge = limited;
  for (int i = 1; i < monotone.count; ++i) {
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

  if (switches == 0 && !limited_at_edge) return unlimited();
  Moment sheared;
  OnLimit on;
  bool on_limit = limited_at_edge;
  for (int i = 0; i < cut_count; ++i, on_limit = !on_limit) {
    if (on_limit) {
      const double p0 = pressure_at(cuts[i]);
      const double p1 = i == switches ? film.maximum_pressure : pressure_at(cuts[i + 1]);
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

template <StressGrowth Growth>
double excess_at_centre(const ShearedFilm& film, double temperature) {
  return Law<Growth>(film, temperature).excess(std::log1p(kC * film.maximum_pressure)).value;
}

bool is_roelands(const ShearedFilm& film) {
  return film.law->lubricant.pressure_viscosity_law == PressureViscosityLaw::kRoelands;
}

}  // namespace

MeanShearStress mean_shear_stress(const ShearedFilm& film, double temperature,
                                  double& switch_guess) {
  return is_roelands(film) ? mean_with<RoelandsStress>(film, temperature, switch_guess)
                           : mean_with<LawStress>(film, temperature, switch_guess);
}

double log_stress_over_limit(const ShearedFilm& film, double temperature) {
  return is_roelands(film) ? excess_at_centre<RoelandsStress>(film, temperature)
                           : excess_at_centre<LawStress>(film, temperature);
}

}  // namespace tribodyn
