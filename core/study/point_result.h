#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/gear/gear_set.h"
#include "core/integrate/solver_work.h"
#include "core/study/point_options.h"
#include "core/study/sensitivities.h"

namespace tribodyn {

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

struct SolverStatistics : SolverWork {
  long accelerations = 0;  ///< accepted extrapolations towards the steady state
  /// Relative change of the section state over the last period; 0 if no period was searched for.
  double periodicity_defect = 0;
  double largest_multiplier = 0;  ///< Floquet, modulus; below 1: the response is attracting
  /// At which the slowest disturbance dies out: like e^(-rate t); 0: no multiplier is known [1/s].
  /// -ln(multiplier) over the period, and the multiplier is good to 3e-3 (1e-4 where it is nearest
  /// to 1: it is marched there): the rate to as much over the period.
  double slowest_decay_rate = 0;
  /// Distance from -1 of the Floquet multiplier nearest to it, and from 1: where it is 0 the period
  /// doubles, or the branch folds. By shooting; 0 otherwise.
  double distance_to_flip = 0, distance_to_fold = 0;
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
  /// Grows with the distance from the range, to tell which of several warnings of one code is about
  /// the place that is furthest outside.
  double excess = 0;
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
  Extremes pinion_specific_sliding;  ///< see SpecificSliding [-]
  Extremes gear_specific_sliding;    ///< likewise
  /// Least phi_T of the loaded flanks, to what shear heating of the inlet thins the film, whether
  /// the model has it or not [-].
  double inlet_heating_factor = 1;
  double limiting_stress_time_share = 0;  ///< share of time with a contact centre on tau_L [-]
  double limiting_stress_area_share = 0;  ///< load-time mean of the area share on tau_L [-]

  PointModel model = PointModel::kFull;
  SteadyStateMethod method = SteadyStateMethod::kMarch;
  bool settled = false;
  int period_in_mesh_cycles = 0;  ///< 0: none found; means are then averages over the record
  int recorded_mesh_cycles = 0;
  /// Of both inefficiencies and torque; of a settled response, and by the quasi-static model, also
  /// of the extremes of the transmission error. Of a response without a period it is half of the
  /// width of the 95 % interval of its averages (rattle_average.h), and the extremes, which are
  /// those over the record and grow with it, have no error. Absent: not estimated.
  std::optional<double> estimated_relative_error;
  SolverStatistics statistics;
  PowerBalance power_balance;
  std::optional<CoexistingResponse> coexisting_response;
  std::vector<RangeWarning> warnings;
  SectionState section_state;  ///< at mesh phase 0; without a period: at the end of the record
  History history;
  std::optional<PointSensitivities> sensitivities;  ///< if requested and found
};

/// A result as the start of a neighbour's search.
inline CarriedState carried_from(const PointResult& r) {
  return {r.section_state, r.mean_pinion_speed,     r.pinion_torque,
          r.wheel_torque,  r.period_in_mesh_cycles, r.contact_loss};
}

}  // namespace tribodyn
