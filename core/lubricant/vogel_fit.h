#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

namespace tribodyn {

/// T_0,ref taken when the data do not determine it, and its standard uncertainty [K] (assumed).
inline constexpr double kTypicalVogelReferenceTemperature = 160;
inline constexpr double kTypicalVogelReferenceTemperatureUncertainty = 15;
/// Relative standard uncertainty of a viscosity that states none (assumed).
inline constexpr double kTypicalViscosityUncertainty = 0.01;

struct ViscosityPoint {
  double temperature;                    ///< [K]
  double viscosity;                      ///< dynamic [Pa s]
  double relative_standard_uncertainty;  ///< [-]; 0: not stated
};

/// Eq 34, ln eta = ln eta_ref + A_1/(T - T_0), fitted to measurements.
struct VogelFit {
  double viscosity_prefactor;      ///< eta_ref [Pa s]
  double temperature_coefficient;  ///< A_1 [K]
  double reference_temperature;    ///< T_0,ref [K]
  /// Covariance of (ln eta_ref, A_1, T_0) in (-, K, K). The three are strongly correlated: for the
  /// uncertainty of a viscosity use relative_viscosity_uncertainty, not the diagonal.
  Eigen::Matrix3d covariance;
  std::vector<double> residuals;  ///< ln(measured/fitted) of every row, in the order given
  double root_mean_square_residual;
  double reduced_chi_square;  ///< weighted squares per degree of freedom; 0 when there is none
  int degrees_of_freedom;     ///< rows less fitted parameters
  double condition_number;    ///< of the weighted Jacobian with columns scaled to unit length
  bool reference_temperature_assumed;  ///< T_0 rests on an assumption, not on the data alone
};

/// Least squares of ln eta over (eta_ref, A_1, T_0). The first two are linear and eliminated
/// (variable projection); T_0 is the bracketed root of the derivative of the remaining sum, the
/// lowest of its minima in (50 K, coldest row - 20 K).
///
/// Weights: 1/u^2 when any row states its uncertainty (others count with 1 %), and covariance
/// (J'WJ)^-1, widened by the reduced chi-square where that exceeds 1. When none does, equal weights
/// and a variance estimated from the residuals, or 1 % where no degree of freedom is left.
/// Where the data leave T_0 open (two distinct temperatures, less curvature than any T_0 in that
/// range would give, or a standard uncertainty above 30 K) the typical T_0 and its uncertainty
/// enter as one more observation. Two temperatures then leave it where it is and are met exactly.
///
/// Rows in any order; replicates allowed. Temperatures count as distinct from 0.5 K apart.
/// Throws Refusal, naming rows counted from 1:
///   VISCOSITY_TABLE_TOO_SHORT     fewer than two distinct temperatures;
///   VISCOSITY_TABLE_OUT_OF_RANGE  a viscosity not in 1e-5 to 1e7 Pa s, a temperature not in 200 to
///                                 620 K, or an uncertainty not in [0, 1];
///   VISCOSITY_TABLE_NOT_MONOTONE  a warmer row thicker than a colder one, or replicates apart, by
///                                 more than four times their uncertainty (3 % where not stated);
///   VISCOSITY_TABLE_NOT_VOGEL     the coldest row rises so steeply that T_0 would run into it, or
///                                 the fitted parameters leave 1e-12..1e3 Pa s, 1..1e5 K.
VogelFit fit_vogel(std::span<const ViscosityPoint> points);

/// The same with T_0 [K] given, known to a standard uncertainty [K]: two distinct temperatures are
/// met exactly. Throws also VISCOSITY_TABLE_NOT_VOGEL when T_0 is not 20 K below the coldest row.
VogelFit fit_vogel_at(std::span<const ViscosityPoint> points, double reference_temperature,
                      double standard_uncertainty);

/// ln of eq 34 and its standard uncertainty, sqrt(g' C g), at a temperature [K] > T_0.
double log_viscosity(const VogelFit& fit, double temperature);
double relative_viscosity_uncertainty(const VogelFit& fit, double temperature);

}  // namespace tribodyn
