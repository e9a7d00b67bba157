#include "core/dynamics/orbit_sensitivity.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "core/dynamics/mesh_cycle_march.h"
#include "core/numerics/dual-inl.h"
#include "core/numerics/square.h"

namespace tribodyn {
namespace HWY_NAMESPACE {

/// What flank_motion_of() calls it.
template <int kCount>
Dual<double, kCount> sqrt(const Dual<double, kCount>& x) {
  return root(x);
}

}  // namespace HWY_NAMESPACE

namespace {

using HWY_NAMESPACE::Dual;

constexpr int kSectionStates = 7,
              kRates = kSectionStates + 1;  // rates: of time, then of the states
constexpr int kPinionTorqueColumn = kSectionStates, kWheelTorqueColumn = kSectionStates + 1;
constexpr int kFirstParameter = kSectionStates + 2;
constexpr int kColumns = kFirstParameter + kContactParameters;

/// Derivatives by the states at the section, T_s, T_w and the contacts' parameters.
template <int kRows>
using ByAll = Eigen::Matrix<double, kRows, kColumns>;
using ByColumns = Eigen::Matrix<double, 1, kColumns>;
template <int kRows>
using ByParameters = Eigen::Matrix<double, kRows, kContactParameters>;

/// Variables of a piece: states at its start, both torques, friction arms at start, middle, end.
constexpr int kFirstArm = kSectionStates + 2, kPieceVariables = kFirstArm + 6;
using PieceNumber = Dual<double, kPieceVariables>;

/// What contacts depend on besides their parameters: mesh force, speeds of pinion and gear.
enum Motion { kForce, kOfPinion, kOfGear, kMotions };
using MotionNumber = Dual<double, kMotions>;

/// Sums over the contacts of an instant whose integrals over time the figures are made of.
enum Sum { kLoss, kFrictionTorque, kLoad, kFilmRatioLoad, kTemperatureLoad, kSums };

/// The contacts of an instant, and derivatives by motion and parameters.
struct Contacts {
  Eigen::Matrix<double, 2, kMotions> arm_by_motion = decltype(arm_by_motion)::Zero();
  ByParameters<2> arm_by_parameter = ByParameters<2>::Zero();
  double arm[2] = {};  // friction torque on pinion and gear over load [m]
  double sum[kSums] = {};
  Eigen::Matrix<double, kSums, kMotions> sum_by_motion = decltype(sum_by_motion)::Zero();
  ByParameters<kSums> sum_by_parameter = ByParameters<kSums>::Zero();
  bool is_told = false;  // the arms follow the motion
};

/// The start, middle or end of a piece: values and derivatives by its own states, both torques and
/// its own arms (the first of PieceNumber).
struct Instantaneous {
  MechanicsOf<PieceNumber> at;
  std::array<PieceNumber, kRates> rate;
};

class OrbitDifferentiator {
 public:
  OrbitDifferentiator(GearPairSystem& system, const MeshGrid& grid,
                      const ContactSensitivityModel& model, const PeriodicOrbit& orbit,
                      double mean_pinion_speed, bool solve_wheel_torque)
      : system_(system),
        grid_(grid),
        model_(model),
        orbit_(orbit),
        friction_(orbit.friction),
        mean_speed_(mean_pinion_speed),
        solve_wheel_torque_(solve_wheel_torque) {
    system.set_torques(orbit.torques);
    scales_ = march_scales(system, mean_pinion_speed);
    light_load_ = kLightShare * scales_.torque / system.mesh().mean_pinion_contact_radius();
  }

  std::optional<OrbitSensitivity> run() {
    find_extremes();
    state_.setZero();
    for (int i = 0; i < kSectionStates; ++i) state_(i + 1, i) = 1;
    for (std::size_t i = 0; i < orbit_.pieces.size(); ++i) {
      if (i > 0) cross_event(orbit_.pieces[i - 1], orbit_.pieces[i]);
      shares_contacts_ = i > 0 && goes_on(orbit_.pieces[i - 1], orbit_.pieces[i]);
      if (!add_piece(i)) return std::nullopt;
    }
    return close();
  }

 private:
  static constexpr double kLightShare = 1e-3;  // of the mean force: see Shooting::light_load()
  /// Of the light load: what an event's location leaves of the force there.
  static constexpr double kNoLoad = 1e-3;

