#pragma once

namespace tribodyn {

/// Eq 15: effective radius along the entrainment, 1/R_e = cos^2(theta)/R_x + sin^2(theta)/R_y [m].
/// entrainment_angle theta [rad], measured from x; radii [m] > 0 (not checked).
double entrainment_radius(double radius_x, double radius_y, double entrainment_angle);

/// Eq 16: effective radius across the entrainment, 1/R_s = sin^2(theta)/R_x + cos^2(theta)/R_y [m].
double side_leakage_radius(double radius_x, double radius_y, double entrainment_angle);

/// What the films of eq 12 and of Hamrock and Dowson depend on besides load. SI units.
struct FilmConditions {
  double entrainment_radius;              ///< R_e of eq 15 [m] > 0
  double side_leakage_radius;             ///< R_s of eq 16 [m] > 0
  double viscosity;                       ///< eta_0(T_in) [Pa s] > 0
  double pressure_viscosity_coefficient;  ///< alpha*(T_in) [1/Pa] > 0
  double entrainment_speed;               ///< U_eff of eq 17 [m/s] >= 0
  double reduced_modulus;                 ///< E' = E/(1 - nu^2) [Pa] > 0
};

/// Eq 12, the central film thickness of Chittenden and Dowson [m]:
///
///   h_cen = 4.31 R_e U_e^0.68 G^0.49 W_e^-0.073 (1 - exp(-1.23 (R_s/R_e)^(2/3))),
///   U_e = eta_0 U_eff/(E' R_e),   G = alpha* E',   W_e = W/(E' R_e^2)                   (eq 13).
///
/// load W [N] > 0 is the part carried by the film. The film is exactly 0 at zero speed. Arguments
/// outside the ranges above are not checked and give NaN or infinity. A regression of smooth, fully
/// flooded, isothermal, Newtonian solutions with an error of several percent.
/// Source: R. J. Chittenden, D. Dowson, J. F. Dunn, C. M. Taylor, Proc. R. Soc. Lond. A 397 (1985)
/// 245-269 (part I) and 271-294 (part II, entrainment at an angle to the axes).
double chittenden_dowson_central_film(const FilmConditions& conditions, double load);

/// Eq 12 from its value at a load of 1 N, for root finders that vary the load alone:
/// h_cen = unit_load_film W^-0.073 [m], unit_load_film = chittenden_dowson_central_film(c, 1.0).
double chittenden_dowson_film_under_load(double unit_load_film, double load);

/// Minimum film thickness of Hamrock and Dowson [m], entrainment along the minor axis:
///
///   h_min = 3.63 R_x U^0.68 G^0.49 W^-0.073 (1 - exp(-0.68 k))
///
/// with U, G, W as above on the entrainment radius (R_e = R_x; side_leakage_radius is not used) and
/// the ellipticity k = a/b [-] >= 1, in the convention of eq 21. Not part of the paper's model.
/// Source: B. J. Hamrock and D. Dowson, J. Lubr. Technol. 99 (1977) 264-276.
double hamrock_dowson_minimum_film(const FilmConditions& conditions, double ellipticity,
                                   double load);

}  // namespace tribodyn
