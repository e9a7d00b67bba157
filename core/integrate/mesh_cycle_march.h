#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "core/driveline/gear_pair_system.h"
#include "core/integrate/dormand_prince_with_events.h"
#include "core/integrate/graded_phase.h"

namespace tribodyn {

/// Scales of the components of the march, for error tests and Newton's method.
struct MarchScales {
  double length;        ///< static mesh deflection [m]
  double speed;         ///< pinion speed of a free vibration that large [rad/s]
  double torque;        ///< [N m]
  double loss_work;     ///< 1 % of the input work of a mesh cycle [J]; of each work in the balance
  double loss_squared;  ///< the same for kLossShareSquared
  double time;          ///< in which the pinion turns by length/R_p0 [s]
  double of(const MeshData& mesh, int component) const;
};

MarchScales march_scales(const GearPairSystem& system, const Torques& torques,
                         double mean_pinion_speed);

/// Opening (or closing) of the gap.
struct GapEvent {
  double phase;  ///< [cycles]
  double time;   ///< [s]
  bool opens;
};

void throw_if_refused(ContactStatus status);

/// The gear pair as a System of DormandPrinceWithEvents, over a variable s from 0 to 1 in a mesh
/// cycle: mesh phase, but stretched where a flank pair takes or gives up its load (GradedPhase).
/// kRecord adds the integrals of RecordComponent.
template <bool kRecord>
class MeshCycleSystem {
 public:
  static constexpr int kSize =
      kRecord ? static_cast<int>(kRecordComponents) : static_cast<int>(kMarchComponents);
  static constexpr int kEvents = 2;
  using State = std::array<double, kSize>;

  /// From mesh phase 0 in a regime. Keeps the references.
  MeshCycleSystem(const GearPairSystem& system, const Torques& torques, const MarchScales& scales,
                  ContactRegime regime, ContactSolver& contacts)
      : system_(system), torques_(torques), scales_(scales), contacts_(contacts), regime_(regime) {
    for (int i = 0; i < kSize; ++i) {
      scale_[i] = scales.of(system.mesh(), i);
    }
    start_piece(0, 0, takes_load());
  }

  /// Mesh phase [cycles] at s, and its inverse, in the present piece.
  double phase(double s) const { return piece_.phase(s); }
  double s_of(double phase) const { return piece_.s_of(phase); }
  ContactRegime regime() const { return regime_; }
  /// Of the mesh tables; of no meaning without a load.
  int interval() const { return interval_; }

  void derivative(double s, const State& y, State& dy) {
    constexpr double kNoRate = std::numeric_limits<double>::quiet_NaN();  // fails the step
    if (std::isfinite(y[kPinionSpeed])) pinion_speed_ = y[kPinionSpeed];
    if (std::isfinite(y[kPinionShaftSpeed])) shaft_speed_ = y[kPinionShaftSpeed];
    // A state without numbers comes from a refused contact earlier in the step, whose name is kept.
    if (y[kPinionSpeed] <= 0 || std::isnan(y[kPinionSpeed])) {
      dy.fill(kNoRate);
      return;
    }
    refusal_ = system_.evaluate(phase(s), interval_, regime_, y.data(), contacts_, instant_);
    if constexpr (kRecord) {
      system_.record_derivative(y.data(), instant_, regime_, torques_, dy.data());
    } else {
      system_.derivative(y.data(), instant_, torques_, dy.data());
    }
    const double slope = piece_.slope(s);
    for (double& rate : dy) rate *= slope;
    // A refused contact fails the step: the wild stages of one that is too long mean nothing.
    if (refusal_ != ContactStatus::kOk) dy.fill(kNoRate);
  }
  void on_no_step() const {
    // Phase goes like the root of time where the pinion stops: steps end before the speed is zero.
    const auto stands = [&](double speed) {
      return speed * scales_.time * system_.mesh().mean_pinion_contact_radius() <
             0.05 * scales_.length;
    };
    if (stands(pinion_speed_)) {
      throw Refusal("NO_FORWARD_ROTATION",
                    "the pinion comes to a stop: the march over mesh phase needs forward rotation");
    }
    if (stands(shaft_speed_)) {
      throw Refusal("NO_FORWARD_ROTATION",
                    "the pinion shaft comes to a stop: the share of power that is lost (eq 30) has "
                    "no value there");
    }
    throw_if_refused(refusal_);
  }

