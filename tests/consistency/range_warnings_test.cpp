// What a result says of the ranges in which its laws were measured or checked.
#include "core/study/range_warnings.h"

#include <gtest/gtest.h>

#include "tests/support/reference_scene.h"

namespace tribodyn {
namespace {

/// A result that stays inside every range, and its scene.
struct Quiet {
  Scene scene = reference_scene();
  PointResult result;

  Quiet() {
    scene.fluid_grounds = {FluidGrounds::TemperatureRange{283.15, 413.15},
                           FluidGrounds::LimitingStress::kMeasuredAtForty};
    result.contact_temperature = {340, 350, 370};
    result.maximum_pressure = {0.5e9, 0.8e9, 1.1e9};
    result.film_ratio = {0.8, 1, 1.2};
    result.settled = true;
    result.period_in_mesh_cycles = 1;
  }
  /// The sentence under a code; empty where there is none.
  std::string sentence(const std::string& code) const {
    for (const RangeWarning& each : range_warnings(scene, result)) {
      if (each.code == code) return each.sentence;
    }
    return {};
  }
};

TEST(RangeWarnings, AreNoneInsideEveryRange) {
  const Quiet quiet;
  EXPECT_TRUE(range_warnings(quiet.scene, quiet.result).empty());
}

TEST(RangeWarnings, SpeakOfTheTemperaturesAtWhichThisLubricantWasMeasured) {
  Quiet own;
  own.scene.fluid_grounds.viscosity_measured = {298.15, 313.15};
  EXPECT_EQ(own.sentence("VISCOSITY_TEMPERATURE"),
            "the film is at 60 to 96.9 C; the viscosity of this lubricant was measured from 25 to "
            "40 C and is extrapolated beyond");
  own.scene.fluid_grounds.viscosity_measured = {343.15, 413.15};
  EXPECT_NE(own.sentence("VISCOSITY_TEMPERATURE"), "") << "the inlet is colder";
  own.scene.fluid_grounds.viscosity_measured = {233.15, 373.15};
  EXPECT_EQ(own.sentence("VISCOSITY_TEMPERATURE"), "");
  own.result.contact_temperature.maximum = 373.16;
  EXPECT_NE(own.sentence("VISCOSITY_TEMPERATURE"), "") << "the contact is hotter";
  own.scene.fluid_grounds.viscosity_measured.reset();
  EXPECT_EQ(own.sentence("VISCOSITY_TEMPERATURE"), "") << "nobody knows where it was measured";
}

TEST(RangeWarnings, RoundTemperaturesToThreeDigits) {
  Quiet cold;
  cold.scene.sump_temperature = 273.15 - 25;
  cold.result.contact_temperature = {268.15, 280, 295.8334};
  EXPECT_EQ(cold.sentence("VISCOSITY_TEMPERATURE"),
            "the film is at -5 to 22.7 C; the viscosity of this lubricant was measured from 10 to "
            "140 C and is extrapolated beyond");
}

TEST(RangeWarnings, NamePressuresOnBothSides) {
  Quiet place;
  const auto said = [&place](double largest) {
    place.result.maximum_pressure.maximum = largest;
    return place.sentence("PRESSURE");
  };
  EXPECT_EQ(said(0.85e9), "");
  EXPECT_EQ(said(1.35e9), "");
  EXPECT_EQ(said(0.6016e9),
            "the largest contact pressure is 0.602 GPa, below the 0.85 to 1.35 GPa at which the "
            "friction model was compared with measurements (fig 5)");
  EXPECT_NE(said(1.36e9).find("1.36 GPa, above the 0.85 to 1.35 GPa"), std::string::npos);
  EXPECT_EQ(said(0), "") << "no flank is loaded";
}

TEST(RangeWarnings, NameRadiiBeyondTheFitsOfEqs21And22WhereTheFitsAreUsed) {
  for (const bool along_x : {false, true}) {
    Quiet place;
    ToothContactTables& tables = place.scene.gear_set.tables;
    (along_x ? tables.radius_x : tables.radius_y)[1][40] =
        120 * (along_x ? tables.radius_y : tables.radius_x)[1][40];
    EXPECT_EQ(place.sentence("RADIUS_RATIO"),
              "the ratio of a contact's radii reaches 120; the fits of eqs 21 and 22 hold from 1 "
              "to 100 (exact_hertz has no such limit)");
    place.scene.options.hertz_solution = HertzSolution::kExact;
    EXPECT_EQ(place.sentence("RADIUS_RATIO"), "");
    place.scene.options.hertz_solution = HertzSolution::kSimplified;
    tables.load_share[1][40] = 0;
    EXPECT_EQ(place.sentence("RADIUS_RATIO"), "") << "a flank that carries nothing";
  }
}

TEST(RangeWarnings, SayWhereTheLimitingStressComesFrom) {
  Quiet place;
  place.result.limiting_stress_area_share = 0.6666;
  using Origin = FluidGrounds::LimitingStress;
  const auto said = [&place](Origin origin) {
    place.scene.fluid_grounds.limiting_stress = origin;
    return place.sentence("LIMITING_STRESS");
  };
  EXPECT_EQ(said(Origin::kMeasuredAtForty),
            "66.7 % of the loaded area is at the limiting shear stress, which was measured at 40 C "
            "and is taken to be independent of temperature");
  EXPECT_NE(said(Origin::kEstimated).find("is estimated from the class of base oil"),
            std::string::npos);
  EXPECT_NE(said(Origin::kStated).find("is as stated for this lubricant"), std::string::npos);
}

}  // namespace
}  // namespace tribodyn
