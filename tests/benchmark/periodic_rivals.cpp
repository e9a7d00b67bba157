#include "tests/benchmark/periodic_rivals.h"

#include <cvode/cvode.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/numerics/gauss_legendre.h"
#include "core/periodic/period_correction.h"
#include "tests/benchmark/cvode_march.h"
#include "tests/benchmark/motion_batch.h"

namespace tribodyn {
namespace {

// The unknowns of the section are its seven states (all but time), then T_s; the equations are the
// time of the period, then the seven states.
constexpr int kTorque = kStates - 1;

constexpr double kLeastResidual = 1e-10;  // of Newton, over the scales of the march
constexpr int kMostIterates = 20;

double inefficiency_of(double loss_share_squared, double time, const Torques& torques) {
  return 100 / std::abs(torques.pinion) * std::sqrt(loss_share_squared / time);
}

void start_period(const MarchState& from, double* y) {
  std::copy(from.begin(), from.end(), y);
  y[kTime] = y[kLossWork] = y[kLossShareSquared] = 0;
}

/// CVODE on the motion under torques, which may change between periods.
CvodeMarch march_of(MotionBatch& batch, const Torques& torques, double tolerance) {
  return {CV_ADAMS, batch.tolerances(tolerance),
          [&batch, &torques](double phase, const double* y, double* rates) {
            std::array<MotionInstant, 1> x;
            x[0].phase = phase;
            std::copy_n(y, kMarchComponents, x[0].state.begin());
            batch.evaluate(x, torques);
            std::copy(x[0].rate.begin(), x[0].rate.end(), rates);
          }};
}

/// The static equilibrium of the mesh at a phase, on the drive flanks and without friction.
MarchState static_state(const RivalProblem& problem, double phase) {
  MarchState out = problem.start;
  out[kTime] = phase * problem.system.cycle_angle() / problem.mean_pinion_speed;
  Mechanics at;
  for (int i = 0; i < 3; ++i) {  // the radius of the gear depends weakly on the approach
    problem.system.mechanics(phase, {}, out.data(), at);
    const double force = problem.torques.pinion / at.mesh.pinion_contact_radius;
    out[kMeshApproach] += force / at.mesh.mesh_stiffness - at.deflection;
    out[kGearSpeed] -= at.transmission_velocity / at.mesh.gear_contact_radius;
  }
  return out;
}

/// Where the first mesh cycles have led.
struct FirstGuess {
  MarchState state;
  Torques torques;
  std::vector<MarchState> samples;  ///< of the last cycle; without cycles static ones
};

/// `phases` of the samples, ascending.
FirstGuess first_guess(const RivalProblem& problem, const std::vector<double>& phases) {
  constexpr double kTolerance = 1e-3;
  FirstGuess out{problem.start, problem.torques, {}};
  if (problem.first_cycles == 0) {
    for (const double phase : phases) out.samples.push_back(static_state(problem, phase));
    return out;
  }
  MotionBatch batch(problem, 1);
  CvodeMarch march = march_of(batch, out.torques, kTolerance);
  for (int cycle = 1; cycle <= problem.first_cycles; ++cycle) {
    const MarchState before = out.state;
    start_period(before, march.state());
    march.start();
    for (const double phase : phases) {
      if (cycle < problem.first_cycles) break;
      march.to(phase);
      out.samples.emplace_back();
      std::copy_n(march.state(), kMarchComponents, out.samples.back().begin());
    }
    march.to(1);
    std::copy_n(march.state(), kMarchComponents, out.state.begin());
    correct_period(problem.system, before, 1, problem.mean_pinion_speed, false, out.torques,
                   out.state);
  }
  return out;
}

/// Decides when Newton's Jacobian is renewed and when Newton ends.
class Iteration {
 public:
  /// Whether to correct an iterate with that residual.
  bool continues(double residual) {
    renews_ = !(residual < 0.5 * last_);
    last_ = residual;
    return std::isfinite(residual) && residual > kLeastResidual && ++corrections_ < kMostIterates;
  }
  bool is_first() const { return corrections_ <= 1; }
  /// Whether the last correction did not help enough.
  bool renews() const { return renews_; }

