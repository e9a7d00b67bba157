#include "core/lubricant/comparison.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/reference_scene.h"
#include "tests/support/refusal_reason.h"

namespace tribodyn {
namespace {

TEST(LubricantFigures, FollowTheLawsTheyRestOn) {
  for (const int fluid : {1, 2, 3}) {
    const Lubricant lubricant = reference_lubricant(fluid);
    const LubricantFigures figures = lubricant_figures(lubricant, {});
    ASSERT_EQ(figures.at.size(), 3);
    // eq 33 gives the measured alpha* back where it was measured
    EXPECT_EQ(figures.at[0].temperature, 313.15);
    EXPECT_NEAR(
        figures.at[0].pressure_viscosity_coefficient / lubricant.pressure_viscosity_coefficient, 1,
        1e-12);
    EXPECT_NEAR(figures.at[0].viscosity,
                lubricant.vogel_viscosity_prefactor *
                    std::exp(lubricant.vogel_temperature_coefficient /
                             (313.15 - lubricant.vogel_reference_temperature)),
                1e-12);
    EXPECT_NEAR(1e6 * figures.kinematic_viscosity_40,
                1e6 * figures.at[0].viscosity / (1016.1 - 0.6323 * 313.15), 1e-9);
    for (std::size_t i = 1; i < 3; ++i) {
      EXPECT_LT(figures.at[i].pressure_viscosity_coefficient,
                figures.at[i - 1].pressure_viscosity_coefficient);
      EXPECT_LT(figures.at[i].viscosity_at_gigapascal, figures.at[i - 1].viscosity_at_gigapascal);
    }
    EXPECT_TRUE(figures.viscosity_index.has_value());
  }
}

TEST(LubricantFigures, FollowTheIndexChosen) {
  const Lubricant lubricant = reference_lubricant();
  ModelOptions options;
  options.pressure_viscosity_index = PressureViscosityIndex::kHoupert;
  const LubricantFigures houpert = lubricant_figures(lubricant, options);
  // alpha* is then the slope at zero pressure, and Z smaller: thinner at 1 GPa
  EXPECT_NEAR(houpert.at[0].pressure_viscosity_coefficient,
              lubricant.pressure_viscosity_coefficient, 1e-20);
  EXPECT_LT(houpert.at[0].viscosity_at_gigapascal,
            lubricant_figures(lubricant, {}).at[0].viscosity_at_gigapascal);
}

TEST(LubricantFigures, RefuseACoefficientThatNoIndexGives) {
  Lubricant lubricant = reference_lubricant();
  lubricant.pressure_viscosity_coefficient = 1e-6;
  EXPECT_EQ(refusal_reason([&] { lubricant_figures(lubricant, {}); }), "PRESSURE_VISCOSITY_INDEX");
}

}  // namespace
}  // namespace tribodyn