  /// Whether a piece starts with the contacts that the one before ends with: pairs hand over their
  /// slots from cycle to cycle.
  static bool goes_on(const OrbitPiece& before, const OrbitPiece& piece) {
    return before.regime.loaded == piece.regime.loaded &&
           std::floor(piece.phase + 1e-9) == std::floor(piece.phase - 1e-9);
  }
  static const MarchState& state_of(const OrbitPiece& p, int part) {
    return part == 0 ? p.start : part == 1 ? p.middle : p.end;
  }
  MeshPhase phase_of(const OrbitPiece& p, int part) const {
    if (p.node >= 0) return grid_.at(p.node + part);
    const double phase = p.phase + 0.5 * part * p.length;
    return system_.at_phase(phase - std::floor(phase));
  }

  /// Which half of which piece holds the extremes of x, and where in it.
  void find_extremes() {
    for (std::size_t i = 0; i < orbit_.pieces.size(); ++i) {
      const OrbitPiece& p = orbit_.pieces[i];
      system_.regime = p.regime;
      for (int half = 0; half < 2; ++half) {
        double x[2] = {}, slope[2] = {};
        const double h = state_of(p, half + 1)[kTime] - state_of(p, half)[kTime];
        for (const int end : {0, 1}) {
          Mechanics at;
          system_.kinematics(phase_of(p, half + end), state_of(p, half + end).data(), at);
          x[end] = at.transmission_error;
          slope[end] = h * at.transmission_velocity;
        }
        const double rise = x[1] - x[0], a = slope[0] + slope[1] - 2 * rise;
        const double b = 3 * rise - 2 * slope[0] - slope[1];
        const double discriminant = b * b - 3 * a * slope[0];
        const double root = discriminant > 0 ? -(b + std::copysign(std::sqrt(discriminant), b)) : 0;
        for (const double t : {0.0, 1.0, root / (3 * a), slope[0] / root}) {
          if (!(t >= 0 && t <= 1)) continue;
          const double value = x[0] + t * (slope[0] + t * (b + t * a));
          if (value < minimum_.value) minimum_.set(value, i, half, t);
          if (value > maximum_.value) maximum_.set(value, i, half, t);
        }
      }
    }
  }

  /// False where a contact has no derivatives.
  bool solve_contacts(const OrbitPiece& p, int part, const Mechanics& at, Contacts& out) {
    out = {};
    const double side = p.regime.side, load = p.regime.load(at.mesh_force);
    if (!(load > 0)) return true;
    const MarchState& y = state_of(p, part);
    const auto force = MotionNumber::variable(at.mesh_force, kForce);
    const auto pinion_speed = MotionNumber::variable(y[kPinionSpeed], kOfPinion);
    const auto gear_speed = MotionNumber::variable(y[kGearSpeed], kOfGear);
    std::array<FlankKinematics, kFlankPairs> off_grid;
    const ModelOptions& options = system_.options();
    MotionNumber torque[2] = {0.0, 0.0}, sum[kSums] = {0.0, 0.0, 0.0, 0.0, 0.0};
    ByParameters<2> torque_by_parameter = ByParameters<2>::Zero();
    for (const FlankKinematics& flank : flanks_of(system_.mesh(), grid_, p, part, off_grid)) {
      if (!(flank.load_share * load > 0)) continue;
      const MotionNumber own_load = flank.load_share * side * force;
      FlankMotionOf<MotionNumber> motion = flank_motion_of(flank, pinion_speed, gear_speed);
      if (options.tabulated_friction_arms) {
        motion.pinion_friction_arm = flank.pinion_friction_arm;
        motion.gear_friction_arm = flank.gear_friction_arm;
      }
      FlankMotion ignored;
      const ContactConditions conditions =
          system_.contact_conditions(flank, own_load.value, y.data(), ignored);
      const ContactSensitivity contact = model_.at(conditions);
      if (contact.status != SensitivityStatus::kOk) return false;
      one_sided_ = one_sided_ || contact.one_sided;
      MotionNumber drift_x = 0.0, drift_y = 0.0;
      if (options.subtract_contact_point_motion) {
        drift_x = flank.contact_point_velocity_x * pinion_speed;
        drift_y = flank.contact_point_velocity_y * pinion_speed;
      }
      const MotionNumber inputs[] = {own_load, motion.pinion_x - drift_x, motion.pinion_y - drift_y,
                                     motion.gear_x - drift_x, motion.gear_y - drift_y};
      constexpr ContactInput kInputs[] = {ContactInput::kLoad, ContactInput::kVelocity1X,
                                          ContactInput::kVelocity1Y, ContactInput::kVelocity2X,
                                          ContactInput::kVelocity2Y};
      const auto chain = [&](const ContactDerivatives& d) {
        MotionNumber number = d.value;
        for (int i = 0; i < 5; ++i) {
          for (int m = 0; m < kMotions; ++m) {
            number.slope[m] += d.by_input(kInputs[i]) * inputs[i].slope[m];
          }
        }
        return number;
      };
      using Parameters = Eigen::Map<const Eigen::Matrix<double, 1, kContactParameters>>;
      const Parameters by_friction(contact.friction.by.data());
      const MotionNumber friction = chain(contact.friction);
      torque[0] = torque[0] + motion.pinion_friction_arm * friction;
      torque[1] = torque[1] + motion.gear_friction_arm * friction;
      torque_by_parameter.row(0) += motion.pinion_friction_arm.value * by_friction;
      torque_by_parameter.row(1) += motion.gear_friction_arm.value * by_friction;
      sum[kLoss] = sum[kLoss] + motion.sliding_speed * friction;
      sum[kLoad] = sum[kLoad] + own_load;
      sum[kFilmRatioLoad] = sum[kFilmRatioLoad] + chain(contact.film_ratio) * own_load;
      sum[kTemperatureLoad] = sum[kTemperatureLoad] + chain(contact.contact_temperature) * own_load;
      out.sum_by_parameter.row(kLoss) += motion.sliding_speed.value * by_friction;
      out.sum_by_parameter.row(kFilmRatioLoad) +=
          own_load.value * Parameters(contact.film_ratio.by.data());
      out.sum_by_parameter.row(kTemperatureLoad) +=
          own_load.value * Parameters(contact.contact_temperature.by.data());
    }
    sum[kFrictionTorque] = torque[0];
    out.sum_by_parameter.row(kFrictionTorque) = torque_by_parameter.row(0);
    for (int s = 0; s < kSums; ++s) {
      out.sum[s] = sum[s].value;
      for (int m = 0; m < kMotions; ++m) out.sum_by_motion(s, m) = sum[s].slope[m];
    }
    out.is_told = load > light_load_;
    for (int gear = 0; gear < 2; ++gear) {
      const MotionNumber arm = torque[gear] / (side * force);
      out.arm[gear] = arm.value;
      if (!out.is_told) continue;
      for (int m = 0; m < kMotions; ++m) out.arm_by_motion(gear, m) = arm.slope[m];
    }
    if (out.is_told) out.arm_by_parameter = torque_by_parameter / load;
    return true;
  }