 private:
  double last_ = std::numeric_limits<double>::infinity();
  int corrections_ = 0;
  bool renews_ = true;
};

void shoot(const RivalProblem& problem, double tolerance, const OnIterate& on_iterate) {
  constexpr double kColumnTolerance = 1e-4;  // of the Jacobian: Newton corrects what is left
  FirstGuess at = first_guess(problem, {});
  MotionBatch batch(problem, 1);
  CvodeMarch plain = march_of(batch, at.torques, tolerance);
  std::vector<double> tolerances = batch.tolerances(tolerance);
  tolerances.resize(kMarchComponents + kStates * kStates, std::max(tolerance, kColumnTolerance));
  using Columns = Eigen::Map<StateMatrix>;
  CvodeMarch varied(CV_ADAMS, tolerances, [&](double phase, const double* y, double* rates) {
    std::array<MotionInstant, 1> x;
    x[0].phase = phase;
    std::copy_n(y, kMarchComponents, x[0].state.begin());
    batch.evaluate(x, at.torques);
    std::copy(x[0].rate.begin(), x[0].rate.end(), rates);
    Columns out(rates + kMarchComponents);
    out = batch.slopes(x[0]) * Eigen::Map<const StateMatrix>(y + kMarchComponents);
    out(MotionBatch::kTurned, kTorque) += batch.slope_by_torque(x[0]);
  });
  StateMatrix start = StateMatrix::Zero();  // of the columns
  for (int i = 1; i < kStates; ++i) start(i, i - 1) = 1;

  Eigen::PartialPivLU<StateMatrix> jacobian;
  for (Iteration newton;;) {
    CvodeMarch& march = newton.renews() ? varied : plain;
    start_period(at.state, march.state());
    if (newton.renews()) Columns(march.state() + kMarchComponents) = start;
    march.start();
    march.to(1);
    const double* end = march.state();
    on_iterate(inefficiency_of(end[kLossShareSquared], end[kTime], at.torques));
    if (newton.renews()) jacobian.compute(Columns(march.state() + kMarchComponents) - start);
    StateColumn residual;
    residual(kTime) = end[kTime] / batch.scale(kTime) - batch.scaled_period();
    for (int i = 1; i < kStates; ++i) residual(i) = (end[i] - at.state[i]) / batch.scale(i);
    if (!newton.continues(residual.norm())) return;
    const StateColumn step = jacobian.solve(residual);
    for (int i = 1; i < kStates; ++i) at.state[i] -= step(i - 1) * batch.scale(i);
    at.torques.pinion -= step(kTorque) * batch.torque_scale();
  }
}

class GaussCollocation {
 public:
  GaussCollocation(const RivalProblem& problem, int intervals)
      : batch_(problem, static_cast<std::size_t>(intervals * kPoints)),
        width_(1.0 / intervals),
        rule_(gauss_legendre<kPoints>()),
        intervals_(static_cast<std::size_t>(intervals)),
        nodes_(static_cast<std::size_t>(intervals) + 1) {
    // Row j integrates the polynomial through the points from 0 to point j.
    Eigen::Matrix<double, kPoints, kPoints> powers, integrals;
    for (int j = 0; j < kPoints; ++j) {
      for (int k = 0; k < kPoints; ++k) {
        powers(j, k) = std::pow(rule_.node(j), k);
        integrals(j, k) = std::pow(rule_.node(j), k + 1) / (k + 1);
      }
    }
    integral_ = integrals * powers.inverse();
    std::vector<double> phases;
    for (int i = 0; i < intervals; ++i) {
      phases.push_back(i * width_);
      for (int j = 0; j < kPoints; ++j) phases.push_back((i + rule_.node(j)) * width_);
    }
    phases.push_back(1);
    const FirstGuess guess = first_guess(problem, phases);
    torques_ = guess.torques;
    for (std::size_t n = 0; n < phases.size(); ++n) {
      if (n % (kPoints + 1) == 0) {
        nodes_[n / (kPoints + 1)] = scaled(guess.samples[n]);
      } else {
        points_.push_back({phases[n], guess.samples[n], {}, {}, {}});
      }
    }
  }

  void solve(const OnIterate& on_iterate) {
    for (Iteration newton;;) {
      batch_.evaluate(points_, torques_);
      on_iterate(inefficiency_of(integral_of(kLossShareSquared), integral_of(kTime), torques_));
      const double residual = set_residuals();
      if (!newton.continues(residual)) return;
      if (newton.is_first() || newton.renews()) {
        for (std::size_t i = 0; i < intervals_.size(); ++i) eliminate(i);
      }
      step();
    }
  }

 private:
  static constexpr int kPoints = 4;
  static constexpr int kBlock = kPoints * kStates;
  /// Derivatives of what follows from a node and the torque.
  template <int kRows>
  using ByNode = Eigen::Matrix<double, kRows, kStates + 1>;

  struct Interval {
    Eigen::PartialPivLU<Eigen::Matrix<double, kBlock, kBlock>> points;  // eliminates the points
    Eigen::Matrix<double, kStates, kBlock> gain;                        // next node by the points
    ByNode<kBlock> points_by_node;
    ByNode<kStates> next_by_node;
    Eigen::Matrix<double, kBlock, 1> point_residuals;
    StateColumn next_residual;
  };

  StateColumn scaled(const MarchState& y) const {
    StateColumn out;
    for (int i = 0; i < kStates; ++i) out(i) = y[i] / batch_.scale(i);
    return out;
  }
  MotionInstant& point(std::size_t interval, int j) {
    return points_[interval * kPoints + static_cast<std::size_t>(j)];
  }
  double integral_of(int component) {
    double out = 0;
    for (std::size_t n = 0; n < points_.size(); ++n) {
      out += rule_.weight(static_cast<int>(n % kPoints)) * points_[n].rate[component];
    }
    return width_ * out;
  }

