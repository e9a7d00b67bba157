// Load sharing in which a film carries no more than its thickness supports.
#include <gtest/gtest.h>

#include <cmath>

#include "core/contact/flank_contact.h"
#include "core/rig/rig.h"
#include "core/study/operating_point.h"
#include "tests/consistency/contact_case.h"
#include "tests/support/reference_scene.h"

namespace tribodyn {
namespace {

ContactSolution answer_of(const ContactCase& c) { return c.model().solve(c.conditions); }

ContactCase closed(ContactCase c) {
  c.options.closed_load_sharing = true;
  return c;
}

void slow_down(double factor, ContactConditions& k) {
  k.velocity_1_x *= factor;
  k.velocity_1_y *= factor;
  k.velocity_2_x *= factor;
  k.velocity_2_y *= factor;
}

TEST(ClosedLoadSharing, ChangesNoContactWhoseFilmSupportsItsLoad) {
  Draw draw(20030);
  int thick = 0;
  for (int n = 0; n < 300; ++n) {
    const ContactCase c = random_contact_case(draw);
    const ContactSolution open = answer_of(c);
    if (open.status != ContactStatus::kOk || open.film_ratio < 1.13) continue;
    ++thick;
    const ContactSolution s = answer_of(closed(c));
    EXPECT_EQ(s.friction, open.friction);
    EXPECT_EQ(s.film_load, open.film_load);
    EXPECT_EQ(s.asperity_area, open.asperity_area);
  }
  EXPECT_GT(thick, 50);
}

TEST(ClosedLoadSharing, CarriesTheWholeLoadAndKeepsTheFilm) {
  Draw draw(20031);
  int thin = 0;
  for (int n = 0; n < 300; ++n) {
    ContactCase c = random_contact_case(draw);
    c.roughness.composite_rms_height *= 10;
    c.roughness.asperity_density /= 10;
    const ContactSolution open = answer_of(c), s = answer_of(closed(c));
    if (s.status != ContactStatus::kOk || s.film_ratio > 1.12) continue;
    ++thin;
    const double x = std::sqrt(M_PI) / 2 * s.film_ratio;
    EXPECT_NEAR(s.film_load / open.film_load, 1 - (1 - x) * (1 - x), 1e-12);
    EXPECT_NEAR((s.film_load + s.asperity_load) / c.conditions.load, 1, 1e-12);
    EXPECT_EQ(s.central_film_thickness, open.central_film_thickness);
    EXPECT_EQ(s.maximum_pressure, open.maximum_pressure);
    EXPECT_GE(s.asperity_area, open.asperity_area);
    EXPECT_LE(s.asperity_area, s.contact_area);
  }
  EXPECT_GT(thin, 50);
}

TEST(ClosedLoadSharing, IsSmoothWhereTheFilmBeginsToSupportAll) {
  // The friction by the logarithm of the speed, on both sides of the place.
  ContactCase c = closed(ContactCase());
  double low = 1e-4, high = 10;
  const ContactConditions fast = c.conditions;
  const auto at = [&](double factor) {
    c.conditions = fast;
    slow_down(factor, c.conditions);
    return answer_of(c);
  };
  for (int i = 0; i < 100; ++i) {
    const double middle = std::sqrt(low * high);
    (at(middle).film_load < at(middle).ellipse_load ? low : high) = middle;
  }
  const double step = 1e-4;
  const double before = (at(low).friction - at(low * (1 - step)).friction) / step;
  const double behind = (at(low * (1 + step)).friction - at(low).friction) / step;
  EXPECT_NEAR(before, behind, 2e-3 * std::abs(behind));
}

TEST(ClosedLoadSharing, TendsToTheBoundaryFrictionOnARig) {
  RigScene scene;
  scene.lubricant = reference_lubricant(1);
  scene.solids = SolidPair(Solid{210e9, 0.3, 46, 7850, 470});
  scene.radii = {9.525e-3, 9.525e-3};
  scene.options = recommended_model();
  scene.options.hertz_solution = HertzSolution::kExact;
  for (const double height : {20e-9, 0.4e-6}) {  // a polished disc, a ground one
    for (const double coefficient : {0.08, 0.17}) {
      scene.roughness = {0.04 / (40e-6 * height), 40e-6, height};
      scene.boundary = {0, coefficient};
      const Rig rig(scene, 373.15);
      double at_one = 0;
      for (double speed = 5; speed > 1e-6; speed *= 0.7) {
        const RigPoint point = rig.at({35, speed, 0.5});
        if (point.film_ratio > 1.2) at_one = point.traction_coefficient;
        if (point.film_ratio > 0.05) continue;
        EXPECT_NEAR(point.traction_coefficient / coefficient, 1, 0.1) << height << " m";
        EXPECT_GT(coefficient, 1.5 * at_one);
      }
    }
  }
}

TEST(ClosedLoadSharing, LeavesTheWorkedPointsAboveAFilmRatioOfOneAndAHalf) {
  // The reference axle from 100 km/h on at a sump of 40 C.
  const Scene scene = reference_scene();
  const FlankContactModel open(scene.lubricant, scene.solid, scene.roughness, scene.boundary,
                               scene.sump_temperature, scene.inlet_temperature_rise, {});
  ModelOptions options;
  options.closed_load_sharing = true;
  const FlankContactModel closed_model(scene.lubricant, scene.solid, scene.roughness,
                                       scene.boundary, scene.sump_temperature,
                                       scene.inlet_temperature_rise, options);
  ContactConditions k = ContactCase().conditions;
  for (double load = 1; load < 1e4; load *= 3) {
    k.load = load;
    const ContactSolution a = open.solve(k), b = closed_model.solve(k);
    if (!(a.film_ratio >= 1.5)) continue;
    EXPECT_NEAR(b.friction / a.friction, 1, 0.01);
  }
}

TEST(ClosedLoadSharing, HasNoEffectOnSmoothSurfacesAndWithEqs43And44AsPublished) {
  ContactCase c;
  slow_down(1e-3, c.conditions);
  ContactCase smooth = c;
  smooth.roughness.asperity_density = 0;
  EXPECT_EQ(answer_of(closed(smooth)).friction, answer_of(smooth).friction);
  c.options.as_published.eq43_44_polynomials = true;
  EXPECT_EQ(answer_of(closed(c)).friction, answer_of(c).friction);
}

TEST(BoundaryFrictionOfAnOil, OverridesThatOfTheSurface) {
  const BoundaryFriction surface{2e6, 0.17};
  LubricantBoundary oil;
  EXPECT_EQ(boundary_friction(surface, oil, 350).asperity_friction_coefficient, 0.17);
  oil.asperity_friction_coefficient = 0.08;
  EXPECT_EQ(boundary_friction(surface, oil, 350).asperity_friction_coefficient, 0.08);
  EXPECT_EQ(boundary_friction(surface, oil, 350).tribofilm_shear_strength, 2e6);
  oil.tribofilm_shear_strength = 1e6;
  EXPECT_EQ(boundary_friction(surface, oil, 350).tribofilm_shear_strength, 1e6);
}

TEST(BoundaryFrictionOfAnOil, FollowsItsTableBetweenTemperaturesAndIsConstantBeyond) {
  LubricantBoundary oil;
  oil.coefficient_by_temperature = {{300, 0.12}, {340, 0.10}, {400, 0.04}};
  const auto at = [&oil](double temperature) {
    return boundary_friction({0, 0.17}, oil, temperature);
  };
  EXPECT_EQ(at(250).asperity_friction_coefficient, 0.12);
  EXPECT_EQ(at(250).coefficient_slope, 0);
  EXPECT_NEAR(at(320).asperity_friction_coefficient, 0.11, 1e-15);
  EXPECT_NEAR(at(370).asperity_friction_coefficient, 0.07, 1e-15);
  EXPECT_NEAR(at(370).coefficient_slope, -1e-3, 1e-15);
  EXPECT_EQ(at(450).asperity_friction_coefficient, 0.04);
}

TEST(BoundaryFrictionOfAnOil, MovesTheSensitivityToTheSump) {
  Scene scene = reference_scene();
  scene.options = recommended_model();
  scene.sump_temperature = 363.15;
  scene.lubricant_boundary.coefficient_by_temperature = {{300, 0.15}, {420, 0.05}};
  OperatingCondition condition;
  condition.vehicle_speed = 30 / 3.6;
  PointOptions options;
  options.tolerance = 1e-6;
  options.sensitivities = true;
  const auto loss = [&](double warmer) {
    Scene moved = scene;
    moved.sump_temperature += warmer;
    return *solve_operating_point(moved, condition, options).inefficiency_energy_mean;
  };
  const PointResult point = solve_operating_point(scene, condition, options);
  ASSERT_TRUE(point.sensitivities);
  for (const ParameterSensitivity& each : point.sensitivities->parameters) {
    if (each.parameter != "sump_temperature") continue;
    const double by_difference = (loss(0.5) - loss(-0.5)) / 1.0;
    EXPECT_NEAR(each.derivative[static_cast<std::size_t>(OrbitFigure::kInefficiencyEnergyMean)],
                by_difference, 2e-3 * std::abs(by_difference));
  }
}

}  // namespace
}  // namespace tribodyn