  /// Mechanics and rates of a state under friction arms that are given for a phase.
  void evaluate(const MeshPhase& phase, const PieceNumber* y, const PieceNumber* arms,
                Instantaneous& out) const {
    MechanicsOf<PieceNumber>& at = out.at;
    system_.mechanics(phase, y, at);
    at.pinion_friction_torque = at.gear_friction_torque = 0.0;
    if (system_.regime.load(at.mesh_force.value) > 0) {
      const PieceNumber load = static_cast<double>(system_.regime.side) * at.mesh_force;
      at.pinion_friction_torque = arms[0] * load;
      at.gear_friction_torque = arms[1] * load;
    }
    const TorquesOf<PieceNumber> torques{
        PieceNumber::variable(orbit_.torques.pinion, kPinionTorqueColumn),
        PieceNumber::variable(orbit_.torques.wheel, kWheelTorqueColumn)};
    system_.motion(y, at, torques, out.rate.data());
  }

  /// Of the start, middle or end of a piece, by its own state and arms.
  void evaluate_part(const OrbitPiece& p, int part, Instantaneous& out) {
    const MarchState& state = state_of(p, part);
    std::array<PieceNumber, kRates> y;
    y[kTime] = 0.0;
    for (int i = 0; i < kSectionStates; ++i) y[i + 1] = PieceNumber::variable(state[i + 1], i);
    const FrictionPerLoad at = friction_.at(p.phase + 0.5 * part * p.length);
    const PieceNumber arms[2] = {PieceNumber::variable(at.pinion, kFirstArm),
                                 PieceNumber::variable(at.gear, kFirstArm + 1)};
    evaluate(phase_of(p, part), y.data(), arms, out);
  }

  /// A Runge-Kutta step by all variables of its piece.
  std::array<PieceNumber, kRates> step(const OrbitPiece& p) {
    constexpr double kNode[4] = {0, 0.5, 0.5, 1};
    constexpr double kWeight[4] = {1.0 / 6, 1.0 / 3, 1.0 / 3, 1.0 / 6};
    PieceNumber arms[3][2];
    for (int part = 0; part < 3; ++part) {
      const FrictionPerLoad at = friction_.at(p.phase + 0.5 * part * p.length);
      arms[part][0] = PieceNumber::variable(at.pinion, kFirstArm + 2 * part);
      arms[part][1] = PieceNumber::variable(at.gear, kFirstArm + 2 * part + 1);
    }
    std::array<PieceNumber, kRates> y, stage, sum;
    y[kTime] = 0.0;
    for (int i = 0; i < kSectionStates; ++i) y[i + 1] = PieceNumber::variable(p.start[i + 1], i);
    sum = y;
    Instantaneous at;
    for (int n = 0; n < 4; ++n) {
      for (int i = 0; i < kRates; ++i) {
        stage[i] = n == 0 ? y[i] : y[i] + (kNode[n] * p.length) * at.rate[i];
      }
      const int part = n == 0 ? 0 : n == 3 ? 2 : 1;
      evaluate(phase_of(p, part), stage.data(), arms[part], at);
      for (int i = 0; i < kRates; ++i) sum[i] = sum[i] + (kWeight[n] * p.length) * at.rate[i];
    }
    return sum;
  }

