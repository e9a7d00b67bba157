#include "tests/benchmark/marching_solvers.h"

#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

#include <algorithm>
#include <array>
#include <boost/numeric/odeint.hpp>
#include <stdexcept>

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

void check(int flag, const char* call) {
  if (flag < 0) throw std::runtime_error(std::string(call) + " failed: " + std::to_string(flag));
}

class Cvode {
 public:
  Cvode(ScaledProblem& problem, double tolerance, int method, bool roots)
      : problem_(problem), roots_(roots) {
    check(SUNContext_Create(nullptr, &context_), "SUNContext_Create");
    vector_ = N_VNew_Serial(kSize, context_);
    N_VConst(0, vector_);
    cvode_ = CVodeCreate(method, context_);
    check(CVodeInit(cvode_, rates, 0, vector_), "CVodeInit");
    check(CVodeSStolerances(cvode_, 0, tolerance), "CVodeSStolerances");
    check(CVodeSetUserData(cvode_, this), "CVodeSetUserData");
    if (method == CV_ADAMS) {
      nonlinear_ = SUNNonlinSol_FixedPoint(vector_, 0, context_);
      check(CVodeSetNonlinearSolver(cvode_, nonlinear_), "CVodeSetNonlinearSolver");
    } else {
      matrix_ = SUNDenseMatrix(kSize, kSize, context_);
      linear_ = SUNLinSol_Dense(vector_, matrix_, context_);
      check(CVodeSetLinearSolver(cvode_, linear_, matrix_), "CVodeSetLinearSolver");
    }
    if (roots) check(CVodeRootInit(cvode_, 2, events), "CVodeRootInit");
    CVodeSetNoInactiveRootWarn(cvode_);
    CVodeSetMaxNumSteps(cvode_, 100000);
    CVodeSetErrFile(cvode_, nullptr);
  }
  ~Cvode() {
    CVodeFree(&cvode_);
    if (nonlinear_ != nullptr) SUNNonlinSolFree(nonlinear_);
    if (linear_ != nullptr) SUNLinSolFree(linear_);
    if (matrix_ != nullptr) SUNMatDestroy(matrix_);
    N_VDestroy(vector_);
    SUNContext_Free(&context_);
  }
  Cvode(const Cvode&) = delete;
  Cvode& operator=(const Cvode&) = delete;

  void cycle(MarchState& state) {
    start_cycle(state);
    double* y = N_VGetArrayPointer(vector_);
    problem_.to_scaled(state, y);
    problem_.hold_regime = false;
    problem_.take_regime(0, y);
    problem_.hold_regime = roots_;
    double phase = 0;
    restart(phase);
    while (phase < 1) {
      check(CVodeSetStopTime(cvode_, 1), "CVodeSetStopTime");
      const int flag = CVode(cvode_, 1, vector_, &phase, CV_NORMAL);
      check(flag, "CVode");
      if (flag != CV_ROOT_RETURN) continue;
      int found[2] = {0, 0};
      CVodeGetRootInfo(cvode_, found);
      problem_.change_regime(found[0] > 0 ? 0 : 1, phase, y);
      CVodeGetLastStep(cvode_, &step_);
      restart(phase);
    }
    CVodeGetLastStep(cvode_, &step_);
    state = problem_.from_scaled(y);
  }

 private:
  /// With the step it had: it need not grope again.
  void restart(double phase) {
    check(CVodeReInit(cvode_, phase, vector_), "CVodeReInit");
    if (step_ > 0) CVodeSetInitStep(cvode_, 0.1 * step_);
    const int rising[2] = {1, 1};
    if (roots_) CVodeSetRootDirection(cvode_, const_cast<int*>(rising));
  }
  static int rates(double phase, N_Vector y, N_Vector dy, void* self) {
    static_cast<Cvode*>(self)->problem_.rates(phase, N_VGetArrayPointer(y), N_VGetArrayPointer(dy));
    return 0;
  }
  static int events(double phase, N_Vector y, double* out, void* self) {
    const auto g = static_cast<Cvode*>(self)->problem_.events(phase, N_VGetArrayPointer(y));
    std::copy(g.begin(), g.end(), out);
    return 0;
  }

  ScaledProblem& problem_;
  bool roots_;
  double step_ = 0;
  SUNContext context_ = nullptr;
  N_Vector vector_ = nullptr;
  void* cvode_ = nullptr;
  SUNNonlinearSolver nonlinear_ = nullptr;
  SUNMatrix matrix_ = nullptr;
  SUNLinearSolver linear_ = nullptr;
};

MarchingSolver cvode(const char* name, int method, bool roots) {
  return {name,
          {1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8},
          [method, roots](ScaledProblem& problem, double tolerance) -> CycleStepper {
            return [solver = std::make_shared<Cvode>(problem, tolerance, method, roots)](
                       MarchState& state) { solver->cycle(state); };
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
          {"odeint dopri5", {1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7}, dopri5},
          cvode("CVODE Adams", CV_ADAMS, false),
          cvode("CVODE Adams, roots", CV_ADAMS, true),
          cvode("CVODE BDF", CV_BDF, false),
          cvode("CVODE BDF, roots", CV_BDF, true)};
}

}  // namespace tribodyn
