#pragma once

#include <functional>
#include <optional>

#include "core/periodic/carried_state.h"
#include "core/study/history.h"

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
  kLargeVibration,  ///< the response with contact loss where one exists (find_loud_response());
                    ///< elsewhere released from 60 um more mesh deflection
};

/// How the steady state of the full model is found.
enum class SteadyStateMethod {
  kAutomatic,  ///< by shooting; marched where shooting finds no attracting response
  /// Found by shooting. Asked for: refused with NOT_FOUND_BY_SHOOTING where marching had to decide,
  /// or as the march would be where a contact is refused at the quasi-static start.
  kShooting,
  kMarch,  ///< marched until it repeats
};

struct PointOptions {
  /// kAutomatic takes the full model where a start, a carried state, a method, another response or
  /// a history is asked for.
  PointModel model = PointModel::kAutomatic;
  PointStart start = PointStart::kQuasiStatic;
  std::optional<CarriedState> carried_state;  ///< overrides start
  bool probe_coexisting_response = false;     ///< also settle from the other start and compare
  /// Adds the warning RESPONSES_COEXIST where another response is found under Coulomb's friction.
  /// Costs up to a millisecond for each speed and load of a prepared gear set near a resonance.
  bool warn_of_coexisting_response = true;
  SteadyStateMethod method = SteadyStateMethod::kAutomatic;
  /// kAutomatic alone: refuses with NOT_FOUND_BY_SHOOTING a point that is not found within some
  /// tens of mesh cycles (a rattle, a doubled period, the neighbourhood of a fold). The others are
  /// the same bits as without it.
  bool gives_up_early = false;
  /// Wanted relative error of both inefficiencies, the torque and the extremes of the transmission
  /// error [1e-8, 1e-2]: whichever model and method answers.
  double tolerance = 1e-3;
  /// Only a march reads the next two, and takes less where `tolerance` asks for it. A point that
  /// was not marched warns of one that is not the default (MARCH_TOLERANCE_UNUSED).
  double march_step_tolerance = 1e-7;  ///< relative error of each step of a march [1e-11, 1e-3]
  /// Relative change of a marched response per period that counts as settled.
  double march_settling_tolerance = 1e-6;
  /// Work limit of a march: transient, search for a period and average together. What measures the
  /// multipliers of the response found, the record of its period and the history come on top.
  /// Contact solutions have a limit too: see point_by_marching.h.
  int maximum_mesh_cycles = 4000;
  /// Averaged at least when no period is found (the paper's 50): more until the error of the
  /// average is within `tolerance` or a limit of work is reached.
  int recorded_mesh_cycles = 50;
  HistoryRequest history;  ///< empty: none computed
  /// Also differentiates the figures by all scalar parameters (PointResult::sensitivities). The
  /// full model answers then; a point that is not found by shooting has none and says so
  /// (NO_SENSITIVITIES).
  bool sensitivities = false;
  /// screen_point() and solve_point_figures(): also PointFigures::contact, for some 5 us (measured
  /// at 20 to 140 km/h; 3 on twelve steps a mesh cycle). A PointResult has it all.
  bool contact_summary = false;
  /// screen_point() and solve_point_figures(): warnings have sentences, not codes alone.
  bool warning_sentences = true;
  /// Called between mesh cycles with the fraction done in [0, 1]; false cancels (throws Cancelled).
  std::function<bool(double)> progress;
};

}  // namespace tribodyn
