// Compiled once per instruction set by foreach_target.h, each time inside a namespace of its own.
// NOLINTBEGIN(bugprone-suspicious-include,misc-redundant-expression)
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SSE4 | HWY_AVX3_DL)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/integrate/step_block.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h.
#include <hwy/highway.h>

#include "core/numerics/dispatch.h"
#include "core/numerics/pack-inl.h"
#include "core/numerics/row-inl.h"
// NOLINTEND(bugprone-suspicious-include,misc-redundant-expression)

#include <algorithm>

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
  const DrivelineDynamics& dynamics = block.system.dynamics();
  const MeshData& mesh = block.system.mesh();
  double pinion_shaft_inertia = 1 / dynamics.pinion_shaft_inertia;  // these four inverse
  double pinion_inertia = 1 / dynamics.pinion_inertia;
  double gear_inertia = 1 / dynamics.gear_inertia;
  double wheel_inertia = 1 / dynamics.wheel_inertia;
  double pinion_shaft_stiffness = dynamics.pinion_shaft_stiffness;
  double pinion_shaft_damping = dynamics.pinion_shaft_damping;
  double gear_shaft_stiffness = dynamics.gear_shaft_stiffness;
  double gear_shaft_damping = dynamics.gear_shaft_damping;
  double mesh_damping = dynamics.mesh_damping;
  double pinion_torque = block.torques.pinion;
  double wheel_torque = block.torques.wheel;
  double pinion_radius = mesh.mean_pinion_contact_radius();
  double gear_radius = mesh.mean_gear_contact_radius();
  double lag_per_approach = mesh.gear_teeth() / gear_radius;
  // From x to the deflection of the touching flanks.
  double backlash = (1 - block.side) * dynamics.half_backlash;
  double cycle_angle = block.system.cycle_angle();
  double reach = block.grid.series_reach();
  double side = block.side;
  bool energy_consistent = block.system.options().energy_consistent;
  bool solve_wheel_torque = block.solve_wheel_torque;
};

/// A phase in the lanes from `lane` on.
struct Phase {
  const Columns& mesh;
  const Columns* friction;
  int lane;
  HWY_INLINE Pack operator[](int row) const { return load_any(mesh[row] + lane); }
  HWY_INLINE Pack torque(FrictionRow row) const { return load_any((*friction)[row] + lane); }
};

/// As Mechanics, but for half the backlash that the transmission error lacks.
struct PackMechanics {
  Pack pinion_radius, gear_radius, relative_radius;  // the last R_p - e'
  Pack stiffness, transmission_error, velocity, deflection, force;
};

/// Two series by Estrin's way: see MeshExpansion::at.
HWY_INLINE Pack series(const Phase& phase, int function, Pack x, Pack x2, Pack x4) {
  const auto term = [&](int k) HWY_ATTR { return phase[kSeriesRow + 2 * k + function]; };
  const auto four = [&](int k) HWY_ATTR {
    return fused(fused(term(k + 3), x, term(k + 2)), x2, fused(term(k + 1), x, term(k)));
  };
  return fused(fused(four(8), x4, four(4)), x4, four(0));
}

/// Of x and the mesh force. Clears `good` where the series do not reach.
HWY_INLINE void mechanics(const Constants& c, const Phase& phase, const Pack* y, PackMechanics& m,
                          Mask& good) {
  const Pack x = less_product(c.lag_per_approach, y[kMeshApproach], phase[kOffsetRow]);
  good = good & (size(x) <= c.reach);
  const Pack x2 = x * x, x4 = x2 * x2;
  m.pinion_radius = phase[kPinionRadiusRow];
  m.gear_radius = series(phase, 0, x, x2, x4);
  m.relative_radius = m.pinion_radius - phase[kErrorSlopeRow];
  m.stiffness = phase[kStiffnessRow];
  // x - b
  const Pack beyond = y[kMeshApproach] + series(phase, 1, x, x2, x4) - phase[kErrorRow];
  m.deflection = beyond + c.backlash;
  m.transmission_error = beyond;
  m.velocity = less_product(m.gear_radius, y[kGearSpeed], m.relative_radius * y[kPinionSpeed]);
  m.force = fused(m.stiffness, m.deflection, c.mesh_damping * m.velocity);
}