  /// d (mesh force, speeds) / d states.
  static Eigen::Matrix<double, kMotions, kSectionStates> motion_by_state(const Instantaneous& at) {
    Eigen::Matrix<double, kMotions, kSectionStates> out = decltype(out)::Zero();
    for (int i = 0; i < kSectionStates; ++i) out(kForce, i) = at.at.mesh_force.slope[i];
    out(kOfPinion, kPinionSpeed - 1) = out(kOfGear, kGearSpeed - 1) = 1;
    return out;
  }

  template <int kRows, int kCount>
  static Eigen::Matrix<double, kRows, kCount> slopes(const std::array<PieceNumber, kRates>& of,
                                                     int first) {
    Eigen::Matrix<double, kRows, kCount> out;
    for (int i = 0; i < kRows; ++i) {
      for (int j = 0; j < kCount; ++j) out(i, j) = of[i + kRates - kRows].slope[first + j];
    }
    return out;
  }

  bool add_piece(std::size_t index) {
    const OrbitPiece& p = orbit_.pieces[index];
    system_.regime = p.regime;
    Contacts contacts[3];
    Instantaneous at[3];
    Eigen::Matrix<double, 2, kSectionStates> arm_by_state[3];
    for (int part = 0; part < 3; ++part) {
      evaluate_part(p, part, at[part]);
      Mechanics plain;
      system_.mechanics(phase_of(p, part), state_of(p, part).data(), plain);
      const bool shared = part == 0 && shares_contacts_;
      if (shared) {
        contacts[0] = last_contacts_;
      } else if (!solve_contacts(p, part, plain, contacts[part])) {
        return false;
      }
      arm_by_state[part] = contacts[part].arm_by_motion * motion_by_state(at[part]);
    }
    const std::array<PieceNumber, kRates> end = step(p);
    const auto by_start = slopes<kRates, kSectionStates>(end, 0);
    const auto by_torques = slopes<kRates, 2>(end, kPinionTorqueColumn);
    const auto by_arms_0 = slopes<kRates, 2>(end, kFirstArm);
    const auto by_arms_1 = slopes<kRates, 2>(end, kFirstArm + 2);
    const auto by_arms_2 = slopes<kRates, 2>(end, kFirstArm + 4);

    // The middle by the cubic through both ends: (y0 + y1)/2 + h/8 (f0 - f1).
    const double eighth = p.length / 8;
    const auto rate_by_state = [&](int part) -> Eigen::Matrix<double, kRates, kSectionStates> {
      return slopes<kRates, kSectionStates>(at[part].rate, 0) +
             slopes<kRates, 2>(at[part].rate, kFirstArm) * arm_by_state[part];
    };
    Eigen::Matrix<double, kRates, kSectionStates> middle_by_start = eighth * rate_by_state(0);
    Eigen::Matrix<double, kRates, kSectionStates> middle_by_end = -eighth * rate_by_state(2);
    for (int i = 0; i < kSectionStates; ++i) {
      middle_by_start(i + 1, i) += 0.5;
      middle_by_end(i + 1, i) += 0.5;
    }
    const Eigen::Matrix<double, kRates, 2> middle_by_torques =
        eighth * (slopes<kRates, 2>(at[0].rate, kPinionTorqueColumn) -
                  slopes<kRates, 2>(at[2].rate, kPinionTorqueColumn));
    const ByParameters<kRates> middle_by_parameter =
        eighth * (slopes<kRates, 2>(at[0].rate, kFirstArm) * contacts[0].arm_by_parameter -
                  slopes<kRates, 2>(at[2].rate, kFirstArm) * contacts[2].arm_by_parameter);

    // (I - B) dX1 = L dX0 + l dT + r dp for the states; then the duration.
    const Eigen::Matrix<double, kRates, kSectionStates> by_middle = by_arms_1 * arm_by_state[1];
    const auto states = [](const auto& m) { return m.template bottomRows<kSectionStates>(); };
    const Eigen::Matrix<double, kRates, kSectionStates> b =
        by_middle * states(middle_by_end) + by_arms_2 * arm_by_state[2];
    const Eigen::Matrix<double, kRates, kSectionStates> l =
        by_start + by_arms_0 * arm_by_state[0] + by_middle * states(middle_by_start);
    ByAll<kRates> change;
    change.noalias() = l * states(state_);
    change.template middleCols<2>(kPinionTorqueColumn) +=
        by_torques + by_middle * states(middle_by_torques);
    change.template rightCols<kContactParameters>() +=
        by_arms_0 * contacts[0].arm_by_parameter + by_arms_2 * contacts[2].arm_by_parameter +
        by_arms_1 * contacts[1].arm_by_parameter + by_middle * states(middle_by_parameter);
    const Eigen::Matrix<double, kSectionStates, kSectionStates> implicit =
        Eigen::Matrix<double, kSectionStates, kSectionStates>::Identity() - states(b);
    ByAll<kRates> next;
    next.template bottomRows<kSectionStates>() = implicit.partialPivLu().solve(states(change));
    next.row(0) = state_.row(0) + change.row(0) + b.row(0) * states(next);

    ByAll<kRates> middle;
    middle.noalias() = middle_by_start * states(state_) + middle_by_end * states(next);
    middle.row(0) += 0.5 * (state_.row(0) + next.row(0));
    middle.template middleCols<2>(kPinionTorqueColumn) += middle_by_torques;
    middle.template rightCols<kContactParameters>() += middle_by_parameter;

    const bool begins = index > 0 && is_event(index - 1);
    const bool ends = index + 1 < orbit_.pieces.size() && is_event(index);
    const ByColumns begin_change = begins ? event_change_ : ByColumns::Zero();
    event_change_.setZero();
    if (ends) event_change_ = phase_change_of_event(index, at, next);
    add_integrals(p, at, contacts, {&state_, &middle, &next}, begin_change, begins, ends);
    for (Extreme* extreme : {&minimum_, &maximum_}) {
      if (extreme->piece == index) {
        differentiate_extreme(p, at, {&state_, &middle, &next}, *extreme);
      }
    }
    state_ = next;
    last_contacts_ = contacts[2];
    return true;
  }

