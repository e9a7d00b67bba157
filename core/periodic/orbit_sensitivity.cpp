#include "core/periodic/orbit_sensitivity.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>

#include "core/driveline/gear_pair_motion.h"
#include "core/integrate/mesh_cycle_march.h"
#include "core/integrate/piece_adjoint.h"
#include "core/integrate/runge_kutta.h"
#include "core/periodic/event_shift.h"
#include "core/periodic/leading_multiplier.h"
#include "core/periodic/orbit_contacts.h"

namespace tribodyn {
namespace {

constexpr int kSectionStates = 7, kRates = kSectionStates + 1;  // rates: of time, then of states

// The adjoints, in two groups of lanes: those of time and states at the end of the period; those of
// the integrals, followed by those of the extremes of the transmission error. Figures are computed
// from the second group.
enum Group { kOfEnd, kOfFigures, kGroups };
enum { kMinimum = kIntegrals, kMaximum };
static_assert(kGroups == OrbitContacts::kGroups);
static_assert(kMaximum + 1 == kAdjointLanes && kRates == kAdjointLanes);

/// An instant of a piece: what its rates depend on, and its transmission error.
struct DifferentiatedInstant {
  StageSlopes slopes;
  double error_by_approach, velocity_by_approach;
};

class OrbitDifferentiator {
 public:
  /// The multiplier needs neither the figures and their adjoints nor the effect of a shifted event
  /// on the steps beside it.
  enum class Wanted { kAll, kMultiplier };

  OrbitDifferentiator(const PeriodicProblem& problem, const PeriodicOrbit& orbit, Wanted wanted)
      : system_(problem.system),
        grid_(problem.grids.with_steps(orbit.steps_per_mesh_cycle)),
        orbit_(orbit),
        friction_(orbit.friction),
        mean_speed_(problem.mean_pinion_speed),
        solve_wheel_torque_(problem.solve_wheel_torque),
        scales_(march_scales(system_, orbit.torques, mean_speed_)),
        light_load_(kLightShare * scales_.torque / system_.mesh().mean_pinion_contact_radius()),
        instruction_set_(problem.contacts.instruction_set()),
        constants_(system_.constants()),
        model_(problem.contacts.model()),
        contacts_(system_, grid_, problem.contacts, model_, orbit, light_load_),
        event_shift_(system_, grid_, problem.contacts, orbit, friction_, contacts_,
                     kNoLoad * light_load_),
        wanted_(wanted) {}

  std::optional<OrbitSensitivity> run() { return pass_through() ? close() : std::nullopt; }

  std::optional<double> largest_multiplier() {
    if (!pass_through()) return std::nullopt;
    using Square = Eigen::Matrix<double, kSectionStates, kSectionStates>;
    const auto scale = [&](int i) { return scales_.of(system_.mesh(), i + 1); };
    Square monodromy;
    for (int i = 0; i < kSectionStates; ++i) {
      for (int j = 0; j < kSectionStates; ++j) {
        monodromy(i, j) = adjoint_[kOfEnd][j + 1][i + 1] * scale(j) / scale(i);
      }
    }
    return leading_multiplier(monodromy).modulus;
  }

 private:
  /// Passes the adjoints from the end of the period to its start. Returns false if a contact has no
  /// derivatives.
  bool pass_through() {
    if (!contacts_.differentiate()) return false;
    if (wanted_ == Wanted::kAll) find_extremes();
    for (int i = 0; i < kRates; ++i) adjoint_[kOfEnd][i][i] = 1;
    for (std::size_t i = orbit_.pieces.size(); i-- > 0;) {
      evaluate_instants(i);
      if (i + 1 < orbit_.pieces.size()) cross_event(i);
      if (!pass_piece(i)) return false;
    }
    return true;
  }

  static constexpr double kLightShare = 1e-3;  // of the mean force: see Shooting::light_load()
  /// Of the light load: what an event's location leaves of the force there.
  static constexpr double kNoLoad = 1e-3;

  MeshPhase phase_of(const OrbitPiece& p, int part) const {
    if (p.node >= 0) return grid_.at(p.node + part);
    const double phase = p.phase + 0.5 * part * p.length;
    return system_.at_phase(phase - std::floor(phase));
  }

