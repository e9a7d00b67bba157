#include "core/periodic/orbit_friction.h"

#include <algorithm>
#include <cmath>

namespace tribodyn {
namespace {

/// Extremes of the cubic through two values with their slopes, over [0, h].
void add_cubic_extremes(double x0, double v0, double x1, double v1, double h, double& low,
                        double& high) {
  low = std::min({low, x0, x1});
  high = std::max({high, x0, x1});
  const double beyond = 4.0 / 27 * h * (std::abs(v0) + std::abs(v1));  // at most
  if (std::max(x0, x1) + beyond <= high && std::min(x0, x1) - beyond >= low) return;
  // x'(t) = v0 + 2 b t + 3 a t^2 with t in [0, 1].
  const double s0 = v0 * h, s1 = v1 * h, rise = x1 - x0;
  const double a = s0 + s1 - 2 * rise, b = 3 * rise - 2 * s0 - s1;
  const double discriminant = b * b - 3 * a * s0;
  if (!(discriminant > 0)) return;
  const double root = -(b + std::copysign(std::sqrt(discriminant), b));
  for (const double t : {root / (3 * a), s0 / root}) {
    if (!(t > 0 && t < 1)) continue;
    const double x = x0 + t * (s0 + t * (b + t * a));
    low = std::min(low, x);
    high = std::max(high, x);
  }
}

double relative(double a, double b) {
  const double size = std::max(std::abs(a), std::abs(b));
  return size > 0 ? std::abs(a - b) / size : 0;
}

std::array<const double*, 3> states(const OrbitPiece& piece) {
  return {piece.start.data(), piece.middle.data(), piece.end.data()};
}

/// Mechanics, loads and motion of the flanks at part 0, 1, 2 of a piece: its start, middle, end.
/// Calls on_contact(flank pair, its kinematics, its conditions) for each loaded contact.
template <class OnContact>
void visit_flanks(const GearPairSystem& system, const MeshGrid& grid, const OrbitPiece& piece,
                  int part, Instant& at, OnContact&& on_contact) {
  const double* state = states(piece)[part];
  if (piece.node >= 0) {
    system.mechanics(grid.at(piece.node + part), piece.regime, state, at);
  } else {
    system.mechanics(piece.phase + 0.5 * part * piece.length, piece.regime, state, at);
  }
  at.load = {};
  const double load = piece.regime.load(at.mesh_force);
  if (!(load > 0)) return;
  std::array<FlankKinematics, kFlankPairs> off_grid;
  const auto& flanks = flanks_of(system.mesh(), grid, piece, part, off_grid);
  for (int k = 0; k < kFlankPairs; ++k) {
    const FlankKinematics& flank = flanks[k];
    at.load[k] = flank.load_share * load;
    if (!(at.load[k] > 0)) continue;
    on_contact(k, flank, system.contact_conditions(flank, at.load[k], state, at.motion[k]));
  }
}

}  // namespace

SolvedPieces solved_pieces(const GearPairSystem& system, const MeshGrid& grid,
                           const std::vector<OrbitPiece>& pieces, const SolvedContacts& contacts,
                           const FlankContactModel& model) {
  SolvedPieces out;
  out.instants.resize(number_instants(pieces, out.first));
  int n = 0, contact = 0;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    for (int part = n - out.first[i]; part < 3; ++part, ++n) {
      Instant& at = out.instants[n];
      visit_flanks(system, grid, pieces[i], part, at,
                   [&](int k, const FlankKinematics&, const ContactConditions& conditions) {
                     ContactFigures& solution = at.contact[k];
                     contacts.copy(contact++, solution);
                     model.complete(conditions, solution);
                     const FlankMotion& motion = at.motion[k];
                     add_flank_friction(motion.pinion_friction_arm, motion.gear_friction_arm,
                                        motion.sliding_speed, solution.friction, at);
                   });
    }
  }
  return out;
}

double OrbitFigures::distance(const OrbitFigures& other) const {
  // Where the transmission error passes through zero its extremes are measured by the larger one.
  const double dte = std::max({std::abs(dte_minimum), std::abs(dte_maximum),
                               std::abs(other.dte_minimum), std::abs(other.dte_maximum)});
  const double extremes = std::max(std::abs(dte_minimum - other.dte_minimum),
                                   std::abs(dte_maximum - other.dte_maximum));
  return std::max({relative(loss_rms, other.loss_rms), relative(loss_energy, other.loss_energy),
                   relative(torque, other.torque), dte > 0 ? extremes / dte : 0});
}

