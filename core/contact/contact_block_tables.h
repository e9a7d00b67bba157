#pragma once

#include <array>
#include <vector>

#include "core/contact/contact_constants.h"
#include "core/numerics/instruction_set.h"
#include "core/surface/surface.h"

namespace tribodyn {

/// sum_ij c_ij x^i y^j over |x|, |y| <= 1; row i ends at its own last power of y. In the order of
/// Horner's scheme, highest powers first.
struct BivariatePolynomial {
  std::vector<int> row_length;       ///< powers of y in each row
  std::vector<double> coefficients;  ///< row after row
};

inline constexpr int kAsperityTerms = 20;
/// F_n of the asperity functions: exp(-l^2/2) v^(n+1) P(x), v = 1/(l + kAsperityShift),
/// x = asperity_scale v + asperity_offset in [-1, 1] for 0 <= l <= kAsperityEnd.
inline constexpr double kAsperityShift = 3.5;
inline constexpr double kAsperityEnd = 36.5;
inline constexpr double kAsperitiesVanish = 38.75;

/// ln F_2 as a polynomial of ln F_5/2, for separations from kDeepestSeparation to those at which a
/// film supports all of its load: the area of asperities that carry what a thin film does not.
inline constexpr int kDeepTerms = 32;
inline constexpr double kDeepestSeparation = -8;

/// Where the thermal iteration starts: ln(1/r - 1), r = tau_bar/tau_bar(all on tau_L), as a cubic
/// in Chebyshev polynomials of ln shear rate, ln(1 + c p_max) and ln(gain tau_bar(all on tau_L)),
/// each scaled to [-1, 1]. Fitted to 64 solutions; within some 10 % in gears, which saves half of
/// the steps.
struct StartFit {
  std::array<double, 3> scale{}, offset{};
  std::array<double, 20> coefficients{};
};

/// What the vector code needs of one fluid on one surface at one sump temperature. The mean stress
/// comes from one function of two variables,
///
///   int_0^p e^G(L, p') p' dp' = p^2/2 e^G(L, p) R(L, ln(1 + c p)),
///
/// with the growth G = ln eta(p, T) - ln eta_0(T) of the pressure-viscosity law, which is
/// L ((1 + c p)^Z - 1) for Roelands's, L = ln eta_0(T) + 9.67 and c = 5.1e-9 1/Pa (eq 31): R is
/// tabulated once for the fluid, so that no quadrature remains in the solve.
struct ContactBlockTables : ContactConstants<double> {
  double inverse_roughness = 0;  ///< 1/sigma_G [1/m]
  BoundaryFriction boundary{};   ///< 0: no F_b
  bool no_boundary_friction = false;

  /// False: the scalar kernel solves all contacts.
  bool can_certify = false;
  bool inlet_shear_heating = false;
  bool closed_load_sharing = false;
  bool isothermal = false, limited = false;

  double log_limit_at_edge = 0;        ///< ln tau_L0, which may be -infinity
  double limit_slope = 0;              ///< gamma_L/c [Pa]
  double convex_factor = 0;            ///< from this L on, tau is convex in p
  bool limited_rim = false;            ///< tau may be above tau_L at the edge and below inside
  double unique_root_temperature = 0;  ///< below it ln tau falls with T at every pressure
  double maximum_temperature = 0;      ///< of the table [K]
  double maximum_log_pressure = 0;     ///< greatest ln(1 + c p) of the table

  double maximum_scaled_pressure = 0;  ///< greatest c p of the table

  // x = factor_scale L + factor_offset, y = depth_scale s + depth_offset.
  double factor_scale = 0, factor_offset = 0, depth_scale = 0, depth_offset = 0;
  BivariatePolynomial ratio;         ///< R to 1e-12
  BivariatePolynomial coarse_ratio;  ///< R to 1e-6: for half of the digits

  bool start_fitted = false;
  StartFit start;

  double asperity_scale = 0, asperity_offset = 0;
  std::array<double, kAsperityTerms> f2{}, f5_2{};  ///< from the highest power down
  double deep_scale = 0, deep_offset = 0;           ///< x = deep_scale ln F_5/2 + deep_offset
  std::array<double, kDeepTerms> deep_area{};       ///< from the highest power down
};

/// Fills the polynomials of R for L in [least_factor, greatest_factor]. Takes as much depth as 24
/// terms allow. Returns false if that is nothing.
bool tabulate_ratio(InstructionSet instruction_set, double least_factor, double greatest_factor,
                    ContactBlockTables& tables);

/// Fills the polynomials of F_2 and F_5/2 and of one as a function of the other.
void tabulate_asperities(ContactBlockTables& tables);

}  // namespace tribodyn