  /// Which half of which piece holds the extremes of x, and where in it.
  void find_extremes() {
    for (std::size_t i = 0; i < orbit_.pieces.size(); ++i) {
      const OrbitPiece& p = orbit_.pieces[i];
      for (int half = 0; half < 2; ++half) {
        double x[2] = {}, slope[2] = {};
        const double h = state_of(p, half + 1)[kTime] - state_of(p, half)[kTime];
        for (const int end : {0, 1}) {
          const ContactsAt& at = contacts_.at(i, half + end);
          x[end] = at.transmission_error;
          slope[end] = h * at.transmission_velocity;
        }
        const double beyond = 4.0 / 27 * (std::abs(slope[0]) + std::abs(slope[1]));  // at most
        if (std::max(x[0], x[1]) + beyond <= maximum_.value &&
            std::min(x[0], x[1]) - beyond >= minimum_.value) {
          continue;
        }
        const double rise = x[1] - x[0], a = slope[0] + slope[1] - 2 * rise;
        const double b = 3 * rise - 2 * slope[0] - slope[1];
        const double discriminant = b * b - 3 * a * slope[0];
        const double root = discriminant > 0 ? -(b + std::copysign(std::sqrt(discriminant), b)) : 0;
        for (const double t : {0.0, 1.0, root / (3 * a), slope[0] / root}) {
          if (!(t >= 0 && t <= 1)) continue;
          const double value = x[0] + t * (slope[0] + t * (b + t * a));
          if (value < minimum_.value) minimum_ = {value, i, half, t};
          if (value > maximum_.value) maximum_ = {value, i, half, t};
        }
      }
    }
  }

  /// A state in a regime under friction arms that are given.
  void evaluate(const MeshPhase& phase, const ContactRegime& regime, const MarchState& y,
                const FrictionArms& arms, DifferentiatedInstant& out) {
    Mechanics at;
    StageSlopes& s = out.slopes;
    std::array<double, kMotionStates> rate;
    system_.motion(phase, regime, y.data(), arms, orbit_.torques, at, rate.data());
    system_.slopes(phase, regime, y.data(), at, arms, rate.data(), s);
    s.load = regime.load(at.mesh_force);
    out.error_by_approach = at.mesh.gear_contact_radius / constants_.gear_radius;
    out.velocity_by_approach =
        -system_.gear_radius_by_approach(phase, y[kMeshApproach]) * y[kGearSpeed];
  }

  /// The parts of a piece and the later stages of its step. The end may be the start of the piece
  /// behind it.
  void evaluate_instants(std::size_t index) {
    const OrbitPiece& p = orbit_.pieces[index];
    FrictionArms arms[3];
    MeshPhase phase[3];
    for (int part = 0; part < 3; ++part) {
      arms[part] = friction_.at(p.phase + 0.5 * part * p.length);
      phase[part] = phase_of(p, part);
    }
    behind_ = part_[0];
    if (index + 1 < orbit_.pieces.size() && !is_event(index)) {
      part_[2] = behind_;
    } else {
      evaluate(phase[2], p.regime, p.end, arms[2], part_[2]);
    }
    evaluate(phase[1], p.regime, p.middle, arms[1], part_[1]);
    evaluate(phase[0], p.regime, p.start, arms[0], part_[0]);
    const std::array<double, 8>* rate = &part_[0].slopes.rate;
    for (int n = 1; n < 4; ++n) {
      MarchState stage = p.start;
      for (int i = 0; i < kRates; ++i) stage[i] += kRungeKuttaNode[n] * p.length * (*rate)[i];
      const int part = n == 3 ? 2 : 1;
      evaluate(phase[part], p.regime, stage, arms[part], stage_[n]);
      rate = &stage_[n].slopes.rate;
    }
  }

  /// Whether flanks part or meet, or their load begins or ends, between a piece and the next one.
  bool is_event(std::size_t index) const {
    return orbit_.pieces[index].regime != orbit_.pieces[index + 1].regime;
  }

