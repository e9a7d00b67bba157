#include "tests/benchmark/marching_solvers.h"

#include <cvode/cvode.h>

#include <array>
#include <boost/numeric/odeint.hpp>
#include <optional>

#include "tests/benchmark/cvode_march.h"

namespace tribodyn {
namespace {

constexpr int kSize = kMarchComponents;
using Scaled = std::array<double, kSize>;

void start_cycle(MarchState& state) {
  state[kTime] = state[kLossWork] = state[kLossShareSquared] = 0;
}

CycleStepper runge_kutta_4(ScaledProblem& problem, double steps) {
  return [&problem, steps](MarchState& state) {
    start_cycle(state);
    Scaled y, stage, k1, k2, k3, k4;
    problem.to_scaled(state, y.data());
    const double h = 1 / steps;
    for (int n = 0; n < static_cast<int>(steps); ++n) {
      const double phase = n * h;
      const auto at = [&](const Scaled& slope, double length) {
        for (int i = 0; i < kSize; ++i) stage[i] = y[i] + length * slope[i];
        return stage.data();
      };
      problem.rates(phase, y.data(), k1.data());
      problem.rates(phase + 0.5 * h, at(k1, 0.5 * h), k2.data());
      problem.rates(phase + 0.5 * h, at(k2, 0.5 * h), k3.data());
      problem.rates(phase + h, at(k3, h), k4.data());
      for (int i = 0; i < kSize; ++i) y[i] += h / 6 * (k1[i] + 2 * k2[i] + 2 * k3[i] + k4[i]);
    }
    state = problem.from_scaled(y.data());
  };
}

CycleStepper dopri5(ScaledProblem& problem, double tolerance) {
  namespace odeint = boost::numeric::odeint;
  return [&problem, tolerance, step = 0.01](MarchState& state) {
    start_cycle(state);
    Scaled y;
    problem.to_scaled(state, y.data());
    odeint::integrate_adaptive(
        odeint::make_controlled(tolerance, 0.0, odeint::runge_kutta_dopri5<Scaled>()),
        [&](const Scaled& at, Scaled& rate, double phase) {
          problem.rates(phase, at.data(), rate.data());
        },
        y, 0.0, 1.0, step);
    state = problem.from_scaled(y.data());
  };
}

MarchingSolver cvode(const char* name, int method, bool roots) {
  return {name,
          {1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9},
          [method, roots](ScaledProblem& problem, double tolerance) -> CycleStepper {
            std::optional<CvodeMarch::Roots> events;
            if (roots) {
              events = {
                  [&problem](double phase, const double* y) { return problem.events(phase, y); },
                  [&problem](int event, double phase, const double* y) {
                    problem.change_regime(event, phase, y);
                  }};
            }
            const auto march = std::make_shared<CvodeMarch>(
                method, std::vector<double>(kSize, tolerance),
                [&problem](double phase, const double* y, double* rates) {
                  problem.rates(phase, y, rates);
                },
                events);
            return [&problem, roots, march](MarchState& state) {
              start_cycle(state);
              problem.to_scaled(state, march->state());
              problem.take_regime(0, march->state());
              problem.hold_regime = roots;
              march->start();
              march->to(1);
              state = problem.from_scaled(march->state());
            };
          }};
}

}  // namespace

ScaledProblem::ScaledProblem(const GearPairSystem& system, const Torques& torques,
                             ContactSolver& contacts, double mean_pinion_speed)
    : system_(system),
      torques_(torques),
      contacts_(contacts),
      march_scales_(march_scales(system, torques, mean_pinion_speed)) {
  for (int i = 0; i < kSize; ++i) scale_[i] = march_scales_.of(system.mesh(), i);
}

void ScaledProblem::to_scaled(const MarchState& state, double* scaled) const {
  for (int i = 0; i < kSize; ++i) scaled[i] = state[i] / scale_[i];
}

MarchState ScaledProblem::from_scaled(const double* scaled) const {
  MarchState out;
  for (int i = 0; i < kSize; ++i) out[i] = scaled[i] * scale_[i];
  return out;
}

void ScaledProblem::take_regime(double phase, const double* scaled) {
  regime_ = system_.regime_of(phase, from_scaled(scaled).data());
}

void ScaledProblem::rates(double phase, const double* scaled, double* scaled_rates) {
  ++evaluations;
  const MarchState y = from_scaled(scaled);
  if (!hold_regime) regime_ = system_.regime_of(phase, y.data());
  Instant at;
  system_.evaluate(phase, system_.mesh().interval_at(phase), regime_, y.data(), contacts_, at);
  MarchState rate;
  system_.derivative(y.data(), at, torques_, rate.data());
  for (int i = 0; i < kSize; ++i) scaled_rates[i] = rate[i] / scale_[i];
}

std::array<double, 2> ScaledProblem::events(double phase, const double* scaled) {
  return system_.events(system_.at_phase(phase), regime_, from_scaled(scaled).data(),
                        march_scales_.length,
                        march_scales_.torque / system_.mesh().mean_pinion_contact_radius());
}

void ScaledProblem::change_regime(int event, double phase, const double* scaled) {
  regime_ =
      system_.regime_after(event, system_.at_phase(phase), regime_, from_scaled(scaled).data());
}

std::vector<MarchingSolver> marching_solvers() {
  return {{"RK4", {24, 48, 96, 192, 384}, runge_kutta_4},
          {"odeint dopri5", {1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9}, dopri5},
          cvode("CVODE Adams", CV_ADAMS, false),
          cvode("CVODE Adams with roots", CV_ADAMS, true),
          cvode("CVODE BDF", CV_BDF, false),
          cvode("CVODE BDF with roots", CV_BDF, true)};
}

}  // namespace tribodyn
