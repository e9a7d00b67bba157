#include "core/contact/contact_block_tables.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/contact/asperity_functions.h"
#include "core/contact/ratio_integrals.h"
#include "core/laws/laws.h"
#include "core/numerics/bracketed_root.h"
#include "core/numerics/chebyshev.h"
#include "core/numerics/gauss_legendre.h"

namespace tribodyn {
namespace {

constexpr int kTerms = kRatioTerms;

const RatioRule& ratio_rule() {
  static const RatioRule rule = [] {
    const auto& points = chebyshev<kTerms>();
    const auto& gauss = gauss_legendre<RatioRule::kNodes>();
    RatioRule out{};
    out.end.fill(1);
    double before = 0;
    for (int j = 0; j < kTerms; ++j) {
      out.end[j] = 0.5 * (1 + points.point[j]);
      for (int n = 0; n < RatioRule::kNodes; ++n) {
        out.node[j * RatioRule::kNodes + n] = before + (out.end[j] - before) * gauss.node(n);
        out.weight[j * RatioRule::kNodes + n] = (out.end[j] - before) * gauss.weight(n);
      }
      for (int i = 0; i < kTerms; ++i) {
        out.to_coefficients[j][i] = out.transposed[i][j] = points.to_coefficients[j][i];
      }
      before = out.end[j];
    }
    return out;
  }();
  return rule;
}

/// The two last coefficients in either direction are rounding.
bool converged(const RatioSquare& coefficients) {
  constexpr double kRounding = 2e-13;
  for (int k = 0; k < kTerms; ++k) {
    for (const int last : {kTerms - 2, kTerms - 1}) {
      if (!(std::abs(coefficients[last][k]) < kRounding &&
            std::abs(coefficients[k][last]) < kRounding)) {
        return false;
      }
    }
  }
  return true;
}

/// Drops what adds up to less than the tolerance, then changes to powers.
BivariatePolynomial truncated(const RatioSquare& coefficients, double tolerance) {
  const auto& in_powers = chebyshev<kTerms>().in_powers;
  const double small = tolerance / 20;
  std::array<int, kTerms> length{};
  int rows = 1;
  for (int j = 0; j < kTerms; ++j) {
    for (int i = 0; i < kTerms; ++i) {
      if (!(std::abs(coefficients[j][i]) > small)) continue;
      length[i] = j + 1;
      rows = std::max(rows, i + 1);
    }
  }
  std::array<std::array<double, kTerms>, kTerms> row{};  // [i][j]: of T_i(x) y^j
  for (int i = 0; i < rows; ++i) {
    for (int m = 0; m < length[i]; ++m) {
      for (int j = m; j >= 0; j -= 2) row[i][j] += in_powers[m][j] * coefficients[m][i];
    }
  }
  BivariatePolynomial out;
  int longest = 1, count = 0;
  for (int i = rows - 1; i >= 0; --i) count += length[i] = longest = std::max(longest, length[i]);
  for (int m = 0; m < rows; ++m) {  // of x^i y^j, in place
    for (int i = m - 2; i >= 0; i -= 2) {
      for (int j = 0; j < length[m]; ++j) row[i][j] += in_powers[m][i] * row[m][j];
    }
    for (int j = 0; j < length[m]; ++j) row[m][j] *= in_powers[m][m];
  }
  out.row_length.reserve(rows);
  out.coefficients.reserve(count);
  for (int i = rows - 1; i >= 0; --i) {
    out.row_length.push_back(length[i]);
    for (int j = length[i] - 1; j >= 0; --j) out.coefficients.push_back(row[i][j]);
  }
  return out;
}

/// The depth ln(1 + c p) of 3 GPa, or of a viscosity 32 e-folds above that at p = 0 and one
/// e-fold below the greatest one, at the temperature of the greatest L.
double maximum_log_pressure_of(const ShearLaw<double>& law, double greatest_factor) {
  constexpr double kGreatestLogPressure = 2.79, kMostLogGrowth = 32;
  if (law.lubricant.pressure_viscosity_law == PressureViscosityLaw::kRoelands) {
    return std::min(kGreatestLogPressure,
                    std::log1p(kMostLogGrowth / std::max(greatest_factor, 1e-3)) / law.index);
  }
  const double log_viscosity = greatest_factor - laws::kRoelandsLogViscosity;
  const double temperature = laws::vogel_temperature(law.lubricant.vogel_temperature_coefficient,
                                                     law.lubricant.vogel_reference_temperature,
                                                     log_viscosity - law.log_vogel_prefactor);
  const double log_growth =
      std::min(kMostLogGrowth, laws::log_greatest_viscosity(law.lubricant) - log_viscosity - 1);
  const auto excess = [&](double depth) {
    return laws::pressure_growth(law.growth, temperature,
                                 std::expm1(depth) / laws::kRoelandsPressureCoefficient) -
           log_growth;
  };
  const double at_end = excess(kGreatestLogPressure);
  return at_end <= 0 ? kGreatestLogPressure
                     : bracketed_root(excess, 0, kGreatestLogPressure, -log_growth, at_end);
}

}  // namespace

bool tabulate_ratio(InstructionSet instruction_set, double least_factor, double greatest_factor,
                    ContactBlockTables& tables) {
  const double centre = 0.5 * (least_factor + greatest_factor);
  const double half = std::max(0.5 * (greatest_factor - least_factor), 1e-3);
  tables.factor_scale = 1 / half;
  tables.factor_offset = -centre / half;
  RatioLanes factor{};
  for (int i = 0; i < kTerms; ++i) factor[i] = centre + half * chebyshev<kTerms>().point[i];
  double maximum_log_pressure = maximum_log_pressure_of(tables.shear, greatest_factor);
  RatioSquare coefficients;
  for (int attempt = 0; attempt < 8; ++attempt, maximum_log_pressure *= 0.85) {
    ratio_coefficients(instruction_set, ratio_rule(), factor, maximum_log_pressure, tables.shear,
                       coefficients);
    if (!converged(coefficients)) continue;
    tables.maximum_log_pressure = maximum_log_pressure;
    tables.maximum_scaled_pressure = std::expm1(maximum_log_pressure);
    tables.depth_scale = 2 / maximum_log_pressure;
    tables.depth_offset = -1;
    tables.ratio = truncated(coefficients, 2e-11);
    tables.coarse_ratio = truncated(coefficients, 3e-6);
    return true;
  }
  return false;
}

namespace {

/// Coefficients of powers, from the highest down, of the polynomial through values at Chebyshev
/// points.
template <int kTerms, int kPoints>
std::array<double, kTerms> powers(const std::array<double, kPoints>& values) {
  const auto& rule = chebyshev<kPoints>();
  std::array<double, kTerms> out{};
  for (int m = 0; m < kTerms; ++m) {
    const auto& weight = rule.to_coefficients[m];
    const double coefficient =
        std::inner_product(values.begin(), values.end(), weight.begin(), 0.0);
    for (int j = m; j >= 0; j -= 2) out[kTerms - 1 - j] += coefficient * rule.in_powers[m][j];
  }
  return out;
}

void tabulate_deep_asperities(ContactBlockTables& tables) {
  struct Fit {
    double scale, offset;
    std::array<double, kDeepTerms> area;
  };
  static const Fit fit = [] {
    constexpr int kPoints = 64;
    constexpr double kShallowest = 1.2;  // a film of this ratio supports all of its load
    const double least = std::log(asperity_functions(kShallowest).f5_2);
    const double most = std::log(asperity_functions(kDeepestSeparation).f5_2);
    std::array<double, kPoints> log_f2;
    for (int i = 0; i < kPoints; ++i) {
      const double log_f5_2 = least + (most - least) * 0.5 * (1 + chebyshev<kPoints>().point[i]);
      log_f2[i] =
          std::log(asperity_functions(separation_under_load(std::exp(log_f5_2), kShallowest)).f2);
    }
    return Fit{2 / (most - least), -(most + least) / (most - least),
               powers<kDeepTerms, kPoints>(log_f2)};
  }();
  tables.deep_scale = fit.scale;
  tables.deep_offset = fit.offset;
  tables.deep_area = fit.area;
}

}  // namespace

void tabulate_asperities(ContactBlockTables& tables) {
  struct Fits {
    double scale, offset;
    std::array<double, kAsperityTerms> f2, f5_2;
  };
  static const Fits fits = [] {
    constexpr int kPoints = 40;
    const auto& rule = chebyshev<kPoints>();
    const double most = 1 / kAsperityShift, least = 1 / (kAsperityEnd + kAsperityShift);
    std::array<double, kPoints> f2, f5_2;
    for (int i = 0; i < kPoints; ++i) {
      const double v = least + (most - least) * 0.5 * (1 + rule.point[i]);
      const double ratio = std::max(0.0, 1 / v - kAsperityShift);
      const double scale = std::exp(0.5 * ratio * ratio) / (v * v * v);
      const AsperityFunctions f = asperity_functions(ratio);
      f2[i] = scale * f.f2;
      f5_2[i] = scale * f.f5_2 / std::sqrt(v);
    }
    Fits out;
    out.scale = 2 / (most - least);
    out.offset = -(most + least) / (most - least);
    out.f2 = powers<kAsperityTerms, kPoints>(f2);
    out.f5_2 = powers<kAsperityTerms, kPoints>(f5_2);
    return out;
  }();
  tables.asperity_scale = fits.scale;
  tables.asperity_offset = fits.offset;
  tables.f2 = fits.f2;
  tables.f5_2 = fits.f5_2;
  if (tables.closed_load_sharing) tabulate_deep_asperities(tables);
}

}  // namespace tribodyn
