#pragma once

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/dynamics/section_state.h"
#include "core/study/history.h"
#include "core/study/prepared_scene.h"
#include "core/study/scene.h"
#include "core/study/sensitivities.h"

namespace tribodyn {

/// What holds the operating point. Every kind keeps the mean speed at the stated value.
struct OperatingCondition {
  enum class Kind {
    kCruise,              ///< T_w from eq 7; T_s solved
    kDriveCycleSnapshot,  ///< as kCruise, T_w with the vehicle's inertia; T_s solved
    kPrescribedTorque,    ///< T_s and pinion speed given; T_w solved
  };
  Kind kind = Kind::kCruise;
  double vehicle_speed = 0;  ///< kCruise, kDriveCycleSnapshot [m/s]
  double acceleration = 0;   ///< kDriveCycleSnapshot [m/s2]
  double ascent_angle = 0;   ///< kCruise, kDriveCycleSnapshot [rad]
  double pinion_torque = 0;  ///< kPrescribedTorque [N m]; negative is coast
  double pinion_speed = 0;   ///< kPrescribedTorque, mean [rad/s]
};

enum class PointModel {
  kAutomatic,    ///< the cheapest whose estimated error is within the tolerance; not in results
  kFull,         ///< steady state of the 4-DoF system, friction in the loop
  kQuasiStatic,  ///< static equilibrium at constant speed, phase by phase
};

/// Where a single point starts; it decides the branch where two responses coexist.
enum class PointStart {
  kQuasiStatic,     ///< wound up to the static equilibrium: the low-amplitude branch
  kLargeVibration,  ///< the same, released from 60 um more mesh deflection: the vibro-impact branch
                    ///< where it exists
};

/// How the steady state of the full model is found.
enum class SteadyStateMethod {
  kAutomatic,  ///< by shooting; marched where shooting finds no attracting response
  /// Found by shooting. Asked for: refused with NOT_FOUND_BY_SHOOTING where marching had to decide,
  /// or as the march would be where a contact is refused at the quasi-static start.
  kShooting,
  kMarch,  ///< marched until it repeats
};

/// A neighbour's steady state, to start from. Speeds and wind-up are shifted to the new point.
struct CarriedState {
  SectionState section_state;
  double mean_pinion_speed = 0;  ///< [rad/s]
  double pinion_torque = 0;      ///< T_s there [N m]
  double wheel_torque = 0;       ///< T_w there [N m]
  int period = 1;                ///< of the response there [mesh cycles]; 0: none found
  bool contact_loss = false;     ///< there
};

struct PointOptions {
  /// kAutomatic takes the full model where a start, a carried state, a method, another response or
  /// a history is asked for.
  PointModel model = PointModel::kAutomatic;
  PointStart start = PointStart::kQuasiStatic;
  std::optional<CarriedState> carried_state;  ///< overrides start
  bool probe_coexisting_response = false;     ///< also settle from the other start and compare
  SteadyStateMethod method = SteadyStateMethod::kAutomatic;
  /// Wanted relative error of both inefficiencies, the torque and the extremes of the transmission
  /// error [1e-8, 1e-2]: whichever model and method answers.
  double tolerance = 1e-3;
  /// Only a march reads the next two, and takes less where `tolerance` asks for it. A point that
  /// was not marched warns of one that is not the default (MARCH_TOLERANCE_UNUSED).
  double march_step_tolerance = 1e-7;  ///< relative error of each step of a march [1e-11, 1e-3]
  /// Relative change of a marched response per period that counts as settled.
  double march_settling_tolerance = 1e-6;
  int maximum_mesh_cycles = 4000;  ///< work limit of the search for the steady state
  int recorded_mesh_cycles = 50;   ///< averaged when no period is found (the paper's 50)
  HistoryRequest history;          ///< empty: none computed
  /// Also differentiates the figures by all scalar parameters (PointResult::sensitivities). The
  /// full model answers then; a point that is not found by shooting has none and says so
  /// (NO_SENSITIVITIES).
  bool sensitivities = false;
  /// screen_point() and solve_point_figures(): also PointFigures::contact, for some 12 us
  /// (measured). A PointResult has it all.
  bool contact_summary = false;
  /// Called between mesh cycles with the fraction done in [0, 1]; false cancels (throws Cancelled).
  std::function<bool(double)> progress;
};

struct Extremes {
  double minimum = 0, mean = 0, maximum = 0;
};

/// An interval without contact inside the recorded steady state.
struct ContactLoss {
  double start_mesh_phase = 0;  ///< cycles from the section [0, period)
  double end_mesh_phase = 0;    ///< cycles; may exceed the period when it wraps
  double duration = 0;          ///< [s]
};

/// Loss of one flank slot.
struct FlankLoss {
  double viscous = 0, boundary = 0;  ///< time means [W]
  /// int F_fr dt/int W dt: the mean of F_fr/W, weighted with the load; 0 without load [-]
  double friction_coefficient = 0;
};

struct SolverStatistics {
  long right_hand_sides = 0;
  long contact_solutions = 0;
  long accepted_steps = 0;
  long rejected_steps = 0;
  long events = 0;                ///< exact locations of contact loss, regain and load onset
  long mesh_cycles = 0;           ///< marched in all, under lagged friction or full
  long accelerations = 0;         ///< accepted extrapolations towards the steady state
  double periodicity_defect = 0;  ///< relative change of the section state over the last period
  double largest_multiplier = 0;  ///< Floquet, modulus; below 1: the response is attracting
  /// At which the slowest disturbance dies out: like e^(-rate t); 0: no multiplier is known [1/s].
  /// -ln(multiplier) over the period, and the multiplier is good to 3e-3 (1e-4 where it is nearest
  /// to 1: it is marched there): the rate to as much over the period.
  double slowest_decay_rate = 0;
};

/// Work over the recorded steady state [J]; input = output + losses + stored + parametric.
struct PowerBalance {
  double input = 0;          ///< T_s dphi_s; in coast negative: what comes out
  double output = 0;         ///< T_w dphi_w; in coast negative: what comes in
  double friction = 0;       ///< flank friction
  double shaft_damping = 0;  ///< c_t1, c_t2
  double mesh_damping = 0;   ///< c xdot^2
  double stored = 0;         ///< change of kinetic and elastic energy
  double parametric = 0;     ///< the torques eq 2 leaves out: F e' - k_m' f^2/2 per radian of phi_p
};

struct RangeWarning {
  std::string code;      ///< stable UPPER_SNAKE_CASE
  std::string sentence;  ///< with the value, its unit and the validated range
};

/// The other steady state at the same operating point, in short.
struct CoexistingResponse {
  double inefficiency_rms = 0;              ///< [%]
  double inefficiency_energy_mean = 0;      ///< [%]
  double pinion_torque = 0;                 ///< [N m]
  double dte_minimum = 0, dte_maximum = 0;  ///< [m]
  bool contact_loss = false;
};

/// A point of the inefficiency curve. SI units; inefficiencies in percent of the power that comes
/// in: at the pinion in drive, at the wheel in coast (T_s < 0).
/// What is lost here is mesh (conjunctional) power: bearings, churning and seals are not in it.
struct PointResult {
  double vehicle_speed = 0;      ///< [m/s]
  double mean_pinion_speed = 0;  ///< [rad/s]
  double mesh_frequency = 0;     ///< [Hz]
  double pinion_torque = 0;      ///< T_s [N m]
  double wheel_torque = 0;       ///< T_w [N m]
  /// Mean power that comes in [W], >= 0: T_s phidot_s, in coast -T_w phidot_w. Where neither gives
  /// power out, friction takes all of it and power comes in at both.
  double input_power = 0;