OrbitFriction::OrbitFriction(const GearPairSystem& system, const FlankContactBatch& contacts,
                             ContactTally& tally, double tolerance,
                             std::optional<double> coefficient)
    : system_(system),
      contacts_(contacts),
      tally_(tally),
      digits_(tolerance >= kHalfDigitsTolerance ? Digits::kHalf : Digits::kFull),
      coefficient_(coefficient),
      geometries_(contacts.model().reduced_modulus(), contacts.model().options()) {}

int OrbitFriction::gather(const MeshGrid& grid, const std::vector<OrbitPiece>& pieces) {
  samples_.resize(number_instants(pieces, first_));
  const std::size_t most = kFlankPairs * samples_.size();
  if (geometries_.size() < most) geometries_.resize(most);
  gathered_.resize_for_overwrite(kGatheredRows, most);
  Instant at;
  int n = 0, count = 0;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const OrbitPiece& p = pieces[i];
    for (int part = n - first_[i]; part < 3; ++part, ++n) {
      Sample& place = samples_[n];
      place.first = count;
      visit_flanks(system_, grid, p, part, at,
                   [&](int k, const FlankKinematics& flank, const ContactConditions& c) {
                     const FlankMotion& motion = at.motion[k];
                     gathered_[kGatheredLoad][count] = c.load;
                     gathered_[kGatheredPinionX][count] = c.velocity_1_x;
                     gathered_[kGatheredPinionY][count] = c.velocity_1_y;
                     gathered_[kGatheredGearX][count] = c.velocity_2_x;
                     gathered_[kGatheredGearY][count] = c.velocity_2_y;
                     gathered_[kGatheredSlidingSpeed][count] = motion.sliding_speed;
                     gathered_[kGatheredPinionArm][count] = motion.pinion_friction_arm;
                     gathered_[kGatheredGearArm][count] = motion.gear_friction_arm;
                     if (p.node >= 0) {
                       geometries_.copy(count, grid.contacts().geometries,
                                        grid.contact(p.node + part, k));
                     } else {
                       geometries_.set(count, flank.radius_x, flank.radius_y);
                     }
                     ++count;
                   });
      place.count = count - place.first;
      place.load = p.regime.load(at.mesh_force);
      place.mesh_force = at.mesh_force;
      place.transmission_error = at.transmission_error;
      place.transmission_velocity = at.transmission_velocity;
    }
  }
  return count;
}

bool OrbitFriction::solve_contacts(const ContactGeometries& geometries, int count) {
  // Without contacts that are solved their figures are 0.
  coefficient_ ? solved_->resize(count) : solved_->resize_for_overwrite(count);
  FlankContactBatchResults results = solved_->results();
  if (coefficient_) {
    for (int i = 0; i < count; ++i)
      results.friction[i] = *coefficient_ * gathered_[kGatheredLoad][i];
    return true;
  }
  if (status_.size() < static_cast<std::size_t>(count)) status_.resize(count);
  results.status = status_.data();
  contacts_.solve(
      geometries, 0, count,
      {gathered_[kGatheredLoad], gathered_[kGatheredPinionX], gathered_[kGatheredPinionY],
       gathered_[kGatheredGearX], gathered_[kGatheredGearY]},
      results, digits_);
  tally_.solutions += count;
  for (int i = 0; i < count && tally_.refusal == ContactStatus::kOk; ++i) {
    tally_.refusal = status_[i];
  }
  return tally_.refusal == ContactStatus::kOk;
}