  /// Takes the derivatives across the place where flanks part or meet: at a fixed phase the state
  /// changes by (f- - f+) dphi, dphi the phase change of the place.
  void cross_event(const OrbitPiece& before, const OrbitPiece& after) {
    if (before.regime.side == after.regime.side) return;
    Instantaneous left, right;
    system_.regime = before.regime;
    evaluate_part(before, 2, left);
    system_.regime = after.regime;
    evaluate_part(after, 0, right);
    const double speed = std::abs(left.at.transmission_velocity.value);
    least_touch_speed_ = std::min(least_touch_speed_, speed);
    greatest_touch_speed_ = std::max(greatest_touch_speed_, speed);
    Eigen::Matrix<double, kRates, 1> rate_jump;
    for (int i = 0; i < kRates; ++i) rate_jump(i) = left.rate[i].value - right.rate[i].value;
    state_.noalias() += rate_jump * event_change_;
  }

  /// Whether flanks part or meet, or their load begins or ends, between a piece and the next one.
  bool is_event(std::size_t index) const {
    const ContactRegime &before = orbit_.pieces[index].regime,
                        &after = orbit_.pieces[index + 1].regime;
    return before.side != after.side || before.loaded != after.loaded;
  }

  /// Slope over phase of the mesh force at the start, middle or end of a piece, by the parabola
  /// through its values there.
  static double force_slope(const OrbitPiece& p, const Instantaneous* at, int part) {
    const auto force = [&](int i) { return at[i].at.mesh_force.value; };
    const double rise = force(2) - force(0), bend = 2 * (force(0) - 2 * force(1) + force(2));
    return (rise + (part - 1) * bend) / p.length;
  }

  /// Of the event at the end of a piece: there the transmission error is that of touching flanks,
  /// or the mesh force is 0. `end`: the state there at a fixed phase.
  ByColumns phase_change_of_event(std::size_t index, const Instantaneous* at,
                                  const ByAll<kRates>& end) const {
    const OrbitPiece& p = orbit_.pieces[index];
    const bool touch = p.regime.side != orbit_.pieces[index + 1].regime.side;
    const PieceNumber& zero = touch ? at[2].at.transmission_error : at[2].at.mesh_force;
    const double slope = touch ? at[2].at.transmission_velocity.value * at[2].rate[kTime].value
                               : force_slope(p, at, 2);
    Eigen::Matrix<double, 1, kSectionStates> by_state;
    for (int i = 0; i < kSectionStates; ++i) by_state(i) = zero.slope[i];
    return -(by_state * end.bottomRows<kSectionStates>()) / slope;
  }