  /// Takes the adjoints back across the place where flanks part or meet, at the end of a piece: at
  /// a fixed phase the state changes by (f- - f+) dphi, dphi the phase change of the place.
  void cross_event(std::size_t index) {
    const OrbitPiece &before = orbit_.pieces[index], &after = orbit_.pieces[index + 1];
    if (before.regime.side == after.regime.side) return;
    const double speed = std::abs(contacts_.at(index, 2).transmission_velocity);
    least_touch_speed_ = std::min(least_touch_speed_, speed);
    greatest_touch_speed_ = std::max(greatest_touch_speed_, speed);
    for (int i = 0; i < kRates; ++i) {
      const double jump = part_[2].slopes.rate[i] - behind_.slopes.rate[i];
      for (int g = 0; g < kGroups; ++g) {
        for (int f = 0; f < kAdjointLanes; ++f) event_adjoint_[g][f] += jump * adjoint_[g][i][f];
      }
    }
  }

  /// Derivatives by the section states.
  using ByState = std::array<double, kRates>;
  static ByState by_state(const DifferentiatedInstant& at, const ArmSlopes& by_motion) {
    ByState out{};
    const StageSlopes& s = at.slopes;
    out[kMeshApproach] = by_motion[0] * s.force_by_approach;
    out[kPinionSpeed] = by_motion[0] * s.damping * s.relative_radius + by_motion[1];
    out[kGearSpeed] = -by_motion[0] * s.damping * s.gear_radius + by_motion[2];
    return out;
  }

  /// What displacements of middle and end of the piece at hand do to the quantities of each group,
  /// at fixed phases and with the friction arms held.
  std::array<AdjointRow, kGroups> weighed(const EventShift::MiddleAndEnd& moved) const {
    std::array<AdjointRow, kGroups> out{};
    for (int i = 0; i < kRates; ++i) {
      for (int f = 0; f < kAdjointLanes; ++f) {
        for (int g = 0; g < kGroups; ++g) out[g][f] += moved.end[i] * adjoint_[g][i][f];
        out[kOfFigures][f] += moved.end[i] * direct_[2][i][f] + moved.middle[i] * direct_[1][i][f];
      }
    }
    return out;
  }

  /// Adds what the change of the event at the end of a piece does through the state there: there
  /// the transmission error is that of touching flanks, or the mesh force is 0. `off_motion`:
  /// the result of EventShift::off_motion_by() for the event.
  void pass_event(std::size_t index, const EventShift::MiddleAndEnd& off_motion) {
    const OrbitPiece& p = orbit_.pieces[index];
    const bool touch = p.regime.side != orbit_.pieces[index + 1].regime.side;
    const DifferentiatedInstant& end = part_[2];
    ByState zero{};
    if (touch) {
      zero[kMeshApproach] = end.error_by_approach;
    } else {
      zero = by_state(end, {1, 0, 0});
    }
    double slope = touch ? contacts_.at(index, 2).transmission_velocity * end.slopes.time
                         : event_shift_.force_slope(index, 2);
    const std::array<AdjointRow, kGroups> off = weighed(off_motion);
    for (int i = 1; i < kRates; ++i) slope += zero[i] * off_motion.end[i];
    for (int i = 1; i < kRates; ++i) {
      const double change = -zero[i] / slope;
      for (int g = 0; g < kGroups; ++g) {
        for (int f = 0; f < kAdjointLanes; ++f) {
          adjoint_[g][i][f] += change * (event_adjoint_[g][f] + off[g][f]);
        }
      }
    }
  }

