#pragma once

#include <array>
#include <optional>

#include "core/contact/contact_sensitivity.h"
#include "core/periodic/periodic_orbit.h"
#include "core/periodic/periodic_problem.h"

// Derivatives of a periodic orbit's figures by the parameters of its contacts, by its torques and
// by its mean speed, by the implicit function theorem.
//
// The orbit found by shooting solves a discrete system: each piece is a Runge-Kutta step whose
// friction arms (friction torque over load) at start, middle and end follow the states there. In a
// small change every piece therefore links only the states at its two ends,
//   (I - B) dX_1 = L dX_0 + l dT + r dp;
// the coupling of friction and motion is in B, L and r, so nothing is iterated. The figures are few
// and the parameters many, so derivatives are passed backwards (piece_adjoint.h): those of the
// state and time at the period's end, and of the integrals and extremes that the figures are made
// of. What arrives at the section gives the Jacobian of the shooting equations X_N = X_0, t_N = the
// period's time: one solution of 8 equations for all figures. What arrives on the way at friction
// arms and sums is a weight of each contact's friction (orbit_contacts.h); the weighted derivatives
// of all contacts by the few levels that their parameters act through are summed, and the chain
// rule takes the sums to the parameters once. Extremes are differentiated at fixed phase. Where
// flanks part or meet the rates f jump, and the states at a fixed phase change by (f- - f+) dphi,
// dphi the phase change of the event (saltation). Pieces that start or end at an event become
// longer or shorter with it (event_shift.h). (R. Seydel, Practical Bifurcation and Stability
// Analysis, 3rd ed., 2010, section 7.4; R. I. Leine and H. Nijmeijer, Dynamics and Bifurcations of
// Non-Smooth Mechanical Systems, 2004, section 7.4; for the adjoints A. Griewank and A. Walther,
// Evaluating Derivatives, 2nd ed., 2008, chapters 3 and 15.)
//
// Measured against central differences on the same grid, extrapolated from relative steps of 1e-4
// and 5e-5: at 200 random smooth points all elasticities agree within 4.4e-6. (Steps of 4e-4 pass
// kinks of the response at six of them, and the differences then err by up to 4e-5.) At 100 random
// points with impacts they agree within 2.5e-4 on 192 steps a cycle (relative steps of 2e-5 and
// 1e-5); on 96 steps within 1e-4 but for one point near a resonance, where the elasticity of -2.18
// by the mean speed errs by 2e-3, and the grid itself by 7e-2. All derivatives together take 1.6
// to 2.75 times as long as the figures of a smooth point at the usual tolerance, and 0.6 to 1.3
// times as long as those of a point with impacts (20 to 140 km/h, Roelands's law, AVX2, medians of
// 200 pairs).

namespace tribodyn {

/// Figures of an orbit that are differentiated. Of a power that comes in at the pinion (drive) or
/// at the wheel (coast), as in PointResult.
enum class OrbitFigure {
  kInefficiencyRms,           ///< [%]
  kInefficiencyEnergyMean,    ///< [%]
  kMeshLossPower,             ///< [W]
  kMeshLossTorque,            ///< [N m]
  kPinionFrictionTorque,      ///< mean [N m]
  kFilmRatio,                 ///< mean, weighted with load and time [-]
  kContactTemperature,        ///< likewise [K]
  kTransmissionErrorMinimum,  ///< [m]
  kTransmissionErrorMaximum,  ///< [m]
};
inline constexpr int kOrbitFigures = 9;

/// Columns: parameters of the contacts in the order of ContactInput, then these.
enum OrbitParameter {
  kKnownTorqueParameter = kContactParameters,  ///< T_w, or T_s where T_w is solved for [N m]
  kMeanSpeedParameter,                         ///< mean pinion speed at the same torque [rad/s]
  kOrbitParameters
};

struct OrbitSensitivity {
  std::array<double, kOrbitFigures> figure{};
  /// By OrbitFigure and parameter: the figure's unit over the parameter's.
  std::array<std::array<double, kOrbitParameters>, kOrbitFigures> derivative{};
  /// Derivatives are those of one side: of some contact (ContactSensitivity::one_sided), of flanks
  /// that never part and press with less than 1 % of the mean force at some instant, or of flanks
  /// that part or meet at less than 1 % of the greatest speed at which they do.
  bool one_sided = false;
};

/// Largest modulus of the Floquet multipliers but for the one nearest to 1, with friction that
/// follows the motion. The orbit must have been solved for, with its friction. Returns nullopt if a
/// contact has no derivatives.
std::optional<double> multiplier_with_friction(const PeriodicProblem& problem,
                                               const PeriodicOrbit& orbit);

/// The orbit must have been solved for, with its friction and figures. Returns nullopt if a contact
/// has no derivatives (no sliding, no entrainment) or is refused beside an event, or if the
/// shooting equations are singular to rounding (a fold).
std::optional<OrbitSensitivity> orbit_sensitivity(const PeriodicProblem& problem,
                                                  const PeriodicOrbit& orbit);

}  // namespace tribodyn