  /// Eq 30 over the power that comes in, RMS over time [%]; absent where T_s = 0.
  std::optional<double> inefficiency_rms;
  std::optional<double> inefficiency_energy_mean;  ///< loss energy / energy that comes in [%]
  double mesh_loss_power = 0;                      ///< mean [W]
  double mesh_loss_torque = 0;                     ///< mesh_loss_power / mean pinion speed [N m]
  double viscous_loss_power = 0;                   ///< [W]
  double boundary_loss_power = 0;                  ///< [W]
  std::array<FlankLoss, kFlankPairs> flank_losses;
  double boundary_to_viscous_friction_ratio = 0;  ///< ratio of the RMS total forces (fig 8) [-]

  Extremes dynamic_transmission_error;  ///< x [m]
  Extremes mesh_force;                  ///< k_m f + c xdot [N]
  Extremes pinion_friction_torque;      ///< T_fr,p [N m]
  Extremes gear_friction_torque;        ///< T_fr,g [N m]

  bool contact_loss = false;
  bool coast_side_contact = false;
  double contact_loss_time_share = 0;  ///< [-]
  std::vector<ContactLoss> contact_losses;

  Extremes central_film_thickness;  ///< over loaded flanks; means are load-time weighted [m]
  Extremes film_ratio;              ///< lambda_s [-]
  Extremes contact_temperature;     ///< T_c [K]
  Extremes maximum_pressure;        ///< p_max [Pa]
  Extremes shear_rate;              ///< [1/s]
  Extremes flash_temperature_rise;  ///< (dT_f)_av, eq 39 [K]
  /// F_fr/W [-]. Its mean is the friction coefficient of the mesh: int sum F_fr dt/int sum W dt.
  Extremes friction_coefficient;
  Extremes pinion_specific_sliding;       ///< see SpecificSliding [-]
  Extremes gear_specific_sliding;         ///< likewise
  double limiting_stress_time_share = 0;  ///< share of time with a contact centre on tau_L [-]
  double limiting_stress_area_share = 0;  ///< load-time mean of the area share on tau_L [-]

