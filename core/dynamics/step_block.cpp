// Compiled once per instruction set by foreach_target.h, each time inside a namespace of its own.
// NOLINTBEGIN(bugprone-suspicious-include,misc-redundant-expression)
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SSE4 | HWY_AVX3_DL)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/dynamics/step_block.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h.
#include <hwy/highway.h>

#include "core/numerics/dispatch.h"
#include "core/numerics/pack-inl.h"
#include "core/numerics/row-inl.h"
// NOLINTEND(bugprone-suspicious-include,misc-redundant-expression)

#include <algorithm>

#include "core/dynamics/step_block.h"

HWY_BEFORE_NAMESPACE();
namespace tribodyn {
namespace HWY_NAMESPACE {
namespace {

/// Places of time and of what moves with a driveline, and which component each is. Derivatives have
/// as many columns: the states but time, then the unknown torque.
struct Shafts {
  enum : int {
    kTime,
    kPinionShaftTwist,
    kWinding,
    kGearShaftTwist,
    kPinionShaftSpeed,
    kPinionSpeed,
    kGearSpeed,
    kWheelSpeed,
    kStates
  };
  static constexpr Driveline kDriveline = Driveline::kElasticShafts;
  static constexpr int component(int place) { return place; }
};
struct NoShafts {
  enum : int { kTime, kWinding, kPinionSpeed, kGearSpeed, kStates };
  static constexpr Driveline kDriveline = Driveline::kConstantTorques;
  static constexpr int component(int place) {
    constexpr int kComponents[kStates] = {tribodyn::kTime, tribodyn::kWinding,
                                          tribodyn::kPinionSpeed, tribodyn::kGearSpeed};
    return kComponents[place];
  }
};
template <class Train>
constexpr bool has_shafts() {
  return Train::kDriveline == Driveline::kElasticShafts;
}

/// What all lanes share.
struct Constants {
  explicit Constants(const StepBlock& block)
      : pinion_shaft_inertia(1 / block.system.dynamics().pinion_shaft_inertia),
        pinion_inertia(1 / block.system.dynamics().pinion_inertia),
        gear_inertia(1 / block.system.dynamics().gear_inertia),
        wheel_inertia(1 / block.system.dynamics().wheel_inertia),
        pinion_shaft_stiffness(block.system.dynamics().pinion_shaft_stiffness),
        pinion_shaft_damping(block.system.dynamics().pinion_shaft_damping),
        gear_shaft_stiffness(block.system.dynamics().gear_shaft_stiffness),
        gear_shaft_damping(block.system.dynamics().gear_shaft_damping),
        mesh_damping(block.system.dynamics().mesh_damping),
        pinion_torque(block.system.torques().pinion),
        wheel_torque(block.system.torques().wheel),
        pinion_radius(block.system.mesh().mean_pinion_contact_radius()),
        gear_radius(block.system.mesh().mean_gear_contact_radius()),
        lag_per_winding(block.system.mesh().gear_teeth() / gear_radius),
        backlash((1 - block.side) * block.system.dynamics().half_backlash),
        cycle_angle(block.system.cycle_angle()),
        reach(block.grid.series_reach()),
        side(block.side),
        energy_consistent(block.system.options().energy_consistent),
        solve_wheel_torque(block.solve_wheel_torque) {}

