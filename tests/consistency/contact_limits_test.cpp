#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "core/lubricant/viscosity.h"
#include "tests/consistency/plain_contact.h"

// Limits in which one model must become another, and what each misprint and option may change.
namespace tribodyn {
namespace {

using plain::difference;

constexpr int kStates = kRandomStates / 4;

/// How a field may differ between two solutions.
#define EXPECT_SAME_FIELD(a, b, field) \
  EXPECT_LE(difference((a).field, (b).field), tolerance) << #field

void expect_same_film(const ContactSolution& a, const ContactSolution& b, double tolerance = 0) {
  EXPECT_SAME_FIELD(a, b, film_load);
  EXPECT_SAME_FIELD(a, b, asperity_load);
  EXPECT_SAME_FIELD(a, b, contact_area);
  EXPECT_SAME_FIELD(a, b, asperity_area);
  EXPECT_SAME_FIELD(a, b, maximum_pressure);
  EXPECT_SAME_FIELD(a, b, central_film_thickness);
  EXPECT_SAME_FIELD(a, b, shear_rate);
  EXPECT_SAME_FIELD(a, b, heat_partition);
}

void expect_same(const ContactSolution& a, const ContactSolution& b, double tolerance = 0) {
  EXPECT_EQ(a.status, b.status);
  expect_same_film(a, b, tolerance);
  EXPECT_SAME_FIELD(a, b, contact_temperature);
  EXPECT_SAME_FIELD(a, b, mean_shear_stress);
  EXPECT_SAME_FIELD(a, b, viscous_friction);
  EXPECT_SAME_FIELD(a, b, boundary_friction);
  EXPECT_SAME_FIELD(a, b, friction);
}

/// Calls `check(case, solution)` for random contacts that solve and stay a degree below the end of
/// the density law.
template <class Check>
void for_random_contacts(std::uint64_t stream, Check check) {
  Draw draw(stream);
  SCOPED_TRACE(draw.seed());
  int solved = 0;
  for (int i = 0; i < kStates; ++i) {
    SCOPED_TRACE("state " + std::to_string(i));
    const ContactCase c = random_contact_case(draw);
    const ContactSolution s = c.solve();
    const double end = -c.lubricant.density_at_zero_kelvin / c.lubricant.density_temperature_slope;
    if (s.status != ContactStatus::kOk || s.contact_temperature > end - 1) continue;
    ++solved;
    check(c, s);
  }
  EXPECT_GT(solved, 0.9 * kStates);
}

TEST(ContactLimits, ShortRelaxationTimeIsTheNewtonianOption) {
  for_random_contacts(31, [](ContactCase c, const ContactSolution&) {
    c.options.newtonian = true;
    const ContactSolution newtonian = c.solve();
    c.options.newtonian = false;
    for (const double relaxation_time : {0.0, 1e-300}) {
      c.lubricant.relaxation_time = relaxation_time;
      const ContactSolution thinning = c.solve();
      if (thinning.status == ContactStatus::kRefusedNoTemperature)
        continue;  // beyond the density law
      expect_same(thinning, newtonian, 1e-13);
    }
  });
}

TEST(ContactLimits, ThinningNeverRaisesFriction) {
  for_random_contacts(32, [](ContactCase c, const ContactSolution& thinning) {
    c.options.newtonian = true;
    const ContactSolution newtonian = c.solve();
    expect_same_film(thinning, newtonian);
    EXPECT_LE(thinning.friction, newtonian.friction * (1 + 1e-12));
  });
}

TEST(ContactLimits, PerfectConductorsAreTheIsothermalOption) {
  for_random_contacts(33, [](ContactCase c, const ContactSolution& heated) {
    c.options.isothermal = true;
    const ContactSolution isothermal = c.solve();
    EXPECT_EQ(isothermal.contact_temperature, c.inlet_temperature());
    EXPECT_EQ(isothermal.flash_temperature_rise, 0);
    EXPECT_EQ(isothermal.oil_temperature_rise, 0);
    expect_same_film(isothermal, heated);
    EXPECT_LE(heated.friction, isothermal.friction * (1 + 1e-12));
    c.options.isothermal = false;
    c.solid.thermal_conductivity = 1e40;
    c.lubricant.thermal_conductivity = 1e40;
    const ContactSolution conducting = c.solve();
    EXPECT_LE(difference(conducting.friction, isothermal.friction), 1e-12);
    EXPECT_LE(difference(conducting.contact_temperature, isothermal.contact_temperature), 1e-14);
  });
}

TEST(ContactLimits, HighLimitingStressIsTheUnlimitedOption) {
  for_random_contacts(34, [](ContactCase c, const ContactSolution& limited) {
    c.options.no_limiting_shear_stress = true;
    const ContactSolution unlimited = c.solve();
    c.options.no_limiting_shear_stress = false;
    c.lubricant.limiting_shear_stress_at_zero_pressure = 1e200;
    const ContactSolution high = c.solve();
    expect_same(high, unlimited, 1e-14);
    EXPECT_EQ(unlimited.limiting_stress_switches, 0);
    EXPECT_EQ(unlimited.limiting_stress_area_share, 0);
    if (unlimited.status == ContactStatus::kOk) {
      EXPECT_GE(unlimited.friction, limited.friction * (1 - 1e-12));
    }
  });
}

TEST(ContactLimits, LimitedShareAndSwitchesAreThoseOfAScan) {
  for_random_contacts(35, [](const ContactCase& c, const ContactSolution& s) {
    const plain::Shear shear{c, s.pressure_viscosity_index, s.shear_rate, s.contact_temperature};
    const plain::Limited scan = plain::limited(shear, s.maximum_pressure);
    EXPECT_EQ(s.limiting_stress_switches, static_cast<int>(scan.switches.size()));
    EXPECT_EQ(s.limiting_stress_at_centre, scan.centre);
    EXPECT_NEAR(s.limiting_stress_area_share, scan.area_share, 1e-7);
  });
}

TEST(ContactLimits, NoBoundaryFrictionLeavesTheAsperityLoad) {
  for_random_contacts(36, [](ContactCase c, const ContactSolution& with) {
    c.options.no_boundary_friction = true;
    const ContactSolution without = c.solve();
    expect_same_film(without, with);
    EXPECT_EQ(without.boundary_friction, 0);
    EXPECT_EQ(without.friction, without.viscous_friction);
    EXPECT_LE(without.contact_temperature, with.contact_temperature * (1 + 1e-14));
    c.options.no_boundary_friction = false;
    c.boundary = {0, 0};
    expect_same(c.solve(), without);
  });
}

TEST(ContactLimits, SmoothSurfacesShareNothing) {
  for_random_contacts(37, [](ContactCase c, const ContactSolution&) {
    c.roughness = {0, 40e-6, 0.4e-6};
    const ContactSolution smooth = c.solve();
    EXPECT_EQ(smooth.film_load, c.conditions.load);
    EXPECT_EQ(smooth.asperity_load, 0);
    EXPECT_EQ(smooth.boundary_friction, 0);
    c.options.hertz_load = HertzLoad::kTotalLoad;
    expect_same(c.solve(), smooth);
  });
}

TEST(ContactLimits, EllipseFromTheTotalLoadHasItsPressure) {
  for_random_contacts(38, [](ContactCase c, const ContactSolution& film) {
    c.options.hertz_load = HertzLoad::kTotalLoad;
    const ContactSolution total = c.solve();
    if (total.status != ContactStatus::kOk) {  // the asperities alone carry more, or too hot
      EXPECT_TRUE(total.status == ContactStatus::kRefusedNoLoadSharing ||
                  total.status == ContactStatus::kRefusedNoTemperature);
      return;
    }
    const double growth = std::cbrt(c.conditions.load / film.film_load);
    EXPECT_LE(difference(total.maximum_pressure, film.maximum_pressure * growth), 1e-13);
    EXPECT_LE(difference(total.contact_area, film.contact_area * growth * growth), 1e-13);
    EXPECT_LE(total.film_load, film.film_load * (1 + 1e-13));
  });
}

TEST(ContactLimits, ExactHertzIsWithinTheFitsError) {
  for_random_contacts(39, [](ContactCase c, const ContactSolution&) {
    c.roughness.asperity_density = 0;
    const double ratio = c.conditions.radius_y / c.conditions.radius_x;
    const ContactSolution fit = c.solve();
    c.options.hertz_solution = HertzSolution::kExact;
    const ContactSolution exact = c.solve();
    if (ratio > 1 && ratio < 100) {
      EXPECT_LE(difference(fit.maximum_pressure, exact.maximum_pressure), 0.022);
    }
    EXPECT_LE(difference(fit.central_film_thickness, exact.central_film_thickness), 1e-14);
  });
}

TEST(ContactLimits, RelabellingTheAxesChangesNothing) {
  for_random_contacts(40, [](ContactCase c, const ContactSolution& s) {
    ContactConditions& k = c.conditions;
    std::swap(k.radius_x, k.radius_y);
    std::swap(k.velocity_1_x, k.velocity_1_y);
    std::swap(k.velocity_2_x, k.velocity_2_y);
    expect_same(c.solve(), s, 1e-10);  // a steep stress multiplies rounding
  });
}

TEST(ContactLimits, SwappingTheSurfacesOrTurningBothAroundChangesNoForce) {
  for_random_contacts(41, [](ContactCase c, const ContactSolution& s) {
    ContactConditions& k = c.conditions;
    std::swap(k.velocity_1_x, k.velocity_2_x);
    std::swap(k.velocity_1_y, k.velocity_2_y);
    const ContactSolution swapped = c.solve();
    if (swapped.status != ContactStatus::kOk) return;  // R_fp a_h is not symmetric: hotter
    EXPECT_EQ(swapped.central_film_thickness, s.central_film_thickness);
    EXPECT_LE(std::abs(swapped.heat_partition + s.heat_partition - 1), 1e-14);
    for (double* v : {&k.velocity_1_x, &k.velocity_1_y, &k.velocity_2_x, &k.velocity_2_y}) {
      *v = -*v;
    }
    expect_same(c.solve(), swapped);
  });
}

TEST(PublishedMisprints, Eq17RefusesBackwardEntrainmentAndChangesNothingElse) {
  for_random_contacts(51, [](ContactCase c, const ContactSolution& s) {
    c.options.as_published.eq17_atan = true;
    const ContactSolution printed = c.solve();
    if (c.conditions.velocity_1_x + c.conditions.velocity_2_x < 0) {
      EXPECT_EQ(printed.status, ContactStatus::kRefusedNegativeEntrainment);
    } else {
      expect_same(printed, s, 1e-9);
      EXPECT_DOUBLE_EQ(printed.entrainment_angle, s.entrainment_angle);
    }
  });
}

TEST(PublishedMisprints, Eq20ChangesTheMajorAxisByTheRootOfTheIntegral) {
  for_random_contacts(52, [](ContactCase c, const ContactSolution&) {
    c.roughness.asperity_density = 0;
    const ContactSolution s = c.solve();
    c.options.as_published.eq20_semi_major = true;
    const ContactSolution printed = c.solve();
    const double ratio = std::max(c.conditions.radius_x, c.conditions.radius_y) /
                         std::min(c.conditions.radius_x, c.conditions.radius_y);
    const double growth = std::cbrt(1.0003 + 0.5968 / ratio);
    EXPECT_LE(difference(printed.semi_major_axis, growth * s.semi_major_axis), 1e-14);
    EXPECT_EQ(printed.semi_minor_axis, s.semi_minor_axis);
    EXPECT_LE(difference(printed.maximum_pressure, s.maximum_pressure / growth), 1e-14);
    EXPECT_EQ(printed.central_film_thickness, s.central_film_thickness);
  });
}

TEST(PublishedMisprints, Eqs20And22GiveAPressure46To95PercentLow) {
  ContactCase c;
  c.roughness.asperity_density = 0;
  const auto shortfall = [&c](double ratio) {
    c.conditions.radius_y = ratio * c.conditions.radius_x;
    c.options.as_published = {};
    const double pressure = c.solve().maximum_pressure;
    c.options.as_published.eq20_semi_major = true;
    c.options.as_published.eq22_inverted_ratio = true;
    return 1 - c.solve().maximum_pressure / pressure;
  };
  EXPECT_NEAR(shortfall(2), 0.46, 0.005);
  EXPECT_NEAR(shortfall(33), 0.95, 0.005);
  double last = 0;
  for (double ratio = 1.05; ratio < 40; ratio *= 1.1) {
    EXPECT_GT(shortfall(ratio), last) << ratio;
    last = shortfall(ratio);
  }
}

TEST(PublishedMisprints, Eq22ScalesTheEllipseAlike) {
  for_random_contacts(53, [](ContactCase c, const ContactSolution&) {
    c.roughness.asperity_density = 0;
    const ContactSolution s = c.solve();
    c.options.as_published.eq22_inverted_ratio = true;
    const ContactSolution printed = c.solve();
    const double ratio = std::max(c.conditions.radius_x, c.conditions.radius_y) /
                         std::min(c.conditions.radius_x, c.conditions.radius_y);
    const double growth = std::cbrt((1.0003 + 0.5968 * ratio) / (1.0003 + 0.5968 / ratio));
    EXPECT_LE(difference(printed.semi_major_axis, growth * s.semi_major_axis), 1e-14);
    EXPECT_LE(difference(printed.semi_minor_axis, growth * s.semi_minor_axis), 1e-14);
  });
}

TEST(PublishedMisprints, Eqs31And32GiveAViscosityAtAGigapascal2e7TimesTooHigh) {
  const Lubricant oil = reference_lubricant(1);
  const double log_eta = log_ambient_viscosity(oil, 313.15);
  const auto viscosity = [&](bool misprint) {
    AsPublished as_published;
    as_published.eq31_32_logarithm = misprint;
    const double factor = roelands_factor(log_eta, as_published);
    const double index = laws::houpert_index(factor, oil.pressure_viscosity_coefficient);
    return std::exp(log_viscosity_under_pressure(log_eta, factor, index, 1e9));
  };
  EXPECT_NEAR(std::log10(viscosity(true)), 10, 0.5);
  EXPECT_NEAR(viscosity(false), 5e2, 2e2);
}

TEST(PublishedMisprints, Eqs31And32LeaveFilmAndLoadToTheCoefficientAlone) {
  for_random_contacts(54, [](ContactCase c, const ContactSolution&) {
    // Where alpha* was measured at the inlet temperature, both forms must give it back there.
    c.lubricant.pressure_viscosity_temperature = c.inlet_temperature();
    const ContactSolution s = c.solve();
    c.options.as_published.eq31_32_logarithm = true;
    const ContactSolution printed = c.solve();
    if (printed.status == ContactStatus::kRefusedNoTemperature) return;
    ASSERT_EQ(printed.status, ContactStatus::kOk);
    expect_same_film(printed, s, 1e-10);
    EXPECT_NE(printed.pressure_viscosity_index, s.pressure_viscosity_index);
  });
}

TEST(PublishedMisprints, Eqs43And44MatterWhereTheyWereNotFitted) {
  ContactCase c;
  const auto asperity_load = [&c](double roughness_height, bool printed) {
    c.roughness.composite_rms_height = roughness_height;
    c.options.as_published.eq43_44_polynomials = printed;
    return c.solve().asperity_load;
  };
  // Film ratio below 1: 2 %. Beyond 2.3 the printed asperities pull.
  EXPECT_NEAR(asperity_load(1e-6, true) / asperity_load(1e-6, false), 1, 0.02);
  EXPECT_GT(asperity_load(0.3e-6, false), 0);
  EXPECT_LT(asperity_load(0.3e-6, true), 0);
}

TEST(PublishedMisprints, Eq46DoesNotReachTheContact) {
  for_random_contacts(55, [](ContactCase c, const ContactSolution& s) {
    c.options.as_published.eq46_square_root_of_sum = true;
    expect_same(c.solve(), s);
  });
}

}  // namespace
}  // namespace tribodyn
