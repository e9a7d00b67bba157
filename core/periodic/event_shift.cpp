#include "core/periodic/event_shift.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "core/integrate/runge_kutta.h"
#include "core/numerics/square.h"

namespace tribodyn {

EventShift::EventShift(const GearPairSystem& system, const MeshGrid& grid,
                       const FlankContactBatch& batch, const PeriodicOrbit& orbit,
                       FrozenFriction& friction, const OrbitContacts& contacts, double no_load)
    : system_(system),
      grid_(grid),
      batch_(batch),
      orbit_(orbit),
      friction_(friction),
      contacts_(contacts),
      no_load_(no_load) {}

double EventShift::force_slope(std::size_t piece, int part) const {
  const auto force = [&](int i) { return contacts_.at(piece, i).mesh_force; };
  const double rise = force(2) - force(0), bend = 2 * (force(0) - 2 * force(1) + force(2));
  return (rise + (part - 1) * bend) / orbit_.pieces[piece].length;
}

EventShift::Integrands EventShift::integrands(const MarchState& y, const Instant& at) const {
  Integrands out{};
  out[kLossSum] = at.loss_power;
  out[kFrictionTorqueSum] = at.pinion_friction_torque;
  for (int k = 0; k < kFlankPairs; ++k) {
    out[kLoadSum] += at.load[k];
    out[kFilmRatioLoadSum] += at.contact[k].film_ratio * at.load[k];
    out[kTemperatureLoadSum] += at.contact[k].contact_temperature * at.load[k];
  }
  out[kSquaredLoss] = square(
      at.loss_power / system_.input_speed(orbit_.torques, y[kPinionShaftSpeed], y[kWheelSpeed]));
  for (double& each : out) each *= system_.cycle_angle() / y[kPinionSpeed];
  return out;
}

/// Differences are over small_step() to either side, or over what changes the load by a thousandth.
bool EventShift::follow_motion(std::size_t piece, const PieceSlopes& slopes, bool start_moves,
                               bool end_moves) {
  piece_ = &orbit_.pieces[piece];
  slopes_ = &slopes;
  const double cycle = std::floor(piece_->phase + 1e-9);
  ContactTally tally;
  ContactSolver contacts(batch_, tally);
  for (int part = 0; part < 3; ++part) {
    along_[part] = {};
    const bool moves = part == 0 ? start_moves : part == 2 ? end_moves : start_moves || end_moves;
    const ContactsAt& unmoved = contacts_.at(piece, part);
    if (!moves || !has_load(unmoved)) continue;
    const double part_phase = piece_->phase + 0.5 * part * piece_->length - cycle;
    const int interval = system_.mesh().interval_at(part_phase);
    const double step =
        std::min(small_step(), 1e-3 * unmoved.load / std::abs(force_slope(piece, part)));
    for (const double shift : {-step, step}) {
      MarchState y = state_of(*piece_, part);
      const auto& rate = slopes.parts[part]->rate;
      for (std::size_t i = 0; i < rate.size(); ++i) y[i] += shift * rate[i];
      Instant at;
      if (system_.evaluate(part_phase + shift, interval, piece_->regime, y.data(), contacts, at) !=
          ContactStatus::kOk) {
        return false;
      }
      const Integrands there = integrands(y, at);
      for (int f = 0; f < kIntegrals; ++f) along_[part].integrands[f] += there[f] / (2 * shift);
      if (!unmoved.arms_follow) continue;
      const double per_load = 1 / (2 * shift * piece_->regime.load(at.mesh_force));
      along_[part].arms.pinion += at.pinion_friction_torque * per_load;
      along_[part].arms.gear += at.gear_friction_torque * per_load;
    }
  }
  return true;
}

/// Takes the step of the piece again after its start and end have moved by these phases [cycles].
/// The start state and the friction arms change as they do along the motion.
EventShift::MiddleAndEnd EventShift::moved_piece(double start_shift, double end_shift) {
  const OrbitPiece& p = *piece_;
  const double length = p.length + end_shift - start_shift;
  FrictionArms arms[3];
  MeshPhase phase[3];
  for (int part = 0; part < 3; ++part) {
    const double shift = (1 - 0.5 * part) * start_shift + 0.5 * part * end_shift;
    const double at = p.phase + 0.5 * part * p.length;
    arms[part] = friction_.at(at);
    arms[part].pinion += shift * along_[part].arms.pinion;
    arms[part].gear += shift * along_[part].arms.gear;
    phase[part] = system_.at_phase(at + shift - std::floor(at + shift));
  }
  constexpr int kRates = std::tuple_size_v<Rates>;
  Rates start{}, rate{}, first_rate{};
  // Friction follows the force as it does in the slopes of the piece: no kink where F is 0.
  const auto set_rate = [&](int part, const StageSlopes& slopes, const Rates& y) {
    Mechanics at;
    system_.mechanics(phase[part], p.regime, y.data(), at);
    const double load = slopes.load > 0 ? p.regime.side * at.mesh_force : 0;
    at.pinion_friction_torque = arms[part].pinion * load;
    at.gear_friction_torque = arms[part].gear * load;
    system_.motion(y.data(), at, orbit_.torques, rate.data());
  };
  for (int i = 0; i < kRates; ++i) start[i] = p.start[i] + start_shift * slopes_->parts[0]->rate[i];
  MiddleAndEnd out;
  out.end = start;
  for (int n = 0; n < 4; ++n) {
    Rates stage = start;
    for (int i = 0; i < kRates; ++i) stage[i] += kRungeKuttaNode[n] * length * rate[i];
    set_rate(n == 0 ? 0 : n == 3 ? 2 : 1, *slopes_->stages[n], stage);
    if (n == 0) first_rate = rate;
    for (int i = 0; i < kRates; ++i) out.end[i] += kRungeKuttaWeight[n] * length * rate[i];
  }
  // The middle by the rate of the last stage: Rk4WithEvents::middle().
  for (int i = 0; i < kRates; ++i) {
    out.middle[i] = 0.5 * (start[i] + out.end[i]) + length / 8 * (first_rate[i] - rate[i]);
  }
  return out;
}

EventShift::MiddleAndEnd EventShift::off_motion_by(int of_start, int of_end) {
  const double step = small_step();
  MiddleAndEnd out = moved_piece(of_start * step, of_end * step);
  const MiddleAndEnd other = moved_piece(-of_start * step, -of_end * step);
  for (std::size_t i = 0; i < out.end.size(); ++i) {
    out.middle[i] =
        (out.middle[i] - other.middle[i]) / (2 * step) - 0.5 * slopes_->parts[1]->rate[i];
    out.end[i] = (out.end[i] - other.end[i]) / (2 * step) - of_end * slopes_->parts[2]->rate[i];
  }
  return out;
}

}  // namespace tribodyn
