#pragma once

namespace tribodyn {

/// One member of a hypoid pair as a blank drawing gives it. Angles in rad, lengths in m.
struct BlankMember {
  int teeth;            ///< N_p or N_g
  double pitch_angle;   ///< delta, between pitch cone and axis [rad]
  double face_angle;    ///< between face cone and axis [rad]
  double spiral_angle;  ///< beta, mean spiral angle [rad]
  double pitch_apex;    ///< pitch cone apex beyond the crossing point [m]
  double face_apex;     ///< face cone apex beyond the crossing point [m]
};

/// Blank data of a hypoid pair, as in the paper's Table 1.
struct HypoidBlank {
  BlankMember pinion;
  BlankMember gear;
  double offset;  ///< shortest distance of the axes [m]
};

/// Where two axes lie with respect to each other.
struct ShaftPlacement {
  double shaft_angle;  ///< [rad]
  double offset;       ///< shortest distance of the axes [m]
};

/// What follows from the blank of one member.
struct MemberGeometry {
  double mean_cone_distance;  ///< A, pitch cone apex to the mean point [m]
  double mean_radius;         ///< r = A sin(delta) [m]
  double addendum;            ///< perpendicular to the pitch cone at the mean point [m]
  double pitch_apex;          ///< beyond the crossing point, derived; compare with the blank's [m]
};

/// What follows from the blanks of the pair, in closed form.
struct HypoidGeometry {
  MemberGeometry pinion;
  MemberGeometry gear;
  double shaft_angle;             ///< [rad]
  double offset_angle;            ///< beta_p - beta_g, in the pitch plane [rad]
  double mean_normal_module;      ///< 2 r_g cos(beta_g)/N_g [m]
  double working_depth;           ///< sum of the addenda [m]
  double limit_pressure_angle;    ///< [rad]
  double limit_curvature_radius;  ///< of the tooth trace in the pitch plane [m]
  double mean_point_sliding;      ///< sliding speed at the mean point per pinion speed [m]
};

/// Shaft angle and offset of two pitch cones that touch along a line of the pitch plane:
///
///   cos(Sigma) = cos(d_p) cos(d_g) cos(e) - sin(d_p) sin(d_g),
///   E = sin(e) (A_p sin(d_p) cos(d_g) + A_g sin(d_g) cos(d_p))/sin(Sigma).
///
/// Cone distances A [m], pitch angles d and offset angle in the pitch plane e [rad]; not checked.
/// ISO 23509 writes R_m, delta and zeta_mp.
ShaftPlacement shaft_placement(double pinion_cone_distance, double gear_cone_distance,
                               double pinion_pitch_angle, double gear_pitch_angle,
                               double offset_angle);

/// The geometry that blank data imply. The pitch plane is tangent to both pitch cones at the mean
/// point, where the tooth traces coincide: so the offset angle is beta_p - beta_g, and
/// r_g cos(beta_g)/(r_p cos(beta_p)) = N_g/N_p with the offset fixes both cone distances. (Taking
/// the mean point at mid face instead is not consistent with Table 1.) The apexes of the blank
/// enter only as the difference face_apex - pitch_apex, so pitch_apex of the result is an
/// independent check.
///
/// Limit pressure angle and limit curvature radius are those of Wildhaber:
///
///   tan(a_lim) = -(tan d_p tan d_g/cos e) (A_p sin b_p - A_g sin b_g)/(A_p tan d_p + A_g tan d_g)
///   r_lim = (tan b_p - tan b_g)/(cos a_lim (1/(A_p cos b_p) - 1/(A_g cos b_g)
///           - tan a_lim (tan b_p/(A_p tan d_p) + tan b_g/(A_g tan d_g))))
///
/// Throws Refusal BLANK_IMPOSSIBLE, naming everything that is wrong, for teeth below 1, pitch or
/// face angles outside (0, 90) degrees, spiral angles outside (-90, 90) degrees, an offset that is
/// not positive (a bevel pair: its cone distances do not follow from these data), a pinion spiral
/// angle that is not above the gear's, values that are not finite, or a working depth that is not
/// positive. Sources: ISO 23509:2016; E. Wildhaber, American Machinist 90 (1946).
HypoidGeometry hypoid_geometry(const HypoidBlank& blank);

}  // namespace tribodyn
