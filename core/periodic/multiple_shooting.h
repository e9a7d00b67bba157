#pragma once

#include <array>
#include <vector>

#include "core/integrate/step_block.h"
#include "core/periodic/shooting.h"

namespace tribodyn {

/// The storage of MultipleShooting, kept from one orbit to the next.
struct CycleStorage {
  CycleResponse response;
  CycleFriction frozen;
  Columns end, derivatives;      ///< of rk4_steps()
  std::vector<double> change;    ///< of the starts, and durations: all unknowns of each
  std::vector<double> duration;  ///< of the steps [s]
};

/// Newton's method on the states at the starts of all steps of one mesh cycle whose flanks stay
/// together: all steps are taken side by side in SIMD lanes. The linear system is condensed to the
/// section state and the unknown torque (forward elimination of the steps' residuals, then back
/// substitution; J. Stoer and R. Bulirsch, Introduction to Numerical Analysis, section 7.3.5).
/// Converges to the orbit that SingleShooting converges to.
class MultipleShooting final : public Shooting {
 public:
  /// Whether it can solve for the orbit: of bilateral contact, over one mesh cycle, without
  /// transient, on a grid with series of the mesh functions.
  static bool applies(const MeshGrid& grid, const ShootingOptions& options,
                      const PeriodicOrbit& orbit);
  /// As Shooting. Starts from the orbit's pieces, of whatever grid, or else from its state alone.
  MultipleShooting(const PeriodicProblem& problem, OrbitFriction& friction, CycleStorage& storage,
                   const MeshGrid& grid, const ShootingOptions& options, PeriodicOrbit& orbit);

  void finish(SolverWork& work) override;

 private:
  double newton_step() override;
  bool evaluate(Nodes nodes) override;
  void start_from_pieces();
  void start_from_state();
  void set_friction();
  void set_jacobian();
  bool fill();
  void write_pieces();

  InstructionSet instruction_set_;
  int steps_;
  CycleResponse& response_;
  CycleFriction& frozen_;
  Columns &end_, &derivatives_;
  std::vector<double>&change_, &duration_;
  bool is_filled_ = false;  // the response, but for its states at starts
  std::array<double, PoincareMapJacobian::kUnknowns> per_scale_{};
  double last_step_ = 0;  // with the derivatives at hand; 0: none
  StepBlock block_;
  long evaluations_ = 0;
};

}  // namespace tribodyn
