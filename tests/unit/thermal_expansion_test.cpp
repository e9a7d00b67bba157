#include "core/lubricant/thermal_expansion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/support/refusal_reason.h"

namespace tribodyn {
namespace {

constexpr double kFifteen = 288.15;

TEST(ThermalExpansion, MatchesClosedForms) {
  // d rho/dT at 15 C is -K_1 for every density
  for (const double rho : {820.0, 870.0, 1000.0}) {
    EXPECT_EQ(expanded_density(rho, kFifteen), rho);
    const double slope =
        (expanded_density(rho, kFifteen + 0.01) - expanded_density(rho, kFifteen - 0.01)) / 0.02;
    EXPECT_NEAR(slope, -kLubricatingOilExpansion, 1e-8);
  }
  // rho_15 = 900, 65 C: a dT = 0.6278/900 * 50 = 0.0348778
  EXPECT_NEAR(expanded_density(900, kFifteen + 50), 900 * std::exp(-0.0348777778 * 1.0279022222),
              1e-6);
}

TEST(DensityLaw, StaysNearD1250) {
  for (const double rho : {820.0, 870.0, 950.0}) {
    const DensityLaw law = density_law(rho, BaseOilClass::kPolyalphaolefin);
    EXPECT_NEAR(law.density_at_zero_kelvin + law.slope * kFifteen, rho, 1e-9);
    EXPECT_NEAR(law.density_at_zero_kelvin + law.slope * 373.15, expanded_density(rho, 373.15),
                1e-9);
    for (double temperature = 263.15; temperature <= 423.15; temperature += 5) {
      EXPECT_NEAR((law.density_at_zero_kelvin + law.slope * temperature) /
                      expanded_density(rho, temperature),
                  1, 0.0013)
          << temperature;
    }
  }
}

TEST(DensityLaw, MatchesThePapersFluids) {
  // rho = 1016.1 - 0.6323 T: 833.9 kg/m3 at 15 C
  const DensityLaw law = density_law(1016.1 - 0.6323 * kFifteen, BaseOilClass::kPolyalphaolefin);
  EXPECT_NEAR(law.slope, -0.6323, 2 * law.slope_uncertainty);
  EXPECT_NEAR(law.slope / -0.6323, 1, 0.01);
}

TEST(DensityLaw, ReturnsTheLineItWasGiven) {
  std::vector<DensityPoint> points;
  for (const double celsius : {60.0, 15.0, 100.0, -20.0}) {
    points.push_back({celsius + 273.15, 1016.1 - 0.6323 * (celsius + 273.15)});
  }
  const DensityLaw law = density_law(points, BaseOilClass::kUnspecified);
  EXPECT_NEAR(law.slope, -0.6323, 1e-12);
  EXPECT_NEAR(law.density_at_zero_kelvin, 1016.1, 1e-9);
  EXPECT_LT(law.root_mean_square_residual, 1e-9);
}

TEST(DensityLaw, IsIndependentOfWhereASingleDensityWasMeasured) {
  const DensityLaw reference = density_law(870, BaseOilClass::kGroupII);
  const std::vector<DensityPoint> at_40 = {
      {313.15, reference.density_at_zero_kelvin + reference.slope * 313.15}};
  EXPECT_NEAR(density_law(at_40, BaseOilClass::kGroupII).slope, reference.slope, 1e-4);
}

TEST(DensityLaw, RefusesNonsense) {
  const auto reason = [](std::vector<DensityPoint> points) {
    return refusal_of([&] { density_law(points, BaseOilClass::kGroupI); });
  };
  EXPECT_EQ(reason({}).substr(0, 19), "DENSITY_TABLE_EMPTY");
  EXPECT_NE(reason({{288.15, 870}, {300, 0.87}}).find("DENSITY_OUT_OF_RANGE: A density of 0.87"),
            std::string::npos);
  EXPECT_NE(reason({{288.15, 870}, {15, 870}}).find("row 2"), std::string::npos);
  EXPECT_NE(reason({{288.15, NAN}}).find("row 1"), std::string::npos);
  EXPECT_EQ(reason({{288.15, 870}, {330, 880}}).substr(0, 13), "DENSITY_RISES");
  EXPECT_EQ(refusal_reason([] { density_law(0.87, BaseOilClass::kGroupI); }),
            "DENSITY_OUT_OF_RANGE");
}

}  // namespace
}  // namespace tribodyn
