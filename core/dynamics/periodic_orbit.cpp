#include "core/dynamics/periodic_orbit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>

#include "core/dynamics/period_correction.h"

namespace tribodyn {
namespace {

constexpr int kUnknowns = SectionMap::kUnknowns;
using Vector = SectionMap::Vector;

/// Sets the torques: nothing of what was tried before may show in a response.
MarchScales scales_at(const Torques& torques, GearPairSystem& system, double mean_pinion_speed) {
  system.set_torques(torques);
  return march_scales(system, mean_pinion_speed);
}

class Shooting {
 public:
  Shooting(GearPairSystem& system, OrbitFriction& friction, const MeshGrid& grid,
           const OrbitRequest& request, PeriodicOrbit& orbit)
      : system_(system),
        grid_(grid),
        request_(request),
        orbit_(orbit),
        scales_(scales_at(orbit.torques, system, request.mean_pinion_speed)),
        mean_force_(scales_.torque / system.mesh().mean_pinion_contact_radius()),
        march_(system, scales_, grid, orbit.period, request.solve_wheel_torque,
               std::clamp(1e-4 * request.tolerance, 1e-12, 1e-9)),
        friction_(friction) {
    for (int i = 0; i + 1 < kUnknowns; ++i) scale_(i) = scales_.of(system.mesh(), i + 1);
    scale_(kUnknowns - 1) = scales_.torque;
    period_time_ = orbit.period * system.cycle_angle() / request.mean_pinion_speed;
  }

  bool march(MarchState& state, Sensitivity* s) {
    if (request_.interrupted && request_.interrupted()) throw Cancelled();
    start_regime(state);
    return march_.run(orbit_.friction, request_.keep_contact, state, s, &orbit_.pieces);
  }

  /// Marches on, with the torque that the train's momentum asks for and the mean speed put back.
  bool let_run(int cycles) {
    constexpr int kRenewal = 20;
    for (int i = 0; i < cycles; ++i) {
      MarchState y = orbit_.state;
      if (!march(y, nullptr)) return false;
      if (request_.renew_friction && i % kRenewal == 0 && !evaluate_friction()) return false;
      correct_period(system_, orbit_.state, orbit_.period, request_.mean_pinion_speed,
                     request_.solve_wheel_torque, y);
      orbit_.state = y;
    }
    return true;
  }

  /// Leaves state and pieces as they are.
  bool renew_map() {
    MarchState y = orbit_.state;
    Sensitivity sensitivity;
    start_regime(y);
    if (!march_.run(orbit_.friction, request_.keep_contact, y, &sensitivity, nullptr)) return false;
    orbit_.map.emplace(sensitivity, scale_, period_time_);
    return true;
  }

  /// One step of Newton's method, with the derivatives at hand if there are any; its scaled length,
  /// NaN where the march breaks down. The pieces are those before the step.
  double improve() {
    MarchState y = orbit_.state;
    if (orbit_.map) {
      if (!march(y, nullptr)) return std::nan("");
    } else {
      Sensitivity sensitivity;
      if (!march(y, &sensitivity)) return std::nan("");
      orbit_.map.emplace(sensitivity, scale_, period_time_);
    }
    Vector residual;
    for (int i = 0; i + 1 < kUnknowns; ++i) {
      residual(i) = (y[i + 1] - orbit_.state[i + 1]) / scale_(i);
    }
    residual(kUnknowns - 1) = y[kTime] / period_time_ - 1;
    const Vector step = orbit_.map->step(residual);
    for (int i = 0; i + 1 < kUnknowns; ++i) orbit_.state[i + 1] += scale_(i) * step(i);
    add_to_unknown(scale_(kUnknowns - 1) * step(kUnknowns - 1));
    return step.norm();
  }

  /// Improves until a step is shorter than `enough`.
  bool converge(double enough) {
    orbit_.moved = 0;
    constexpr int kMostSteps = 20, kMostDerivatives = 6;
    double last = 0;
    int derivatives = 0;
    for (int i = 0; i < kMostSteps; ++i) {
      if (!orbit_.map) ++derivatives;
      const double step = orbit_.defect = improve();
      if (!(step < 1e9)) return false;
      orbit_.moved = std::max(orbit_.moved, step);
      if (step < enough) return true;
      // Derivatives from elsewhere have served their time.
      if (i > 0 && step > 0.2 * last) {
        if (derivatives >= kMostDerivatives) return false;
        orbit_.map.reset();
      }
      last = step;
    }
    return false;
  }

