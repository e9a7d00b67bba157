#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/dynamics/shooting.h"
#include "core/dynamics/step_block.h"

namespace tribodyn {

/// How the states at all steps' starts follow the section state and the unknown torque, in one mesh
/// cycle of one grid. Unknowns: the seven states, then the torque.
struct CycleDerivatives {
  using Square = Eigen::Matrix<double, SectionMap::kUnknowns, SectionMap::kUnknowns>;
  struct Step {
    Square state;                 ///< over the step; the torque stays
    SectionMap::Vector duration;  ///< of the step [s]
    Square from_section;          ///< from the section to the step's start
  };
  std::vector<Step> steps;
};

/// Newton's method on the states at all steps' starts, for one mesh cycle of flanks that stay
/// together: every step is a problem of its own, so all are taken side by side. Converges to what
/// SingleShooting converges to.
class MultipleShooting final : public Shooting {
 public:
  /// Whether it can solve for such a response.
  static bool applies(const MeshGrid& grid, const OrbitRequest& request,
                      const PeriodicOrbit& orbit);
  /// As Shooting. Starts from the orbit's pieces, of whatever grid, or else from its state alone.
  MultipleShooting(GearPairSystem& system, OrbitFriction& friction, const MeshGrid& grid,
                   const OrbitRequest& request, PeriodicOrbit& orbit);

  bool evaluate_friction() override;
  void finish(MarchStatistics& statistics, long& marched_cycles) override;

 private:
  Step improve() override;
  void start_from_pieces();
  void start_from_state();
  void spread_friction();
  void take_derivatives();
  bool fill();
  void write_pieces();

  InstructionSet instruction_set_;
  int steps_;
  CycleResponse response_;
  bool is_filled_ = false;  // but for its states at starts
  CycleFriction lagged_;
  StepBlock block_;
  Columns end_, derivatives_;
  std::vector<SectionMap::Vector> particular_;  // what the residuals alone do to the starts
  std::vector<double> duration_;
  long evaluations_ = 0;
};

}  // namespace tribodyn
