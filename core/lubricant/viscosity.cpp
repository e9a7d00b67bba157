#include "core/lubricant/viscosity.h"

#include <cmath>
#include <string>
#include <vector>

#include "core/numerics/bracketed_root.h"
#include "core/numerics/gauss_legendre.h"
#include "core/refusal.h"

namespace tribodyn {

double log_ambient_viscosity(const Lubricant& lubricant, double temperature) {
  return std::log(lubricant.vogel_viscosity_prefactor) +
         lubricant.vogel_temperature_coefficient /
             (temperature - lubricant.vogel_reference_temperature);
}

double ambient_viscosity(const Lubricant& lubricant, double temperature) {
  return std::exp(log_ambient_viscosity(lubricant, temperature));
}

double density(const Lubricant& lubricant, double temperature) {
  return lubricant.density_at_zero_kelvin + lubricant.density_temperature_slope * temperature;
}

double roelands_factor(double log_ambient_viscosity, const AsPublished& as_published) {
  return as_published.eq31_32_logarithm
             ? std::log(std::exp(log_ambient_viscosity) + kRoelandsLogViscosity)
             : log_ambient_viscosity + kRoelandsLogViscosity;
}

double log_viscosity_under_pressure(double log_ambient_viscosity, double factor, double index,
                                    double pressure) {
  return log_ambient_viscosity +
         factor * std::expm1(index * std::log1p(kRoelandsPressureCoefficient * pressure));
}

namespace {

/// Eq 33 at one L: int_0^inf exp(-v) (1 + v/L)^(1/Z - 1) dv / (Z c L). The integrand peaks near
/// v = 1/Z - 1 - L and falls as exp(-v) beyond, so panels of width 4 up to its hundred-e-fold tail
/// lose nothing.
class ReciprocalAsymptotic {
 public:
  explicit ReciprocalAsymptotic(double factor) : factor_(factor) {}

  /// Its coefficient [1/Pa] and the derivative by the index.
  ValueAndSlope at(double index) {
    const auto& rule = gauss_legendre<kNodes>();
    const double power = 1 / index - 1;
    const double end = 60 + 6 * std::max(0.0, power);
    double integral = 0, by_power = 0;
    for (std::size_t i = 0; kPanel * static_cast<double>(i) < end; ++i) {
      const Nodes v = kPanel * static_cast<double>(i) + kPanel * rule.node;
      if (i == logarithms_.size()) logarithms_.emplace_back((v / factor_).log1p());
      const Nodes part = rule.weight * (power * logarithms_[i] - v).exp();
      integral += kPanel * part.sum();
      by_power += kPanel * (logarithms_[i] * part).sum();
    }
    const double coefficient = index * kRoelandsPressureCoefficient * factor_ / integral;
    return {coefficient, coefficient * (1 / index + by_power / (integral * index * index))};
  }

 private:
  static constexpr double kPanel = 4;
  static constexpr int kNodes = 20;
  using Nodes = Eigen::Array<double, kNodes, 1>;
  double factor_;
  std::vector<Nodes> logarithms_;  // ln(1 + v/L) of each panel
};

}  // namespace

double reciprocal_asymptotic_coefficient(double factor, double index) {
  return ReciprocalAsymptotic(factor).at(index).value;
}

double index_from_reciprocal_asymptotic(double factor, double coefficient) {
  constexpr double kLow = 0.05, kHigh = 3;
  ReciprocalAsymptotic law(factor);
  const auto excess = [&](double index) {
    const ValueAndSlope at = law.at(index);
    return ValueAndSlope{at.value / coefficient - 1, at.slope / coefficient};
  };
  if (factor > 0 && coefficient > 0) {
    const double start = index_from_houpert(factor, coefficient);
    const double index = safeguarded_newton(excess, kLow, kHigh, start, true, 1e-9);
    if (std::abs(excess(index).value) < 1e-9) return index;
  }
  throw Refusal("PRESSURE_VISCOSITY_INDEX",
                "no Roelands index Z in [0.05, 3] gives a pressure-viscosity coefficient of " +
                    std::to_string(coefficient * 1e9) +
                    " 1/GPa back by eq 33 (ln eta_0 + 9.67 = " + std::to_string(factor) + ")");
}

double index_from_houpert(double factor, double coefficient) {
  return coefficient / (kRoelandsPressureCoefficient * factor);
}

}  // namespace tribodyn
