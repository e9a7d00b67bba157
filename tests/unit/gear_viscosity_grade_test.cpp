#include "core/lubricant/gear_viscosity_grade.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/support/reference_data.h"

namespace tribodyn {
namespace {

using Points = std::vector<ViscosityPoint>;

std::string designation(double kv100, const Points& cold = {}) {
  return gear_viscosity_grade(1e-6 * kv100, cold).designation;
}

TEST(GearViscosityGrade, MatchesThePublishedTable) {
  const nlohmann::json table =
      load_reference("published_checks.json").at("inputs_only").at("sae_j306_2019");
  for (const auto& [grade, band] : table.at("kv100_bands_mm2_s").items()) {
    const double lower = band.at(0);
    EXPECT_EQ(designation(lower), grade);
    EXPECT_NE(designation(lower - 0.01), grade);
    if (band.size() < 2 || band.at(1).is_null()) continue;
    const double upper = band.at(1);
    EXPECT_EQ(designation(upper - 0.01), grade);
    EXPECT_NE(designation(upper), grade);
  }
  for (const nlohmann::json& grade : table.at("low_temperature_grades")) {
    const double celsius = grade.at("max_temperature_celsius_for_150000_mpa_s");
    const double kv100 = grade.at("min_kv100_mm2_s");
    const Points at_limit = {{celsius + 273.15, 150, 0}}, above = {{celsius + 273.15, 150.1, 0}};
    const std::string name = grade.at("grade");
    EXPECT_EQ(gear_viscosity_grade(1e-6 * kv100, at_limit).low_temperature_grade, name);
    EXPECT_NE(gear_viscosity_grade(1e-6 * kv100, above).low_temperature_grade, name);
    EXPECT_NE(gear_viscosity_grade(1e-6 * (kv100 - 0.01), at_limit).low_temperature_grade, name);
    EXPECT_EQ(low_temperature_grade_of(celsius + 273.15, 1e-6 * kv100), name);
    EXPECT_NE(low_temperature_grade_of(celsius + 273.25, 1e-6 * kv100), name);
  }
}

TEST(GearViscosityGrade, NamesOilsOfTheTrade) {
  EXPECT_EQ(designation(14.5, {{233.15, 110, 0}}), "75W-90");
  EXPECT_EQ(designation(15.9, {{233.15, 165, 0}, {247.15, 30, 0}}), "80W-90");
  EXPECT_EQ(designation(26, {{261.15, 100, 0}}), "85W-140");
  EXPECT_EQ(designation(5.9, {{218.15, 100, 0}}), "70W-70");
  EXPECT_EQ(designation(6.6, {{233.15, 20, 0}}), "75W-75");
}

TEST(GearViscosityGrade, GrantsNoMoreThanWasMeasured) {
  // Thin enough at -26 C; not measured at -40 C.
  const GearViscosityGrade grade = gear_viscosity_grade(14e-6, Points{{247.15, 90, 0}});
  EXPECT_EQ(grade.designation, "80W-90");
  EXPECT_NE(grade.note.find("75W"), std::string::npos);
  // thin enough colder than -40 C is enough for 75W, not for 70W
  EXPECT_EQ(designation(14, {{228.15, 149, 0}}), "75W-90");
  // too thick at -30 C misses 75W and 70W without further measurement
  const GearViscosityGrade thick = gear_viscosity_grade(14e-6, Points{{243.15, 151, 0}});
  EXPECT_EQ(thick.designation, "90");
  EXPECT_EQ(thick.note.find("75W"), std::string::npos);
}

TEST(GearViscosityGrade, LeavesUnnamedWhatHasNoGrade) {
  EXPECT_EQ(designation(3.7, {{233.15, 1, 0}}), "");
  EXPECT_FALSE(gear_viscosity_grade(3.7e-6, Points{}).note.empty());
  EXPECT_FALSE(gear_viscosity_grade(std::nullopt, Points{}).note.empty());
  EXPECT_EQ(designation(NAN), "");
  EXPECT_EQ(designation(-3), "");
  EXPECT_EQ(designation(INFINITY), "");
  EXPECT_EQ(designation(14, {{NAN, 100, 0}, {233.15, NAN, 0}, {233.15, -5, 0}}), "90");
  // 80W wants 8.5 mm2/s
  const GearViscosityGrade thin =
      gear_viscosity_grade(7e-6, Points{{233.15, 200, 0}, {247.15, 100, 0}});
  EXPECT_EQ(thin.designation, "75");
  EXPECT_NE(thin.note.find("8.5"), std::string::npos);
}

}  // namespace
}  // namespace tribodyn