bool OrbitFriction::evaluate(const MeshGrid& grid, const std::vector<OrbitPiece>& pieces,
                             const Torques& torques, double light, FrozenFriction& friction,
                             OrbitFigures& f) {
  if (!solve_contacts(geometries_, gather(grid, pieces))) return false;
  const double* contact_friction = solved_->friction();
  friction.clear(samples_.size());
  f = {};
  least_pressing_force_ = 1e300;
  double low = 1e300, high = -1e300, squares = 0, time = 0, loss = 0;
  int next = 0;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const OrbitPiece& p = pieces[i];
    const Sample* at = &samples_[first_[i]];
    for (int part = 0; part < 3; ++part) {
      const Sample& place = at[part];
      if (first_[i] + part == next) {
        ++next;
        struct {
          double pinion_friction_torque = 0, gear_friction_torque = 0, loss_power = 0;
        } sums;
        for (int n = place.first; n < place.first + place.count; ++n) {
          add_flank_friction(gathered_[kGatheredPinionArm][n], gathered_[kGatheredGearArm][n],
                             gathered_[kGatheredSlidingSpeed][n], contact_friction[n], sums);
        }
        loss = sums.loss_power;
        // Across a gap it goes from the value before to that after: no jump where a flank meets.
        if (place.load > light) {
          friction.add(
              p.phase + 0.5 * part * p.length,
              {sums.pinion_friction_torque / place.load, sums.gear_friction_torque / place.load},
              place.load);
        }
      }
      if (p.regime.side != 0) {
        least_pressing_force_ = std::min(least_pressing_force_, p.regime.side * place.mesh_force);
      }
      const double* state = states(p)[part];
      const double duration =
          p.length * (part == 1 ? 4 : 1) / 6 * system_.cycle_angle() / state[kPinionSpeed];
      const double share =
          loss / system_.input_speed(torques, state[kPinionShaftSpeed], state[kWheelSpeed]);
      f.loss_energy += duration * loss;
      squares += duration * share * share;
      time += duration;
    }
    for (int part = 0; part < 2; ++part) {
      add_cubic_extremes(at[part].transmission_error, at[part].transmission_velocity,
                         at[part + 1].transmission_error, at[part + 1].transmission_velocity,
                         states(p)[part + 1][kTime] - states(p)[part][kTime], low, high);
    }
  }
  f.loss_rms = std::sqrt(squares / time);
  f.dte_minimum = low;
  f.dte_maximum = high;
  return true;
}

bool OrbitFriction::evaluate(const StepBlock& block, const GridContacts& contacts,
                             const CycleResponse& response, FrozenFriction& friction,
                             OrbitFigures& f) {
  const auto count = static_cast<int>(contacts.node.size());
  gathered_.resize_for_overwrite(kGatheredRows, contacts.node.size());
  gather_contact_conditions(instruction_set(), block, contacts, response, gathered_);
  if (!solve_contacts(contacts.geometries, count)) return false;
  const double* contact_friction = solved_->friction();
  friction.clear(contacts.first.size());
  f = {};
  least_pressing_force_ = 1e300;
  const int last = 2 * block.grid.steps();
  const double per_width = static_cast<double>(last) / contacts.stride;
  double low = 1e300, high = -1e300, squares = 0, time = 0;
  for (int place = 0, node = 0; node <= last; ++place, node += contacts.stride) {
    const Columns& at = node % 2 == 0 ? response.start : response.middle;
    const int lane = node / 2;
    double loss = 0;
    FrictionArms torque;
    for (int n = contacts.first[place]; n < contacts.first[place + 1]; ++n) {
      torque.pinion += gathered_[kGatheredPinionArm][n] * contact_friction[n];
      torque.gear += gathered_[kGatheredGearArm][n] * contact_friction[n];
      loss += gathered_[kGatheredSlidingSpeed][n] * contact_friction[n];
    }
    const double load = block.side * at[kMeshForceRow][lane];
    const double per_load = 1 / load;
    friction.add_evenly(static_cast<double>(node) / last,
                        {torque.pinion * per_load, torque.gear * per_load}, load, per_width);
    least_pressing_force_ = std::min(least_pressing_force_, load);
    // By Simpson's rule, or by trapezoids where there are no middles.
    const double inside = contacts.stride == 2 ? 6 : node % 2 == 0 ? 2 : 4;
    const double weight = node == 0 || node == last ? (contacts.stride == 2 ? 3 : 1) : inside;
    const double duration = weight / (3 * last) * system_.cycle_angle() / at[kPinionSpeed][lane];
    const double share = loss / system_.input_speed(block.torques, at[kPinionShaftSpeed][lane],
                                                    at[kWheelSpeed][lane]);
    f.loss_energy += duration * loss;
    squares += duration * share * share;
    time += duration;
    if (node == last) break;
    const int next_node = node + contacts.stride;
    const Columns& next = next_node % 2 == 0 ? response.start : response.middle;
    const int to = next_node / 2;
    add_cubic_extremes(at[kTransmissionErrorRow][lane], at[kTransmissionVelocityRow][lane],
                       next[kTransmissionErrorRow][to], next[kTransmissionVelocityRow][to],
                       next[kTime][to] - at[kTime][lane], low, high);
  }
  f.loss_rms = std::sqrt(squares / time);
  f.dte_minimum = low;
  f.dte_maximum = high;
  return true;
}

}  // namespace tribodyn