/// Eqs 1-4 by phase.
HWY_INLINE void rates(const Constants& c, const Phase& phase, const PackMechanics& m, const Pack* y,
                      Pack* dy) {
  const Pack pressing = greatest(c.side * m.force, 0);
  const Pack pinion_shaft =
      fused(c.pinion_shaft_stiffness, y[kPinionShaftTwist],
            c.pinion_shaft_damping * (y[kPinionShaftSpeed] - y[kPinionSpeed]));
  const Pack gear_shaft = fused(c.gear_shaft_stiffness, y[kGearShaftTwist],
                                c.gear_shaft_damping * (y[kGearSpeed] - y[kWheelSpeed]));
  Pack pinion = fused(phase.torque(kPinionFrictionRow), pressing,
                      less_product(m.pinion_radius, m.force, pinion_shaft));
  if (c.energy_consistent) {
    pinion = fused(m.force, phase[kErrorSlopeRow], pinion);
    pinion = less_product(0.5 * phase[kStiffnessSlopeRow], square(m.deflection), pinion);
  }
  const Pack gear =
      fused(phase.torque(kGearFrictionRow), pressing, fused(m.gear_radius, m.force, -gear_shaft));
  const Pack time = c.cycle_angle / y[kPinionSpeed];
  dy[kTime] = time;
  dy[kMeshApproach] =
      time * less_product(c.gear_radius, y[kGearSpeed], c.pinion_radius * y[kPinionSpeed]);
  dy[kPinionSpeed] = time * (pinion * c.pinion_inertia);
  dy[kGearSpeed] = time * (gear * c.gear_inertia);
  dy[kPinionShaftTwist] = time * (y[kPinionShaftSpeed] - y[kPinionSpeed]);
  dy[kGearShaftTwist] = time * (y[kGearSpeed] - y[kWheelSpeed]);
  dy[kPinionShaftSpeed] = time * ((c.pinion_torque - pinion_shaft) * c.pinion_shaft_inertia);
  dy[kWheelSpeed] = time * ((gear_shaft - c.wheel_torque) * c.wheel_inertia);
}

/// Of one Runge-Kutta stage, what its derivatives need.
struct Stage {
  Pack relative_radius, gear_radius, stiffness, time, per_speed, deflection;
  Pack pinion_arm, gear_arm;  // of the force: d torque/d force
  Pack stiffness_slope;
  Pack rate[kStates];
};

HWY_INLINE void store_stage(const Constants& c, const Phase& phase, const PackMechanics& m,
                            const Pack* y, const Pack* dy, Stage& out) {
  const Pack by_force = where(c.side * m.force > 0, c.side);
  out.relative_radius = m.relative_radius;
  out.gear_radius = m.gear_radius;
  out.stiffness = m.stiffness;
  out.time = dy[kTime];
  out.per_speed = 1 / y[kPinionSpeed];
  out.deflection = m.deflection;
  out.pinion_arm = fused(by_force, phase.torque(kPinionFrictionRow), -m.pinion_radius);
  out.gear_arm = fused(by_force, phase.torque(kGearFrictionRow), m.gear_radius);
  if (c.energy_consistent) {
    out.pinion_arm = out.pinion_arm + phase[kErrorSlopeRow];
    out.stiffness_slope = phase[kStiffnessSlopeRow];
  }
  for (int i = 0; i < kStates; ++i) out.rate[i] = dy[i];
}

