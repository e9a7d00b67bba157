#include "core/dynamics/periodic_orbit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "core/dynamics/period_correction.h"

namespace tribodyn {
namespace {

constexpr int kUnknowns = 8;  // seven states and the torque
using Vector = Eigen::Matrix<double, kUnknowns, 1>;

/// Extremes of the cubic through two values with their slopes, over [0, h].
void add_cubic_extremes(double x0, double v0, double x1, double v1, double h, double& low,
                        double& high) {
  low = std::min({low, x0, x1});
  high = std::max({high, x0, x1});
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

class Shooting {
 public:
  Shooting(GearPairSystem& system, const OrbitRequest& request, PeriodicOrbit& orbit)
      : system_(system),
        request_(request),
        orbit_(orbit),
        scales_(march_scales(system, request.mean_pinion_speed)),
        march_(system, scales_, request.steps, orbit.period, request.solve_wheel_torque) {
    for (int i = 0; i + 1 < kUnknowns; ++i) scale_(i) = scales_.of(system.mesh(), i + 1);
    scale_(kUnknowns - 1) = scales_.torque;
    period_time_ = orbit.period * system.cycle_angle() / request.mean_pinion_speed;
  }

  bool march(MarchState& state, Sensitivity* s) {
    if (request_.interrupted && request_.interrupted()) throw Cancelled();
    start_regime(state);
    return march_.run(orbit_.friction, request_.keep_contact, state, s, &pieces_);
  }

  /// Marches on, with the torque that the train's momentum asks for and the mean speed put back.
  bool let_run(int cycles) {
    for (int i = 0; i < cycles; ++i) {
      MarchState y = orbit_.state;
      if (!march(y, nullptr)) return false;
      correct_period(system_, orbit_.state, orbit_.period, request_.mean_pinion_speed,
                     request_.solve_wheel_torque, y);
      orbit_.state = y;
    }
    return true;
  }

  /// One step of Newton's method; its scaled length, NaN where the march breaks down.
  double newton() {
    MarchState y = orbit_.state;
    if (!march(y, &sensitivity_)) return std::nan("");
    Eigen::Matrix<double, kUnknowns, kUnknowns> jacobian;
    Vector residual;
    for (int i = 0; i + 1 < kUnknowns; ++i) {
      jacobian.row(i) = sensitivity_[i + 1].matrix();
      jacobian(i, i) -= 1;
      residual(i) = (y[i + 1] - orbit_.state[i + 1]) / scale_(i);
      jacobian.row(i) /= scale_(i);
    }
    jacobian.row(kUnknowns - 1) = sensitivity_[kTime].matrix() / period_time_;
    residual(kUnknowns - 1) = y[kTime] / period_time_ - 1;
    const Vector step = (jacobian * scale_.asDiagonal()).partialPivLu().solve(-residual);
    for (int i = 0; i + 1 < kUnknowns; ++i) orbit_.state[i + 1] += scale_(i) * step(i);
    add_to_unknown(scale_(kUnknowns - 1) * step(kUnknowns - 1));
    return step.norm();
  }

  /// Friction on the pieces of the last march, and the figures with it. False when refused.
  bool evaluate_friction() {
    const double light =
        1e-3 * scales_.torque / system_.mesh().mean_pinion_contact_radius();  // [N]
    orbit_.friction.clear();
    orbit_.pieces.resize(pieces_.size());
    orbit_.contact_loss = orbit_.tension = false;
    OrbitFigures f;
    double low = 1e300, high = -1e300, squares = 0, time = 0;
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      SolvedPiece& solved = orbit_.pieces[i];
      const OrbitPiece& p = solved.piece = pieces_[i];
      system_.regime = p.regime;
      const bool goes_on = i > 0 && pieces_[i - 1].regime.side == p.regime.side &&
                           pieces_[i - 1].regime.loaded == p.regime.loaded;
      const MarchState* states[3] = {&p.start, &p.middle, &p.end};
      for (int n = 0; n < 3; ++n) {
        Instant& at = solved.at[n];
        const double phase = p.phase + 0.5 * n * p.length;
        if (n == 0 && goes_on && std::floor(p.phase + 1e-9) == std::floor(p.phase - 1e-9)) {
          at = orbit_.pieces[i - 1].at[2];
        } else {
          // A cycle's end is not the next one's start: the pairs hand over their slots.
          const double inside = std::min(phase - std::floor(p.phase + 1e-9), 1.0);
          const int intervals = system_.mesh().intervals();
          system_.set_interval(std::clamp(static_cast<int>(inside * intervals), 0, intervals - 1));
          system_.evaluate(inside, states[n]->data(), at);
          if (system_.refusal() != ContactStatus::kOk) return false;
          const double load = p.regime.side != 0 && p.regime.loaded
                                  ? std::max(0.0, p.regime.side * at.mesh_force)
                                  : 0;
          orbit_.friction.add(phase, load > light
                                         ? FrictionPerLoad{at.pinion_friction_torque / load,
                                                           at.gear_friction_torque / load}
                                         : orbit_.friction.last());
        }
        if (p.regime.side != 0 && p.regime.side * at.mesh_force < 0) orbit_.tension = true;
        const double rate =
            p.length * (n == 1 ? 4 : 1) / 6 * system_.cycle_angle() / (*states[n])[kPinionSpeed];
        const double share = at.loss_power / (*states[n])[kPinionShaftSpeed];
        f.loss_energy += rate * at.loss_power;
        squares += rate * share * share;
        time += rate;
      }
      if (p.regime.side == 0) orbit_.contact_loss = true;
      for (int n = 0; n < 2; ++n) {
        const double h = (*states[n + 1])[kTime] - (*states[n])[kTime];
        add_cubic_extremes(solved.at[n].transmission_error, solved.at[n].transmission_velocity,
                           solved.at[n + 1].transmission_error,
                           solved.at[n + 1].transmission_velocity, h, low, high);
      }
    }
    f.loss_rms = std::sqrt(squares / time);
    f.dte_minimum = low;
    f.dte_maximum = high;
    f.torque = request_.solve_wheel_torque ? system_.torques().wheel : system_.torques().pinion;
    orbit_.figures = f;
    return true;
  }

  /// But for the one nearest to 1: the train as a whole runs on at any speed.
  double largest_multiplier() const {
    Eigen::Matrix<double, kUnknowns - 1, kUnknowns - 1> monodromy;
    for (int i = 0; i + 1 < kUnknowns; ++i) {
      monodromy.row(i) = sensitivity_[i + 1].head<kUnknowns - 1>().matrix();
    }
    Eigen::VectorXcd multipliers =
        Eigen::EigenSolver<Eigen::MatrixXd>(monodromy, false).eigenvalues();
    Eigen::Index free = 0;
    (multipliers.array() - 1.0).abs().minCoeff(&free);
    multipliers(free) = 0;
    return multipliers.cwiseAbs().maxCoeff();
  }

  void start_regime(const MarchState& state) {
    if (request_.keep_contact) {
      system_.regime = {scales_side(), true};
    } else {
      system_.regime = system_.regime_of(0, state.data());
    }
    orbit_.regime = system_.regime;
  }
  const FixedStepMarch& marches() const { return march_; }

 private:
  int scales_side() const { return system_.torques().pinion >= 0 ? 1 : -1; }
  void add_to_unknown(double change) {
    Torques t = system_.torques();
    (request_.solve_wheel_torque ? t.wheel : t.pinion) += change;
    system_.set_torques(t);
  }

  GearPairSystem& system_;
  const OrbitRequest& request_;
  PeriodicOrbit& orbit_;
  MarchScales scales_;
  FixedStepMarch march_;
  Vector scale_;
  double period_time_;
  Sensitivity sensitivity_;
  std::vector<OrbitPiece> pieces_;
};

double relative(double a, double b) {
  const double size = std::max(std::abs(a), std::abs(b));
  return size > 0 ? std::abs(a - b) / size : 0;
}

}  // namespace

double OrbitFigures::distance(const OrbitFigures& other) const {
  // Where the transmission error passes through zero its extremes are measured by the larger one.
  const double dte = std::max({std::abs(dte_minimum), std::abs(dte_maximum),
                               std::abs(other.dte_minimum), std::abs(other.dte_maximum)});
  const double extremes = std::max(std::abs(dte_minimum - other.dte_minimum),
                                   std::abs(dte_maximum - other.dte_maximum));
  return std::max({relative(loss_rms, other.loss_rms), relative(loss_energy, other.loss_energy),
                   relative(torque, other.torque), dte > 0 ? extremes / dte : 0});
}

bool solve_periodic_orbit(GearPairSystem& system, const OrbitRequest& request, PeriodicOrbit& orbit,
                          MarchStatistics& statistics, long& marched_cycles) {
  constexpr int kMostSweeps = 24, kMostSteps = 14;
  Shooting shooting(system, request, orbit);
  system.set_torques(orbit.torques);
  const auto finish = [&](bool good) {
    const FixedStepMarch& march = shooting.marches();
    statistics.right_hand_sides += march.evaluations();
    statistics.accepted_steps += march.steps();
    statistics.events += march.events();
    orbit.torques = system.torques();
    return good;
  };
  if (orbit.friction.last().pinion == 0) {
    // The first friction, on the response's very first period.
    MarchState trial = orbit.state;
    ++marched_cycles;
    if (!shooting.march(trial, nullptr) || !shooting.evaluate_friction()) return finish(false);
  }
  if (request.first_cycles > 0) {
    marched_cycles += static_cast<long>(request.first_cycles) * orbit.period;
    if (!shooting.let_run(request.first_cycles)) return finish(false);
  }
  double previous_change = 0;
  OrbitFigures previous;
  for (int sweep = 0; sweep < kMostSweeps; ++sweep) {
    // No better than the friction is known.
    const double enough =
        std::max({1e-11, 0.02 * request.tolerance, 0.02 * std::min(previous_change, 0.05)});
    bool found = false;
    for (int i = 0; i < kMostSteps && !found; ++i) {
      marched_cycles += orbit.period;
      const double step = shooting.newton();
      if (!(step < 1e9)) return finish(false);
      found = step < enough;
      orbit.defect = step;
    }
    if (!found || !shooting.evaluate_friction()) return finish(false);
    const double change = sweep == 0 ? 1 : orbit.figures.distance(previous);
    previous = orbit.figures;
    // Sweeps contract like a geometric series.
    const double contraction =
        previous_change > 0 ? std::clamp(change / previous_change, 0.01, 0.9) : 0.9;
    previous_change = change;
    orbit.unsettled = change * contraction / (1 - contraction);
    if (sweep > 0 && (orbit.unsettled <= request.tolerance || change < 1e-13)) {
      orbit.largest_multiplier = shooting.largest_multiplier();
      return finish(true);
    }
  }
  return finish(false);
}

}  // namespace tribodyn
