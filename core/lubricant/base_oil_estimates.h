#pragma once

#include <string>

#include "core/lubricant/base_oil.h"

namespace tribodyn {

/// A value from a correlation, with its standard uncertainty in the same unit. For parameters that
/// nobody measured: every one of them is to be shown as an assumption.
struct Estimate {
  double value;
  double standard_uncertainty;
  std::string source;        ///< correlation, citation, what it was checked against
  bool inside_range = true;  ///< arguments outside the range are moved to its edge
};

/// alpha* [1/Pa] of So and Klaus (1980), in the coefficients of Stachowiak and Batchelor:
///
///   alpha = 1e-8 (1.030 + 3.509 L^3.0627 + 2.412e-4 B^5.1903 L^1.5976
///                 - 3.387 L^3.0975 rho^0.1162),   L = lg v,
///
/// v [mm2/s] and rho [g/cm3] at the temperature and atmospheric pressure, B the slope of ASTM D341.
/// Against the measured oils of Stachowiak and Batchelor's table 2.3 at 30, 60 and 100 C: -9 % on
/// average, 14 % root mean square, no bias at 30 C. Of the paper's fluids (polymer in PAO) it gives
/// 117 to 128 %. Range checked: 2.5 to 2200 mm2/s, B of 2.5 to 4.4, 750 to 1000 kg/m3.
/// Sources: B. Y. C. So and E. E. Klaus, ASLE Trans. 23 (1980) 409-421; G. W. Stachowiak and A. W.
/// Batchelor, Engineering Tribology.
/// Arguments in SI: kinematic viscosity [m2/s], density [kg/m3].
Estimate so_klaus_pressure_viscosity_coefficient(double kinematic_viscosity, double density,
                                                 double viscosity_temperature_slope);

/// alpha [1/Pa] of Gold et al. (2001), 1e-9 s v^t with v [mm2/s] at the temperature; s, t of
/// mineral oils 9.904, 0.1390; polyalphaolefins 7.382, 0.1335; esters 6.605, 0.1360; polyglycols
/// 5.489, 0.1485. Of the mineral oils of table 2.3 above it gives 77 % on average, of the paper's
/// fluids 72 to 83 %. The constants are those of public gear software, not checked against the
/// paper: copies exchange the numbers of polyalphaolefins and esters (11 %) or the digits of s and
/// t. Of five polyalphaolefins whose alpha* is measured (10.8 to 19.1 by this function against 14.8
/// to 23.9 1/GPa) all are nearer with these. Range: 2 to 2000 mm2/s.
/// Source: P. W. Gold, A. Schmidt, H. Dicke, J. Loos, C. Assmann, J. Synth. Lubr. 18 (2001) 51-79.
/// Argument in SI: kinematic viscosity [m2/s].
Estimate gold_pressure_viscosity_coefficient(BaseOilClass base_oil, double kinematic_viscosity);

/// alpha* [1/Pa] by class, with its standard uncertainty:
/// - groups I and II, naphthenic: So and Klaus; 15 %.
/// - group III and unspecified: geometric mean of So and Klaus and Gold's mineral oils; 20 and 25
/// %.
/// - polyalphaolefins: geometric mean of So and Klaus and Gold's polyalphaolefins; 20 %. Either
///   alone misses the paper's three fluids by a quarter, to opposite sides; the mean by 3, -8 and
///   1 %.
/// - esters and polyglycols: Gold; 30 %.
Estimate estimate_pressure_viscosity_coefficient(BaseOilClass base_oil, double kinematic_viscosity,
                                                 double density,
                                                 double viscosity_temperature_slope);

/// k_f [W/(m K)] at atmospheric pressure. Mineral oils, groups I to III and naphthenic: Cragoe's
/// (0.117/d)(1 - 0.00054 t), d specific gravity at 15 C, t in C (NBS Misc. Publ. 97, 1929; 10 %).
/// Polyalphaolefins 0.154 (Larsson and Andersson 2000; 10 %). Esters and polyglycols 0.15, others
/// 0.14 (assumed; 15 %). It doubles towards 1 GPa, which the model leaves out.
/// density_15 [kg/m3] from 700 to 1200, temperature [K] from 230 to 470.
Estimate estimate_thermal_conductivity(BaseOilClass base_oil, double density_15,
                                       double temperature);

/// gamma_L [-] of tau_L = tau_L0 + gamma_L p. Measured: polyalphaolefins 0.029 (Hoglund and
/// Jacobson 1986 as the paper cites it; 0.029 to 0.04 in circulation), polyglycols 0.044 (Hoglund
/// 1999), naphthenic oils 0.047 (LVI 260), 0.053 (N100; both Hoglund 1999) and 0.083 (Habchi 2010,
/// Shell T9): 0.060 +/- 35 %. Groups I and II 0.05 (M100: 0.047). The others are placed by the
/// order in which friction of elastohydrodynamic films ranks oils (naphthenic > paraffinic mineral
/// > ester > PAO) and carry 40 %.
Estimate estimate_limiting_shear_stress_coefficient(BaseOilClass base_oil);

/// tau_L0 [Pa]. Naphthenic: 0, as the law of Shell T9 is proportional to pressure (Habchi 2010).
/// Others: 4 MPa, 50 % (Hoglund and Jacobson 1986, PAO at 40 C, as the paper cites it).
Estimate estimate_limiting_shear_stress_at_zero_pressure(BaseOilClass base_oil);

/// Temperature at which the rheology is stated where nobody states another [K].
inline constexpr double kTypicalRheologyTemperature = 343.15;

/// lambda of eq 24 [s] from the dynamic viscosity [Pa s] at 70 C: viscosity/57.5 kPa, the stress at
/// which the paper's fluids, calibrated to 4.5e-7 s, start to thin. Good to a factor of two or
/// three (100 %): nothing public gives it by class.
Estimate estimate_relaxation_time(double viscosity);
/// Exponents of eq 24: 0.9 (10 %) and 0.25 (40 %), calibrated on the paper's three fluids.
Estimate estimate_havriliak_negami_alpha();
Estimate estimate_havriliak_negami_beta();

/// Density at 15 C [kg/m3] typical of the class: 3 %, polyglycols and unspecified 5 % (assumed).
Estimate estimate_density_15(BaseOilClass base_oil);

}  // namespace tribodyn