  /// Friction on the pieces of the last march, and the figures with it. False when refused.
  bool evaluate_friction() {
    if (!friction_.evaluate(grid_, orbit_.pieces, 1e-3 * mean_force_, orbit_.friction,
                            orbit_.figures)) {
      return false;
    }
    orbit_.least_pressing_force = friction_.least_pressing_force() / mean_force_;
    orbit_.contact_loss = std::any_of(orbit_.pieces.begin(), orbit_.pieces.end(),
                                      [](const OrbitPiece& p) { return p.regime.side == 0; });
    orbit_.figures.torque =
        request_.solve_wheel_torque ? system_.torques().wheel : system_.torques().pinion;
    return true;
  }

  void start_regime(const MarchState& state) {
    if (request_.keep_contact) {
      system_.regime = {scales_side(), true};
    } else {
      system_.regime = system_.regime_of(0, state.data());
    }
    orbit_.regime = system_.regime;
  }
  /// Hands over what has become of the torque and the work.
  void finish(MarchStatistics& statistics, long& marched_cycles) {
    statistics.right_hand_sides += march_.evaluations();
    statistics.accepted_steps += march_.steps();
    statistics.events += march_.events();
    marched_cycles += march_.steps() / grid_.steps();
    orbit_.torques = system_.torques();
  }

 private:
  int scales_side() const { return system_.torques().pinion >= 0 ? 1 : -1; }
  void add_to_unknown(double change) {
    Torques t = system_.torques();
    (request_.solve_wheel_torque ? t.wheel : t.pinion) += change;
    system_.set_torques(t);
  }