  /// Returns their root mean square.
  double set_residuals() {
    double sum = end_residual().squaredNorm();
    for (std::size_t i = 0; i < intervals_.size(); ++i) {
      Interval& here = intervals_[i];
      here.next_residual = nodes_[i] - nodes_[i + 1];
      std::array<StateColumn, kPoints> rates;
      for (int j = 0; j < kPoints; ++j) {
        rates[j] = scaled(point(i, j).rate);
        here.next_residual += width_ * rule_.weight(j) * rates[j];
      }
      for (int j = 0; j < kPoints; ++j) {
        StateColumn r = nodes_[i] - scaled(point(i, j).state);
        for (int l = 0; l < kPoints; ++l) r += width_ * integral_(j, l) * rates[l];
        here.point_residuals.segment<kStates>(j * kStates) = r;
      }
      sum += here.point_residuals.squaredNorm() + here.next_residual.squaredNorm();
    }
    return std::sqrt(sum / static_cast<double>(kStates * (points_.size() + nodes_.size())));
  }
  StateColumn end_residual() const {
    StateColumn out = nodes_.back() - nodes_.front();
    out(kTime) -= batch_.scaled_period();
    return out;
  }

  void eliminate(std::size_t i) {
    Interval& here = intervals_[i];
    Eigen::Matrix<double, kBlock, kBlock> matrix = decltype(matrix)::Identity();
    ByNode<kBlock> right = ByNode<kBlock>::Zero();
    here.next_by_node << StateMatrix::Identity(), StateColumn::Zero();
    for (int l = 0; l < kPoints; ++l) {
      const StateMatrix slopes = width_ * batch_.slopes(point(i, l));
      const double by_torque = width_ * batch_.slope_by_torque(point(i, l));
      here.gain.middleCols<kStates>(l * kStates) = rule_.weight(l) * slopes;
      here.next_by_node(MotionBatch::kTurned, kStates) += rule_.weight(l) * by_torque;
      right.middleRows<kStates>(l * kStates).leftCols<kStates>().setIdentity();
      for (int j = 0; j < kPoints; ++j) {
        matrix.block<kStates, kStates>(j * kStates, l * kStates) -= integral_(j, l) * slopes;
        right(j * kStates + MotionBatch::kTurned, kStates) += integral_(j, l) * by_torque;
      }
    }
    here.points.compute(matrix);
    here.points_by_node = here.points.solve(right);
    here.next_by_node += here.gain * here.points_by_node;
  }

  void step() {
    // The last node by the first one and the torque, and where both are kept.
    ByNode<kStates> last_by_first;
    last_by_first << StateMatrix::Identity(), StateColumn::Zero();
    StateColumn kept = StateColumn::Zero();
    for (Interval& here : intervals_) {
      here.point_residuals = here.points.solve(here.point_residuals).eval();
      here.next_residual += here.gain * here.point_residuals;
      const StateMatrix next = here.next_by_node.leftCols<kStates>();
      kept = next * kept + here.next_residual;
      last_by_first = next * last_by_first;
      last_by_first.col(kStates) += here.next_by_node.col(kStates);
    }
    StateMatrix matrix = last_by_first.rightCols<kStates>();
    for (int k = 1; k < kStates; ++k) matrix(k, k - 1) -= 1;
    const StateColumn unknown = matrix.partialPivLu().solve(-(end_residual() + kept));

    Eigen::Matrix<double, kStates + 1, 1> change;  // of a node and the torque
    change << 0, unknown;
    torques_.pinion += change(kStates) * batch_.torque_scale();
    for (std::size_t i = 0; i < intervals_.size(); ++i) {
      const Interval& here = intervals_[i];
      nodes_[i] += change.head<kStates>();
      const Eigen::Matrix<double, kBlock, 1> points =
          here.points_by_node * change + here.point_residuals;
      for (int n = 0; n < kBlock; ++n) {
        point(i, n / kStates).state[n % kStates] += points(n) * batch_.scale(n % kStates);
      }
      change.head<kStates>() = (here.next_by_node * change + here.next_residual).eval();
    }
    nodes_.back() += change.head<kStates>();
  }

  MotionBatch batch_;
  double width_;  // [cycles]
  const GaussLegendre<kPoints>& rule_;
  Eigen::Matrix<double, kPoints, kPoints> integral_;
  Torques torques_;
  std::vector<Interval> intervals_;
  std::vector<StateColumn> nodes_;     // scaled
  std::vector<MotionInstant> points_;  // all intervals'
};

}  // namespace

std::vector<PeriodicRival> periodic_rivals() {
  return {{"CVODE shooting", {1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9}, shoot},
          {"Gauss collocation",
           {6, 12, 24, 48, 96, 192, 384},
           [](const RivalProblem& problem, double intervals, const OnIterate& on_iterate) {
             GaussCollocation(problem, static_cast<int>(intervals)).solve(on_iterate);
           }}};
}

}  // namespace tribodyn