  bool pass_piece(std::size_t index) {
    const OrbitPiece& p = orbit_.pieces[index];
    const bool begins = index > 0 && is_event(index - 1);
    const bool ends = index + 1 < orbit_.pieces.size() && is_event(index);
    PieceSlopes slopes;
    slopes.length = p.length;
    slopes.stages = {&part_[0].slopes, &stage_[1].slopes, &stage_[2].slopes, &stage_[3].slopes};
    for (int part = 0; part < 3; ++part) {
      slopes.parts[part] = &part_[part].slopes;
      const ContactsAt& at = contacts_.at(index, part);
      slopes.arm[part] = {at.arm[0], at.arm[1]};
    }
    for (StateAdjoint& each : direct_) each = {};
    AdjointRow begin_adjoint{};
    EventShift::MiddleAndEnd off_motion[2];  // by the phase of the start and of the end
    const bool all = wanted_ == Wanted::kAll;
    if (all) {
      if ((begins || ends) && !event_shift_.follow_motion(index, slopes, begins, ends)) {
        return false;
      }
      add_integrals(index, begins, ends, begin_adjoint);
      if (begins) off_motion[0] = event_shift_.off_motion_by(1, 0);
      if (ends) off_motion[1] = event_shift_.off_motion_by(0, 1);
      if (minimum_.piece == index) differentiate_extreme(p, minimum_, kMinimum);
      if (maximum_.piece == index) differentiate_extreme(p, maximum_, kMaximum);
    }
    if (ends) pass_event(index, off_motion[1]);
    event_adjoint_ = weighed(off_motion[0]);
    for (int f = 0; f < kAdjointLanes; ++f) event_adjoint_[kOfFigures][f] += begin_adjoint[f];

    const std::span groups(adjoint_.data(), all ? kGroups : kOfEnd + 1);
    std::array<PieceAdjoint, kGroups> by;
    pass_back(instruction_set_, constants_, slopes, all ? &direct_ : nullptr, groups, by.data());
    if (!all) return true;
    for (int g = 0; g < kGroups; ++g) {
      for (int f = 0; f < kAdjointLanes; ++f) {
        by_pinion_torque_[g][f] += by[g].pinion_torque[f];
        by_wheel_torque_[g][f] += by[g].wheel_torque[f];
      }
      for (int part = 0; part < 3; ++part) {
        contacts_.weigh_arms(contacts_.at(index, part), g, by[g].arm[part]);
      }
    }
    return true;
  }

  double input_speed(double pinion_shaft_speed, double wheel_speed) const {
    return system_.input_speed(orbit_.torques, pinion_shaft_speed, wheel_speed);
  }

  /// Adds the integrals of a piece by Simpson's rule. An end of the piece that is an event moves
  /// with it, and the middle half as far. Where the load begins or ends, the integrands stay 0; at
  /// a fixed phase they would have infinite derivatives, because they rise there like a power below
  /// 1 of the force.
  void add_integrals(std::size_t index, bool begins, bool ends, AdjointRow& begin_adjoint) {
    const OrbitPiece& p = orbit_.pieces[index];
    AdjointRow sum{};
    for (int part = 0; part < 3; ++part) {
      const ContactsAt& at = contacts_.at(index, part);
      if (!event_shift_.has_load(at)) continue;
      const MarchState& y = state_of(p, part);
      const double phase_weight = p.length / 6 * (part == 1 ? 4 : 1);
      const double weight = phase_weight * system_.cycle_angle() / y[kPinionSpeed];
      const double speed = input_speed(y[kPinionShaftSpeed], y[kWheelSpeed]);
      const double share = at.sum[kLossSum] / speed;
      const double by_loss = 2 * share / speed;  // of the square
      for (int f = 0; f < kIntegrals; ++f) {
        const bool squared = f == kSquaredLoss;
        const double value = weight * (squared ? share * share : at.sum[f]);
        ArmSlopes slopes = at.sum_slopes[squared ? kLossSum : f];
        if (squared) {
          for (double& each : slopes) each *= by_loss;
        }
        ByState by = by_state(part_[part], slopes);
        for (double& each : by) each *= weight;
        by[kPinionSpeed] -= value / y[kPinionSpeed];
        if (squared) {
          // By the speed at which the power comes in.
          by[kPinionShaftSpeed] -= weight * by_loss * share * input_speed(1, 0);
          by[kWheelSpeed] -= weight * by_loss * share * input_speed(0, 1);
        }
        for (int i = 1; i < kRates; ++i) direct_[part][i][f] += by[i];
        sum[f] += value;
        if (!begins && !ends) continue;
        // Of the events' phases.
        const double change = event_shift_.integrands_along(part)[f];
        begin_adjoint[f] += begins ? (1 - 0.5 * part) * phase_weight * change : 0;
        event_adjoint_[kOfFigures][f] += ends ? 0.5 * part * phase_weight * change : 0;
      }
      contacts_.weigh_sums(at, weight, kSquaredLoss, weight * by_loss);
    }
    for (int f = 0; f < kIntegrals; ++f) {
      integral_[f] += sum[f];
      if (begins) begin_adjoint[f] -= sum[f] / p.length;
      if (ends) event_adjoint_[kOfFigures][f] += sum[f] / p.length;
    }
  }