  double pinion_shaft_inertia, pinion_inertia, gear_inertia, wheel_inertia;  // inverse
  double pinion_shaft_stiffness, pinion_shaft_damping, gear_shaft_stiffness, gear_shaft_damping;
  double mesh_damping, pinion_torque, wheel_torque, pinion_radius, gear_radius;
  double lag_per_winding;
  double backlash;  // from x to the deflection of the touching flanks
  double cycle_angle, reach, side;
  bool energy_consistent, solve_wheel_torque;
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
template <class Train>
HWY_INLINE void mechanics(const Constants& c, const Phase& phase, const Pack* y, PackMechanics& m,
                          Mask& good) {
  const Pack x = less_product(c.lag_per_winding, y[Train::kWinding], phase[kOffsetRow]);
  good = good & (size(x) <= c.reach);
  const Pack x2 = x * x, x4 = x2 * x2;
  m.pinion_radius = phase[kPinionRadiusRow];
  m.gear_radius = series(phase, 0, x, x2, x4);
  m.relative_radius = m.pinion_radius - phase[kErrorSlopeRow];
  m.stiffness = phase[kStiffnessRow];
  // x - b
  const Pack beyond = y[Train::kWinding] + series(phase, 1, x, x2, x4) - phase[kErrorRow];
  m.deflection = beyond + c.backlash;
  m.transmission_error = beyond;
  m.velocity =
      less_product(m.gear_radius, y[Train::kGearSpeed], m.relative_radius * y[Train::kPinionSpeed]);
  m.force = fused(m.stiffness, m.deflection, c.mesh_damping * m.velocity);
}

/// Eqs 1-4 by phase.
template <class Train>
HWY_INLINE void rates(const Constants& c, const Phase& phase, const PackMechanics& m, const Pack* y,
                      Pack* dy) {
  const Pack pressing = greatest(c.side * m.force, 0);
  Pack pinion_shaft = c.pinion_torque, gear_shaft = c.wheel_torque;
  if constexpr (has_shafts<Train>()) {
    pinion_shaft =
        fused(c.pinion_shaft_stiffness, y[Train::kPinionShaftTwist],
              c.pinion_shaft_damping * (y[Train::kPinionShaftSpeed] - y[Train::kPinionSpeed]));
    gear_shaft = fused(c.gear_shaft_stiffness, y[Train::kGearShaftTwist],
                       c.gear_shaft_damping * (y[Train::kGearSpeed] - y[Train::kWheelSpeed]));
  }
  Pack pinion = fused(phase.torque(kPinionFrictionRow), pressing,
                      less_product(m.pinion_radius, m.force, pinion_shaft));
  if (c.energy_consistent) {
    pinion = fused(m.force, phase[kErrorSlopeRow], pinion);
    pinion = less_product(0.5 * phase[kStiffnessSlopeRow], square(m.deflection), pinion);
  }
  const Pack gear =
      fused(phase.torque(kGearFrictionRow), pressing, fused(m.gear_radius, m.force, -gear_shaft));
  const Pack time = c.cycle_angle / y[Train::kPinionSpeed];
  dy[Train::kTime] = time;
  dy[Train::kWinding] = time * less_product(c.gear_radius, y[Train::kGearSpeed],
                                            c.pinion_radius * y[Train::kPinionSpeed]);
  dy[Train::kPinionSpeed] = time * (pinion * c.pinion_inertia);
  dy[Train::kGearSpeed] = time * (gear * c.gear_inertia);
  if constexpr (has_shafts<Train>()) {
    dy[Train::kPinionShaftTwist] = time * (y[Train::kPinionShaftSpeed] - y[Train::kPinionSpeed]);
    dy[Train::kGearShaftTwist] = time * (y[Train::kGearSpeed] - y[Train::kWheelSpeed]);
    dy[Train::kPinionShaftSpeed] =
        time * ((c.pinion_torque - pinion_shaft) * c.pinion_shaft_inertia);
    dy[Train::kWheelSpeed] = time * ((gear_shaft - c.wheel_torque) * c.wheel_inertia);
  }
}

/// Of one Runge-Kutta stage, what its derivatives need.
template <class Train>
struct Stage {
  Pack relative_radius, gear_radius, stiffness, time, per_speed, deflection;
  Pack pinion_arm, gear_arm;  // of the force: d torque/d force
  Pack stiffness_slope;
  Pack rate[Train::kStates];
};

template <class Train>
HWY_INLINE void keep_stage(const Constants& c, const Phase& phase, const PackMechanics& m,
                           const Pack* y, const Pack* dy, Stage<Train>& out) {
  const Pack by_force = where(c.side * m.force > 0, c.side);
  out.relative_radius = m.relative_radius;
  out.gear_radius = m.gear_radius;
  out.stiffness = m.stiffness;
  out.time = dy[Train::kTime];
  out.per_speed = 1 / y[Train::kPinionSpeed];
  out.deflection = m.deflection;
  out.pinion_arm = fused(by_force, phase.torque(kPinionFrictionRow), -m.pinion_radius);
  out.gear_arm = fused(by_force, phase.torque(kGearFrictionRow), m.gear_radius);
  if (c.energy_consistent) {
    out.pinion_arm = out.pinion_arm + phase[kErrorSlopeRow];
    out.stiffness_slope = phase[kStiffnessSlopeRow];
  }
  for (int i = 0; i < Train::kStates; ++i) out.rate[i] = dy[i];
}

/// As FixedStepMarch::sensitivity_rates, of one column.
template <class Train>
HWY_INLINE void derivative_rates(const Constants& c, const Stage<Train>& at, int column,
                                 const Pack* s, Pack* ds) {
  const Pack velocity = less_product(at.gear_radius, s[Train::kGearSpeed],
                                     at.relative_radius * s[Train::kPinionSpeed]);
  const Pack force = fused(at.stiffness, s[Train::kWinding], c.mesh_damping * velocity);
  const bool by_torque = column == Train::kStates - 1;
  Pack pinion_shaft = by_torque && !c.solve_wheel_torque ? 1 : 0;
  Pack gear_shaft = by_torque && c.solve_wheel_torque ? 1 : 0;
  if constexpr (has_shafts<Train>()) {
    pinion_shaft =
        fused(c.pinion_shaft_stiffness, s[Train::kPinionShaftTwist],
              c.pinion_shaft_damping * (s[Train::kPinionShaftSpeed] - s[Train::kPinionSpeed]));
    gear_shaft = fused(c.gear_shaft_stiffness, s[Train::kGearShaftTwist],
                       c.gear_shaft_damping * (s[Train::kGearSpeed] - s[Train::kWheelSpeed]));
  }
  Pack pinion = fused(at.pinion_arm, force, pinion_shaft);
  if (c.energy_consistent) {
    pinion = less_product(at.stiffness_slope * at.deflection, s[Train::kWinding], pinion);
  }
  const Pack gear = fused(at.gear_arm, force, -gear_shaft);
  ds[Train::kTime] = 0;
  ds[Train::kWinding] =
      less_product(c.gear_radius, s[Train::kGearSpeed], c.pinion_radius * s[Train::kPinionSpeed]);
  ds[Train::kPinionSpeed] = c.pinion_inertia * pinion;
  ds[Train::kGearSpeed] = c.gear_inertia * gear;
  if constexpr (has_shafts<Train>()) {
    ds[Train::kPinionShaftTwist] = s[Train::kPinionShaftSpeed] - s[Train::kPinionSpeed];
    ds[Train::kGearShaftTwist] = s[Train::kGearSpeed] - s[Train::kWheelSpeed];
    ds[Train::kPinionShaftSpeed] = -c.pinion_shaft_inertia * pinion_shaft;
    ds[Train::kWheelSpeed] = c.wheel_inertia * gear_shaft;
    if (by_torque && c.solve_wheel_torque) {
      ds[Train::kWheelSpeed] = ds[Train::kWheelSpeed] - c.wheel_inertia;
    } else if (by_torque) {
      ds[Train::kPinionShaftSpeed] = ds[Train::kPinionShaftSpeed] + c.pinion_shaft_inertia;
    }
  }
  const Pack faster = s[Train::kPinionSpeed] * at.per_speed;
  for (int i = 0; i < Train::kStates; ++i) {
    ds[i] = less_product(at.rate[i], faster, at.time * ds[i]);
  }
}

constexpr double kNode[4] = {0, 0.5, 0.5, 1};
constexpr double kWeight[4] = {1.0 / 6, 1.0 / 3, 1.0 / 3, 1.0 / 6};

template <class Train>
void differentiate(const Constants& c, const Stage<Train>* stages, double h, int lane,
                   Columns& out) {
  constexpr int kStates = Train::kStates;
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

template <class Train>
bool steps_of(const StepBlock& block, const CycleResponse& response, Columns& end,
              Columns* derivatives) {
  constexpr int kStates = Train::kStates;
  const Constants c(block);
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
    y[Train::kTime] = sum[Train::kTime] = 0;
    for (int i = 1; i < kStates; ++i) {
      sum[i] = y[i] = load_any(response.start[Train::component(i)] + lane);
    }
    Stage<Train> stages[4];
    Mask good = ~nowhere();
    for (int n = 0; n < 4; ++n) {
      for (int i = 0; i < kStates; ++i) {
        stage[i] = n == 0 ? y[i] : fused(kNode[n] * h, rate[i], y[i]);
      }
      PackMechanics m;
      mechanics<Train>(c, *phases[n], stage, m, good);
      rates<Train>(c, *phases[n], m, stage, rate);
      if (derivatives != nullptr) keep_stage(c, *phases[n], m, stage, rate, stages[n]);
      for (int i = 0; i < kStates; ++i) sum[i] = fused(kWeight[n] * h, rate[i], sum[i]);
    }
    for (int i = 0; i < kStates; ++i) {
      good = good & (size(sum[i]) < 1e100);
      store_any(sum[i], end[Train::component(i)] + lane);
    }
    good = good & (sum[Train::kPinionSpeed] > 0);
    all_good = all_good && all(good | beyond(lane, steps));
    if (derivatives != nullptr) differentiate(c, stages, h, lane, *derivatives);
  }
  return all_good;
}

template <class Train>
bool fill_of(const StepBlock& block, CycleResponse& response) {
  constexpr int kStates = Train::kStates;
  const Constants c(block);
  const MeshGrid::MeshColumns& mesh = block.grid.mesh_columns(block.side);
  const int steps = block.grid.steps();
  const double h = 1.0 / steps;
  const double half_backlash = block.system.dynamics().half_backlash;
  Columns& rate = response.rate;
  bool all_good = true;
  const auto fill = [&](const Phase& phase, int lane, Columns& to, Pack* y, Mask good) HWY_ATTR {
    PackMechanics m;
    mechanics<Train>(c, phase, y, m, good);
    store_any(m.force, to[kMeshForceRow] + lane);
    store_any(m.transmission_error + half_backlash, to[kTransmissionErrorRow] + lane);
    store_any(m.velocity, to[kTransmissionVelocityRow] + lane);
    good = good & (size(m.force) < 1e100) & (y[Train::kPinionSpeed] > 0);
    all_good = all_good && all(good | beyond(lane, steps + (&to == &response.start ? 1 : 0)));
    return m;
  };
  Pack y[kStates];
  for (int lane = 0; lane <= steps; lane += pack_lanes()) {
    const Phase phase{mesh.starts, &block.friction.start, lane};
    for (int i = 0; i < kStates; ++i) y[i] = load_any(response.start[Train::component(i)] + lane);
    const PackMechanics m = fill(phase, lane, response.start, y, ~nowhere());
    Pack dy[kStates];
    rates<Train>(c, phase, m, y, dy);
    for (int i = 0; i < kStates; ++i) store_any(dy[i], rate[Train::component(i)] + lane);
  }
  for (int lane = 0; lane < steps; lane += pack_lanes()) {
    for (int i = 0; i < kStates; ++i) {
      const int component = Train::component(i);
      const double* const at = response.start[component] + lane;
      const double* const slope = rate[component] + lane;
      y[i] = fused(h / 8, load_any(slope) - load_any(slope + 1),
                   0.5 * (load_any(at) + load_any(at + 1)));
      store_any(y[i], response.middle[component] + lane);
    }
    fill({mesh.middles, nullptr, lane}, lane, response.middle, y, ~nowhere());
  }
  for (const int i : states_of(Train::kDriveline).still) {
    std::copy_n(response.start[i], steps, response.middle[i]);
  }
  return all_good;
}

template <class Train>
void compose_of(const Columns& derivatives, CycleDerivatives& out) {
  constexpr int kSize = Train::kStates, kTorque = kSize - 1;
  constexpr std::size_t kMatrix = std::size_t{kSize} * kSize;
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

template <class Train>
void follow_of(const CycleDerivatives& derivatives, const CycleResponse& response,
               const Columns& end, double* particular) {
  constexpr int kSize = Train::kStates;
  std::fill_n(particular, kSize, 0.0);
  double residual[kSize];
  for (int s = 0; s < derivatives.steps; ++s) {
    for (int i = 1; i < kSize; ++i) {
      const int component = Train::component(i);
      residual[i - 1] = end[component][s] - response.start[component][s + 1];
    }
    residual[kSize - 1] = end[tribodyn::kTime][s];
    const double* const matrix = derivatives.step.get() + derivatives.matrix() * s;
    double* const at = particular + kSize * s;
    store_row(add_product<kSize - 1>(matrix, at, load_row<kSize>(residual)), at + kSize);
  }
}

template <class Train>
double add_section_of(const CycleDerivatives& derivatives, const double* section,
                      const double* per_scale, double* particular) {
  constexpr int kSize = Train::kStates;
  const double nothing[kSize] = {};
  const auto scale = load_row<kSize>(per_scale);
  auto largest = load_row<kSize>(nothing);
  for (int s = 0; s <= derivatives.steps; ++s) {
    const double* const matrix = derivatives.from_section.get() + derivatives.matrix() * s;
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

}  // namespace

bool steps_in_lanes(const StepBlock& block, const CycleResponse& response, Columns& end,
                    Columns* derivatives) {
  return block.system.has_shafts() ? steps_of<Shafts>(block, response, end, derivatives)
                                   : steps_of<NoShafts>(block, response, end, derivatives);
}

bool fill_lanes(const StepBlock& block, CycleResponse& response) {
  return block.system.has_shafts() ? fill_of<Shafts>(block, response)
                                   : fill_of<NoShafts>(block, response);
}

void compose_matrices(const Columns& derivatives, CycleDerivatives& out) {
  out.unknowns == Shafts::kStates ? compose_of<Shafts>(derivatives, out)
                                  : compose_of<NoShafts>(derivatives, out);
}

void follow_in_rows(const CycleDerivatives& derivatives, const CycleResponse& response,
                    const Columns& end, double* particular) {
  derivatives.unknowns == Shafts::kStates
      ? follow_of<Shafts>(derivatives, response, end, particular)
      : follow_of<NoShafts>(derivatives, response, end, particular);
}

double add_section_in_rows(const CycleDerivatives& derivatives, const double* section,
                           const double* per_scale, double* particular) {
  return derivatives.unknowns == Shafts::kStates
             ? add_section_of<Shafts>(derivatives, section, per_scale, particular)
             : add_section_of<NoShafts>(derivatives, section, per_scale, particular);
}

void see_in_lanes(const StepBlock& block, const GridContacts& contacts,
                  const CycleResponse& response, Columns& seen) {
  const int count = static_cast<int>(contacts.node.size());
  // What the contacts of a node share, where the contact is.
  for (int i = 0; i < count; ++i) {
    const int node = contacts.node[i];
    const Columns& at = node % 2 == 0 ? response.start : response.middle;
    seen[kSeenLoad][i] = at[kMeshForceRow][node / 2];
    seen[kSeenPinionX][i] = at[kPinionSpeed][node / 2];
    seen[kSeenGearX][i] = at[kGearSpeed][node / 2];
  }
  const ModelOptions& options = block.system.options();
  const double side = block.side;
  for (int i = 0; i < count; i += pack_lanes()) {
    const auto flank = [&](int row) HWY_ATTR { return load_any(contacts.kinematics[row] + i); };
    const auto put = [&](SeenRow row, Pack value) HWY_ATTR { store_any(value, seen[row] + i); };
    const Pack pinion_speed = load_any(seen[kSeenPinionX] + i);
    const Pack gear_speed = load_any(seen[kSeenGearX] + i);
    const Pack pinion_vx = flank(kPinionVelocityXRow), pinion_vy = flank(kPinionVelocityYRow);
    const Pack gear_vx = flank(kGearVelocityXRow), gear_vy = flank(kGearVelocityYRow);
    const Pack pinion_x = pinion_vx * pinion_speed, pinion_y = pinion_vy * pinion_speed;
    const Pack gear_x = gear_vx * gear_speed, gear_y = gear_vy * gear_speed;
    const Pack slide_x = pinion_x - gear_x, slide_y = pinion_y - gear_y;
    const Pack sliding = root(fused(slide_x, slide_x, square(slide_y)));
    put(kSeenLoad, flank(kLoadShareRow) * greatest(side * load_any(seen[kSeenLoad] + i), 0));
    put(kSeenSlidingSpeed, sliding);
    if (options.tabulated_friction_arms) {
      put(kSeenPinionArm, flank(kPinionArmRow));
      put(kSeenGearArm, flank(kGearArmRow));
    } else {
      const Pack per_speed = where(sliding > 0, 1 / sliding);
      put(kSeenPinionArm, -per_speed * fused(slide_x, pinion_vx, slide_y * pinion_vy));
      put(kSeenGearArm, per_speed * fused(slide_x, gear_vx, slide_y * gear_vy));
    }
    Pack drift_x = 0, drift_y = 0;
    if (options.subtract_contact_point_motion) {
      drift_x = flank(kContactPointVelocityXRow) * pinion_speed;
      drift_y = flank(kContactPointVelocityYRow) * pinion_speed;
    }
    put(kSeenPinionX, pinion_x - drift_x);
    put(kSeenPinionY, pinion_y - drift_y);
    put(kSeenGearX, gear_x - drift_x);
    put(kSeenGearY, gear_y - drift_y);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace tribodyn
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tribodyn {
bool take_steps(InstructionSet instruction_set, const StepBlock& block,
                const CycleResponse& response, Columns& end, Columns* derivatives) {
  TRIBODYN_RETURN_WITH(instruction_set, steps_in_lanes, block, response, end, derivatives)
}

bool fill_response(InstructionSet instruction_set, const StepBlock& block,
                   CycleResponse& response) {
  TRIBODYN_RETURN_WITH(instruction_set, fill_lanes, block, response)
}

void compose_steps(InstructionSet instruction_set, const Columns& derivatives,
                   CycleDerivatives& out) {
  TRIBODYN_RETURN_WITH(instruction_set, compose_matrices, derivatives, out)
}

void follow_residuals(InstructionSet instruction_set, const CycleDerivatives& derivatives,
                      const CycleResponse& response, const Columns& end, double* particular) {
  TRIBODYN_RETURN_WITH(instruction_set, follow_in_rows, derivatives, response, end, particular)
}

double add_section_change(InstructionSet instruction_set, const CycleDerivatives& derivatives,
                          const double* section, const double* per_scale, double* particular) {
  TRIBODYN_RETURN_WITH(instruction_set, add_section_in_rows, derivatives, section, per_scale,
                       particular)
}

void see_contacts(InstructionSet instruction_set, const StepBlock& block,
                  const GridContacts& contacts, const CycleResponse& response, Columns& seen) {
  TRIBODYN_RETURN_WITH(instruction_set, see_in_lanes, block, contacts, response, seen)
}

}  // namespace tribodyn
#endif
