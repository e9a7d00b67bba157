#include "tests/benchmark/cvode_march.h"

#include <cvode/cvode.h>

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

namespace tribodyn {
namespace {

void check(int flag, const char* call) {
  if (flag < 0) throw std::runtime_error(std::string(call) + " failed: " + std::to_string(flag));
}

}  // namespace

CvodeMarch::CvodeMarch(int method, const std::vector<double>& tolerances, Rates rates,
                       std::optional<Roots> roots)
    : rates_(std::move(rates)), roots_(std::move(roots)) {
  const auto size = static_cast<sunindextype>(tolerances.size());
  check(SUNContext_Create(nullptr, &context_), "SUNContext_Create");
  vector_ = N_VNew_Serial(size, context_);
  tolerances_ = N_VNew_Serial(size, context_);
  N_VConst(0, vector_);
  std::copy(tolerances.begin(), tolerances.end(), N_VGetArrayPointer(tolerances_));
  cvode_ = CVodeCreate(method, context_);
  const auto rates_of = [](double phase, N_Vector y, N_Vector dy, void* self) {
    static_cast<CvodeMarch*>(self)->rates_(phase, N_VGetArrayPointer(y), N_VGetArrayPointer(dy));
    return 0;
  };
  check(CVodeInit(cvode_, rates_of, 0, vector_), "CVodeInit");
  check(CVodeSVtolerances(cvode_, 0, tolerances_), "CVodeSVtolerances");
  check(CVodeSetUserData(cvode_, this), "CVodeSetUserData");
  if (method == CV_ADAMS) {
    nonlinear_ = SUNNonlinSol_FixedPoint(vector_, 0, context_);
    check(CVodeSetNonlinearSolver(cvode_, nonlinear_), "CVodeSetNonlinearSolver");
  } else {
    matrix_ = SUNDenseMatrix(size, size, context_);
    linear_ = SUNLinSol_Dense(vector_, matrix_, context_);
    check(CVodeSetLinearSolver(cvode_, linear_, matrix_), "CVodeSetLinearSolver");
  }
  const auto roots_of = [](double phase, N_Vector y, double* out, void* self) {
    const auto g = static_cast<CvodeMarch*>(self)->roots_->functions(phase, N_VGetArrayPointer(y));
    std::copy(g.begin(), g.end(), out);
    return 0;
  };
  if (roots_) check(CVodeRootInit(cvode_, 2, roots_of), "CVodeRootInit");
  CVodeSetNoInactiveRootWarn(cvode_);
  CVodeSetMaxNumSteps(cvode_, 100000);
  CVodeSetErrFile(cvode_, nullptr);
}

CvodeMarch::~CvodeMarch() {
  CVodeFree(&cvode_);
  if (nonlinear_ != nullptr) SUNNonlinSolFree(nonlinear_);
  if (linear_ != nullptr) SUNLinSolFree(linear_);
  if (matrix_ != nullptr) SUNMatDestroy(matrix_);
  N_VDestroy(vector_);
  N_VDestroy(tolerances_);
  SUNContext_Free(&context_);
}

void CvodeMarch::start() {
  if (phase_ > 0) CVodeGetLastStep(cvode_, &step_);
  restart(0);
}

void CvodeMarch::to(double phase) {
  while (phase_ < phase) {
    check(CVodeSetStopTime(cvode_, 1), "CVodeSetStopTime");
    const int flag = CVode(cvode_, phase, vector_, &phase_, CV_NORMAL);
    check(flag, "CVode");
    if (flag != CV_ROOT_RETURN) continue;
    int found[2] = {0, 0};
    CVodeGetRootInfo(cvode_, found);
    roots_->on_root(found[0] > 0 ? 0 : 1, phase_, state());
    CVodeGetLastStep(cvode_, &step_);
    restart(phase_);
  }
}

void CvodeMarch::restart(double phase) {
  phase_ = phase;
  check(CVodeReInit(cvode_, phase, vector_), "CVodeReInit");
  if (step_ > 0) CVodeSetInitStep(cvode_, 0.1 * step_);
  int rising[2] = {1, 1};
  if (roots_) CVodeSetRootDirection(cvode_, rising);
}

}  // namespace tribodyn
