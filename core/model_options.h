#pragma once

namespace tribodyn {

/// The misprints of the paper that can be switched back on, one by one, to see what each does.
/// All off by default. Source: Paouris et al. (the paper), corrected as documented beside each law.
struct AsPublished {
  bool eq17_atan = false;            ///< theta = atan(V/U) instead of atan2(V, U)
  bool eq20_semi_major = false;      ///< a_c with (k eps)^2 instead of k^2 eps
  bool eq22_inverted_ratio = false;  ///< eps with Ry/Rx instead of Rx/Ry
  bool eq31_32_logarithm = false;    ///< ln(eta0 + 9.67) instead of ln eta0 + 9.67; implies eq 32
  bool eq43_44_polynomials = false;  ///< fitted polynomials instead of the exact F_n
  bool eq46_square_root_of_sum = false;  ///< sqrt(m_a + m_r) instead of sqrt(m_a m_r)

  bool operator==(const AsPublished&) const = default;
};

/// Where the Roelands index Z comes from.
enum class PressureViscosityIndex {
  kReciprocalAsymptotic,  ///< Z solves eq 33 for the measured alpha* (default)
  kHoupert,               ///< Z from eq 32; alpha* is then the slope of ln eta at p = 0
};

enum class HertzSolution {
  kSimplified,  ///< Hamrock-Brewe fits, eqs 20, 21 and 22 corrected (default)
  kExact,       ///< complete elliptic integrals
};

enum class HertzLoad {
  kFilmLoad,   ///< ellipse from W_EHL = W - W_asp (default)
  kTotalLoad,  ///< ellipse from W
};

/// What the model includes. Defaults are the paper's model as corrected: the preset "paper".
struct ModelOptions {
  bool isothermal = false;                ///< T_c = T_in: no thermal network (eqs 37, 38 and 39)
  bool newtonian = false;                 ///< F = 1 in eq 23: no shear thinning
  bool no_limiting_shear_stress = false;  ///< tau not restricted to tau_L
  bool no_boundary_friction = false;      ///< F_b = 0; asperities still carry load
  bool damping_in_contact_only = false;   ///< c xdot acts only while flanks touch
  bool energy_consistent = false;         ///< adds the parametric torques missing from eq 2
  bool subtract_contact_point_motion = false;  ///< entrainment relative to the moving footprint
  bool load_dependent_mesh_data = false;       ///< Fourier series and load shares at the torque
  bool tabulated_friction_arms =
      false;  ///< r_fr of the tables, not of the actual sliding direction
  /// The film of eq 12 times phi_T of P. K. Gupta and others (1992), with the pressure that the
  /// contact would have if the film carried all of its load.
  bool inlet_shear_heating = false;
  /// A film carries at most laws::supported_share() of what eq 41 leaves to it. Asperities carry
  /// the rest, so that friction tends to the boundary value where the film vanishes. Without effect
  /// on smooth surfaces and together with as_published.eq43_44_polynomials.
  bool closed_load_sharing = false;
  PressureViscosityIndex pressure_viscosity_index = PressureViscosityIndex::kReciprocalAsymptotic;
  HertzSolution hertz_solution = HertzSolution::kSimplified;
  HertzLoad hertz_load = HertzLoad::kFilmLoad;
  AsPublished as_published;

  bool operator==(const ModelOptions&) const = default;
};

/// The preset "recommended": the paper's model with the inlet heating that the paper asks for and
/// load sharing that holds for thin films too.
inline ModelOptions recommended_model() {
  ModelOptions out;
  out.inlet_shear_heating = true;
  out.closed_load_sharing = true;
  return out;
}

}  // namespace tribodyn
