#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "core/study/operating_point.h"
#include "tests/consistency/plain_contact.h"
#include "tests/support/cruise.h"
#include "tests/support/run_length.h"

// Where the limiting stress vanishes, is constant, or meets the stress twice.
namespace tribodyn {
namespace {

using plain::difference;

/// The area mean of eq 23 by many rings.
double brute_force_stress(const ContactCase& c, const ContactSolution& s) {
  const plain::Shear shear{c, s.pressure_viscosity_index, s.shear_rate, s.contact_temperature};
  constexpr int kRings = kShortRun ? 200'000 : 1'000'000;
  double sum = 0;
  for (int i = 0; i < kRings; ++i) {
    const double xi = (i + 0.5) / kRings;
    sum += shear.stress(s.maximum_pressure * xi) * xi;
  }
  return 2 * sum / kRings;
}

TEST(LimitingStress, ZeroAtZeroPressure) {
  ContactCase c;
  c.lubricant.limiting_shear_stress_at_zero_pressure = 0;
  for (const double load : {1e-3, 1.0, 2000.0}) {
    SCOPED_TRACE(load);
    c.conditions.load = load;
    const ContactSolution s = c.solve();
    ASSERT_EQ(s.status, ContactStatus::kOk);
    EXPECT_GE(s.limiting_stress_switches, 1);  // the edge sits on the limit, which is 0 there
    EXPECT_LE(difference(s.mean_shear_stress, brute_force_stress(c, s)), 1e-10);
  }
}

TEST(LimitingStress, ConstantWithPressure) {
  ContactCase c;
  c.lubricant.limiting_shear_stress_coefficient = 0;
  const ContactSolution s = c.solve();
  ASSERT_EQ(s.status, ContactStatus::kOk);
  EXPECT_LE(s.mean_shear_stress, 4e6);
  EXPECT_LE(difference(s.mean_shear_stress, brute_force_stress(c, s)), 1e-10);
  c.sump_temperature = 253.15;
  c.options.isothermal = true;  // stiff all over
  EXPECT_NEAR(c.solve().mean_shear_stress, 4e6, 2e4);
}

TEST(LimitingStress, ZeroEverywhereIsNoViscousFriction) {
  ContactCase c;
  c.lubricant.limiting_shear_stress_at_zero_pressure = 0;
  c.lubricant.limiting_shear_stress_coefficient = 0;
  const ContactSolution s = c.solve();
  ASSERT_EQ(s.status, ContactStatus::kOk);
  EXPECT_EQ(s.mean_shear_stress, 0);
  EXPECT_EQ(s.friction, s.boundary_friction);
  EXPECT_EQ(s.limiting_stress_area_share, 1);
  EXPECT_LE(difference(s.contact_temperature,
                       c.inlet_temperature() + s.thermal_resistance_1 * s.heat_partition *
                                                   s.boundary_friction * s.sliding_speed),
            1e-14);
  c.conditions.velocity_2_x = -c.conditions.velocity_1_x;  // nor without a film
  c.conditions.velocity_2_y = -c.conditions.velocity_1_y;
  EXPECT_EQ(c.solve().viscous_friction, 0);
}

TEST(LimitingStress, ClippedAtRimAndCentreButNotBetween) {
  ContactCase c;
  c.lubricant.limiting_shear_stress_at_zero_pressure = 1e5;
  c.options.newtonian = c.options.isothermal = true;
  const ContactSolution s = c.solve();
  ASSERT_EQ(s.status, ContactStatus::kOk);
  EXPECT_EQ(s.limiting_stress_switches, 2);
  EXPECT_TRUE(s.limiting_stress_at_centre);
  EXPECT_LT(s.limiting_stress_area_share, 1);
  const plain::Shear shear{c, s.pressure_viscosity_index, s.shear_rate, s.contact_temperature};
  const plain::Limited scan = plain::limited(shear, s.maximum_pressure);
  ASSERT_EQ(scan.switches.size(), 2u);
  EXPECT_TRUE(scan.centre);
  EXPECT_NEAR(s.limiting_stress_area_share, scan.area_share, 1e-12);
  EXPECT_LE(difference(s.mean_shear_stress, brute_force_stress(c, s)), 1e-10);
}

/// Share of time with a contact centre on the limit, the limiting stress multiplied by `factor`.
double limited_time_share(Scene scene, double speed, const PointOptions& options,
                          double factor = 1) {
  scene.lubricant.limiting_shear_stress_at_zero_pressure *= factor;
  scene.lubricant.limiting_shear_stress_coefficient *= factor;
  return solve_operating_point(scene, cruise(speed), options).limiting_stress_time_share;
}

// Where the stress crosses the limit at a small angle, the place depends on the last digits of
// both.
TEST(LimitingStress, ShareOfTimeOnTheLimitIsAsExactAsThePoint) {
  constexpr double kTolerance = 1e-3;
  int limited_for_a_time = 0;
  for (const double at_zero : {0.0, 4e6}) {
    for (const double sump : {10.0, 40.0, 90.0}) {
      for (double speed = 30; speed <= 140; speed += kShortRun ? 44 : 11) {
        SCOPED_TRACE(std::to_string(at_zero) + " Pa, " + std::to_string(sump) + " C, " +
                     std::to_string(speed) + " km/h");
        Scene scene = reference_scene(1, sump);
        scene.lubricant.limiting_shear_stress_at_zero_pressure = at_zero;
        PointOptions loose, tight;
        loose.tolerance = kTolerance;
        tight.tolerance = 1e-7;
        const double share = limited_time_share(scene, speed, tight);
        const double more = limited_time_share(scene, speed, tight, 1 - kTolerance);
        const double less = limited_time_share(scene, speed, tight, 1 + kTolerance);
        const double error = kTolerance * share + std::max(more - share, share - less);
        EXPECT_NEAR(limited_time_share(scene, speed, loose), share, error);
        if (share < 0.01 || share > 0.99) continue;
        if (++limited_for_a_time % 5 != 1) continue;
        loose.method = SteadyStateMethod::kMarch;
        EXPECT_NEAR(limited_time_share(scene, speed, loose), share, error) << "marched";
      }
    }
  }
  EXPECT_GT(limited_for_a_time, kShortRun ? 2 : 10);
}

}  // namespace
}  // namespace tribodyn
