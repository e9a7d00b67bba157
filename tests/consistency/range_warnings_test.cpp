// What a result says of the ranges in which its laws were measured or checked.
#include "core/study/range_warnings.h"

#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

#include "core/study/operating_point.h"
#include "core/study/screening.h"
#include "core/study/warning_kinds.h"
#include "tests/support/reference_scene.h"

namespace tribodyn {
namespace {

/// Figures that stay inside every range, and their scene.
struct Quiet {
  Scene scene = reference_scene();
  RangeFigures figures;

  Quiet() {
    scene.fluid_grounds = {FluidGrounds::TemperatureRange{283.15, 413.15},
                           FluidGrounds::LimitingStress::kMeasuredAtForty};
    figures.contact_temperature = 370;
    figures.maximum_pressure = 1.1e9;
    figures.film_ratio = 0.8;
    figures.film_thickness = 1e-6;
    figures.inlet_viscosity = 0.05;
  }
  /// The sentence under a code; empty where there is none.
  std::string sentence(const std::string& code) const {
    for (const RangeWarning& each : range_warnings(scene, figures)) {
      if (each.code == code) return each.sentence;
    }
    return {};
  }
};

TEST(RangeWarnings, AreNoneInsideEveryRange) {
  const Quiet quiet;
  EXPECT_TRUE(range_warnings(quiet.scene, quiet.figures).empty());
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
  own.figures.contact_temperature = 373.16;
  EXPECT_NE(own.sentence("VISCOSITY_TEMPERATURE"), "") << "the contact is hotter";
  own.scene.fluid_grounds.viscosity_measured.reset();
  EXPECT_EQ(own.sentence("VISCOSITY_TEMPERATURE"), "") << "nobody knows where it was measured";
}

TEST(RangeWarnings, RoundTemperaturesToThreeDigits) {
  Quiet cold;
  cold.scene.sump_temperature = 273.15 - 25;
  cold.figures.contact_temperature = 295.8334;
  EXPECT_EQ(cold.sentence("VISCOSITY_TEMPERATURE"),
            "the film is at -5 to 22.7 C; the viscosity of this lubricant was measured from 10 to "
            "140 C and is extrapolated beyond");
}

TEST(RangeWarnings, NamePressuresOnBothSides) {
  Quiet place;
  const auto said = [&place](double largest) {
    place.figures.maximum_pressure = largest;
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
  Quiet place;
  place.figures.radius_ratio = 120;
  EXPECT_NE(place.sentence("RADIUS_RATIO").find("120"), std::string::npos);
  place.scene.options.hertz_solution = HertzSolution::kExact;
  EXPECT_EQ(place.sentence("RADIUS_RATIO"), "");
}

TEST(RangeWarnings, SpeakOfTheInletByWhatItsHeatDoesToTheFilm) {
  for (const bool with_heating : {false, true}) {
    Quiet place;
    place.scene.options.inlet_shear_heating = with_heating;
    place.scene.sump_temperature = 223.15;  // however cold
    const auto has = [&place](double factor, const char* code) {
      place.figures.inlet_heating_factor = factor;
      return !place.sentence(code).empty();
    };
    EXPECT_FALSE(has(0.951, "INLET_HEATING_LEFT_OUT"));
    EXPECT_EQ(has(0.949, "INLET_HEATING_LEFT_OUT"), !with_heating);
    EXPECT_FALSE(has(0.501, "STARVATION"));
    EXPECT_EQ(has(0.499, "STARVATION"), with_heating);
  }
}

TEST(RangeWarnings, WithholdTheVerdictWhereNoFigureDecides) {
  Quiet place;
  const auto withholds = [&place] {
    return any_withholds_verdict(range_warnings(place.scene, place.figures));
  };
  EXPECT_FALSE(withholds());
  for (const auto& change : std::vector<std::function<void(RangeFigures&)>>{
           [](RangeFigures& f) { f.film_thickness = 10.1e-6; },
           [](RangeFigures& f) { f.inlet_viscosity = 1.1e6; },
           [](RangeFigures& f) { f.inlet_viscosity = 0.9e-4; },
           [](RangeFigures& f) { f.inlet_heating_factor = 0.9; },
           [](RangeFigures& f) { f.settled = false; }}) {
    place.figures = Quiet().figures;
    change(place.figures);
    EXPECT_TRUE(withholds());
  }
}

TEST(RangeWarnings, AreThoseOfTheResultWhereAnOrbitIsScreened) {
  for (const double celsius : {-20.0, 40.0, 90.0}) {
    for (const double kilometres_per_hour : {20.0, 60.0, 120.0}) {
      Scene scene = reference_scene();
      scene.sump_temperature = celsius + 273.15;
      PreparedScene prepared(scene);
      OperatingCondition condition;
      condition.vehicle_speed = kilometres_per_hour / 3.6;
      std::vector<std::string> of_result, of_figures;
      for (const RangeWarning& each : solve_prepared_point(prepared, condition, {}).warnings) {
        of_result.push_back(each.code);
      }
      for (const RangeWarning& each : screen_point(prepared, condition, {}).warnings) {
        of_figures.push_back(each.code);
      }
      EXPECT_EQ(of_figures, of_result) << celsius << " C, " << kilometres_per_hour << " km/h";
    }
  }
}

TEST(RangeWarnings, ThinTheFilmAsMuchAsTheModelDoesAtItsWorstFlank) {
  Scene scene = reference_scene();
  scene.sump_temperature = 263.15;
  OperatingCondition condition;
  condition.vehicle_speed = 100 / 3.6;
  const PointResult without = solve_operating_point(scene, condition, {});
  scene.options.inlet_shear_heating = true;
  const PointResult with = solve_operating_point(scene, condition, {});
  EXPECT_NEAR(with.inlet_heating_factor, without.inlet_heating_factor, 0.01);
  const double mean = with.film_ratio.mean / without.film_ratio.mean;
  EXPECT_LT(with.inlet_heating_factor, mean);
  EXPECT_GT(with.inlet_heating_factor, 0.6 * mean);
}

TEST(RangeWarnings, SayWhereTheLimitingStressComesFrom) {
  Quiet place;
  place.figures.limiting_stress_area_share = 0.6666;
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

TEST(RangeWarnings, FrictionAndHeatThatNoOilSurvivesWithholdTheVerdict) {
  Quiet place;
  EXPECT_TRUE(place.sentence("NO_LUBRICATED_CONTACT").empty());
  place.figures.friction_coefficient = 1e103;
  EXPECT_FALSE(place.sentence("NO_LUBRICATED_CONTACT").empty());
  place.figures.friction_coefficient = 0.1;
  place.figures.contact_temperature = 2500;
  EXPECT_FALSE(place.sentence("NO_LUBRICATED_CONTACT").empty());
  EXPECT_TRUE(withholds_verdict("NO_LUBRICATED_CONTACT"));
}

}  // namespace
}  // namespace tribodyn
