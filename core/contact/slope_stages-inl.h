// The stages of contact_slopes.cpp: contacts that have been solved, in dual numbers of packs.
// Compiled once per instruction set by contact_slopes.cpp.
#if defined(TRIBODYN_CORE_CONTACT_SLOPE_STAGES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRIBODYN_CORE_CONTACT_SLOPE_STAGES_INL_H_
#undef TRIBODYN_CORE_CONTACT_SLOPE_STAGES_INL_H_
#else
#define TRIBODYN_CORE_CONTACT_SLOPE_STAGES_INL_H_
#endif

#include <hwy/highway.h>

#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>

#include "core/contact/contact_slopes.h"
#include "core/contact/limited_rim-inl.h"
#include "core/laws/asperities-inl.h"
#include "core/laws/film-inl.h"
#include "core/laws/heat-inl.h"
#include "core/laws/pressure_growth-inl.h"
#include "core/laws/shear-inl.h"
#include "core/numerics/dual-inl.h"
#include "core/numerics/gauss_legendre.h"
#include "core/numerics/pack-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tribodyn {
namespace HWY_NAMESPACE {
namespace {

/// By the conditions, ln(beta eta_0/k_f) of the inlet and E' as far as it heats the inlet.
enum { kInletLoading = kConditionSlopes, kInletModulus, kInletVariables };
using InletNumber = Dual<Pack, kInletVariables>;

/// What the contact follows from once the film is known that would carry all of the load: first
/// what decides how film and asperities share the load, then the rest.
enum SharedVariable {
  kSharedLoad,
  kSharedFilm,     // h_cen if the film carried all
  kSharedModulus,  // ln E', in the ellipse
  kSharedRmsHeight,
  kSharedLoadFactor,
  kSharingVariables,
  kSharedAreaFactor = kSharingVariables,
  kSharedSlide,
  kSharedConductance1,  // of 1 m2 whose ellipse is that at 1 N
  kSharedConductance2,
  kSharedOilConductivity,
  kSharedTribofilm,
  kSharedAsperityFriction,
  kSharedVariables
};
/// The last variable is free for ln(W_EHL/W).
using SharingNumber = Dual<Pack, kSharingVariables + 1>;
using SharedNumber = Dual<Pack, kSharedVariables>;

/// The same number with derivatives by all shared variables: by the further ones they are 0.
HWY_INLINE SharedNumber widened(const SharingNumber& x) {
  SharedNumber out(0.0);
  out.value = x.value;
  for (int k = 0; k < kSharingVariables; ++k) out.slope[k] = x.slope[k];
  return out;
}

/// By temperature, logarithm of the shear rate and the levels of the stress without pressure.
using StressNumber = Dual<Pack, 2 + kStressLevels>;

/// What one stage leaves to the next.
struct SlopeStages {
  InletNumber film, slide, conductance_1, conductance_2;
  SharedNumber viscous_area, boundary_friction, pressure, shear_rate, base, gain, film_ratio;
  Pack asperity_share;
  // Derivatives of ln tau_bar.
  Pack by_temperature, by_log_rate, by_log_pressure, by_limit_at_zero_pressure,
      by_limit_coefficient;
  Pack by_stress_level[kStressLevels];
  Pack by_growth[kGrowthArguments];
};

template <int kCount>
HWY_INLINE Dual<Pack, kCount> constant(Pack value) {
  Dual<Pack, kCount> out(0.0);
  out.value = value;
  return out;
}
/// The same as a number of any kind.
template <class Real>
HWY_INLINE Real as(Pack value) {
  if constexpr (std::same_as<Real, Pack>) {
    return value;
  } else {
    return constant<Real::kVariables>(value);
  }
}

/// The film if it carried all the load, the sliding and what the speeds do to the heat.
HWY_NOINLINE void eval_conditions(const ContactBlockTables& t, const Columns& solved,
                                  SlopeStages& stages, std::size_t i) {
  const auto row = [&](int r) HWY_ATTR { return load_any(solved[r] + i); };
  const auto variable = [&](int r)
                            HWY_ATTR { return InletNumber::variable(row(r), r - kSolvedLoad); };
  const InletNumber x_1 = variable(kSolvedVelocity1X), y_1 = variable(kSolvedVelocity1Y);
  const InletNumber x_2 = variable(kSolvedVelocity2X), y_2 = variable(kSolvedVelocity2Y);
  const InletNumber mean_x2 = square(0.5 * (x_1 + x_2)), mean_y2 = square(0.5 * (y_1 + y_2));
  const InletNumber slide2 = square(x_1 - x_2) + square(y_1 - y_2);
  const auto curvature_x = constant<kInletVariables>(row(kSolvedCurvatureX));
  const auto curvature_y = constant<kInletVariables>(row(kSolvedCurvatureY));
  const InletNumber log_along =
      logarithm(curvature_along_entrainment(mean_x2, mean_y2, curvature_x, curvature_y));
  const InletNumber log_across =
      logarithm(curvature_across_entrainment(mean_x2, mean_y2, curvature_x, curvature_y));
  const InletNumber log_speed2 = logarithm(entrainment_speed_squared(mean_x2, mean_y2));
  const InletNumber log_load = logarithm(variable(kSolvedLoad));
  stages.film =
      exponential(log_film(InletNumber(t.log_film), log_speed2, log_along - log_speed2, log_load)) *
      side_leakage(log_along - log_across);
  if (t.inlet_shear_heating) {
    const InletNumber modulus = InletNumber::variable(t.reduced_modulus, kInletModulus);
    const Pack unit_pressure = row(kSolvedUnitPressure);
    const InletNumber pressure =
        chained(unit_pressure, (2.0 / 3 / t.reduced_modulus) * unit_pressure, modulus) *
        exponential((1.0 / 3) * log_load);
    stages.film = stages.film *
                  inlet_heating_factor(InletNumber::variable(t.log_thermal_loading, kInletLoading),
                                       log_speed2, logarithm(slide2), pressure, modulus);
  }
  stages.slide = root(slide2);
  const auto per_x = constant<kInletVariables>(row(kSolvedPerSemiX));
  const auto per_y = constant<kInletVariables>(row(kSolvedPerSemiY));
  const InletNumber one(1.0);
  stages.conductance_1 = moving_source_conductance(t.conductance_factor_1, one,
                                                   speed_per_length(x_1, y_1, per_x, per_y));
  stages.conductance_2 = moving_source_conductance(t.conductance_factor_2, one,
                                                   speed_per_length(x_2, y_2, per_x, per_y));
}

/// P(x) and its slope, from the highest power down.
struct PolynomialAndSlope {
  Pack value, slope;
};
template <std::size_t kTerms>
HWY_INLINE PolynomialAndSlope asperity_polynomial(const std::array<double, kTerms>& c, Pack x) {
  PolynomialAndSlope out{c[0], 0};
  for (std::size_t j = 1; j < kTerms; ++j) {
    out.slope = fused(out.slope, x, out.value);
    out.value = fused(out.value, x, c[j]);
  }
  return out;
}

/// F_n of the film ratio l by its table: exp(-l^2/2) v^(n+1) P. `power`: v^(n+1).
HWY_INLINE SharingNumber asperity_function(const ContactBlockTables& t,
                                           const std::array<double, kAsperityTerms>& c,
                                           double order, Pack gaussian, Pack v, Pack power,
                                           Mask some, const SharingNumber& film_ratio) {
  const PolynomialAndSlope p =
      asperity_polynomial(c, fused(v, t.asperity_scale, t.asperity_offset));
  const Pack value = where(some, gaussian * power * p.value);
  const Pack fall = fused(v, fused(t.asperity_scale * v, p.slope / p.value, order + 1),
                          least(film_ratio.value, kAsperityEnd));
  return chained(value, -value * fall, film_ratio);
}

/// Load sharing, ellipse, heat: all but the stress.
HWY_NOINLINE void eval_shared_contact(const ContactBlockTables& t, const Columns& solved,
                                      SlopeStages& stages, std::size_t i) {
  const auto row = [&](int r) HWY_ATTR { return load_any(solved[r] + i); };
  const auto variable = [](Pack value, int n)
                            HWY_ATTR { return SharingNumber::variable(value, n); };
  const Pack load_all = row(kSolvedLoad);
  const SharingNumber load = variable(load_all, kSharedLoad);
  const SharingNumber film_under_all = variable(stages.film.value, kSharedFilm);
  const SharingNumber log_modulus = variable(0, kSharedModulus);
  const SharingNumber rms_height = variable(1 / t.inverse_roughness, kSharedRmsHeight);
  const SharingNumber load_factor = variable(t.asperity_load_factor, kSharedLoadFactor);
  // A value at 1 N that grows with a power of E'.
  const auto unit = [&](Pack value, double power)
                        HWY_ATTR { return chained(value, power * value, log_modulus); };
  const SharingNumber unit_area = unit(row(kSolvedUnitArea), -2.0 / 3);

  const SharingNumber log_load = logarithm(load);
  const SharingNumber ratio_all = film_under_all / rms_height;
  const Pack log_share = logarithm(row(kSolvedEllipseLoad) / load_all);
  const Mask some = ratio_all.value < kAsperitiesVanish;  // asperities touch
  const Pack ratio = ratio_all.value * film_thinning(log_share),
             inside = least(ratio, kAsperityEnd);
  const Pack v = 1 / (inside + kAsperityShift), gaussian = exponential(-0.5 * square(inside));
  const Pack cube = square(v) * v;
  const auto f5_2 = [&](const SharingNumber& film_ratio) HWY_ATTR {
    return asperity_function(t, t.f5_2, 2.5, gaussian, v, cube * root(v), some, film_ratio);
  };
  const SharingNumber asperities = load_factor * unit_area * exponential((-1.0 / 3) * log_load);
  const SharingNumber share =
      root_with_slopes<kSharingVariables + 1>(log_share, [&](const SharingNumber& r) HWY_ATTR {
        return exponential(r) +
               asperities * exponential((2.0 / 3) * r) * f5_2(ratio_all * film_thinning(r)) - 1.0;
      });

  const SharingNumber film = film_under_all * film_thinning(share), film_ratio = film / rms_height;
  const SharingNumber load_root = exponential((1.0 / 3) * (log_load + share));
  const SharingNumber contact_area = unit_area * square(load_root);
  const SharedNumber area_factor =
      SharedNumber::variable(t.asperity_area_factor, kSharedAreaFactor);
  SharedNumber asperity_area =
      area_factor *
      widened(contact_area * asperity_function(t, t.f2, 2, gaussian, v, cube, some, film_ratio));
  SharingNumber asperity_load = load_factor * contact_area * f5_2(film_ratio);
  stages.film_ratio = widened(film_ratio);
  const SharedNumber wide_area = widened(contact_area), wide_film = widened(film);
  stages.viscous_area = viscous_area(wide_area, asperity_area);
  if (t.closed_load_sharing) {
    const SharingNumber supported = supported_share(film_ratio);
    const Mask closes = supported.value < 1;
    const SharingNumber rest = load - supported * load * exponential(share);
    const SharingNumber log_f5_2 = logarithm(rest / (load_factor * contact_area));
    const PolynomialAndSlope log_f2 = asperity_polynomial(
        t.deep_area, clamped(fused(log_f5_2.value, t.deep_scale, t.deep_offset), -1, 1));
    const Pack f2 = exponential(log_f2.value);
    const SharingNumber deep = chained(f2, f2 * log_f2.slope * t.deep_scale, log_f5_2);
    const SharedNumber area = least(area_factor * widened(contact_area * deep), wide_area);
    asperity_load = select(closes, rest, asperity_load);
    asperity_area = select(closes, area, asperity_area);
    stages.viscous_area =
        select(closes, widened(supported) * viscous_area(wide_area, area), stages.viscous_area);
  }
  stages.asperity_share = asperity_area.value / contact_area.value;
  stages.boundary_friction = SharedNumber(0.0);
  if (!t.no_boundary_friction) {
    stages.boundary_friction = boundary_friction(
        SharedNumber::variable(t.boundary.tribofilm_shear_strength, kSharedTribofilm),
        asperity_area,
        SharedNumber::variable(t.boundary.asperity_friction_coefficient, kSharedAsperityFriction),
        widened(asperity_load));
  }
  stages.pressure = widened(unit(row(kSolvedUnitPressure), 2.0 / 3) * load_root);

  const SharedNumber slide = SharedNumber::variable(stages.slide.value, kSharedSlide);
  stages.shear_rate = shear_rate(slide, wide_film);
  stages.base = SharedNumber(t.inlet_temperature);
  stages.gain = SharedNumber(0.0);
  if (t.isothermal) return;
  // A sqrt(U/l) grows as (W^(1/3))^(3/2) with the load.
  const SharedNumber area = widened(unit(row(kSolvedUnitArea), -0.5) * load_root * root(load_root));
  const SharedNumber conductivity =
      SharedNumber::variable(t.shear.lubricant.thermal_conductivity, kSharedOilConductivity);
  const auto conductance = [&](const InletNumber& of_unit_ellipse, int n) HWY_ATTR {
    return area * SharedNumber::variable(of_unit_ellipse.value, n);
  };
  const ThermalLine<SharedNumber> line = contact_temperature(
      t.inlet_temperature,
      slide * flash_resistance(2.0 * conductivity * wide_area, wide_film,
                               conductance(stages.conductance_1, kSharedConductance1),
                               conductance(stages.conductance_2, kSharedConductance2)),
      stages.boundary_friction, stages.viscous_area,
      oil_rise_per_stress(slide, wide_film, conductivity));
  stages.base = line.base;
  stages.gain = line.gain;
}

/// int tau c p d(c p) between two depths s = ln(1 + c p), and the same weighted with the
/// derivatives of ln tau by the arguments of its growth.
struct Moments {
  Pack value;
  Pack by_growth[kGrowthArguments];
};

/// Digits of the exponentials that are factors of the integrand: the moments err by as much, 2e-8
/// (relative). Exponentials inside an exponent are computed with all digits, because an exponent
/// of up to 20 would multiply their relative error by as much.
constexpr Digits kMomentDigits = Digits::kHalf;

/// A quadrature rule on [0, 1].
struct Rule {
  int nodes;
  const double* node;
  const double* weight;
};
template <int kNodes>
Rule gauss_rule() {
  const auto& r = gauss_legendre<kNodes>();
  return {kNodes, r.node.data(), r.weight.data()};
}

/// E-folds of the integrand on a panel at most: those that 16 nodes integrate to 1e-10 (relative).
constexpr double kMomentLogGrowth = 20;

HWY_INLINE int panels_of(Pack log_growth) {
  int panels = 1;
  while (panels < 64 && any(log_growth > panels * kMomentLogGrowth)) ++panels;
  return panels;
}

/// The fewest nodes, in twos, by the e-folds of the integrand on a panel: the quadrature then errs
/// by less than 1e-8 (relative; greatest of 3,000 films under improved Yasutomi laws and of 20,000
/// under Roelands's, with random parameters).
HWY_INLINE Rule rule_for(Pack log_growth) {
  if (!any(log_growth > 4)) return gauss_rule<8>();
  if (!any(log_growth > 8)) return gauss_rule<10>();
  if (!any(log_growth > 12)) return gauss_rule<12>();
  if (!any(log_growth > 16)) return gauss_rule<14>();
  return gauss_rule<16>();
}

/// Panels that are even in s, between two depths.
struct Panels {
  int count;
  Pack from, width;
  Rule rule;