  GearPairSystem& system_;
  const MeshGrid& grid_;
  const OrbitRequest& request_;
  PeriodicOrbit& orbit_;
  MarchScales scales_;
  double mean_force_;
  FixedStepMarch march_;
  OrbitFriction& friction_;
  Vector scale_;
  double period_time_;
};

}  // namespace

SectionMap::SectionMap(const Sensitivity& sensitivity, const Vector& scale, double period) {
  Eigen::Matrix<double, kUnknowns, kUnknowns> jacobian;
  for (int i = 0; i + 1 < kUnknowns; ++i) {
    jacobian.row(i) = sensitivity[i + 1].matrix();
    monodromy_.row(i) = sensitivity[i + 1].head<kUnknowns - 1>().matrix() / scale(i);
    jacobian(i, i) -= 1;
    jacobian.row(i) /= scale(i);
  }
  jacobian.row(kUnknowns - 1) = sensitivity[kTime].matrix() / period;
  factors_.compute(jacobian * scale.asDiagonal());
  monodromy_ *= scale.head<kUnknowns - 1>().asDiagonal();
}

double SectionMap::multiplier_bound() const {
  if (multiplier_bound_ < 0) multiplier_bound_ = bound_of_multipliers();
  return multiplier_bound_;
}

double SectionMap::distance_from_doubling() const {
  using Square = Eigen::Matrix<double, kUnknowns - 1, kUnknowns - 1>;
  return 1 / Eigen::PartialPivLU<Square>(monodromy_ + Square::Identity()).inverse().norm();
}

/// |lambda|^k is at most the norm of the k-th power, once the multiplier nearest to 1 is taken out.
double SectionMap::bound_of_multipliers() const {
  constexpr double kUnknown = std::numeric_limits<double>::infinity();
  constexpr int kIterations = 3, kSquarings = 10;
  constexpr double kFound = 1e-6;
  using Square = Eigen::Matrix<double, kUnknowns - 1, kUnknowns - 1>;
  using Direction = Eigen::Matrix<double, kUnknowns - 1, 1>;
  const Eigen::PartialPivLU<Square> factors(monodromy_ - Square::Identity());
  Direction right = Direction::Ones(), left = Direction::Ones();
  for (int i = 0; i < kIterations; ++i) {
    right = factors.solve(right).normalized();
    left = factors.transpose().solve(left).normalized();
  }
  const double overlap = left.dot(right);
  const double nearest = left.dot(monodromy_ * right) / overlap;
  const double missed = (monodromy_ * right - nearest * right).norm() +
                        (monodromy_.transpose() * left - nearest * left).norm();
  if (!(missed < kFound * std::abs(overlap))) return kUnknown;
  Square power = monodromy_ - nearest / overlap * right * left.transpose();
  double log_norm = 0, exponent = 1;  // of the power: e^log_norm times the matrix at hand
  for (int i = 0; i < kSquarings; ++i) {
    power = (power * power).eval();
    const double norm = power.norm();
    if (norm == 0) return 0;
    exponent *= 2;
    log_norm = 2 * log_norm + std::log(norm);
    power /= norm;
  }
  return std::exp(log_norm / exponent);
}

double SectionMap::largest_multiplier() const {
  if (largest_multiplier_ >= 0) return largest_multiplier_;
  Eigen::Matrix<std::complex<double>, kUnknowns - 1, 1> multipliers =
      Eigen::EigenSolver<Eigen::Matrix<double, kUnknowns - 1, kUnknowns - 1>>(monodromy_, false)
          .eigenvalues();
  Eigen::Index free = 0;
  (multipliers.array() - 1.0).abs().minCoeff(&free);
  multipliers(free) = 0;
  return largest_multiplier_ = multipliers.cwiseAbs().maxCoeff();
}

bool approach_without_friction(GearPairSystem& system, OrbitFriction& friction,
                               const MeshGrid& grid, const OrbitRequest& request,
                               PeriodicOrbit& orbit, MarchStatistics& statistics,
                               long& marched_cycles) {
  Shooting shooting(system, friction, grid, request, orbit);
  // Friction changes the response by some percent.
  const bool good = shooting.let_run(request.first_cycles) && shooting.converge(1e-3);
  shooting.finish(statistics, marched_cycles);
  return good;
}

bool solve_periodic_orbit(GearPairSystem& system, OrbitFriction& friction, const MeshGrid& grid,
                          const OrbitRequest& request, PeriodicOrbit& orbit,
                          MarchStatistics& statistics, long& marched_cycles) {
  constexpr int kMostSweeps = 24;
  constexpr double kLikelyContraction = 0.2, kUnmeasured = 0.3;
  Shooting shooting(system, friction, grid, request, orbit);
  const auto finish = [&](bool good) {
    shooting.finish(statistics, marched_cycles);
    return good;
  };
  const auto parts_for_sure = [&](double pull) {
    return request.keep_contact && orbit.least_pressing_force < -pull;
  };
  double last_change = 0;
  if (orbit.contraction == 0) {
    if (!shooting.evaluate_friction()) return finish(false);
    // Friction calms some responses.
    if (parts_for_sure(0.25)) return finish(true);
    orbit.contraction = kLikelyContraction;
  }
  OrbitFigures previous = orbit.figures;
  for (int sweep = 1; sweep < kMostSweeps; ++sweep) {
    // No better than the friction is known.
    const double enough =
        std::max({1e-11, 0.2 * request.tolerance, 0.1 * orbit.contraction * last_change});
    if (!shooting.converge(enough) || !shooting.evaluate_friction()) return finish(false);
    const double change = orbit.figures.distance(previous);
    previous = orbit.figures;
    // Sweeps contract like a geometric series; the first change is not theirs alone.
    const bool measured = last_change > 0;
    if (measured) orbit.contraction = std::clamp(change / last_change, 0.02, 0.9);
    last_change = change;
    const double contraction = std::max(orbit.contraction, measured ? 0.0 : kUnmeasured);
    const double moved = measured ? change : std::max(change, 0.1 * orbit.moved);
    orbit.unsettled = moved * contraction / (1 - contraction) + orbit.defect;
    if (orbit.unsettled <= request.tolerance || change < 1e-13) return finish(true);
    if (parts_for_sure(kClearPull + change)) return finish(true);
  }
  return finish(false);
}

bool renew_map(GearPairSystem& system, OrbitFriction& friction, const MeshGrid& grid,
               const OrbitRequest& request, PeriodicOrbit& orbit, MarchStatistics& statistics,
               long& marched_cycles) {
  Shooting shooting(system, friction, grid, request, orbit);
  const bool good = shooting.renew_map();
  shooting.finish(statistics, marched_cycles);
  return good;
}

}  // namespace tribodyn