  struct Extreme {
    double value;
    std::size_t piece = 0;
    int half = 0;
    double t = 0;  // in the half
  };
  /// Of the cubic through both ends of the half, at its place.
  void differentiate_extreme(const OrbitPiece& p, const Extreme& extreme, int lane) {
    const double t = extreme.t, u = 1 - t;
    const double value[2] = {(1 + 2 * t) * u * u, (1 + 2 * u) * t * t};
    const double slope[2] = {t * u * u, -t * t * u};
    const double h = state_of(p, extreme.half + 1)[kTime] - state_of(p, extreme.half)[kTime];
    double by_h = 0;
    for (const int end : {0, 1}) {
      const DifferentiatedInstant& at = part_[extreme.half + end];
      StateAdjoint& to = direct_[extreme.half + end];
      to[kMeshApproach][lane] +=
          value[end] * at.error_by_approach + h * slope[end] * at.velocity_by_approach;
      to[kPinionSpeed][lane] += h * slope[end] * at.slopes.relative_radius;
      to[kGearSpeed][lane] -= h * slope[end] * at.slopes.gear_radius;
      by_h += slope[end] * contacts_.at(extreme.piece, extreme.half + end).transmission_velocity;
    }
    direct_[extreme.half + 1][kTime][lane] += by_h;
    direct_[extreme.half][kTime][lane] -= by_h;
  }

  std::optional<OrbitSensitivity> close() {
    // Equations: states return, the period takes its time. Unknowns: states, the unknown torque.
    using Square = Eigen::Matrix<double, kRates, kRates>;
    const double time = orbit_.period * system_.cycle_angle() / mean_speed_;
    const auto& by_unknown = solve_wheel_torque_ ? by_wheel_torque_ : by_pinion_torque_;
    const auto& by_known = solve_wheel_torque_ ? by_pinion_torque_ : by_wheel_torque_;
    // By the unknowns: of the equations, each over its scale; of what the figures are made of.
    Square jacobian, figures;
    const double torque_scale = scales_.torque;
    for (int j = 0; j < kRates; ++j) {
      const bool torque = j == kSectionStates;
      const double scale = torque ? torque_scale : scales_.of(system_.mesh(), j + 1);
      for (int f = 0; f < kAdjointLanes; ++f) {
        const auto by = [&](int g) { return torque ? by_unknown[g][f] : adjoint_[g][j + 1][f]; };
        jacobian(f, j) = scale * (by(kOfEnd) - (f == j + 1 ? 1 : 0));
        figures(f, j) = scale * by(kOfFigures);
      }
    }
    for (int f = 0; f < kRates; ++f) {
      jacobian.row(f) /= f == kTime ? time : scales_.of(system_.mesh(), f);
    }
    const Eigen::PartialPivLU<Square> factors(jacobian);
    if (!(factors.rcond() > 1e-12)) return std::nullopt;
    // What a residual of each equation does to the figures and to the unknown torque.
    Eigen::Matrix<double, kRates, kRates + 1> right;
    right.leftCols<kRates>() = figures.transpose();
    right.col(kRates).setZero();
    right(kSectionStates, kRates) = torque_scale;
    Eigen::Matrix<double, kRates, kRates + 1> solved;
    solved = factors.transpose().solve(right);
    Eigen::Matrix<double, kRates + 1, kRates> by_residual = solved.transpose();
    for (int f = 0; f < kRates; ++f) {
      by_residual.col(f) /= f == kTime ? time : scales_.of(system_.mesh(), f);
    }
    if (!by_residual.allFinite()) return std::nullopt;

    using ByOrbitParameters = Eigen::Matrix<double, 1, kOrbitParameters>;
    Eigen::Matrix<double, kRates + 1, kOrbitParameters> total;
    Eigen::Matrix<double, kRates, kOrbitParameters> of_end, direct;
    const OrbitContacts::ByParameters by_parameter = contacts_.by_parameters();
    of_end.leftCols<kContactParameters>() = by_parameter.topRows<kRates>();
    direct.leftCols<kContactParameters>() = by_parameter.bottomRows<kRates>();
    for (int f = 0; f < kAdjointLanes; ++f) {
      of_end(f, kKnownTorqueParameter) = by_known[kOfEnd][f];
      direct(f, kKnownTorqueParameter) = by_known[kOfFigures][f];
      of_end(f, kMeanSpeedParameter) = f == kTime ? time / mean_speed_ : 0;
      direct(f, kMeanSpeedParameter) = 0;
    }
    total.noalias() = -by_residual * of_end;
    total.topRows<kRates>() += direct;

    ByOrbitParameters torque[2] = {ByOrbitParameters::Zero(), ByOrbitParameters::Zero()};
    torque[solve_wheel_torque_ ? 1 : 0] = total.row(kRates);
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
      const double value = integral_[sum] / time;
      set_figure(figure, value, total.row(sum) / time + value / mean_speed_ * speed);
    };
    const auto set_ratio = [&](OrbitFigure figure, int sum) {
      const double value = integral_[sum] / integral_[kLoadSum];
      set_figure(figure, value,
                 (total.row(sum) - value * total.row(kLoadSum)) / integral_[kLoadSum]);
    };
    set_mean(OrbitFigure::kMeshLossPower, kLossSum);
    set_mean(OrbitFigure::kPinionFrictionTorque, kFrictionTorqueSum);
    set_ratio(OrbitFigure::kFilmRatio, kFilmRatioLoadSum);
    set_ratio(OrbitFigure::kContactTemperature, kTemperatureLoadSum);
    const ByOrbitParameters loss_by = total.row(kLossSum);
    const double turned = orbit_.period * system_.cycle_angle();
    set_figure(OrbitFigure::kMeshLossTorque, integral_[kLossSum] / turned, loss_by / turned);
    const double energy = 100 * integral_[kLossSum] / (input * turned);
    set_figure(OrbitFigure::kInefficiencyEnergyMean, energy,
               100 / (input * turned) * loss_by - energy / input * input_by);
    const double rms = inefficiency_rms(std::sqrt(integral_[kSquaredLoss] / time), input);
    set_figure(OrbitFigure::kInefficiencyRms, rms,
               rms * (0.5 / integral_[kSquaredLoss] * total.row(kSquaredLoss) +
                      0.5 / mean_speed_ * speed - 1 / input * input_by));
    set_figure(OrbitFigure::kTransmissionErrorMinimum, minimum_.value, total.row(kMinimum));
    set_figure(OrbitFigure::kTransmissionErrorMaximum, maximum_.value, total.row(kMaximum));
    constexpr double kLittleForce = 0.01;  // of the mean force
    constexpr double kLittleSpeed = 0.01;  // of the greatest one
    out.one_sided = contacts_.one_sided() ||
                    least_touch_speed_ < kLittleSpeed * greatest_touch_speed_ ||
                    (!orbit_.contact_loss && orbit_.least_pressing_force < kLittleForce);
    return out;
  }

