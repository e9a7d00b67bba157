#include "core/lubricant/base_oil_estimates.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "core/celsius.h"
#include "core/number_text.h"

namespace tribodyn {
namespace {

struct Ranged {
  double value;
  bool inside;
};

// The argument moved into the range; NaN to the lower edge.
Ranged limited(double value, double lower, double upper) {
  if (value >= lower && value <= upper) return {value, true};
  return {value > upper ? upper : lower, false};
}

struct GoldConstants {
  double s, t;
  const char* group;
};

GoldConstants gold_constants(BaseOilClass base_oil) {
  switch (base_oil) {
    case BaseOilClass::kPolyalphaolefin:
      return {7.382, 0.1335, "polyalphaolefins"};
    case BaseOilClass::kEster:
      return {6.605, 0.1360, "esters"};
    case BaseOilClass::kPolyalkyleneGlycol:
      return {5.489, 0.1485, "polyglycols"};
    default:
      return {9.904, 0.1390, "mineral oils"};
  }
}

Estimate relative(double value, double relative_uncertainty, std::string source,
                  bool inside_range = true) {
  return {value, relative_uncertainty * value, std::move(source), inside_range};
}

std::string per_gigapascal(const Estimate& estimate) {
  return known_text(1e9 * estimate.value, 1e9 * estimate.standard_uncertainty) + " 1/GPa";
}

}  // namespace

Estimate so_klaus_pressure_viscosity_coefficient(double kinematic_viscosity, double density,
                                                 double viscosity_temperature_slope) {
  const auto [v, v_inside] = limited(1e6 * kinematic_viscosity, 2.5, 2200);
  const auto [rho, rho_inside] = limited(1e-3 * density, 0.75, 1.0);
  const auto [b, b_inside] = limited(viscosity_temperature_slope, 2.5, 4.4);
  const double l = std::log10(v);
  const double alpha = 1.030 + 3.509 * std::pow(l, 3.0627) +
                       2.412e-4 * std::pow(b, 5.1903) * std::pow(l, 1.5976) -
                       3.387 * std::pow(l, 3.0975) * std::pow(rho, 0.1162);
  return relative(1e-8 * alpha, 0.15, "So and Klaus 1980 (ASLE Trans. 23, 409)",
                  v_inside && rho_inside && b_inside);
}

Estimate gold_pressure_viscosity_coefficient(BaseOilClass base_oil, double kinematic_viscosity) {
  const auto [s, t, group] = gold_constants(base_oil);
  const auto [v, inside] = limited(1e6 * kinematic_viscosity, 2, 2000);
  return relative(1e-9 * s * std::pow(v, t), 0.3,
                  std::string("Gold et al. 2001 (J. Synth. Lubr. 18, 51), ") + group, inside);
}

Estimate estimate_pressure_viscosity_coefficient(BaseOilClass base_oil, double kinematic_viscosity,
                                                 double density,
                                                 double viscosity_temperature_slope) {
  Estimate gold = gold_pressure_viscosity_coefficient(base_oil, kinematic_viscosity);
  if (base_oil == BaseOilClass::kEster || base_oil == BaseOilClass::kPolyalkyleneGlycol) {
    return gold;
  }
  Estimate so_klaus = so_klaus_pressure_viscosity_coefficient(kinematic_viscosity, density,
                                                              viscosity_temperature_slope);
  if (base_oil == BaseOilClass::kGroupI || base_oil == BaseOilClass::kGroupII ||
      base_oil == BaseOilClass::kNaphthenic) {
    return so_klaus;
  }
  return relative(std::sqrt(so_klaus.value * gold.value),
                  base_oil == BaseOilClass::kUnspecified ? 0.25 : 0.2,
                  "geometric mean of " + so_klaus.source + ", " + per_gigapascal(so_klaus) +
                      ", and " + gold.source + ", " + per_gigapascal(gold),
                  so_klaus.inside_range && gold.inside_range);
}

Estimate estimate_thermal_conductivity(BaseOilClass base_oil, double density_15,
                                       double temperature) {
  switch (base_oil) {
    case BaseOilClass::kGroupI:
    case BaseOilClass::kGroupII:
    case BaseOilClass::kGroupIII:
    case BaseOilClass::kNaphthenic: {
      const auto [rho, rho_inside] = limited(density_15, 700, 1200);
      const auto [t, t_inside] = limited(temperature, 230, 470);
      return relative(117 / rho * (1 - 0.00054 * (t - kZeroCelsius)), 0.1,
                      "Cragoe 1929 (NBS Misc. Publ. 97), petroleum oils at ambient pressure",
                      rho_inside && t_inside);
    }
    case BaseOilClass::kPolyalphaolefin:
      return relative(0.154, 0.1, "Larsson and Andersson 2000, PAO at ambient pressure");
    case BaseOilClass::kEster:
    case BaseOilClass::kPolyalkyleneGlycol:
      return relative(0.15, 0.15, "assumed for esters and polyglycols at ambient pressure");
    case BaseOilClass::kUnspecified:
      break;
  }
  return relative(0.14, 0.15, "assumed, the middle of lubricating oils at ambient pressure");
}

Estimate estimate_limiting_shear_stress_coefficient(BaseOilClass base_oil) {
  switch (base_oil) {
    case BaseOilClass::kPolyalphaolefin:
      return relative(0.029, 0.2, "Hoglund and Jacobson 1986, PAO at 40 C");
    case BaseOilClass::kNaphthenic:
      return relative(0.06, 0.35,
                      "Hoglund 1999 (0.047, 0.053) and Habchi 2010 (0.083), naphthenic oils");
    case BaseOilClass::kGroupI:
    case BaseOilClass::kGroupII:
      return relative(0.05, 0.4, "assumed, between PAO (0.029) and naphthenic oil (0.060)");
    case BaseOilClass::kGroupIII:
      return relative(0.04, 0.4, "assumed, between PAO (0.029) and solvent-refined mineral oil");
    case BaseOilClass::kEster:
      return relative(0.035, 0.4, "assumed, somewhat above PAO (0.029)");
    case BaseOilClass::kPolyalkyleneGlycol:
      return relative(0.044, 0.4, "Hoglund 1999, a polyglycol");
    case BaseOilClass::kUnspecified:
      break;
  }
  return relative(0.045, 0.5, "assumed, between PAO (0.029) and naphthenic oil (0.060)");
}

Estimate estimate_limiting_shear_stress_at_zero_pressure(BaseOilClass base_oil) {
  if (base_oil == BaseOilClass::kNaphthenic) {
    return {0, 2e6, "Habchi 2010, the naphthenic oil Shell T9: proportional to pressure"};
  }
  return relative(4e6, 0.5, "Hoglund and Jacobson 1986, PAO at 40 C");
}

Estimate estimate_relaxation_time(double viscosity) {
  constexpr double kCriticalStress = 57.5e3;
  return relative(viscosity / kCriticalStress, 1,
                  "as the paper's fluids (calibrated: thinning starts at 57.5 kPa)");
}

Estimate estimate_havriliak_negami_alpha() {
  return relative(0.9, 0.1, "as the paper's fluids (calibrated)");
}

Estimate estimate_havriliak_negami_beta() {
  return relative(0.25, 0.4, "as the paper's fluids (calibrated)");
}

Estimate estimate_density_15(BaseOilClass base_oil) {
  struct Typical {
    double density, relative_uncertainty;
  };
  static constexpr Typical kTypical[] = {
      {880, 0.05},   // unspecified
      {885, 0.03},   // group I
      {870, 0.03},   // group II
      {850, 0.03},   // group III
      {845, 0.03},   // polyalphaolefin
      {930, 0.03},   // ester
      {1020, 0.05},  // polyalkylene glycol
      {910, 0.03},   // naphthenic
  };
  static_assert(std::size(kTypical) == kBaseOilClasses);
  const Typical& typical = kTypical[static_cast<int>(base_oil)];
  return relative(
      typical.density, typical.relative_uncertainty,
      std::string("assumed, typical of ") +
          (base_oil == BaseOilClass::kUnspecified ? "lubricating oils" : name(base_oil)));
}

}  // namespace tribodyn
