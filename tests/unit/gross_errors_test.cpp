#include "core/lubricant/gross_errors.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/celsius.h"
#include "core/lubricant/viscosity.h"
#include "core/refusal.h"

namespace tribodyn {
namespace {

FluidMeasurements oil(double kv40 = 103, double kv100 = 15, double density = 868) {
  FluidMeasurements fluid;
  fluid.base_oil = BaseOilClass::kPolyalphaolefin;
  fluid.kinematic_viscosity_40 = 1e-6 * kv40;
  fluid.kinematic_viscosity_100 = 1e-6 * kv100;
  fluid.density_15 = density;
  return fluid;
}

ViscosityPoint cold(double celsius, double pascal_seconds) {
  return {celsius + kZeroCelsius, pascal_seconds, 0};
}

bool says(const std::string& sentence, const std::string& part) {
  return sentence.find(part) != std::string::npos;
}

// What a fit that is not possible says.
std::string fit_refusal(const FluidMeasurements& fluid) {
  try {
    characterise(fluid);
  } catch (const Refusal& refusal) {
    return refusal.what();
  }
  return "";
}

TEST(GrossErrors, NameTheUnitOfAColdViscosityInPascalSeconds) {
  FluidMeasurements fluid = oil();
  fluid.cold_viscosities = {cold(-40, 0.15)};
  const CharacterisedFluid known = characterise(fluid);
  ASSERT_EQ(known.gross_errors.size(), 1);
  const GrossError& error = known.gross_errors.front();
  EXPECT_EQ(error.code, "VISCOSITY_CONTRADICTED");
  EXPECT_EQ(error.measurement, Measurement::kColdViscosity);
  EXPECT_EQ(error.row, 0);
  EXPECT_TRUE(says(error.sentence, "150 mPa s at -40 C lies 97 % below the law")) << error.sentence;
  EXPECT_TRUE(says(error.sentence, "Did you mean 150 Pa s (150000 mPa s) at -40 C?"))
      << error.sentence;
}

TEST(GrossErrors, NameTheSlipWhereNoLawCanBeFittedAtAll) {
  FluidMeasurements fluid = oil(65.8, 11.8, 860);
  fluid.cold_viscosities = {cold(-40, 0.036)};  // thinner than at 40 C
  EXPECT_TRUE(says(fit_refusal(fluid), "Did you mean 36 Pa s (36000 mPa s) at -40 C?"))
      << fit_refusal(fluid);
  fluid.cold_viscosities = {cold(-40, 0.036), cold(-26, 0.0065)};
  EXPECT_TRUE(says(fit_refusal(fluid), "36 Pa s (36000 mPa s) at -40 C, 6.5 Pa s (6500 mPa s)"))
      << fit_refusal(fluid);
  fluid.cold_viscosities.clear();
  fluid.viscosities = {{kZeroCelsius + 26, 6.5, 0}};
  EXPECT_TRUE(says(fit_refusal(fluid), "Did you mean 6500 mPa s at -26 C?")) << fit_refusal(fluid);
}

TEST(GrossErrors, AreFewWhereOneViscositySpoilsTheFitOfAll) {
  FluidMeasurements fluid = oil();
  const CharacterisedFluid good = characterise(fluid);
  for (const double celsius : {0.0, 20.0, 60.0, 80.0}) {
    const double temperature = celsius + kZeroCelsius;
    fluid.viscosities.push_back({temperature, ambient_viscosity(good.lubricant, temperature), 0});
  }
  EXPECT_TRUE(characterise(fluid).gross_errors.empty());
  fluid.viscosities[2].viscosity *= 0.01;
  const std::string refusal = fit_refusal(fluid);
  EXPECT_TRUE(says(refusal, " P (")) << refusal;
  EXPECT_TRUE(says(refusal, "at 60 C?")) << refusal;
}

TEST(GrossErrors, LeaveOilsOfTheTradeAlone) {
  const struct {
    double kv40, kv100, density, celsius, pascal_seconds;
  } kOils[] = {{103, 15.1, 868, -40, 98},  {144, 14.5, 895, -26, 140}, {177, 24.6, 870, -40, 130},
               {65.8, 11.8, 860, -40, 36}, {40.5, 7.9, 850, -40, 18},  {98, 14.8, 865, -40, 120}};
  for (const auto& each : kOils) {
    FluidMeasurements fluid = oil(each.kv40, each.kv100, each.density);
    fluid.sheared_kinematic_viscosity_100 = 0.93e-6 * each.kv100;
    fluid.cold_viscosities = {cold(each.celsius, each.pascal_seconds)};
    const CharacterisedFluid known = characterise(fluid);
    EXPECT_TRUE(known.gross_errors.empty()) << known.gross_errors.front().sentence;
    EXPECT_FALSE(known.grade.low_temperature_grade.empty()) << each.kv40;
  }
}

/// The oil without KV40 and KV100: its viscosities at four temperatures, times a factor.
FluidMeasurements table_of(const FluidMeasurements& fluid, double factor) {
  FluidMeasurements out;
  out.base_oil = fluid.base_oil;
  out.density_15 = fluid.density_15;
  const Lubricant law = characterise(fluid).lubricant;
  for (const double celsius : {20.0, 40.0, 60.0, 100.0}) {
    const double temperature = celsius + kZeroCelsius;
    out.viscosities.push_back({temperature, factor * ambient_viscosity(law, temperature), 0});
  }
  return out;
}

TEST(GrossErrors, HoldATableToTheLimitsOfKV100) {
  EXPECT_TRUE(characterise(table_of(oil(), 1)).gross_errors.empty());
  for (const double factor : {1e3, 1e-3}) {
    const auto errors = characterise(table_of(oil(), factor)).gross_errors;
    ASSERT_EQ(errors.size(), 1) << factor;
    const GrossError& error = errors.front();
    EXPECT_EQ(error.code, "VISCOSITY_IMPLAUSIBLE");
    EXPECT_EQ(error.measurement, Measurement::kViscosity);
    EXPECT_EQ(error.row, 3) << "the one at 100 C";
    EXPECT_TRUE(says(error.sentence, "mPa s and Pa s")) << error.sentence;
    EXPECT_TRUE(says(error.sentence, "A factor of 1000 makes it 15 mm2/s")) << error.sentence;
  }
}

TEST(GrossErrors, HoldATableToTheLimitsOfTheViscosityIndex) {
  FluidMeasurements fluid;
  fluid.viscosities = {{kHundredCelsius, 0.014, 0}, {kFortyCelsius, 0.02, 0}};
  const auto errors = characterise(fluid).gross_errors;
  ASSERT_EQ(errors.size(), 1);
  EXPECT_EQ(errors.front().code, "VISCOSITY_INDEX_IMPLAUSIBLE");
  EXPECT_EQ(errors.front().measurement, Measurement::kViscosity);
  EXPECT_EQ(errors.front().row, 1) << "the one at 40 C";
}

struct ColdOil {
  double kv40, kv100, density, celsius, pascal_seconds;
};

FluidMeasurements with_cold(const ColdOil& oil_data, double factor) {
  FluidMeasurements fluid = oil(oil_data.kv40, oil_data.kv100, oil_data.density);
  fluid.base_oil = BaseOilClass::kGroupI;
  fluid.cold_viscosities = {cold(oil_data.celsius, factor * oil_data.pascal_seconds)};
  return fluid;
}

// 80W-90, 85W-140 and SAE 30 as their maker publishes them.
constexpr ColdOil kPublished[] = {
    {136, 14.5, 900, -26, 112}, {328, 25.3, 910, -12, 81.8}, {53, 10.5, 879, -35, 14}};

TEST(GrossErrors, LeavePublishedColdViscositiesAlone) {
  for (const ColdOil& each : kPublished) {
    const auto errors = characterise(with_cold(each, 1)).gross_errors;
    EXPECT_TRUE(errors.empty()) << errors.front().sentence;
  }
}

TEST(GrossErrors, NameThePowerOfTenByWhichAColdViscosityIsTooHigh) {
  for (const ColdOil& each : kPublished) {
    for (const double factor : {100.0, 1000.0}) {
      const CharacterisedFluid known = characterise(with_cold(each, factor));
      ASSERT_EQ(known.gross_errors.size(), 1) << each.kv40;
      const GrossError& error = known.gross_errors.front();
      EXPECT_EQ(error.code, "COLD_VISCOSITY_IMPLAUSIBLE");
      EXPECT_EQ(error.measurement, Measurement::kColdViscosity);
      EXPECT_TRUE(says(error.sentence, factor == 100 ? "1/100 of it" : "1/1000 of it"))
          << error.sentence;
    }
  }
}

TEST(GrossErrors, RefuseAColdViscosityThatIsTooLow) {
  for (const double factor : {0.1, 0.01}) {
    for (const ColdOil& each :
         {ColdOil{103, 15.1, 868, -40, 98}, ColdOil{136, 14.5, 900, -26, 112}}) {
      const FluidMeasurements fluid = with_cold(each, factor);
      if (!fit_refusal(fluid).empty()) continue;  // no law can be fitted at all
      EXPECT_FALSE(characterise(fluid).gross_errors.empty()) << each.kv40 << " " << factor;
    }
  }
}

TEST(GrossErrors, BeginBeyondTheLimitsOfTheTable) {
  const auto code = [](const FluidMeasurements& fluid) {
    const auto errors = characterise(fluid).gross_errors;
    return errors.empty() ? std::string() : errors.front().code;
  };
  EXPECT_EQ(code(oil(15.01, 15)), "VISCOSITY_INDEX_IMPLAUSIBLE");
  EXPECT_EQ(code(oil(400, 15)), "");
  EXPECT_EQ(code(oil(450, 15)), "VISCOSITY_INDEX_IMPLAUSIBLE");
  EXPECT_EQ(code(oil(120, 50, 970)), "") << "a silicone of index 423";
  EXPECT_EQ(code(oil(20000, 1600, 970)), "VISCOSITY_IMPLAUSIBLE");
  FluidMeasurements sheared = oil();
  sheared.sheared_kinematic_viscosity_100 = 15.2e-6;
  EXPECT_EQ(code(sheared), "");
  sheared.sheared_kinematic_viscosity_100 = 15.4e-6;
  EXPECT_EQ(code(sheared), "SHEARED_THICKER_THAN_FRESH");
  // Of a stated uncertainty three standard deviations are credible.
  FluidMeasurements uncertain = oil();
  const CharacterisedFluid known = characterise(uncertain);
  for (const double celsius : {0.0, 20.0, 60.0, 80.0}) {
    const double temperature = celsius + kZeroCelsius;
    uncertain.viscosities.push_back(
        {temperature, ambient_viscosity(known.lubricant, temperature), 0});
  }
  uncertain.viscosities[1].viscosity *= 1.5;
  EXPECT_EQ(code(uncertain), "VISCOSITY_CONTRADICTED");
  uncertain.viscosities[1].relative_standard_uncertainty = 0.2;
  EXPECT_EQ(code(uncertain), "");
}

TEST(GrossErrors, HoldAStatedLawAgainstTheKinematicViscosities) {
  FluidMeasurements fluid = oil();
  const CharacterisedFluid known = characterise(fluid);
  fluid.stated.vogel_viscosity_prefactor = known.parameters.vogel_viscosity_prefactor;
  fluid.stated.vogel_temperature_coefficient = known.parameters.vogel_temperature_coefficient;
  fluid.stated.vogel_reference_temperature = known.parameters.vogel_reference_temperature;
  EXPECT_TRUE(characterise(fluid).gross_errors.empty());
  fluid.kinematic_viscosity_40 = 120e-6;
  const auto errors = characterise(fluid).gross_errors;
  ASSERT_EQ(errors.size(), 1);
  EXPECT_EQ(errors.front().code, "LAW_CONTRADICTED");
  EXPECT_EQ(errors.front().measurement, Measurement::kKinematicViscosity40);
  EXPECT_TRUE(says(errors.front().sentence, "17 % above the stated law"))
      << errors.front().sentence;
}

TEST(GrossErrors, EarnNoWGrade) {
  FluidMeasurements fluid = oil();
  fluid.cold_viscosities = {cold(-40, 0.15)};
  const GearViscosityGrade grade = characterise(fluid).grade;
  EXPECT_EQ(grade.low_temperature_grade, "");
  EXPECT_TRUE(says(grade.note, "at -40 C contradicts the law and proves no W grade")) << grade.note;
  fluid.cold_viscosities = {cold(-40, 98)};
  EXPECT_EQ(characterise(fluid).grade.designation, "75W-90");
}

}  // namespace
}  // namespace tribodyn
