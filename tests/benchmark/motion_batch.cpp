#include "tests/benchmark/motion_batch.h"

#include <algorithm>

#include "core/driveline/gear_pair_motion.h"
#include "core/integrate/mesh_cycle_march.h"

namespace tribodyn {

MotionBatch::MotionBatch(const RivalProblem& problem, std::size_t instants)
    : problem_(problem),
      slots_(instants),
      all_(problem.contacts.model().reduced_modulus(), problem.contacts.model().options(),
           kFlankPairs * instants),
      solved_(all_),
      contacts_(kFlankPairs * instants) {
  const MarchScales scales =
      march_scales(problem.system, problem.torques, problem.mean_pinion_speed);
  for (int i = 0; i < kMarchComponents; ++i) scale_[i] = scales.of(problem.system.mesh(), i);
  torque_scale_ = scales.torque;
  for (auto& column : columns_) column.resize(contacts_.size());
}

void MotionBatch::evaluate(std::span<MotionInstant> instants, const Torques& torques) {
  const GearPairSystem& system = problem_.system;
  std::size_t count = 0;
  for (std::size_t i = 0; i < instants.size(); ++i) {
    MotionInstant& x = instants[i];
    Slot& slot = slots_[i];
    set_phase(i, x.phase);
    x.regime = system.regime_of(x.phase, x.state.data());
    system.mechanics(slot.mesh, x.regime, x.state.data(), x.at);
    const double load = x.regime.load(x.at.mesh_force);
    for (int k = 0; k < kFlankPairs; ++k) {
      if (!(slot.flanks[k].load_share * load > 0)) continue;
      Contact& contact = contacts_[count];
      contact.instant = i;
      const ContactConditions c = system.contact_conditions(
          slot.flanks[k], slot.flanks[k].load_share * load, x.state.data(), contact.motion);
      solved_.copy(count, all_, kFlankPairs * i + static_cast<std::size_t>(k));
      columns_[0][count] = c.load;
      columns_[1][count] = c.velocity_1_x;
      columns_[2][count] = c.velocity_1_y;
      columns_[3][count] = c.velocity_2_x;
      columns_[4][count] = c.velocity_2_y;
      ++count;
    }
  }
  FlankContactBatchResults results;
  results.friction = columns_[5].data();
  problem_.contacts.solve(solved_, 0, count,
                          {columns_[0].data(), columns_[1].data(), columns_[2].data(),
                           columns_[3].data(), columns_[4].data()},
                          results);
  problem_.tally.solutions += static_cast<long>(count);
  for (std::size_t n = 0; n < count; ++n) {
    const FlankMotion& motion = contacts_[n].motion;
    add_flank_friction(motion.pinion_friction_arm, motion.gear_friction_arm, motion.sliding_speed,
                       columns_[5][n], instants[contacts_[n].instant].at);
  }
  for (MotionInstant& x : instants) {
    static_cast<Mechanics&>(scratch_) = x.at;
    system.derivative(x.state.data(), scratch_, torques, x.rate.data());
  }
}

StateMatrix MotionBatch::slopes(const MotionInstant& x) const {
  const GearPairSystem& system = problem_.system;
  const double load = x.regime.load(x.at.mesh_force);
  FrictionArms arms;
  if (load > 0) arms = {x.at.pinion_friction_torque / load, x.at.gear_friction_torque / load};
  MotionSlopes slopes;
  system.slopes(system.at_phase(x.phase), x.regime, x.state.data(), x.at, arms, x.rate.data(),
                slopes);
  StateMatrix out = StateMatrix::Zero();
  for (int j = kTime + 1; j < kStates; ++j) {
    std::array<double, kStates> unit{}, rate;
    unit[j] = scale_[j];
    HWY_NAMESPACE::linear_motion(system.constants(), slopes, unit.data(), rate.data());
    HWY_NAMESPACE::by_phase(slopes, unit.data(), rate.data());
    for (int i = 0; i < kStates; ++i) out(i, j) = rate[i] / scale_[i];
  }
  return out;
}
double MotionBatch::slope_by_torque(const MotionInstant& x) const {
  return x.rate[kTime] * problem_.system.constants().per_pinion_shaft_inertia * torque_scale_ /
         scale_[kTurned];
}

double MotionBatch::scaled_period() const {
  return problem_.system.cycle_angle() / problem_.mean_pinion_speed / scale_[kTime];
}

std::vector<double> MotionBatch::tolerances(double relative) const {
  std::vector<double> out;
  for (const double scale : scale_) out.push_back(relative * scale);
  return out;
}

void MotionBatch::set_phase(std::size_t i, double phase) {
  Slot& slot = slots_[i];
  if (slot.phase == phase) return;
  slot.phase = phase;
  slot.mesh = problem_.system.at_phase(phase);
  const MeshData& mesh = problem_.system.mesh();
  mesh.flanks(mesh.interval_at(phase), phase, slot.flanks);
  for (std::size_t k = 0; k < kFlankPairs; ++k) {
    const FlankKinematics& flank = slot.flanks[k];
    if (flank.load_share > 0) all_.set(kFlankPairs * i + k, flank.radius_x, flank.radius_y);
  }
}

}  // namespace tribodyn