  PointModel model = PointModel::kFull;
  SteadyStateMethod method = SteadyStateMethod::kMarch;
  bool settled = false;
  int period_in_mesh_cycles = 0;  ///< 0: none found; results are then averages over the record
  int recorded_mesh_cycles = 0;
  std::optional<double> estimated_relative_error;  ///< absent: not estimated
  SolverStatistics statistics;
  PowerBalance power_balance;
  std::optional<CoexistingResponse> coexisting_response;
  std::vector<RangeWarning> warnings;
  SectionState section_state;  ///< the steady state at mesh phase 0
  History history;
  std::optional<PointSensitivities> sensitivities;  ///< if requested and found
};

/// A result as the start of a neighbour's search.
inline CarriedState carried_from(const PointResult& r) {
  return {r.section_state, r.mean_pinion_speed,     r.pinion_torque,
          r.wheel_torque,  r.period_in_mesh_cycles, r.contact_loss};
}

/// Solves one operating point. Throws Refusal (reasons: contact_status_name, NO_FORWARD_ROTATION,
/// WORK_LIMIT, ...) or Cancelled.
/// `gear_set`: that of the scene where it is prepared already, as PreparedScene takes it; null: it
/// is prepared here. The result is the same bits either way.
PointResult solve_operating_point(const Scene& scene, const OperatingCondition& condition,
                                  const PointOptions& options,
                                  std::shared_ptr<PreparedGearSet> gear_set = nullptr);
/// The same bits, for many points of one scene.
PointResult solve_prepared_point(PreparedScene& scene, const OperatingCondition& condition,
                                 const PointOptions& options);

/// Figures of the loaded flanks over the steady state.
struct ContactSummary {
  double film_ratio_minimum;              ///< lambda_s [-]
  double film_ratio_mean;                 ///< weighted with load and time [-]
  double contact_temperature_maximum;     ///< T_c [K]
  double contact_temperature_mean;        ///< weighted with load and time [K]
  double viscous_loss_power;              ///< mean [W]
  double boundary_loss_power;             ///< mean [W]
  double friction_coefficient_mean;       ///< as PointResult::friction_coefficient [-]
  double pressure_maximum;                ///< p_max [Pa]
  double flash_temperature_rise_maximum;  ///< (dT_f)_av [K]
};

/// The figures of a point to which PointOptions::tolerance applies, and others on request.
struct PointFigures {
  double pinion_torque = 0;                        ///< T_s [N m]
  double wheel_torque = 0;                         ///< T_w [N m]
  std::optional<double> inefficiency_rms;          ///< as in PointResult [%]
  std::optional<double> inefficiency_energy_mean;  ///< [%]
  double mesh_loss_power = 0;                      ///< mean [W]
  double dte_minimum = 0, dte_maximum = 0;         ///< x [m]
  bool contact_loss = false;
  bool settled = false;
  int period_in_mesh_cycles = 0;                   ///< 0: none found
  std::optional<double> estimated_relative_error;  ///< absent: not estimated
  long contact_solutions = 0;
  PointModel model = PointModel::kFull;  ///< used
  /// By PointOptions::contact_summary. Absent where no flank carries a load.
  std::optional<ContactSummary> contact;
  /// By PointOptions::sensitivities, on the grid of the figures.
  std::optional<PointSensitivities> sensitivities;
};

/// The main figures of a result, with its contact summary and sensitivities.
PointFigures main_figures(const PointResult& result);

/// As solve_prepared_point from PointOptions::start, to within the tolerance, but faster. Histories
/// and coexisting responses are not looked for; the start is never carried. Throws as
/// solve_prepared_point does.
PointFigures solve_point_figures(PreparedScene& prepared, const OperatingCondition& condition,
                                 const PointOptions& options);

/// For screening: the same for one of many lubricants on one prepared gear set, all at the same few
/// speeds and loads. The response under Coulomb's friction is found once for all of them; each
/// starts from there and is solved for on one grid, on which the error of the steps is known from
/// that response. An answer is the same bits whichever lubricants came before. Other points than
/// the first at a speed and load take half the time where twelve steps a mesh cycle do, and little
/// less than alone where many are needed; the first takes up to twice. Some hundred speeds and
/// loads are remembered; more in turn gain nothing.
PointFigures screen_point(PreparedScene& prepared, const OperatingCondition& condition,
                          const PointOptions& options);

}  // namespace tribodyn
