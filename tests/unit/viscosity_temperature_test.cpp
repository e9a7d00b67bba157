#include "core/lubricant/viscosity_temperature.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/celsius.h"
#include "core/lubricant/viscosity.h"
#include "core/lubricant/walther_vogel.h"
#include "tests/support/reference_scene.h"
#include "tests/support/refusal_reason.h"

namespace tribodyn {
namespace {

ViscosityTemperatureLine line_of(double kv40, double kv100) {
  return viscosity_temperature_line({kFortyCelsius, 1e-6 * kv40}, {kHundredCelsius, 1e-6 * kv100});
}

TEST(ViscosityTemperatureLine, MeetsItsOwnPoints) {
  std::mt19937 random(341);
  std::uniform_real_distribution<double> lg(std::log10(0.22), 6.5), fraction(0.02, 0.98);
  for (int i = 0; i < 2000; ++i) {
    const double kv40 = std::pow(10, lg(random));
    const double kv100 = 0.215 * std::pow(kv40 / 0.215, fraction(random));
    const ViscosityTemperatureLine line = line_of(kv40, kv100);
    EXPECT_NEAR(1e6 * kinematic_viscosity(line, kFortyCelsius) / kv40, 1, 2e-13) << kv40;
    EXPECT_NEAR(1e6 * kinematic_viscosity(line, kHundredCelsius) / kv100, 1, 2e-12)
        << kv40 << " " << kv100;
    const ViscosityTemperatureLine swapped =
        viscosity_temperature_line({kHundredCelsius, 1e-6 * kv100}, {kFortyCelsius, 1e-6 * kv40});
    EXPECT_NEAR(swapped.slope / line.slope, 1, 1e-12);
  }
}

TEST(ViscosityTemperatureLine, MatchesPublishedConstants) {
  // lg lg(v + 0.7) = A - B lg T of an ISO VG 32 oil, 32 and 5.4 mm2/s: A 9.5259, B 3.7449 with
  // T in whole kelvin (313, 373) as printed; 8.5 mm2/s at 80 C.
  const ViscosityTemperatureLine line = viscosity_temperature_line({313, 32e-6}, {373, 5.4e-6});
  EXPECT_NEAR(line.slope, 3.7449, 5e-5);
  EXPECT_NEAR(line.reference_ordinate + line.slope * std::log10(313.0), 9.5259, 1e-4);
  EXPECT_NEAR(1e6 * kinematic_viscosity(line, 353), 8.5, 0.05);
}

TEST(ViscosityTemperatureLine, MatchesTheSimplifiedFormAboveTwo) {
  for (const auto& [kv40, kv100] : {std::pair{73.3, 8.86}, {22.83, 5.05}, {460.0, 30.0}}) {
    const auto w = [](double v) { return std::log10(std::log10(v + 0.7)); };
    const double slope = (w(kv40) - w(kv100)) / std::log10(kHundredCelsius / kFortyCelsius);
    const ViscosityTemperatureLine line = line_of(kv40, kv100);
    for (double temperature = 253.15; temperature < 430; temperature += 7) {
      const double simple =
          std::pow(10, std::pow(10, w(kv40) - slope * std::log10(temperature / kFortyCelsius))) -
          0.7;
      if (simple < 2.5) continue;
      EXPECT_NEAR(1e6 * kinematic_viscosity(line, temperature) / simple, 1, 1e-4);
    }
  }
}

TEST(ViscosityTemperatureLine, MatchesTheStandardsInverse) {
  // v = y - exp(-0.7487 - 3.295 y + 0.6119 y^2 - 0.3193 y^3), y = Z - 0.7: an approximation
  const ViscosityTemperatureLine line = line_of(3, 1);
  for (double temperature = 300; temperature < 460; temperature += 5) {
    const double y =
        std::pow(10, std::pow(10, line.reference_ordinate -
                                      line.slope * std::log10(temperature / kFortyCelsius))) -
        0.7;
    const double printed = y - std::exp(-0.7487 - 3.295 * y + 0.6119 * y * y - 0.3193 * y * y * y);
    EXPECT_NEAR(1e6 * kinematic_viscosity(line, temperature) / printed, 1, 0.002) << temperature;
  }
}

TEST(ViscosityTemperatureLine, FallsAsTheTemperatureRises) {
  const ViscosityTemperatureLine line = line_of(100, 8);
  double last = INFINITY;
  for (double temperature = 240; temperature < 560; temperature += 1) {
    const double v = kinematic_viscosity(line, temperature);
    EXPECT_LT(v, last);
    last = v;
  }
}

TEST(ViscosityTemperatureLine, RefusesWhereTheStandardIsUndefined) {
  const auto reason = [](double t1, double v1, double t2, double v2) {
    return refusal_reason([&] { viscosity_temperature_line({t1, 1e-6 * v1}, {t2, 1e-6 * v2}); });
  };
  constexpr const char* kReason = "VISCOSITY_TEMPERATURE_LINE";
  EXPECT_EQ(reason(kFortyCelsius, 100, kHundredCelsius, 10), "none");
  EXPECT_EQ(reason(kFortyCelsius, 10, kHundredCelsius, 100), kReason);
  EXPECT_EQ(reason(kFortyCelsius, 10, kHundredCelsius, 10), kReason);
  EXPECT_EQ(reason(kFortyCelsius, 10, kFortyCelsius + 0.5, 9), kReason);
  EXPECT_EQ(reason(kFortyCelsius, 10, kHundredCelsius, 0.2), kReason);
  EXPECT_EQ(reason(kFortyCelsius, -10, kHundredCelsius, 1), kReason);
  EXPECT_EQ(reason(kFortyCelsius, 3e7, kHundredCelsius, 1), kReason);
  EXPECT_EQ(reason(kFortyCelsius, NAN, kHundredCelsius, 1), kReason);
  EXPECT_EQ(reason(kFortyCelsius, 10, NAN, 1), kReason);
  EXPECT_EQ(reason(40, 100, 100, 10), kReason);  // Celsius by mistake
  EXPECT_EQ(refusal_reason([] { kinematic_viscosity(line_of(1, 0.4), 500); }), kReason);
  EXPECT_EQ(refusal_reason([] { kinematic_viscosity(line_of(2000, 8), 200); }), kReason);
}

TEST(WaltherVogel, StaysNearD341) {
  // Vogel through 40 and 100 C with the T_0 of walther_reference_temperature: how far from D341.
  const DensityLaw density = density_law(870, BaseOilClass::kGroupI);
  double ordinary = 0, ordinary_between = 0, heavy = 0;
  for (const auto& [kv40, kv100] : {std::pair{73.3, 8.86},
                                    {22.83, 5.05},
                                    {100.0, 14.5},
                                    {46.0, 6.8},
                                    {32.0, 5.4},
                                    {90.0, 15.5},
                                    {17.0, 3.9},
                                    {30.8, 5.9},
                                    {108.1, 15.9},
                                    {460.0, 30.0},
                                    {220.0, 19.0},
                                    {320.0, 55.0}}) {
    const ViscosityTemperatureLine line = line_of(kv40, kv100);
    const double t0 = walther_reference_temperature(line, density);
    const auto log_eta = [&](double temperature) {
      return std::log(kinematic_viscosity(line, temperature) *
                      (density.density_at_zero_kelvin + density.slope * temperature));
    };
    const double a1 = (log_eta(kFortyCelsius) - log_eta(kHundredCelsius)) /
                      (1 / (kFortyCelsius - t0) - 1 / (kHundredCelsius - t0));
    for (double temperature = 263.15; temperature < 424; temperature += 5) {
      const double vogel =
          log_eta(kHundredCelsius) + a1 * (1 / (temperature - t0) - 1 / (kHundredCelsius - t0));
      const double residual = std::abs(vogel - log_eta(temperature));
      if (kv100 > 16) {
        heavy = std::max(heavy, residual);
        continue;
      }
      ordinary = std::max(ordinary, residual);
      if (temperature > kFortyCelsius && temperature < kHundredCelsius) {
        ordinary_between = std::max(ordinary_between, residual);
      }
    }
  }
  EXPECT_LT(ordinary, 0.036);
  EXPECT_LT(ordinary_between, 0.0094);
  EXPECT_LT(heavy, 0.067);
}

TEST(TemperatureOfViscosity, IsTheInverseOfEq34) {
  const Lubricant fluid = reference_lubricant();
  for (const double temperature : {230.0, 313.15, 420.0}) {
    EXPECT_NEAR(temperature_of_viscosity(fluid, ambient_viscosity(fluid, temperature)), temperature,
                1e-10);
  }
}

}  // namespace
}  // namespace tribodyn
