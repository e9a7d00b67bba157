// Periodic orbits on grids of steps: the order of their states, and their Floquet multipliers.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/periodic/orbit_sensitivity.h"
#include "core/periodic/orbit_solver.h"
#include "core/periodic/steady_state.h"
#include "core/study/prepared_scene.h"
#include "tests/support/coarse_tables.h"
#include "tests/support/reference_scene.h"

namespace tribodyn {
namespace {

struct OrbitCase {
  const char* name;
  double pinion_torque;  ///< [N m]
  double pinion_speed;   ///< [rad/s]
  bool contact_loss;
};
void PrintTo(const OrbitCase& c, std::ostream* out) { *out << c.name; }

class OrbitOrder : public testing::TestWithParam<OrbitCase> {
 protected:
  /// Finds the orbit on a grid of `steps` per mesh cycle.
  void find(int steps, PeriodicOrbit& orbit) {
    const OrbitCase& c = GetParam();
    ShootingOptions options;
    options.tolerance = 1e-9;  // contacts are solved to 1e-10
    options.bilateral_contact = !c.contact_loss;
    options.first_cycles = c.contact_loss ? 60 : 0;
    orbit.torques = {c.pinion_torque, c.pinion_torque * 36 / 13};
    orbit.state = static_start(system_, orbit.torques, c.pinion_speed, 0, 0, 0);
    const PeriodicProblem problem = this->problem(options.tolerance);
    SolverWork work;
    OrbitSolver solver(problem, work);
    const MeshGrid& grid = prepared_.gear_set().grids().with_steps(steps);
    ASSERT_TRUE(solver.solve_without_friction(grid, options, orbit)) << steps;
    ASSERT_TRUE(solver.solve(grid, options, orbit)) << steps;
    ASSERT_EQ(orbit.contact_loss, c.contact_loss) << steps;
  }

  PeriodicProblem problem(double tolerance) {
    return {system_,
            prepared_.contacts(),
            prepared_.gear_set().grids(),
            tally_,
            {},
            GetParam().pinion_speed,
            false,
            tolerance,
            {}};
  }

  /// The largest relative difference of the states at the section.
  static double distance(const PeriodicOrbit& a, const PeriodicOrbit& b) {
    const MarchState& x = a.pieces.front().start;
    const MarchState& y = b.pieces.front().start;
    double out = 0;
    for (int i = kPinionShaftTwist; i <= kWheelSpeed; ++i) {
      out = std::max(out, std::abs(x[i] / y[i] - 1));
    }
    return out;
  }

  const Scene scene_ = with_coarse_tables(reference_scene(), 8);
  PreparedScene prepared_{scene_};
  const GearPairSystem& system_ = prepared_.gear_set().system();
  ContactTally tally_;
};

// Runge-Kutta steps of order four end at the kinks of the tables and at events.
TEST_P(OrbitOrder, IsFourInContactAndAcrossContactLoss) {
  constexpr int kCoarse = 48, kFine = 384, kReference = 1536;
  PeriodicOrbit coarse, fine, reference;
  ASSERT_NO_FATAL_FAILURE(find(kCoarse, coarse));
  ASSERT_NO_FATAL_FAILURE(find(kFine, fine));
  ASSERT_NO_FATAL_FAILURE(find(kReference, reference));
  const double coarse_error = distance(coarse, reference), fine_error = distance(fine, reference);
  EXPECT_LT(coarse_error, 1e-4);
  EXPECT_NEAR(std::log(coarse_error / fine_error) / std::log(kFine / kCoarse), 4, 0.4)
      << coarse_error << " and " << fine_error;
}

// By the derivatives of the contacts, against finite differences of the event-exact march.
TEST_P(OrbitOrder, MultiplierWithFrictionIsThatOfTheMarch) {
  const OrbitCase& c = GetParam();
  for (const int steps : {24, 96}) {
    PeriodicOrbit orbit;
    ASSERT_NO_FATAL_FAILURE(find(steps, orbit));
    const PeriodicProblem problem = this->problem(1e-9);
    const auto by_derivatives = multiplier_with_friction(problem, orbit);
    ASSERT_TRUE(by_derivatives);
    MarchOptions march;
    march.relative_tolerance = 1e-8;
    SolverWork work;
    const double marched = marched_multiplier(problem, orbit, march, work);
    EXPECT_NEAR(*by_derivatives, marched, steps == 24 ? 3e-4 : 1e-4) << c.name << ' ' << steps;
  }
}

INSTANTIATE_TEST_SUITE_P(Places, OrbitOrder,
                         testing::Values(OrbitCase{"drive", 40, 230, false},
                                         OrbitCase{"slow_drive", 40, 60, false},
                                         OrbitCase{"coast", -25, 230, false},
                                         OrbitCase{"contact_loss", 20.1, 200, true},
                                         OrbitCase{"faster_contact_loss", 25, 205, true}),
                         [](const auto& place) { return place.param.name; });

}  // namespace
}  // namespace tribodyn
