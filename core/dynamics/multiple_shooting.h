#pragma once

#include <array>
#include <vector>

#include "core/dynamics/shooting.h"
#include "core/dynamics/step_block.h"

namespace tribodyn {

/// What multiple shooting works on, kept from one response to the next.
struct CycleStorage {
  CycleResponse response;
  CycleFriction lagged;
  Columns end, derivatives;      ///< of take_steps()
  std::vector<double> change;    ///< of the starts, and durations: all unknowns of each
  std::vector<double> duration;  ///< of the steps [s]
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
  MultipleShooting(GearPairSystem& system, OrbitFriction& friction, CycleStorage& storage,
                   const MeshGrid& grid, const OrbitRequest& request, PeriodicOrbit& orbit);

  void finish(MarchStatistics& statistics, long& marched_cycles) override;

 private:
  double improve() override;
  bool evaluate(Places places) override;
  void start_from_pieces();
  void start_from_state();
  void spread_friction();
  void take_derivatives();
  bool fill();
  void write_pieces();

  InstructionSet instruction_set_;
  int steps_;
  CycleResponse& response_;
  CycleFriction& lagged_;
  Columns &end_, &derivatives_;
  std::vector<double>&change_, &duration_;
  bool is_filled_ = false;  // the response, but for its states at starts
  std::array<double, SectionMap::kUnknowns> per_scale_{};
  double last_step_ = 0;  // with the derivatives at hand; 0: none
  StepBlock block_;
  long evaluations_ = 0;
};

}  // namespace tribodyn
