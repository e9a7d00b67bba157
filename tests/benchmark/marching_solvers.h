#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/integrate/mesh_cycle_march.h"

namespace tribodyn {

/// Eqs 1-11 with friction in the loop over mesh phase, for integrators that know nothing of gears:
/// components over their scales, the regime by the state unless it is held.
class ScaledProblem {
 public:
  /// Keeps the references.
  ScaledProblem(const GearPairSystem& system, const Torques& torques, ContactSolver& contacts,
                double mean_pinion_speed);

  void rates(double phase, const double* scaled, double* scaled_rates);
  /// Functions that pass through zero where the regime that is held ends.
  std::array<double, 2> events(double phase, const double* scaled);
  void change_regime(int event, double phase, const double* scaled);
  void take_regime(double phase, const double* scaled);

  void to_scaled(const MarchState& state, double* scaled) const;
  MarchState from_scaled(const double* scaled) const;

  bool hold_regime = false;  ///< until change_regime
  long evaluations = 0;

 private:
  const GearPairSystem& system_;
  const Torques& torques_;
  ContactSolver& contacts_;
  ContactRegime regime_;
  MarchScales march_scales_;
  MarchState scale_{};
};

/// Advances a state by one mesh cycle.
using CycleStepper = std::function<void(MarchState&)>;

/// A way to integrate, at one accuracy. `accuracy` is the relative tolerance, or for RK4 the steps
/// per mesh cycle.
struct MarchingSolver {
  std::string name;
  std::vector<double> accuracies;
  std::function<CycleStepper(ScaledProblem& problem, double accuracy)> make;
};

/// RK4, Boost.odeint's dopri5, CVODE by Adams and BDF, with root finding and without.
std::vector<MarchingSolver> marching_solvers();

}  // namespace tribodyn