  const GearPairSystem& system_;
  const MeshGrid& grid_;
  const PeriodicOrbit& orbit_;
  FrozenFriction friction_;
  double mean_speed_;
  bool solve_wheel_torque_;
  MarchScales scales_;
  double light_load_;
  InstructionSet instruction_set_;
  const MotionConstants& constants_;
  ContactSensitivityModel model_;
  OrbitContacts contacts_;
  EventShift event_shift_;
  Wanted wanted_;
  /// Of the piece at hand, and the start of the one behind it.
  DifferentiatedInstant part_[3]{}, stage_[4]{}, behind_{};
  std::array<StateAdjoint, 3> direct_;
  std::array<StateAdjoint, kGroups> adjoint_{};
  std::array<AdjointRow, kGroups> event_adjoint_{};  ///< of the phase of the event at a piece's end
  std::array<AdjointRow, kGroups> by_pinion_torque_{}, by_wheel_torque_{};
  AdjointRow integral_{};
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();
  double least_touch_speed_ = kInfinity, greatest_touch_speed_ = 0;  ///< [m/s]
  Extreme minimum_{kInfinity}, maximum_{-kInfinity};
};

}  // namespace

std::optional<OrbitSensitivity> orbit_sensitivity(const PeriodicProblem& problem,
                                                  const PeriodicOrbit& orbit) {
  return OrbitDifferentiator(problem, orbit, OrbitDifferentiator::Wanted::kAll).run();
}

std::optional<double> multiplier_with_friction(const PeriodicProblem& problem,
                                               const PeriodicOrbit& orbit) {
  return OrbitDifferentiator(problem, orbit, OrbitDifferentiator::Wanted::kMultiplier)
      .largest_multiplier();
}

}  // namespace tribodyn