/// The rates of the variational equations, of one column.
HWY_INLINE void derivative_rates(const Constants& c, const Stage& at, int column, const Pack* s,
                                 Pack* ds) {
  const Pack velocity =
      less_product(at.gear_radius, s[kGearSpeed], at.relative_radius * s[kPinionSpeed]);
  const Pack force = fused(at.stiffness, s[kMeshApproach], c.mesh_damping * velocity);
  const Pack pinion_shaft =
      fused(c.pinion_shaft_stiffness, s[kPinionShaftTwist],
            c.pinion_shaft_damping * (s[kPinionShaftSpeed] - s[kPinionSpeed]));
  const Pack gear_shaft = fused(c.gear_shaft_stiffness, s[kGearShaftTwist],
                                c.gear_shaft_damping * (s[kGearSpeed] - s[kWheelSpeed]));
  Pack pinion = fused(at.pinion_arm, force, pinion_shaft);
  if (c.energy_consistent) {
    pinion = less_product(at.stiffness_slope * at.deflection, s[kMeshApproach], pinion);
  }
  const Pack gear = fused(at.gear_arm, force, -gear_shaft);
  ds[kTime] = 0;
  ds[kMeshApproach] = less_product(c.gear_radius, s[kGearSpeed], c.pinion_radius * s[kPinionSpeed]);
  ds[kPinionSpeed] = c.pinion_inertia * pinion;
  ds[kGearSpeed] = c.gear_inertia * gear;
  ds[kPinionShaftTwist] = s[kPinionShaftSpeed] - s[kPinionSpeed];
  ds[kGearShaftTwist] = s[kGearSpeed] - s[kWheelSpeed];
  ds[kPinionShaftSpeed] = -c.pinion_shaft_inertia * pinion_shaft;
  ds[kWheelSpeed] = c.wheel_inertia * gear_shaft;
  if (column == kTorque && c.solve_wheel_torque) {
    ds[kWheelSpeed] = ds[kWheelSpeed] - c.wheel_inertia;
  } else if (column == kTorque) {
    ds[kPinionShaftSpeed] = ds[kPinionShaftSpeed] + c.pinion_shaft_inertia;
  }
  const Pack faster = s[kPinionSpeed] * at.per_speed;
  for (int i = 0; i < kStates; ++i) {
    ds[i] = less_product(at.rate[i], faster, at.time * ds[i]);
  }
}

constexpr double kNode[4] = {0, 0.5, 0.5, 1};
constexpr double kWeight[4] = {1.0 / 6, 1.0 / 3, 1.0 / 3, 1.0 / 6};

