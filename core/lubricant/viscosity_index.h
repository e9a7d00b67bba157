#pragma once

namespace tribodyn {

/// The two reference oils that a viscosity index compares with: kinematic viscosities at 40 C
/// [mm2/s] of oils that share the test oil's viscosity at 100 C.
struct ViscosityIndexReferences {
  double index_0;    ///< L, of the oil of viscosity index 0 [mm2/s]
  double index_100;  ///< H, of the oil of viscosity index 100 [mm2/s]
};

/// L = a Y^2 + b Y + c and H = d Y^2 + e Y + f with the sixteen pieces of ASTM D2270, appendix X2.
/// The standard's own fits: within 0.12 % of its table, and with steps of up to 0.18 % where the
/// pieces join (the largest in H at Y = 7.7), a fifth of a point of index.
/// kinematic_viscosity_100 Y [mm2/s], from 2 up.
/// Throws Refusal VISCOSITY_INDEX_UNDEFINED below 2 mm2/s.
ViscosityIndexReferences viscosity_index_references(double kinematic_viscosity_100);

/// Viscosity index [-] of ASTM D2270 from kinematic viscosities U at 40 C and Y at 100 C [mm2/s]:
///
///   U > H  (procedure A):  VI = 100 (L - U)/(L - H),                 at most 100;
///   U <= H (procedure B):  VI = 100 + (10^N - 1)/0.00715,   N = lg(H/U)/lg(Y),   at least 100.
///
/// Not rounded (the standard reports whole numbers). Negative for very temperature-sensitive oils.
/// Throws Refusal VISCOSITY_INDEX_UNDEFINED for Y < 2 mm2/s, or U not finite, or U <= Y (an oil
/// that does not thin with temperature). Source: ASTM D2270-10, Calculating Viscosity Index from
/// Kinematic Viscosity at 40 and 100 C.
double viscosity_index(double kinematic_viscosity_40, double kinematic_viscosity_100);

}  // namespace tribodyn