  void events(double s, const State& y, std::array<double, kEvents>& g) const {
    g = system_.events(system_.at_phase(phase(s)), regime_, y.data(), scales_.length,
                       scales_.torque / system_.mesh().mean_pinion_contact_radius());
  }

  void on_event(int index, double s, const State& y) {
    const double at_phase = phase(s);
    const ContactRegime before = regime_;
    regime_ = system_.regime_after(index, system_.at_phase(at_phase), before, y.data());
    if (gap_events != nullptr && (before.side == 0) != (regime_.side == 0)) {
      gap_events->push_back({at_phase, y[kTime], regime_.side == 0});
    }
    if (regime_.loaded) interval_ = system_.mesh().interval_at(std::max(s, at_phase));
    start_piece(s, at_phase, regime_.side == before.side && regime_.loaded);  // load from zero
  }

  double next_breakpoint(double) const { return piece_end_; }
  void on_breakpoint(double s) {
    ++interval_;
    start_piece(s, s, takes_load());
  }
  double scale(int i) const { return scale_[i]; }
  /// The load of all ends where the event is, like a power: friction goes like W^0.74 there.
  bool corner_at(int) const { return regime_.loaded; }

  std::vector<GapEvent>* gap_events = nullptr;

 private:
  /// Up to the next sample of the tables. Without a load there is no friction, and the tables do
  /// not matter: then to the end of the mesh cycle, once s and phase agree.
  void start_piece(double s, double phase, bool load_begins) {
    constexpr double kPhaseRounding = 1e-13;
    const bool has_load = regime_.side != 0 && regime_.loaded;
    piece_end_ = !has_load && std::abs(s - phase) < kPhaseRounding
                     ? 1
                     : static_cast<double>(interval_ + 1) / system_.mesh().intervals();
    piece_ = GradedPhase(s, phase, piece_end_, load_begins, gives_load());
  }
  bool takes_load() const { return share_is_zero(0); }
  bool gives_load() const { return share_is_zero(1); }
  /// Whether a loaded pair has no load at that end (0 or 1) of the interval but has inside.
  bool share_is_zero(int end) const {
    if (!regime_.loaded) return false;
    constexpr double kNothing = 1e-12;
    const double count = system_.mesh().intervals();
    std::array<FlankKinematics, kFlankPairs> at_end, inside;
    system_.mesh().flanks(interval_, (interval_ + end) / count, at_end);
    system_.mesh().flanks(interval_, (interval_ + 0.5) / count, inside);
    for (int k = 0; k < kFlankPairs; ++k) {
      if (at_end[k].load_share <= kNothing && inside[k].load_share > kNothing) return true;
    }
    return false;
  }

  const GearPairSystem& system_;
  Torques torques_;
  MarchScales scales_;
  ContactSolver& contacts_;
  ContactRegime regime_;
  int interval_ = 0;
  State scale_;
  GradedPhase piece_;
  double piece_end_ = 1;
  double pinion_speed_ = 0, shaft_speed_ = 0;   ///< in the last evaluation
  ContactStatus refusal_ = ContactStatus::kOk;  ///< of the last evaluation of a state with numbers
  Instant instant_;
};

/// Marches a point of the section over one mesh cycle; time and work start from zero. Adds to
/// `work`. Throws Refusal NO_FORWARD_ROTATION if the pinion stops, and a Refusal with the name of
/// the contact's status if a contact is refused.
void march_mesh_cycle(const GearPairSystem& system, const MarchScales& scales,
                      const MarchOptions& options, ContactSolver& contacts, SectionPoint& at,
                      SolverWork& work);

}  // namespace tribodyn