  double input_speed(const MarchState& y) const {
    return system_.input_speed(y[kPinionShaftSpeed], y[kWheelSpeed]);
  }
  /// d input_speed / d states.
  Eigen::Matrix<double, 1, kSectionStates> input_speed_by_state() const {
    Eigen::Matrix<double, 1, kSectionStates> out = decltype(out)::Zero();
    out(kPinionShaftSpeed - 1) = system_.input_speed(1, 0);
    out(kWheelSpeed - 1) = system_.input_speed(0, 1);
    return out;
  }

  /// Integrands over phase, the sums and the square of eq 30, and their derivatives.
  struct Integrands {
    Eigen::Matrix<double, kSums + 1, 1> value, by_force;
    Eigen::Matrix<double, kSums + 1, kSectionStates> by_state;
    ByParameters<kSums + 1> by_parameter;
  };
  Integrands integrands(const MarchState& y, const Instantaneous& at, const Contacts& c) const {
    Integrands out;
    const double per_phase = system_.cycle_angle() / y[kPinionSpeed];
    const auto by_state = motion_by_state(at);
    for (int s = 0; s < kSums; ++s) out.value(s) = c.sum[s];
    out.by_state.template topRows<kSums>() = c.sum_by_motion * by_state;
    out.by_parameter.template topRows<kSums>() = c.sum_by_parameter;
    const double speed = input_speed(y), share = c.sum[kLoss] / speed;
    out.value(kSums) = share * share;
    out.by_state.row(kSums) =
        2 * share / speed * (out.by_state.row(kLoss) - share * input_speed_by_state());
    out.by_parameter.row(kSums) = 2 * share / speed * out.by_parameter.row(kLoss);
    out.by_force << c.sum_by_motion.col(kForce), 2 * share / speed * c.sum_by_motion(kLoss, kForce);
    out.by_force *= per_phase;
    out.by_state.col(kPinionSpeed - 1) -= out.value / y[kPinionSpeed];
    out.value *= per_phase;
    out.by_state *= per_phase;
    out.by_parameter *= per_phase;
    return out;
  }

  /// By Simpson's rule. An end of the piece that is an event moves with it, and the middle half as
  /// far: `begin_change` and event_change_ are the phase changes of start and end. Where the load
  /// begins or ends, the integrands stay 0; at a fixed phase they would have infinite derivatives,
  /// because they rise there like a power below 1 of the force. Elsewhere their change with phase
  /// is that with the force; all else changes little within a piece.
  void add_integrals(const OrbitPiece& p, const Instantaneous* at, const Contacts* contacts,
                     const std::array<const ByAll<kRates>*, 3>& states,
                     const ByColumns& begin_change, bool begins, bool ends) {
    const double sixth = p.length / 6;
    const auto presses = [&](int part) {
      return p.regime.load(at[part].at.mesh_force.value) > kNoLoad * light_load_;
    };
    Eigen::Matrix<double, kSums + 1, 1> sum = decltype(sum)::Zero();
    for (int part = 0; part < 3; ++part) {
      const bool moves = part == 0 ? begins : part == 2 ? ends : begins || ends;
      if (!presses(part)) continue;
      const Integrands here = integrands(state_of(p, part), at[part], contacts[part]);
      const double weight = sixth * (part == 1 ? 4 : 1);
      sum += weight * here.value;
      integral_by_all_.noalias() +=
          (weight * here.by_state) * states[part]->template bottomRows<kSectionStates>();
      integral_by_all_.template rightCols<kContactParameters>() += weight * here.by_parameter;
      if (!moves) continue;
      const ByColumns change = (1 - 0.5 * part) * begin_change + 0.5 * part * event_change_;
      integral_by_all_.noalias() += (weight * force_slope(p, at, part) * here.by_force) * change;
    }
    integral_ += sum;
    if (begins || ends) {
      integral_by_all_.noalias() += sum / p.length * (event_change_ - begin_change);
    }
  }

