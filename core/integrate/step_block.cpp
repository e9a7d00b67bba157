// Compiled once per instruction set by foreach_target.h, each time inside a namespace of its own.
// NOLINTBEGIN(bugprone-suspicious-include,misc-redundant-expression)
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SSE4 | HWY_AVX3_DL)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/integrate/step_block.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h.
#include <hwy/highway.h>

#include "core/driveline/motion-inl.h"
#include "core/gear/flank_motion-inl.h"
#include "core/numerics/dispatch.h"
#include "core/numerics/pack-inl.h"
#include "core/numerics/row-inl.h"
// NOLINTEND(bugprone-suspicious-include,misc-redundant-expression)

#include <algorithm>

#include "core/integrate/runge_kutta.h"
#include "core/integrate/step_block.h"

HWY_BEFORE_NAMESPACE();
namespace tribodyn {
namespace HWY_NAMESPACE {
namespace {

constexpr int kStates =
    kStepUnknowns;                    // time and the seven states; derivatives have as many columns
constexpr int kTorque = kStates - 1;  // column of the unknown torque

/// What all lanes share.
struct Constants {
  const StepBlock& block;
  const MotionConstants& motion = block.system.constants();
  double lag_per_approach = block.system.mesh().gear_teeth() / motion.gear_radius;
  double reach = block.grid.series_reach();
  double side = block.side;
  bool energy_consistent = block.system.options().energy_consistent;
};

/// A phase in the lanes from `lane` on.
struct Phase {
  const Columns& mesh;
  const Columns* friction;
  int lane;
  HWY_INLINE Pack operator[](int row) const { return load_any(mesh[row] + lane); }
  HWY_INLINE Pack torque(FrictionRow row) const { return load_any((*friction)[row] + lane); }
};

/// Two series by Estrin's way: see MeshExpansion::at.
HWY_INLINE Pack series(const Phase& phase, int function, Pack x, Pack x2, Pack x4) {
  const auto term = [&](int k) HWY_ATTR { return phase[kSeriesRow + 2 * k + function]; };
  const auto four = [&](int k) HWY_ATTR {
    return fused(fused(term(k + 3), x, term(k + 2)), x2, fused(term(k + 1), x, term(k)));
  };
  return fused(fused(four(8), x4, four(4)), x4, four(0));
}

/// dR_g/dx by the derivative of its series.
HWY_INLINE Pack gear_radius_slope(const Phase& phase, Pack x) {
  const Pack x2 = x * x, x4 = x2 * x2;
  const auto term = [&](int power)
                        HWY_ATTR { return (power + 1) * phase[kSeriesRow + 2 * (power + 1)]; };
  const auto four = [&](int k) HWY_ATTR {
    return fused(fused(term(k + 3), x, term(k + 2)), x2, fused(term(k + 1), x, term(k)));
  };
  const Pack last = fused(term(10), x2, fused(term(9), x, term(8)));
  return fused(fused(last, x4, four(4)), x4, four(0));
}

/// Where the gear is in its series: from the angle that they are around [rad].
HWY_INLINE Pack series_place(const Constants& c, const Phase& phase, const Pack* y) {
  return less_product(c.lag_per_approach, y[kMeshApproach], phase[kOffsetRow]);
}

/// The mesh functions and the mesh force. Clears `good` where the series do not reach.
HWY_INLINE void mechanics(const Constants& c, const Phase& phase, const Pack* y,
                          MechanicsOf<Pack>& at, Mask& good) {
  const Pack x = series_place(c, phase, y);
  good = good & (size(x) <= c.reach);
  const Pack x2 = x * x, x4 = x2 * x2;
  MeshFunctionsOf<Pack>& m = at.mesh;
  m.pinion_contact_radius = phase[kPinionRadiusRow];
  m.gear_contact_radius = series(phase, 0, x, x2, x4);
  m.radius_integral = series(phase, 1, x, x2, x4);
  m.mesh_stiffness = phase[kStiffnessRow];
  m.mesh_stiffness_slope = phase[kStiffnessSlopeRow];
  m.static_transmission_error = phase[kErrorRow];
  m.static_transmission_error_slope = phase[kErrorSlopeRow];
  set_mesh_force(c.motion, c.side, y, at);
}

HWY_INLINE void rates(const Constants& c, const Phase& phase, const Pack* y, MechanicsOf<Pack>& at,
                      Pack* dy) {
  const Pack load = greatest(c.side * at.mesh_force, 0);
  at.pinion_friction_torque = phase.torque(kPinionFrictionRow) * load;
  at.gear_friction_torque = phase.torque(kGearFrictionRow) * load;
  const ShaftTorques<Pack> shaft = shaft_torques(c.motion, y);
  at.pinion_shaft_torque = shaft.pinion;
  at.gear_shaft_torque = shaft.gear;
  const Torques& torques = c.block.torques;
  motion(c.motion, c.energy_consistent, y, at, torques.pinion, torques.wheel, dy);
}

/// As GearPairSystem::slopes().
HWY_INLINE void set_slopes(const Constants& c, const Phase& phase, const MechanicsOf<Pack>& at,
                           const Pack* y, const Pack* dy, MotionSlopesOf<Pack>& out) {
  const SlopePlace<Pack> place{
      .touches = true,
      .damping = c.motion.mesh_damping,
      .load_by_force = where(c.side * at.mesh_force > 0, c.side),
      .radius_by_approach =
          -c.lag_per_approach * gear_radius_slope(phase, series_place(c, phase, y)),
      .pinion_arm = phase.torque(kPinionFrictionRow),
      .gear_arm = phase.torque(kGearFrictionRow)};
  set_motion_slopes(c.motion, c.energy_consistent, place, at, y, dy, out);
}

void differentiate(const Constants& c, const MotionSlopesOf<Pack>* stages, double h, int lane,
                   Columns& out) {
  for (int column = 0; column < kStates; ++column) {
    Pack s[kStates], ds[kStates], sum[kStates];
    for (int i = 0; i < kStates; ++i) {
      sum[i] = i == column + 1 ? 1 : 0;
      ds[i] = 0;
    }
    for (int n = 0; n < 4; ++n) {
      for (int i = 0; i < kStates; ++i) {
        s[i] = i == column + 1 ? 1 : 0;
        if (n > 0) s[i] = fused(kRungeKuttaNode[n] * h, ds[i], s[i]);
      }
      linear_motion(c.motion, stages[n], s, ds);
      if (column == kTorque && c.block.solve_wheel_torque) {
        ds[kWheelSpeed] = ds[kWheelSpeed] - c.motion.per_wheel_inertia;
      } else if (column == kTorque) {
        ds[kPinionShaftSpeed] = ds[kPinionShaftSpeed] + c.motion.per_pinion_shaft_inertia;
      }
      by_phase(stages[n], s, ds);
      for (int i = 0; i < kStates; ++i) sum[i] = fused(kRungeKuttaWeight[n] * h, ds[i], sum[i]);
    }
    for (int i = 0; i < kStates; ++i) store_any(sum[i], out[kStates * i + column] + lane);
  }
}

/// The last lanes may be beyond the last step; a number there means nothing.
HWY_INLINE Mask beyond(int lane, int steps) {
  alignas(64) double place[kColumnLanes];
  for (int i = 0; i < pack_lanes(); ++i) place[i] = lane + i;
  return load(place) >= static_cast<double>(steps);
}

HWY_INLINE bool all(Mask x) { return !any(~x); }

/// y + the columns of a matrix times the first `kCount` of x.
template <int kCount, int kSize>
HWY_INLINE Row<kSize> add_product(const double* matrix, const double* x, Row<kSize> even) {
  const auto column = [&](int j) HWY_ATTR { return load_row<kSize>(matrix + kSize * j); };
  Row<kSize> odd = 0;
  for (int j = 0; j + 1 < kCount; j += 2) {
    even = fused(x[j], column(j), even);
    odd = fused(x[j + 1], column(j + 1), odd);
  }
  if (kCount % 2 == 1) even = fused(x[kCount - 1], column(kCount - 1), even);
  return even + odd;
}

}  // namespace

bool steps_in_lanes(const StepBlock& block, const CycleResponse& response, Columns& end,
                    Columns* derivatives) {
  const Constants c{block};
  const MeshGrid::MeshColumns& mesh = block.grid.mesh_columns(block.side);
  const int steps = block.grid.steps();
  const double h = 1.0 / steps;
  bool all_good = true;
  for (int lane = 0; lane < steps; lane += pack_lanes()) {
    const Phase start{mesh.starts, &block.friction.start, lane};
    const Phase middle{mesh.middles, &block.friction.middle, lane};
    const Phase last{mesh.starts, &block.friction.start, lane + 1};
    const Phase* const phases[4] = {&start, &middle, &middle, &last};
    Pack y[kStates], sum[kStates], stage[kStates], rate[kStates];
    y[kTime] = sum[kTime] = 0;
    for (int i = 1; i < kStates; ++i) {
      sum[i] = y[i] = load_any(response.start[i] + lane);
    }
    MotionSlopesOf<Pack> stages[4];
    Mask good = ~nowhere();
    for (int n = 0; n < 4; ++n) {
      for (int i = 0; i < kStates; ++i) {
        stage[i] = n == 0 ? y[i] : fused(kRungeKuttaNode[n] * h, rate[i], y[i]);
      }
      MechanicsOf<Pack> at;
      mechanics(c, *phases[n], stage, at, good);
      rates(c, *phases[n], stage, at, rate);
      if (derivatives != nullptr) set_slopes(c, *phases[n], at, stage, rate, stages[n]);
      for (int i = 0; i < kStates; ++i) sum[i] = fused(kRungeKuttaWeight[n] * h, rate[i], sum[i]);
    }
    for (int i = 0; i < kStates; ++i) {
      good = good & (size(sum[i]) < 1e100);
      store_any(sum[i], end[i] + lane);
    }
    good = good & (sum[kPinionSpeed] > 0);
    all_good = all_good && all(good | beyond(lane, steps));
    if (derivatives != nullptr) differentiate(c, stages, h, lane, *derivatives);
  }
  return all_good;
}

bool fill_lanes(const StepBlock& block, CycleResponse& response) {
  const Constants c{block};
  const MeshGrid::MeshColumns& mesh = block.grid.mesh_columns(block.side);
  const int steps = block.grid.steps();
  const double h = 1.0 / steps;
  Columns& rate = response.rate;
  bool all_good = true;
  const auto fill = [&](const Phase& phase, int lane, Columns& to, Pack* y, Mask good) HWY_ATTR {
    MechanicsOf<Pack> at;
    mechanics(c, phase, y, at, good);
    store_any(at.mesh_force, to[kMeshForceRow] + lane);
    store_any(at.transmission_error, to[kTransmissionErrorRow] + lane);
    store_any(at.transmission_velocity, to[kTransmissionVelocityRow] + lane);
    good = good & (size(at.mesh_force) < 1e100) & (y[kPinionSpeed] > 0);
    all_good = all_good && all(good | beyond(lane, steps + (&to == &response.start ? 1 : 0)));
    return at;
  };
  Pack y[kStates];
  for (int lane = 0; lane <= steps; lane += pack_lanes()) {
    const Phase phase{mesh.starts, &block.friction.start, lane};
    for (int i = 0; i < kStates; ++i) y[i] = load_any(response.start[i] + lane);
    MechanicsOf<Pack> at = fill(phase, lane, response.start, y, ~nowhere());
    Pack dy[kStates];
    rates(c, phase, y, at, dy);
    for (int i = 0; i < kStates; ++i) store_any(dy[i], rate[i] + lane);
  }
  for (int lane = 0; lane < steps; lane += pack_lanes()) {
    for (int i = 0; i < kStates; ++i) {
      const double* const at = response.start[i] + lane;
      const double* const slope = rate[i] + lane;
      y[i] = fused(h / 8, load_any(slope) - load_any(slope + 1),
                   0.5 * (load_any(at) + load_any(at + 1)));
      store_any(y[i], response.middle[i] + lane);
    }
    fill({mesh.middles, nullptr, lane}, lane, response.middle, y, ~nowhere());
  }
  return all_good;
}

void compose_matrices(const Columns& derivatives, CycleDerivatives& out) {
  constexpr int kSize = kStates;
  constexpr std::size_t kMatrix = CycleDerivatives::kMatrix;
  const double nothing[kSize] = {};
  for (int j = 0; j < kSize; ++j) {
    double* const column = out.from_section.get() + kSize * j;
    for (int i = 0; i < kSize; ++i) column[i] = i == j && j < kTorque ? 1 : 0;
  }
  for (int s = 0; s < out.steps; ++s) {
    double* const step = out.step.get() + kMatrix * s;
    for (int j = 0; j < kSize; ++j) {
      for (int i = 0; i + 1 < kSize; ++i) {
        step[kSize * j + i] = derivatives[kSize * (i + 1) + j][s];
      }
      step[kSize * j + kSize - 1] = derivatives[j][s];
    }
    const double* const from = out.from_section.get() + kMatrix * s;
    double* const to = out.from_section.get() + kMatrix * (s + 1);
    for (int j = 0; j < kSize; ++j) {
      const auto direct = load_row<kSize>(j == kTorque ? step + kSize * kTorque : nothing);
      store_row(add_product<kTorque>(step, from + kSize * j, direct), to + kSize * j);
    }
  }
}

void condense_in_rows(const CycleDerivatives& derivatives, const CycleResponse& response,
                      const Columns& end, double* particular) {
  constexpr int kSize = kStates;
  std::fill_n(particular, kSize, 0.0);
  double residual[kSize];
  for (int s = 0; s < derivatives.steps; ++s) {
    for (int i = 1; i < kSize; ++i) {
      residual[i - 1] = end[i][s] - response.start[i][s + 1];
    }
    residual[kSize - 1] = end[kTime][s];
    const double* const matrix = derivatives.step.get() + CycleDerivatives::kMatrix * s;
    double* const at = particular + kSize * s;
    store_row(add_product<kSize - 1>(matrix, at, load_row<kSize>(residual)), at + kSize);
  }
}

double expand_in_rows(const CycleDerivatives& derivatives, const double* section,
                      const double* per_scale, double* particular) {
  constexpr int kSize = kStates;
  const double nothing[kSize] = {};
  const auto scale = load_row<kSize>(per_scale);
  auto largest = load_row<kSize>(nothing);
  for (int s = 0; s <= derivatives.steps; ++s) {
    const double* const matrix = derivatives.from_section.get() + CycleDerivatives::kMatrix * s;
    double* const at = particular + kSize * s;
    const auto sum = add_product<kSize>(matrix, section, load_row<kSize>(at));
    store_row(sum, at);
    for (int k = 0; k < sum.kParts; ++k) {
      largest.v[k] = hn::Max(largest.v[k], hn::Abs(hn::Mul(sum.v[k], scale.v[k])));
    }
  }
  double found[kSize];
  store_row(largest, found);
  return *std::max_element(found, found + kSize);
}

void gather_in_lanes(const StepBlock& block, const GridContacts& contacts,
                     const CycleResponse& response, Columns& conditions) {
  const int count = static_cast<int>(contacts.node.size());
  // What the contacts of a node share, where the contact is.
  for (int i = 0; i < count; ++i) {
    const int node = contacts.node[i];
    const Columns& at = node % 2 == 0 ? response.start : response.middle;
    conditions[kGatheredLoad][i] = at[kMeshForceRow][node / 2];
    conditions[kGatheredPinionX][i] = at[kPinionSpeed][node / 2];
    conditions[kGatheredGearX][i] = at[kGearSpeed][node / 2];
  }
  const ModelOptions& options = block.system.options();
  for (int i = 0; i < count; i += pack_lanes()) {
    const auto flank = [&](int row) HWY_ATTR { return load_any(contacts.kinematics[row] + i); };
    const auto put = [&](GatheredRow row, Pack value)
                         HWY_ATTR { store_any(value, conditions[row] + i); };
    const FlankKinematicsOf<Pack> kinematics{
        .load_share = flank(kLoadShareRow),
        .radius_x = 0,  // with the geometries of the contacts
        .radius_y = 0,
        .pinion_velocity_x = flank(kPinionVelocityXRow),
        .pinion_velocity_y = flank(kPinionVelocityYRow),
        .gear_velocity_x = flank(kGearVelocityXRow),
        .gear_velocity_y = flank(kGearVelocityYRow),
        .contact_point_velocity_x = flank(kContactPointVelocityXRow),
        .contact_point_velocity_y = flank(kContactPointVelocityYRow),
        .pinion_friction_arm = flank(kPinionArmRow),
        .gear_friction_arm = flank(kGearArmRow)};
    const Pack pinion_speed = load_any(conditions[kGatheredPinionX] + i);
    FlankMotionOf<Pack> motion;
    set_flank_motion(kinematics, pinion_speed, load_any(conditions[kGatheredGearX] + i),
                     options.tabulated_friction_arms, motion);
    put(kGatheredLoad,
        kinematics.load_share * greatest(block.side * load_any(conditions[kGatheredLoad] + i), 0));
    put(kGatheredSlidingSpeed, motion.sliding_speed);
    put(kGatheredPinionArm, motion.pinion_friction_arm);
    put(kGatheredGearArm, motion.gear_friction_arm);
    if (options.subtract_contact_point_motion) subtract_drift(kinematics, pinion_speed, motion);
    put(kGatheredPinionX, motion.pinion_x);
    put(kGatheredPinionY, motion.pinion_y);
    put(kGatheredGearX, motion.gear_x);
    put(kGatheredGearY, motion.gear_y);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace tribodyn
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tribodyn {
bool rk4_steps(InstructionSet instruction_set, const StepBlock& block,
               const CycleResponse& response, Columns& end, Columns* derivatives) {
  TRIBODYN_RETURN_WITH(instruction_set, steps_in_lanes, block, response, end, derivatives)
}

bool complete_midpoints(InstructionSet instruction_set, const StepBlock& block,
                        CycleResponse& response) {
  TRIBODYN_RETURN_WITH(instruction_set, fill_lanes, block, response)
}

void compose_derivatives(InstructionSet instruction_set, const Columns& derivatives,
                         CycleDerivatives& out) {
  TRIBODYN_RETURN_WITH(instruction_set, compose_matrices, derivatives, out)
}

void condense_residuals(InstructionSet instruction_set, const CycleDerivatives& derivatives,
                        const CycleResponse& response, const Columns& end, double* particular) {
  TRIBODYN_RETURN_WITH(instruction_set, condense_in_rows, derivatives, response, end, particular)
}

double expand_section_update(InstructionSet instruction_set, const CycleDerivatives& derivatives,
                             const double* section, const double* per_scale, double* particular) {
  TRIBODYN_RETURN_WITH(instruction_set, expand_in_rows, derivatives, section, per_scale, particular)
}

void gather_contact_conditions(InstructionSet instruction_set, const StepBlock& block,
                               const GridContacts& contacts, const CycleResponse& response,
                               Columns& conditions) {
  TRIBODYN_RETURN_WITH(instruction_set, gather_in_lanes, block, contacts, response, conditions)
}

}  // namespace tribodyn
#endif
