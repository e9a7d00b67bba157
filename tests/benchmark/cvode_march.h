#pragma once

#include <nvector/nvector_serial.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

#include <array>
#include <functional>
#include <optional>
#include <vector>

namespace tribodyn {

/// CVODE over mesh phase: by Adams with functional iteration (CV_ADAMS), or by BDF with a dense
/// difference Jacobian (CV_BDF).
class CvodeMarch {
 public:
  using Rates = std::function<void(double phase, const double* y, double* rates)>;
  /// Two functions whose rise through zero interrupts the march.
  struct Roots {
    std::function<std::array<double, 2>(double phase, const double* y)> functions;
    std::function<void(int root, double phase, const double* y)> on_root;
  };

  /// `tolerances`: error of a step allowed to each component, in its unit.
  CvodeMarch(int method, const std::vector<double>& tolerances, Rates rates,
             std::optional<Roots> roots = std::nullopt);
  CvodeMarch(const CvodeMarch&) = delete;
  CvodeMarch& operator=(const CvodeMarch&) = delete;
  ~CvodeMarch();

  double* state() { return N_VGetArrayPointer(vector_); }
  /// Begins a mesh cycle from state(), with a tenth of the step that ended the last one.
  void start();
  /// Marches to a phase from 0 to 1; state() is then the one there. Throws std::runtime_error.
  void to(double phase);

 private:
  void restart(double phase);

  Rates rates_;
  std::optional<Roots> roots_;
  double phase_ = 0, step_ = 0;
  SUNContext context_ = nullptr;
  N_Vector vector_ = nullptr, tolerances_ = nullptr;
  void* cvode_ = nullptr;
  SUNNonlinearSolver nonlinear_ = nullptr;
  SUNMatrix matrix_ = nullptr;
  SUNLinearSolver linear_ = nullptr;
};

}  // namespace tribodyn
