#include <gtest/gtest.h>

#include <cmath>

#include "tests/consistency/plain_contact.h"
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

}  // namespace
}  // namespace tribodyn
