// Compiled once per instruction set by foreach_target.h, each time inside a namespace of its own.
// NOLINTBEGIN(bugprone-suspicious-include,misc-redundant-expression)
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SSE4 | HWY_AVX3_DL)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/integrate/piece_adjoint.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h.
#include <hwy/highway.h>

#include "core/driveline/motion-inl.h"
#include "core/numerics/dispatch.h"
#include "core/numerics/row-inl.h"
// NOLINTEND(bugprone-suspicious-include,misc-redundant-expression)

#include <cstddef>
#include <utility>

#include "core/integrate/piece_adjoint.h"
#include "core/integrate/runge_kutta.h"

HWY_BEFORE_NAMESPACE();
namespace tribodyn {
namespace HWY_NAMESPACE {
namespace {

constexpr int kRates = kMotionStates;
constexpr int kArms = 4;  // of pinion and gear at the middle, then at the end

/// Derivatives of the figures by what the rates of one instant depend on.
template <int kSize>
struct RatesAdjoint {
  Row<kSize> state[kRates];
  Row<kSize> pinion_arm, gear_arm, pinion_torque, wheel_torque;
};

/// From those by the rates themselves.
template <int kSize>
HWY_INLINE void transpose_rates(const MotionConstants& c, const StageSlopes& at,
                                const Row<kSize>* rate, RatesAdjoint<kSize>& out) {
  using R = Row<kSize>;
  const R pinion = (at.time * c.per_pinion_inertia) * rate[kPinionSpeed];
  const R gear = (at.time * c.per_gear_inertia) * rate[kGearSpeed];
  const R pinion_shaft = (at.time * c.per_pinion_shaft_inertia) * rate[kPinionShaftSpeed];
  const R wheel = (at.time * c.per_wheel_inertia) * rate[kWheelSpeed];
  const R pinion_twisting = at.time * rate[kPinionShaftTwist];
  const R gear_twisting = at.time * rate[kGearShaftTwist];
  const R approach = at.time * rate[kMeshApproach];
  R slower = at.rate[0] * rate[0];
  R slower_2 = at.rate[4] * rate[4];
  for (int i = 1; i < 4; ++i) {
    slower = fused(at.rate[i], rate[i], slower);
    slower_2 = fused(at.rate[i + 4], rate[i + 4], slower_2);
  }
  const R force = fused(at.pinion_arm, pinion, at.gear_arm * gear);
  const R pinion_shaft_torque = pinion - pinion_shaft;
  const R gear_shaft_torque = wheel - gear;
  const R pinion_slip = fused(c.pinion_shaft_damping, pinion_shaft_torque, pinion_twisting);
  const R gear_slip = fused(c.gear_shaft_damping, gear_shaft_torque, gear_twisting);
  out.state[kTime] = R(0);
  out.state[kPinionShaftTwist] = c.pinion_shaft_stiffness * pinion_shaft_torque;
  out.state[kGearShaftTwist] = c.gear_shaft_stiffness * gear_shaft_torque;
  out.state[kPinionShaftSpeed] = pinion_slip;
  out.state[kWheelSpeed] = -1.0 * gear_slip;
  out.state[kMeshApproach] =
      fused(at.force_by_approach, force,
            fused(at.pinion_torque_by_approach, pinion, at.gear_torque_by_approach * gear));
  out.state[kPinionSpeed] =
      fused(at.damping * at.relative_radius, force,
            fused(c.pinion_radius, approach,
                  fused(-at.per_speed, slower + slower_2, -1.0 * pinion_slip)));
  out.state[kGearSpeed] =
      fused(-at.damping * at.gear_radius, force, fused(-c.gear_radius, approach, gear_slip));
  out.pinion_arm = at.load * pinion;
  out.gear_arm = at.load * gear;
  out.pinion_torque = pinion_shaft;
  out.wheel_torque = -1.0 * wheel;
}

/// The end of the step by its arms at the middle and at the end.
HWY_INLINE void step_by_arms(const MotionConstants& c, const PieceSlopes& piece, Row<kArms>* end) {
  const double h = piece.length;
  const double unit[2 * kArms - 1] = {0, 0, 0, 1, 0, 0, 0};
  const auto arm = [&](int n) HWY_ATTR { return load_row<kArms>(unit + 3 - n); };
  Row<kArms> s[kRates], ds[kRates];
  for (int i = 0; i < kRates; ++i) end[i] = ds[i] = Row<kArms>(0);
  for (int n = 1; n < 4; ++n) {
    const StageSlopes& at = *piece.stages[n];
    for (int i = 0; i < kRates; ++i) s[i] = (kRungeKuttaNode[n] * h) * ds[i];
    linear_motion(c, at, s, ds);
    ds[kPinionSpeed] =
        fused(c.per_pinion_inertia * at.load, n < 3 ? arm(0) : arm(2), ds[kPinionSpeed]);
    ds[kGearSpeed] = fused(c.per_gear_inertia * at.load, n < 3 ? arm(1) : arm(3), ds[kGearSpeed]);
    by_phase(at, s, ds);
    for (int i = 0; i < kRates; ++i) end[i] = fused(kRungeKuttaWeight[n] * h, ds[i], end[i]);
  }
}

/// Adds what a row by friction arms does by the states that they follow.
template <int kSize>
HWY_INLINE void add_arms(const std::array<ArmSlopes, 2>& arms, const StageSlopes& at,
                         const Row<kSize>& pinion, const Row<kSize>& gear, Row<kSize>* state) {
  const Row<kSize> force = fused(arms[0][0], pinion, arms[1][0] * gear);
  state[kMeshApproach] = fused(at.force_by_approach, force, state[kMeshApproach]);
  state[kPinionSpeed] = fused(
      arms[0][1], pinion,
      fused(arms[1][1], gear, fused(at.damping * at.relative_radius, force, state[kPinionSpeed])));
  state[kGearSpeed] =
      fused(arms[0][2], pinion,
            fused(arms[1][2], gear, fused(-at.damping * at.gear_radius, force, state[kGearSpeed])));
}

/// What rows by the state at the middle are by the state at the end: the cubic, and through the
/// arms there.
template <int kSize>
HWY_INLINE void add_middle_by_end(const MotionConstants& c, const PieceSlopes& piece,
                                  const Row<kSize>* middle, Row<kSize>* end) {
  RatesAdjoint<kSize> by;
  transpose_rates(c, *piece.parts[2], middle, by);
  add_arms(piece.arm[2], *piece.parts[2], by.pinion_arm, by.gear_arm, by.state);
  const double eighth = piece.length / 8;
  for (int i = 0; i < kRates; ++i) {
    end[i] = fused(0.5, middle[i], fused(-eighth, by.state[i], end[i]));
  }
}

/// Gauss and Jordan with pivots on the diagonal: the matrix is near to 1.
HWY_INLINE void invert(double (&m)[kArms][kArms]) {
  for (int k = 0; k < kArms; ++k) {
    const double pivot = 1 / m[k][k];
    m[k][k] = 1;
    for (double& each : m[k]) each *= pivot;
    for (int i = 0; i < kArms; ++i) {
      if (i == k) continue;
      const double factor = m[i][k];
      m[i][k] = 0;
      for (int j = 0; j < kArms; ++j) m[i][j] -= factor * m[k][j];
    }
  }
}

using Figures = Row<kAdjointLanes>;

HWY_INLINE Figures load_figures(const AdjointRow& from) {
  return load_row<kAdjointLanes>(from.data());
}

/// What the friction arms of a piece do, which follow the states that they change. With dX_1 =
/// S + Q (arms at middle and end) of the end and these arms = N dX_1 + ...: with rows x by X_1,
///   x = rows + (x Q) N  =>  x Q = rows Q (1 - N Q)^-1.
struct ArmFeedback {
  double q[kRates][kArms], n[kRates][kArms];  // of each state, by arm
  double inverse[kArms][kArms];               // of 1 - N Q
};

HWY_INLINE void set_feedback(const MotionConstants& c, const PieceSlopes& piece, ArmFeedback& out) {
  Row<kArms> end_by_arm[kRates];
  step_by_arms(c, piece, end_by_arm);
  for (int i = 0; i < kRates; ++i) store_row(end_by_arm[i], out.q[i]);

  Row<kArms> arm_by_end[kRates], middle_arm[kRates];
  const double unit[2 * kArms - 1] = {0, 0, 0, 1, 0, 0, 0};
  const auto arm = [&](int n) HWY_ATTR { return load_row<kArms>(unit + 3 - n); };
  for (int i = 0; i < kRates; ++i) arm_by_end[i] = middle_arm[i] = Row<kArms>(0);
  add_arms<kArms>(piece.arm[1], *piece.parts[1], arm(0), arm(1), middle_arm);
  add_arms<kArms>(piece.arm[2], *piece.parts[2], arm(2), arm(3), arm_by_end);
  add_middle_by_end<kArms>(c, piece, middle_arm, arm_by_end);
  for (int i = 0; i < kRates; ++i) store_row(arm_by_end[i], out.n[i]);
  for (int a = 0; a < kArms; ++a) {
    for (int b = 0; b < kArms; ++b) {
      double sum = a == b ? 1 : 0;
      for (int i = 1; i < kRates; ++i) sum -= out.n[i][a] * out.q[i][b];
      out.inverse[a][b] = sum;
    }
  }
  invert(out.inverse);
}

HWY_INLINE void back_in_group(const MotionConstants& c, const PieceSlopes& piece,
                              const ArmFeedback& feedback,
                              const std::array<StateAdjoint, 3>* direct, StateAdjoint& state,
                              PieceAdjoint& out) {
  Figures middle[kRates], x[kRates];
  for (int i = 0; i < kRates; ++i) {
    x[i] = load_figures(state[i]);
    middle[i] = Figures(0);
    if (direct == nullptr) continue;
    x[i] = x[i] + load_figures((*direct)[2][i]);
    middle[i] = load_figures((*direct)[1][i]);
  }
  if (direct != nullptr) add_middle_by_end(c, piece, middle, x);
  Figures by_arm[kArms], solved[kArms];
  for (int a = 0; a < kArms; ++a) {
    by_arm[a] = feedback.q[0][a] * x[0];
    for (int i = 1; i < kRates; ++i) by_arm[a] = fused(feedback.q[i][a], x[i], by_arm[a]);
  }
  for (int b = 0; b < kArms; ++b) {
    solved[b] = feedback.inverse[0][b] * by_arm[0];
    for (int a = 1; a < kArms; ++a) solved[b] = fused(feedback.inverse[a][b], by_arm[a], solved[b]);
  }
  for (int i = 1; i < kRates; ++i) {
    for (int a = 0; a < kArms; ++a) x[i] = fused(feedback.n[i][a], solved[a], x[i]);
  }

  // The step, from its last stage to its first.
  const double h = piece.length;
  Figures sum[kRates], rate[kRates];
  RatesAdjoint<kAdjointLanes> by;
  Figures pinion_torque = 0, wheel_torque = 0, arms[3][2];
  for (int i = 0; i < kRates; ++i) sum[i] = x[i];
  for (int stage = 3; stage >= 0; --stage) {
    for (int i = 0; i < kRates; ++i) {
      rate[i] = (kRungeKuttaWeight[stage] * h) * x[i];
      if (stage < 3) rate[i] = fused(kRungeKuttaNode[stage + 1] * h, by.state[i], rate[i]);
    }
    transpose_rates(c, *piece.stages[stage], rate, by);
    for (int i = 0; i < kRates; ++i) sum[i] = sum[i] + by.state[i];
    pinion_torque = pinion_torque + by.pinion_torque;
    wheel_torque = wheel_torque + by.wheel_torque;
    const int part = stage == 0 ? 0 : stage == 3 ? 2 : 1;
    arms[part][0] = stage == 1 ? arms[1][0] + by.pinion_arm : by.pinion_arm;
    arms[part][1] = stage == 1 ? arms[1][1] + by.gear_arm : by.gear_arm;
  }
  // The middle: (y0 + y1)/2 + h/8 (f0 - f1).
  add_arms(piece.arm[1], *piece.parts[1], arms[1][0], arms[1][1], middle);
  const double eighth = h / 8;
  transpose_rates(c, *piece.parts[0], middle, by);
  for (int i = 0; i < kRates; ++i) {
    sum[i] = fused(0.5, middle[i], fused(eighth, by.state[i], sum[i]));
  }
  arms[0][0] = fused(eighth, by.pinion_arm, arms[0][0]);
  arms[0][1] = fused(eighth, by.gear_arm, arms[0][1]);
  pinion_torque = fused(eighth, by.pinion_torque, pinion_torque);
  wheel_torque = fused(eighth, by.wheel_torque, wheel_torque);
  transpose_rates(c, *piece.parts[2], middle, by);
  arms[2][0] = fused(-eighth, by.pinion_arm, arms[2][0]);
  arms[2][1] = fused(-eighth, by.gear_arm, arms[2][1]);
  pinion_torque = fused(-eighth, by.pinion_torque, pinion_torque);
  wheel_torque = fused(-eighth, by.wheel_torque, wheel_torque);
  add_arms(piece.arm[0], *piece.parts[0], arms[0][0], arms[0][1], sum);

  for (int i = 0; i < kRates; ++i) {
    if (direct != nullptr) sum[i] = sum[i] + load_figures((*direct)[0][i]);
    store_row(sum[i], state[i].data());
  }
  for (int part = 0; part < 3; ++part) {
    store_row(arms[part][0], out.arm[part][0].data());
    store_row(arms[part][1], out.arm[part][1].data());
  }
  store_row(pinion_torque, out.pinion_torque.data());
  store_row(wheel_torque, out.wheel_torque.data());
}

}  // namespace

void back_in_rows(const MotionConstants& c, const PieceSlopes& piece,
                  const std::array<StateAdjoint, 3>* direct, std::span<StateAdjoint> groups,
                  PieceAdjoint* out) {
  ArmFeedback feedback;
  set_feedback(c, piece, feedback);
  for (std::size_t g = 0; g < groups.size(); ++g) {
    const bool is_last = g + 1 == groups.size();
    back_in_group(c, piece, feedback, is_last ? direct : nullptr, groups[g], out[g]);
  }
}

void add_rows(int count, const AdjointRow* weights, const double* slopes, std::size_t stride,
              int rows, AdjointRow* sum) {
  constexpr int kTogether = 8;
  for (int first = 0; first < rows; first += kTogether) {
    const int last = first + kTogether < rows ? first + kTogether : rows;
    Figures out[kTogether];
    for (int l = first; l < last; ++l) out[l - first] = load_figures(sum[l]);
    if (last - first == kTogether) {
      for (int i = 0; i < count; ++i) {
        const Figures weight = load_figures(weights[i]);
        for (int l = 0; l < kTogether; ++l) {
          out[l] = fused(slopes[(first + l) * stride + i], weight, out[l]);
        }
      }
    } else {
      for (int i = 0; i < count; ++i) {
        const Figures weight = load_figures(weights[i]);
        for (int l = first; l < last; ++l) {
          out[l - first] = fused(slopes[l * stride + i], weight, out[l - first]);
        }
      }
    }
    for (int l = first; l < last; ++l) store_row(out[l - first], sum[l].data());
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace tribodyn
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tribodyn {

void pass_back(InstructionSet instruction_set, const MotionConstants& constants,
               const PieceSlopes& piece, const std::array<StateAdjoint, 3>* direct,
               std::span<StateAdjoint> groups, PieceAdjoint* out) {
  TRIBODYN_RETURN_WITH(instruction_set, back_in_rows, constants, piece, direct, groups, out)
}

void add_weighted_slopes(InstructionSet instruction_set, int count, const AdjointRow* weights,
                         const double* slopes, std::size_t stride, int rows, AdjointRow* sum) {
  TRIBODYN_RETURN_WITH(instruction_set, add_rows, count, weights, slopes, stride, rows, sum)
}

}  // namespace tribodyn
#endif