  struct Extreme {
    explicit Extreme(double bound) : value(bound) {}
    double value;
    std::size_t piece = 0;
    int half = 0;
    double t = 0;  // in the half
    Eigen::Matrix<double, 1, kColumns> by_all = decltype(by_all)::Zero();
    void set(double new_value, std::size_t in_piece, int in_half, double at) {
      value = new_value;
      piece = in_piece;
      half = in_half;
      t = at;
    }
  };
  /// Of the cubic through both ends of the half, at its place.
  void differentiate_extreme(const OrbitPiece& p, const Instantaneous* at,
                             const std::array<const ByAll<kRates>*, 3>& states, Extreme& out) {
    const double t = out.t, u = 1 - t;
    const double value[2] = {(1 + 2 * t) * u * u, (1 + 2 * u) * t * t};
    const double slope[2] = {t * u * u, -t * t * u};
    const double h = state_of(p, out.half + 1)[kTime] - state_of(p, out.half)[kTime];
    out.by_all.setZero();
    double by_h = 0;
    for (const int end : {0, 1}) {
      const MechanicsOf<PieceNumber>& here = at[out.half + end].at;
      Eigen::Matrix<double, 1, kSectionStates> row;
      for (int i = 0; i < kSectionStates; ++i) {
        row(i) = value[end] * here.transmission_error.slope[i] +
                 h * slope[end] * here.transmission_velocity.slope[i];
      }
      by_h += slope[end] * here.transmission_velocity.value;
      out.by_all += row * states[out.half + end]->template bottomRows<kSectionStates>();
    }
    out.by_all += by_h * (states[out.half + 1]->row(0) - states[out.half]->row(0));
  }

  std::optional<OrbitSensitivity> close() {
    // Equations: states return, the period takes its time. Unknowns: states, the unknown torque.
    const int unknown = solve_wheel_torque_ ? kWheelTorqueColumn : kPinionTorqueColumn;
    const int known = solve_wheel_torque_ ? kPinionTorqueColumn : kWheelTorqueColumn;
    const double time = orbit_.period * system_.cycle_angle() / mean_speed_;
    Eigen::Matrix<double, kRates, kRates> jacobian;
    jacobian.topLeftCorner<kSectionStates, kSectionStates>() =
        state_.bottomRows<kSectionStates>().leftCols<kSectionStates>() -
        Eigen::Matrix<double, kSectionStates, kSectionStates>::Identity();
    jacobian.topRightCorner<kSectionStates, 1>() = state_.bottomRows<kSectionStates>().col(unknown);
    jacobian.bottomLeftCorner<1, kSectionStates>() = state_.row(0).leftCols<kSectionStates>();
    jacobian(kSectionStates, kSectionStates) = state_(0, unknown);
    Eigen::Matrix<double, kRates, kOrbitParameters> right;
    const auto set = [&](int column, const auto& from) {
      right.col(column).template head<kSectionStates>() = -from.template tail<kSectionStates>();
      right(kSectionStates, column) = -from(0);
    };
    for (int j = 0; j < kContactParameters; ++j) set(j, state_.col(kFirstParameter + j));
    set(kKnownTorqueParameter, state_.col(known));
    right.col(kMeanSpeedParameter).setZero();
    right(kSectionStates, kMeanSpeedParameter) = -time / mean_speed_;
    Eigen::Matrix<double, kRates, 1> row_scale, column_scale;
    for (int i = 0; i < kSectionStates; ++i) {
      row_scale(i) = 1 / scales_.of(system_.mesh(), i + 1);
      column_scale(i) = scales_.of(system_.mesh(), i + 1);
    }
    row_scale(kSectionStates) = 1 / time;
    column_scale(kSectionStates) = scales_.torque;
    const Eigen::PartialPivLU<Eigen::Matrix<double, kRates, kRates>> factors(
        row_scale.asDiagonal() * jacobian * column_scale.asDiagonal());
    if (!(factors.rcond() > 1e-12)) return std::nullopt;
    const Eigen::Matrix<double, kRates, kOrbitParameters> change =
        column_scale.asDiagonal() * factors.solve(row_scale.asDiagonal() * right);
    if (!change.allFinite()) return std::nullopt;

    // Of anything that is known by all columns, by the parameters.
    using ByOrbitParameters = Eigen::Matrix<double, 1, kOrbitParameters>;
    const auto total = [&](const Eigen::Matrix<double, 1, kColumns>& by_all) {
      ByOrbitParameters out = by_all.leftCols<kSectionStates>() * change.topRows<kSectionStates>();
      out += by_all(unknown) * change.row(kSectionStates);
      out.leftCols<kContactParameters>() += by_all.rightCols<kContactParameters>();
      out(kKnownTorqueParameter) += by_all(known);
      return out;
    };
    ByOrbitParameters torque[2] = {ByOrbitParameters::Zero(), ByOrbitParameters::Zero()};
    torque[solve_wheel_torque_ ? 1 : 0] = change.row(kSectionStates);
    torque[solve_wheel_torque_ ? 0 : 1](kKnownTorqueParameter) = 1;
    ByOrbitParameters speed = ByOrbitParameters::Zero();
    speed(kMeanSpeedParameter) = 1;

    const double ratio = static_cast<double>(system_.mesh().pinion_teeth()) /
                         static_cast<double>(system_.mesh().gear_teeth());
    const double input = input_torque(orbit_.torques, ratio);
    const ByOrbitParameters input_by = (orbit_.torques.pinion > 0 ? 1.0 : 0.0) * torque[0] -
                                       (orbit_.torques.wheel < 0 ? ratio : 0.0) * torque[1];
    OrbitSensitivity out;
    const auto set_figure = [&](OrbitFigure figure, double value, const ByOrbitParameters& by) {
      const auto at = static_cast<std::size_t>(figure);
      out.figure[at] = value;
      Eigen::Map<ByOrbitParameters>(out.derivative[at].data()) = by;
    };
    /// Of an integral over the period, over its time.
    const auto set_mean = [&](OrbitFigure figure, int sum) {
      const double value = integral_(sum) / time;
      set_figure(figure, value,
                 total(integral_by_all_.row(sum)) / time + value / mean_speed_ * speed);
    };
    const auto set_ratio = [&](OrbitFigure figure, int sum) {
      const double value = integral_(sum) / integral_(kLoad);
      set_figure(figure, value,
                 (total(integral_by_all_.row(sum)) - value * total(integral_by_all_.row(kLoad))) /
                     integral_(kLoad));
    };
    set_mean(OrbitFigure::kMeshLossPower, kLoss);
    set_mean(OrbitFigure::kPinionFrictionTorque, kFrictionTorque);
    set_ratio(OrbitFigure::kFilmRatio, kFilmRatioLoad);
    set_ratio(OrbitFigure::kContactTemperature, kTemperatureLoad);
    const ByOrbitParameters loss_by = total(integral_by_all_.row(kLoss));
    const double turned = orbit_.period * system_.cycle_angle();
    set_figure(OrbitFigure::kMeshLossTorque, integral_(kLoss) / turned, loss_by / turned);
    const double energy = 100 * integral_(kLoss) / (input * turned);
    set_figure(OrbitFigure::kInefficiencyEnergyMean, energy,
               100 / (input * turned) * loss_by - energy / input * input_by);
    const double rms = 100 / input * std::sqrt(integral_(kSums) / time);
    set_figure(OrbitFigure::kInefficiencyRms, rms,
               rms * (0.5 / integral_(kSums) * total(integral_by_all_.row(kSums)) +
                      0.5 / mean_speed_ * speed - 1 / input * input_by));
    set_figure(OrbitFigure::kTransmissionErrorMinimum, minimum_.value, total(minimum_.by_all));
    set_figure(OrbitFigure::kTransmissionErrorMaximum, maximum_.value, total(maximum_.by_all));
    Eigen::Map<ByOrbitParameters>(out.unknown_torque.data()) = change.row(kSectionStates);
    constexpr double kLittleForce = 0.01;  // of the mean force
    constexpr double kLittleSpeed = 0.01;  // of the greatest one
    out.one_sided = one_sided_ || least_touch_speed_ < kLittleSpeed * greatest_touch_speed_ ||
                    (!orbit_.contact_loss && orbit_.least_pressing_force < kLittleForce);
    return out;
  }