  /// The depth of a node.
  HWY_INLINE Pack at(int panel, int n) const { return fused(width, panel + rule.node[n], from); }
};
/// `steepness`: d ln tau/ds at the depth `end`. ln tau is steepest there: a stress as steep
/// everywhere would have at least as many e-folds.
HWY_INLINE Panels panels_between(Pack from, Pack end, Pack steepness) {
  const Pack length = end - from, log_growth = (steepness + 2) * length;
  const int count = panels_of(log_growth);
  return {count, from, length * (1.0 / count), rule_for(log_growth * (1.0 / count))};
}

/// How ln tau grows from the edge to a depth under a pressure-viscosity law, and the moments of
/// that between two depths: a policy of eval_mean_stress().
template <class G>
concept GrowthMoments = requires(const ContactBlockTables& t, Pack temperature, Pack base,
                                 Pack factor, Pack depth, Dual<Pack, 1> varied, Moments& out) {
  { G::log_stress_at(t, temperature, base, factor, depth) } -> std::same_as<Pack>;
  { G::log_stress_at(t, temperature, base, factor, varied) } -> std::same_as<Dual<Pack, 1>>;
  G::eval(t, temperature, base, factor, depth, depth, out);
};

struct RoelandsMoments {
  template <class Real>
  static HWY_INLINE Real log_stress_at(const ContactBlockTables& t, Pack, Pack base, Pack factor,
                                       Real s) {
    return log_under_pressure(as<Real>(base), as<Real>(factor),
                              exponential(t.shear.index * s) - 1.0);
  }
  static HWY_INLINE void eval(const ContactBlockTables& t, Pack, Pack base, Pack factor, Pack from,
                              Pack end, Moments& out) {
    const double index = t.shear.index;
    const Pack offset = base - factor;
    Pack value = 0, by_factor = 0, by_index = 0;
    const Panels panels = panels_between(from, end, index * factor * exponential(index * end));
    for (int panel = 0; panel < panels.count; ++panel) {
      for (int n = 0; n < panels.rule.nodes; ++n) {
        const Pack s = panels.at(panel, n);
        const Pack u = exponential<kMomentDigits>(s), power = exponential(index * s);
        const Pack stress =
            exponential<kMomentDigits>(clamped(fused(factor, power, offset), -600, 100));
        const Pack weighted = panels.rule.weight[n] * panels.width * stress * (u - 1) * u;
        value = value + weighted;
        by_factor = fused(weighted, power - 1, by_factor);
        by_index = fused(weighted * s, power, by_index);
      }
    }
    for (int k = 2; k < kGrowthArguments; ++k) out.by_growth[k] = 0;
    out.value = value;
    out.by_growth[0] = by_factor;
    out.by_growth[1] = factor * by_index;
  }
};

struct LawMoments {
  using Number = Dual<Pack, kGrowthArguments>;

