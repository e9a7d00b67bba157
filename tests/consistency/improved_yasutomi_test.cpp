#include "tests/support/improved_yasutomi.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "core/contact/mean_shear_stress.h"
#include "core/lubricant/comparison.h"
#include "core/lubricant/viscosity.h"
#include "core/refusal.h"
#include "tests/consistency/plain_contact.h"

namespace tribodyn {
namespace {

ContactCase gear_oil_case() {
  ContactCase c;
  set_yasutomi(gear_oil_80w90(), c.lubricant);
  return c;
}

GrowthLaw<double> law_of(const Lubricant& oil) {
  return laws::growth_law(oil, std::log(oil.vogel_viscosity_prefactor));
}

TEST(ImprovedYasutomi, HasTheAmbientViscositiesAndGradeThatArePrintedForAGearOil) {
  const Lubricant oil = gear_oil_case().lubricant;
  const auto millipascal_seconds = [&](double celsius) {
    return 1e3 * ambient_viscosity(oil, kZeroCelsius + celsius);
  };
  EXPECT_NEAR(millipascal_seconds(40), 123.96, 0.005);
  EXPECT_NEAR(millipascal_seconds(80), 21.40, 0.005);
  EXPECT_NEAR(millipascal_seconds(100), 11.545, 0.0005);
  EXPECT_NEAR(millipascal_seconds(-26), 130300, 50);
  EXPECT_LT(millipascal_seconds(-26), 150000);  // SAE 80W
  constexpr double kDensityAtHundredCelsius = 806;
  const double kinematic = 1e3 * millipascal_seconds(100) / kDensityAtHundredCelsius;
  EXPECT_GE(kinematic, 13.5);  // SAE 90
  EXPECT_LT(kinematic, 18.5);
}

TEST(ImprovedYasutomi, IsThePrintedFormAtEveryPressureAndTemperature) {
  const PrintedYasutomi printed = gear_oil_80w90();
  const Lubricant oil = gear_oil_case().lubricant;
  for (double celsius = -20; celsius <= 200; celsius += 11) {
    const double temperature = kZeroCelsius + celsius;
    for (double pressure = 0; pressure <= 2e9; pressure += 0.05e9) {
      const double log_viscosity = printed.log_viscosity(pressure, temperature);
      if (log_viscosity > std::log(printed.of_pressure[kGlassViscosity])) break;
      const double growth = laws::pressure_growth(law_of(oil), temperature, pressure);
      EXPECT_NEAR(log_ambient_viscosity(oil, temperature) + growth, log_viscosity, 1e-12)
          << celsius << " C, " << pressure << " Pa";
    }
  }
}

TEST(ImprovedYasutomi, StaysAtTheViscosityOfTheGlassBelowTheTransition) {
  const Lubricant oil = gear_oil_case().lubricant;
  const double temperature = 300;
  for (const double pressure : {2.5e9, 4e9, 1e10}) {
    EXPECT_NEAR(log_ambient_viscosity(oil, temperature) +
                    laws::pressure_growth(law_of(oil), temperature, pressure),
                std::log(1e12), 1e-12);
  }
}

TEST(ImprovedYasutomi, HasTheReciprocalAsymptoticCoefficientOfItsIntegral) {
  const PrintedYasutomi printed = gear_oil_80w90();
  const Lubricant oil = gear_oil_case().lubricant;
  for (double celsius = 0; celsius <= 200; celsius += 20) {
    const double temperature = kZeroCelsius + celsius;
    const auto growth = [&](double pressure) {
      return printed.log_viscosity(pressure, temperature) - printed.log_viscosity(0, temperature);
    };
    double end = 0;
    while (growth(end) < 38 && growth(end + 1e7) > growth(end)) end += 1e7;
    const double integral =
        plain::integral([&](double pressure) { return std::exp(-growth(pressure)); }, 0, end);
    EXPECT_NEAR(integral * reciprocal_asymptotic_of_growth(law_of(oil), temperature), 1, 1e-9)
        << celsius << " C";
  }
  // The order of size of gear oils at 40 C.
  const LubricantFigures figures = lubricant_figures(oil, {});
  EXPECT_GT(figures.at[0].pressure_viscosity_coefficient, 15e-9);
  EXPECT_LT(figures.at[0].pressure_viscosity_coefficient, 35e-9);
  EXPECT_NEAR(std::log(figures.at[0].viscosity_at_gigapascal),
              printed.log_viscosity(1e9, figures.at[0].temperature), 1e-12);
}

TEST(ImprovedYasutomi, FallsWithTemperatureWhereItIsProvedTo) {
  using Number = laws::Dual<double, 1>;
  const GrowthLaw<double> law = law_of(gear_oil_case().lubricant);
  int proved = 0;
  for (double temperature = 250; temperature < 480; temperature += 10) {
    for (double pressure = 0.05e9; pressure < 3e9; pressure += 0.05e9) {
      if (!laws::pressure_growth_falls(law, temperature, pressure)) continue;
      ++proved;
      EXPECT_LE(
          laws::pressure_growth(law, Number::variable(temperature, 0), Number(pressure)).slope[0],
          0)
          << temperature << " K, " << pressure << " Pa";
    }
  }
  EXPECT_GT(proved, 500);
}

TEST(ImprovedYasutomi, HasTheMeanStressOfQuadratureOverPosition) {
  Draw draw(1301);
  SCOPED_TRACE(draw.seed());
  for (int n = 0; n < (kShortRun ? 30 : 150); ++n) {
    ContactCase c = random_contact_case(draw);
    set_yasutomi(gear_oil_80w90(), c.lubricant);
    c.sump_temperature = draw.between(273, 403);
    c.options.newtonian = n % 8 == 3;
    const FlankContactModel model = c.model();
    const double pressure = draw.log_between(1e7, 1.5e9), rate = draw.log_between(1e2, 1e8);
    const double temperature = c.inlet_temperature() + draw.between(0, 80);
    double guess = 0;
    const MeanShearStress mean = mean_shear_stress(
        {&model.constants().shear, pressure, std::log(rate), true}, temperature, guess);
    const double expected = plain::mean_stress(plain::Shear{c, 0, rate, temperature}, pressure);
    EXPECT_NEAR(std::exp(mean.log_value) / expected, 1, 1e-10)
        << "state " << n << ": " << pressure << " Pa, " << rate << " 1/s, " << temperature << " K";
  }
}

TEST(ImprovedYasutomi, RefusesATemperatureNearItsGlassTransition) {
  ContactCase c = gear_oil_case();
  c.sump_temperature = kZeroCelsius - 50;
  c.inlet_temperature_rise = 0;
  try {
    c.model();
    FAIL() << "was accepted";
  } catch (const Refusal& refusal) {
    EXPECT_EQ(refusal.reason(), "PARAMETER_OUT_OF_RANGE");
    EXPECT_NE(std::string(refusal.what()).find("-50 C"), std::string::npos) << refusal.what();
  }
}

}  // namespace
}  // namespace tribodyn
