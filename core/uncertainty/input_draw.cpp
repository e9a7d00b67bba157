#include "core/uncertainty/input_draw.h"

#include <algorithm>
#include <cmath>

#include "core/celsius.h"
#include "core/numerics/square.h"

namespace tribodyn {

VogelDraw drawn_vogel(const VogelFit& fit, const std::array<double, 3>& deviations) {
  const double cold_temperature = std::max(kFortyCelsius, fit.reference_temperature + 40);
  const double warm_temperature = cold_temperature + 60;
  // By ln eta_ref, A_1 and T_0 of ln eta at both temperatures, and of T_0.
  const auto by_parameters = [&fit](double temperature) {
    const double above = temperature - fit.reference_temperature;
    return Eigen::RowVector3d(1, 1 / above, fit.temperature_coefficient / square(above));
  };
  Eigen::Matrix3d jacobian;
  jacobian << by_parameters(cold_temperature), by_parameters(warm_temperature),
      Eigen::RowVector3d(0, 0, 1);
  const Eigen::Matrix3d covariance = jacobian * fit.covariance * jacobian.transpose();
  // Cholesky's factor, with a zero column where rounding leaves no variance.
  Eigen::Matrix3d factor = Eigen::Matrix3d::Zero();
  for (int j = 0; j < 3; ++j) {
    double rest = covariance(j, j);
    for (int k = 0; k < j; ++k) rest -= square(factor(j, k));
    if (!(rest > 1e-14 * covariance(j, j))) continue;
    factor(j, j) = std::sqrt(rest);
    for (int i = j + 1; i < 3; ++i) {
      double product = covariance(i, j);
      for (int k = 0; k < j; ++k) product -= factor(i, k) * factor(j, k);
      factor(i, j) = product / factor(j, j);
    }
  }
  const Eigen::Vector3d error =
      factor * Eigen::Vector3d(deviations[0], deviations[1], deviations[2]);
  const double cold = log_viscosity(fit, cold_temperature) + error(0);
  const double warm = log_viscosity(fit, warm_temperature) + error(1);
  VogelDraw out{};
  // The law must hold at both temperatures, and eq 34 is about absolute temperatures.
  out.reference_temperature =
      std::clamp(fit.reference_temperature + error(2), 1.0, cold_temperature - 20);
  const double cold_inverse = 1 / (cold_temperature - out.reference_temperature);
  const double warm_inverse = 1 / (warm_temperature - out.reference_temperature);
  out.temperature_coefficient = (cold - warm) / (cold_inverse - warm_inverse);
  out.viscosity_prefactor = std::exp(cold - out.temperature_coefficient * cold_inverse);
  return out;
}

DensityDraw drawn_density(const DensityDraw& law, double density_at_zero_uncertainty,
                          double slope_uncertainty, double pivot,
                          const std::array<double, 2>& deviations) {
  const double turned = slope_uncertainty * deviations[0];
  const double own = std::sqrt(
      std::max(0.0, square(density_at_zero_uncertainty) - square(pivot * slope_uncertainty)));
  return {law.density_at_zero_kelvin - pivot * turned + own * deviations[1], law.slope + turned};
}

}  // namespace tribodyn