  template <class Real>
  static HWY_INLINE Real log_stress_at(const ContactBlockTables& t, Pack temperature, Pack base,
                                       Pack, Real s) {
    return as<Real>(base) +
           pressure_growth(t.shear.growth, as<Real>(temperature),
                           exponential_less_one(s) * (1 / kRoelandsPressureCoefficient));
  }
  static HWY_INLINE void eval(const ContactBlockTables& t, Pack at, Pack base, Pack, Pack from,
                              Pack end, Moments& out) {
    const auto law = by_its_parameters<Number>(t.shear.growth);
    const Number temperature = Number::variable(at, 0);
    out.value = 0;
    for (int k = 0; k < kGrowthArguments; ++k) out.by_growth[k] = 0;
    const Pack steepness = log_stress_at(t, at, base, 0, Dual<Pack, 1>::variable(end, 0)).slope[0];
    const Panels panels = panels_between(from, end, steepness);
    for (int panel = 0; panel < panels.count; ++panel) {
      for (int n = 0; n < panels.rule.nodes; ++n) {
        const Pack q = exponential_less_one(panels.at(panel, n));
        const Number growth = pressure_growth(
            law, temperature, constant<kGrowthArguments>(q * (1 / kRoelandsPressureCoefficient)));
        const Pack stress = exponential<kMomentDigits>(clamped(base + growth.value, -600, 100));
        const Pack weighted = panels.rule.weight[n] * panels.width * stress * q * (q + 1);
        out.value = out.value + weighted;
        for (int k = 0; k < kGrowthArguments; ++k) {
          out.by_growth[k] = fused(weighted, growth.slope[k], out.by_growth[k]);
        }
      }
    }
  }
};

/// c p at which a limited rim ends; 0 without one. `scaled`: c p at the centre.
template <GrowthMoments Growth>
HWY_INLINE Pack end_of_rim(const ContactBlockTables& t, Pack temperature, Pack base, Pack factor,
                           Pack scaled) {
  constexpr int kSteps = 6;  // from the edge, as start_rim(): the error is cubed or better
  const double edge_limit = t.shear.lubricant.limiting_shear_stress_at_zero_pressure;
  Pack x = 0;
  for (int n = 0; n < kSteps; ++n) {
    const Dual<Pack, 1> log_stress = Growth::log_stress_at(
        t, temperature, base, factor, logarithm(Dual<Pack, 1>::variable(x, 0) + 1.0));
    const LimitExcess h(exponential(clamped(log_stress.value, -600, 100)), log_stress.slope[0],
                        limiting_shear_stress(edge_limit, t.limit_slope, x), t.limit_slope);
    x = clamped(x + RimStep(h).change, 0, scaled);
  }
  return where(base > t.log_limit_at_edge, x);
}

/// Derivatives of ln tau_bar at the temperature found. The place where the stress meets tau_L
/// towards the centre follows from the area share on it.
template <GrowthMoments Growth>
HWY_NOINLINE void eval_mean_stress(const ContactBlockTables& t, const Columns& solved,
                                   SlopeStages& stages, std::size_t i) {
  const auto row = [&](int r) HWY_ATTR { return load_any(solved[r] + i); };
  const Pack temperature = row(kSolvedContactTemperature);
  ShearLaw<StressNumber> law;
  const LubricantOf<double>& oil = t.shear.lubricant;
  const auto level = [](double value, int n)
                         HWY_ATTR { return StressNumber::variable(value, 2 + n - kDirectLevels); };
  law.log_vogel_prefactor = level(t.shear.log_vogel_prefactor, kLevelLogVogelPrefactor);
  law.log_relaxation_time = level(t.shear.log_relaxation_time, kLevelLogRelaxationTime);
  law.shift_reference = level(t.shear.shift_reference, kLevelShiftReference);
  law.lubricant.vogel_temperature_coefficient =
      level(oil.vogel_temperature_coefficient, kLevelVogelCoefficient);
  law.lubricant.vogel_reference_temperature =
      level(oil.vogel_reference_temperature, kLevelVogelReference);
  law.lubricant.havriliak_negami_alpha = level(oil.havriliak_negami_alpha, kLevelThinningAlpha);
  law.lubricant.havriliak_negami_beta = level(oil.havriliak_negami_beta, kLevelThinningBeta);
  law.lubricant.density_at_zero_kelvin =
      level(oil.density_at_zero_kelvin, kLevelDensityAtZeroKelvin);
  law.lubricant.density_temperature_slope =
      level(oil.density_temperature_slope, kLevelDensitySlope);
  law.newtonian = t.shear.newtonian;
  const Pack log_rate = logarithm(stages.shear_rate.value);
  const LogStress<StressNumber> stress = log_stress<Digits::kFull>(
      law, StressNumber::variable(temperature, 0), StressNumber::variable(log_rate, 1));

  const Pack scaled = kRoelandsPressureCoefficient * stages.pressure.value;
  const Pack share = row(kSolvedLimitedAreaShare), mean = row(kSolvedMeanShearStress);
  Pack q = scaled * root(1 - share), rim = 0;  // c p where tau_L holds again, and up to where
  if (t.limited_rim && any(stress.base.value > t.log_limit_at_edge)) {
    rim = where(share < 1,
                end_of_rim<Growth>(t, temperature, stress.base.value, stress.factor.value, scaled));
    q = greatest(least(root(fused(q, q, rim * rim)), scaled), rim);
  }
  const Pack per_integral = 2 / (mean * square(scaled));
  Moments moments;
  Growth::eval(t, temperature, stress.base.value, stress.factor.value, logarithm(rim + 1),
               logarithm(q + 1), moments);
  const Pack by_base = moments.value * per_integral;
  for (int k = 0; k < kGrowthArguments; ++k) {
    stages.by_growth[k] = moments.by_growth[k] * per_integral;
  }
  const bool roelands = oil.pressure_viscosity_law == PressureViscosityLaw::kRoelands;
  const Pack by_factor = roelands ? stages.by_growth[0] : Pack(0);
  const auto by = [&](int n) HWY_ATTR {
    return fused(by_base, stress.base.slope[n], by_factor * stress.factor.slope[n]);
  };
  stages.by_temperature = by(0);
  if (!roelands) stages.by_temperature = stages.by_temperature + stages.by_growth[0];
  stages.by_log_rate = by(1);
  for (int n = 0; n < kStressLevels; ++n) stages.by_stress_level[n] = by(2 + n);

  const Pack log_centre = Growth::log_stress_at(t, temperature, stress.base.value,
                                                stress.factor.value, logarithm(scaled + 1));
  Pack centre = exponential(clamped(log_centre, -600, 100));
  if (t.limited) {
    const Pack limit =
        limiting_shear_stress(oil.limiting_shear_stress_at_zero_pressure, t.limit_slope, scaled);
    centre = least(centre, limit);
  }
  stages.by_log_pressure = 2 * centre / mean - 2;
  stages.by_limit_at_zero_pressure =
      0.5 * (square(scaled) - square(q) + square(rim)) * per_integral;
  stages.by_limit_coefficient = (square(scaled) * scaled - square(q) * q + square(rim) * rim) *
                                per_integral * (1 / (3 * kRoelandsPressureCoefficient));
}

/// The temperature by the implicit function theorem, and the chain rule to conditions and levels.
HWY_NOINLINE void put_slopes(const ContactBlockTables& t, const Columns& solved,
                             const SlopeStages& stages, ContactSlopes& slopes, std::size_t i) {
  const Pack mean = load_any(solved[kSolvedMeanShearStress] + i);
  // d tau_bar = moved (everything but the temperature's own change).
  const Pack moved = mean / less_product(stages.by_temperature * stages.gain.value, mean, 1);
  const Pack friction_by_log = stages.viscous_area.value * moved;
  const Pack temperature_by_log = stages.gain.value * moved;

  const Pack per_pressure = stages.by_log_pressure / stages.pressure.value;
  const Pack per_rate = stages.by_log_rate / stages.shear_rate.value;
  Pack friction[kSharedVariables], temperature[kSharedVariables];
  for (int k = 0; k < kSharedVariables; ++k) {
    const Pack line = fused(mean, stages.gain.slope[k], stages.base.slope[k]);
    const Pack log_stress =
        fused(per_pressure, stages.pressure.slope[k],
              fused(per_rate, stages.shear_rate.slope[k], stages.by_temperature * line));
    friction[k] = fused(mean, stages.viscous_area.slope[k],
                        fused(friction_by_log, log_stress, stages.boundary_friction.slope[k]));
    temperature[k] = fused(temperature_by_log, log_stress, line);
  }

  const auto chain = [&](const Pack* by, Columns& to) HWY_ATTR {
    const auto put = [&](int r, Pack value) HWY_ATTR { store_any(value, to[r] + i); };
    for (int k = 0; k < kConditionSlopes; ++k) {
      Pack sum =
          fused(by[kSharedFilm], stages.film.slope[k], by[kSharedSlide] * stages.slide.slope[k]);
      sum = fused(by[kSharedConductance1], stages.conductance_1.slope[k], sum);
      sum = fused(by[kSharedConductance2], stages.conductance_2.slope[k], sum);
      put(k, k == 0 ? sum + by[kSharedLoad] : sum);
    }
    const auto level = [&](int n, Pack value) HWY_ATTR { put(kConditionSlopes + n, value); };
    level(kLevelRmsHeight, by[kSharedRmsHeight]);
    level(kLevelTribofilmStrength, by[kSharedTribofilm]);
    level(kLevelAsperityFriction, by[kSharedAsperityFriction]);
    level(kLevelOilConductivity, by[kSharedOilConductivity]);
    level(kLevelLogFilm, by[kSharedFilm] * stages.film.value);
    level(kLevelLogThermalLoading, by[kSharedFilm] * stages.film.slope[kInletLoading]);
    level(kLevelReducedModulus, fused(by[kSharedFilm], stages.film.slope[kInletModulus],
                                      by[kSharedModulus] * (1 / t.reduced_modulus)));
    level(kLevelAsperityLoadFactor, by[kSharedLoadFactor]);
    level(kLevelAsperityAreaFactor, by[kSharedAreaFactor]);
    level(kLevelConductanceFactor1,
          by[kSharedConductance1] * stages.conductance_1.value * (1 / t.conductance_factor_1));
    level(kLevelConductanceFactor2,
          by[kSharedConductance2] * stages.conductance_2.value * (1 / t.conductance_factor_2));
  };
  chain(friction, slopes.friction);
  chain(temperature, slopes.temperature);
  chain(stages.film_ratio.slope, slopes.film_ratio);

  const auto stress_level = [&](int n, Pack by_log) HWY_ATTR {
    store_any(friction_by_log * by_log, slopes.friction[kConditionSlopes + n] + i);
    store_any(temperature_by_log * by_log, slopes.temperature[kConditionSlopes + n] + i);
  };
  stress_level(kLevelInletTemperature, stages.by_temperature);
  store_any(0, slopes.film_ratio[kConditionSlopes + kLevelInletTemperature] + i);
  store_any(fused(temperature_by_log, stages.by_temperature, 1),
            slopes.temperature[kConditionSlopes + kLevelInletTemperature] + i);
  for (int n = 0; n < kStressLevels; ++n) {
    stress_level(kDirectLevels + n, stages.by_stress_level[n]);
  }
  for (int k = 1; k < kGrowthArguments; ++k) {
    stress_level(kLevelGrowth + k - 1, stages.by_growth[k]);
  }
  stress_level(kLevelLimitAtZeroPressure, stages.by_limit_at_zero_pressure);
  stress_level(kLevelLimitCoefficient, stages.by_limit_coefficient);
  store_any(stages.asperity_share, slopes.edge[0] + i);
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace tribodyn
HWY_AFTER_NAMESPACE();

#endif  // TRIBODYN_CORE_CONTACT_SLOPE_STAGES_INL_H_