  GearPairSystem& system_;
  const MeshGrid& grid_;
  const ContactSensitivityModel& model_;
  const PeriodicOrbit& orbit_;
  LaggedFriction friction_;
  double mean_speed_;
  bool solve_wheel_torque_;
  MarchScales scales_;
  double light_load_;
  ByAll<kRates> state_;
  Contacts last_contacts_;
  bool shares_contacts_ = false;
  bool one_sided_ = false;
  ByColumns event_change_ = ByColumns::Zero();  ///< of the phase of the event at a piece's end
  Eigen::Matrix<double, kSums + 1, 1> integral_ = decltype(integral_)::Zero();
  ByAll<kSums + 1> integral_by_all_ = ByAll<kSums + 1>::Zero();
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();
  double least_touch_speed_ = kInfinity, greatest_touch_speed_ = 0;  ///< [m/s]
  Extreme minimum_{kInfinity}, maximum_{-kInfinity};
};

}  // namespace

std::optional<OrbitSensitivity> orbit_sensitivity(GearPairSystem& system, const MeshGrid& grid,
                                                  const ContactSensitivityModel& contacts,
                                                  const PeriodicOrbit& orbit,
                                                  double mean_pinion_speed,
                                                  bool solve_wheel_torque) {
  return OrbitDifferentiator(system, grid, contacts, orbit, mean_pinion_speed, solve_wheel_torque)
      .run();
}

}  // namespace tribodyn