void differentiate(const Constants& c, const Stage* stages, double h, int lane, Columns& out) {
  for (int column = 0; column < kStates; ++column) {
    Pack s[kStates], ds[kStates], sum[kStates];
    for (int i = 0; i < kStates; ++i) sum[i] = i == column + 1 ? 1 : 0;
    for (int n = 0; n < 4; ++n) {
      for (int i = 0; i < kStates; ++i) {
        s[i] = i == column + 1 ? 1 : 0;
        if (n > 0) s[i] = fused(kNode[n] * h, ds[i], s[i]);
      }
      derivative_rates(c, stages[n], column, s, ds);
      for (int i = 0; i < kStates; ++i) sum[i] = fused(kWeight[n] * h, ds[i], sum[i]);
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
    Stage stages[4];
    Mask good = ~nowhere();
    for (int n = 0; n < 4; ++n) {
      for (int i = 0; i < kStates; ++i) {
        stage[i] = n == 0 ? y[i] : fused(kNode[n] * h, rate[i], y[i]);
      }
      PackMechanics m;
      mechanics(c, *phases[n], stage, m, good);
      rates(c, *phases[n], m, stage, rate);
      if (derivatives != nullptr) store_stage(c, *phases[n], m, stage, rate, stages[n]);
      for (int i = 0; i < kStates; ++i) sum[i] = fused(kWeight[n] * h, rate[i], sum[i]);
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
  const double half_backlash = block.system.dynamics().half_backlash;
  Columns& rate = response.rate;
  bool all_good = true;
  const auto fill = [&](const Phase& phase, int lane, Columns& to, Pack* y, Mask good) HWY_ATTR {
    PackMechanics m;
    mechanics(c, phase, y, m, good);
    store_any(m.force, to[kMeshForceRow] + lane);
    store_any(m.transmission_error + half_backlash, to[kTransmissionErrorRow] + lane);
    store_any(m.velocity, to[kTransmissionVelocityRow] + lane);
    good = good & (size(m.force) < 1e100) & (y[kPinionSpeed] > 0);
    all_good = all_good && all(good | beyond(lane, steps + (&to == &response.start ? 1 : 0)));
    return m;
  };
  Pack y[kStates];
  for (int lane = 0; lane <= steps; lane += pack_lanes()) {
    const Phase phase{mesh.starts, &block.friction.start, lane};
    for (int i = 0; i < kStates; ++i) y[i] = load_any(response.start[i] + lane);
    const PackMechanics m = fill(phase, lane, response.start, y, ~nowhere());
    Pack dy[kStates];
    rates(c, phase, m, y, dy);
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
                     const CycleResponse& response, Columns& seen) {
  const int count = static_cast<int>(contacts.node.size());
  // What the contacts of a node share, where the contact is.
  for (int i = 0; i < count; ++i) {
    const int node = contacts.node[i];
    const Columns& at = node % 2 == 0 ? response.start : response.middle;
    seen[kGatheredLoad][i] = at[kMeshForceRow][node / 2];
    seen[kGatheredPinionX][i] = at[kPinionSpeed][node / 2];
    seen[kGatheredGearX][i] = at[kGearSpeed][node / 2];
  }
  const ModelOptions& options = block.system.options();
  const double side = block.side;
  for (int i = 0; i < count; i += pack_lanes()) {
    const auto flank = [&](int row) HWY_ATTR { return load_any(contacts.kinematics[row] + i); };
    const auto put = [&](GatheredRow row, Pack value) HWY_ATTR { store_any(value, seen[row] + i); };
    const Pack pinion_speed = load_any(seen[kGatheredPinionX] + i);
    const Pack gear_speed = load_any(seen[kGatheredGearX] + i);
    const Pack pinion_vx = flank(kPinionVelocityXRow), pinion_vy = flank(kPinionVelocityYRow);
    const Pack gear_vx = flank(kGearVelocityXRow), gear_vy = flank(kGearVelocityYRow);
    const Pack pinion_x = pinion_vx * pinion_speed, pinion_y = pinion_vy * pinion_speed;
    const Pack gear_x = gear_vx * gear_speed, gear_y = gear_vy * gear_speed;
    const Pack slide_x = pinion_x - gear_x, slide_y = pinion_y - gear_y;
    const Pack sliding = root(fused(slide_x, slide_x, square(slide_y)));
    put(kGatheredLoad,
        flank(kLoadShareRow) * greatest(side * load_any(seen[kGatheredLoad] + i), 0));
    put(kGatheredSlidingSpeed, sliding);
    if (options.tabulated_friction_arms) {
      put(kGatheredPinionArm, flank(kPinionArmRow));
      put(kGatheredGearArm, flank(kGearArmRow));
    } else {
      const Pack per_speed = where(sliding > 0, 1 / sliding);
      put(kGatheredPinionArm, -per_speed * fused(slide_x, pinion_vx, slide_y * pinion_vy));
      put(kGatheredGearArm, per_speed * fused(slide_x, gear_vx, slide_y * gear_vy));
    }
    Pack drift_x = 0, drift_y = 0;
    if (options.subtract_contact_point_motion) {
      drift_x = flank(kContactPointVelocityXRow) * pinion_speed;
      drift_y = flank(kContactPointVelocityYRow) * pinion_speed;
    }
    put(kGatheredPinionX, pinion_x - drift_x);
    put(kGatheredPinionY, pinion_y - drift_y);
    put(kGatheredGearX, gear_x - drift_x);
    put(kGatheredGearY, gear_y - drift_y);
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
                               Columns& seen) {
  TRIBODYN_RETURN_WITH(instruction_set, gather_in_lanes, block, contacts, response, seen)
}

}  // namespace tribodyn
#endif
