#include "core/lubricant/characterisation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include "core/celsius.h"
#include "core/lubricant/viscosity.h"
#include "tests/support/reference_scene.h"
#include "tests/support/refusal_reason.h"

namespace tribodyn {
namespace {

FluidMeasurements three_numbers(double kv40 = 100, double kv100 = 14.5, double density = 860) {
  FluidMeasurements fluid;
  fluid.base_oil = BaseOilClass::kPolyalphaolefin;
  fluid.kinematic_viscosity_40 = 1e-6 * kv40;
  fluid.kinematic_viscosity_100 = 1e-6 * kv100;
  fluid.density_15 = density;
  return fluid;
}

std::multiset<std::string> codes(const CharacterisedFluid& fluid) {
  std::multiset<std::string> result;
  for (const CharacterisationWarning& warning : fluid.warnings) result.insert(warning.code);
  return result;
}

bool warns(const CharacterisedFluid& fluid, const std::string& code,
           const std::string& parameter = "") {
  return std::any_of(fluid.warnings.begin(), fluid.warnings.end(), [&](const auto& warning) {
    return warning.code == code && (parameter.empty() || warning.parameter == parameter);
  });
}

KnownParameter measured(double value) {
  return {value, 0.01 * std::abs(value), Provenance::kMeasured, "laboratory"};
}

// Calls f(known parameter, value in the Lubricant) for all of them.
template <class F>
void for_each(const CharacterisedFluid& fluid, F&& f) {
  const auto& p = fluid.parameters;
  const Lubricant& l = fluid.lubricant;
  f(p.vogel_viscosity_prefactor, l.vogel_viscosity_prefactor);
  f(p.vogel_temperature_coefficient, l.vogel_temperature_coefficient);
  f(p.vogel_reference_temperature, l.vogel_reference_temperature);
  f(p.pressure_viscosity_coefficient, l.pressure_viscosity_coefficient);
  f(p.pressure_viscosity_temperature, l.pressure_viscosity_temperature);
  f(p.relaxation_time, l.relaxation_time);
  f(p.havriliak_negami_alpha, l.havriliak_negami_alpha);
  f(p.havriliak_negami_beta, l.havriliak_negami_beta);
  f(p.rheology_reference_temperature, l.rheology_reference_temperature);
  f(p.limiting_shear_stress_at_zero_pressure, l.limiting_shear_stress_at_zero_pressure);
  f(p.limiting_shear_stress_coefficient, l.limiting_shear_stress_coefficient);
  f(p.thermal_conductivity, l.thermal_conductivity);
  f(p.density_at_zero_kelvin, l.density_at_zero_kelvin);
  f(p.density_temperature_slope, l.density_temperature_slope);
}

TEST(Characterisation, GivesBackTheThreeNumbersItWasGiven) {
  for (const auto& [kv40, kv100] :
       {std::pair{73.3, 8.86}, {22.83, 5.05}, {100.0, 14.5}, {460.0, 30.0}, {320.0, 55.0}}) {
    const CharacterisedFluid fluid = characterise(three_numbers(kv40, kv100));
    EXPECT_NEAR(1e6 * kinematic_viscosity(fluid.lubricant, kFortyCelsius) / kv40, 1, 1e-12);
    EXPECT_NEAR(1e6 * kinematic_viscosity(fluid.lubricant, kHundredCelsius) / kv100, 1, 1e-12);
    EXPECT_NEAR(density(fluid.lubricant, 288.15), 860, 1e-9);
    EXPECT_EQ(fluid.walther_comparison.size(), 17);
    for (const ViscosityLawComparison& at : fluid.walther_comparison) {
      EXPECT_NEAR(at.vogel_viscosity / at.walther_viscosity, 1, 0.07) << at.temperature;
    }
  }
  EXPECT_NEAR(*characterise(three_numbers(73.3, 8.86)).viscosity_index, 92, 0.5);
  EXPECT_NEAR(*characterise(three_numbers(22.83, 5.05)).viscosity_index, 156, 0.5);
}

TEST(Characterisation, StatesEveryAssumption) {
  const CharacterisedFluid fluid = characterise(three_numbers());
  EXPECT_EQ(codes(fluid).count("PARAMETER_ESTIMATED"), 7);
  EXPECT_TRUE(warns(fluid, "EXPANSION_ESTIMATED", "density_temperature_slope"));
  EXPECT_TRUE(warns(fluid, "VOGEL_REFERENCE_TEMPERATURE_ASSUMED", "vogel_reference_temperature"));
  EXPECT_FALSE(warns(fluid, "BASE_OIL_UNSPECIFIED"));
  for (const char* parameter :
       {"pressure_viscosity_coefficient", "relaxation_time", "havriliak_negami_alpha",
        "havriliak_negami_beta", "limiting_shear_stress_at_zero_pressure",
        "limiting_shear_stress_coefficient", "thermal_conductivity"}) {
    EXPECT_TRUE(warns(fluid, "PARAMETER_ESTIMATED", parameter)) << parameter;
  }
  EXPECT_EQ(fluid.parameters.vogel_viscosity_prefactor.provenance, Provenance::kFitted);
  EXPECT_EQ(fluid.parameters.density_at_zero_kelvin.provenance, Provenance::kDerived);
  EXPECT_EQ(fluid.parameters.pressure_viscosity_coefficient.provenance, Provenance::kAssumed);
  for_each(fluid, [](const KnownParameter& known, double value) {
    EXPECT_EQ(known.value, value);
    EXPECT_FALSE(known.source.empty());
  });

  FluidMeasurements bare = three_numbers();
  bare.base_oil = BaseOilClass::kUnspecified;
  bare.density_15.reset();
  const CharacterisedFluid guessed = characterise(bare);
  EXPECT_TRUE(warns(guessed, "BASE_OIL_UNSPECIFIED"));
  EXPECT_TRUE(warns(guessed, "DENSITY_ESTIMATED", "density_at_zero_kelvin"));
  // a density that may be 5 % off shifts the viscosity by as much
  EXPECT_GT(*guessed.parameters.vogel_viscosity_prefactor.standard_uncertainty /
                guessed.lubricant.vogel_viscosity_prefactor,
            0.05);
}

TEST(Characterisation, AsksForTheClassOfBaseOilOnlyWhereAnEstimateDependsOnIt) {
  FluidMeasurements fluid = three_numbers();
  fluid.base_oil = BaseOilClass::kUnspecified;
  EXPECT_TRUE(warns(characterise(fluid), "BASE_OIL_UNSPECIFIED"));
  fluid.densities = {{373.15, 805}};
  fluid.stated.pressure_viscosity_coefficient = measured(2e-8);
  fluid.stated.limiting_shear_stress_coefficient = measured(0.03);
  EXPECT_TRUE(warns(characterise(fluid), "BASE_OIL_UNSPECIFIED"));
  fluid.stated.thermal_conductivity = measured(0.14);
  EXPECT_FALSE(warns(characterise(fluid), "BASE_OIL_UNSPECIFIED"));
}

TEST(Characterisation, ReproducesThePapersFluids) {
  for (const int number : {1, 2, 3}) {
    const Lubricant lubricant = reference_lubricant(number);
    FluidMeasurements fluid;
    fluid.base_oil = BaseOilClass::kPolyalphaolefin;
    for (const double celsius : {10.0, 25.0, 40.0, 60.0, 80.0, 100.0, 120.0, 140.0}) {
      const double temperature = celsius + 273.15;
      fluid.viscosities.push_back({temperature, ambient_viscosity(lubricant, temperature), 0.01});
      fluid.densities.push_back({temperature, density(lubricant, temperature)});
    }
    fluid.stated.pressure_viscosity_coefficient =
        measured(lubricant.pressure_viscosity_coefficient);
    fluid.stated.pressure_viscosity_temperature = measured(kFortyCelsius);
    fluid.stated.limiting_shear_stress_coefficient =
        measured(lubricant.limiting_shear_stress_coefficient);
    const CharacterisedFluid result = characterise(fluid);
    const Lubricant& l = result.lubricant;
    EXPECT_NEAR(l.vogel_viscosity_prefactor / lubricant.vogel_viscosity_prefactor, 1, 1e-9);
    EXPECT_NEAR(l.vogel_temperature_coefficient / lubricant.vogel_temperature_coefficient, 1, 1e-9);
    EXPECT_NEAR(l.vogel_reference_temperature / lubricant.vogel_reference_temperature, 1, 1e-9);
    EXPECT_NEAR(l.density_at_zero_kelvin, lubricant.density_at_zero_kelvin, 1e-8);
    EXPECT_NEAR(l.density_temperature_slope, lubricant.density_temperature_slope, 1e-11);
    EXPECT_EQ(l.pressure_viscosity_coefficient, lubricant.pressure_viscosity_coefficient);
    EXPECT_EQ(result.parameters.pressure_viscosity_coefficient.provenance, Provenance::kMeasured);
    EXPECT_EQ(l.thermal_conductivity, lubricant.thermal_conductivity);
    // what the estimators say of the rest holds within its uncertainty
    EXPECT_NEAR(l.relaxation_time, lubricant.relaxation_time,
                *result.parameters.relaxation_time.standard_uncertainty);
    EXPECT_FALSE(warns(result, "VISCOSITY_MISFIT"));
    EXPECT_FALSE(warns(result, "EXPANSION_ESTIMATED"));
    EXPECT_FALSE(warns(result, "VISCOSITY_EXTRAPOLATED"));
    EXPECT_TRUE(result.walther_comparison.empty());
  }
}

TEST(Characterisation, TakesOverWhatIsStated) {
  const Lubricant lubricant = reference_lubricant(2);
  FluidMeasurements fluid;
  auto& stated = fluid.stated;
  stated.vogel_viscosity_prefactor = measured(lubricant.vogel_viscosity_prefactor);
  stated.vogel_temperature_coefficient = measured(lubricant.vogel_temperature_coefficient);
  stated.vogel_reference_temperature = measured(lubricant.vogel_reference_temperature);
  stated.density_at_zero_kelvin = measured(lubricant.density_at_zero_kelvin);
  stated.density_temperature_slope = measured(lubricant.density_temperature_slope);
  stated.pressure_viscosity_coefficient = measured(lubricant.pressure_viscosity_coefficient);
  stated.relaxation_time = measured(0);
  const CharacterisedFluid result = characterise(fluid);
  EXPECT_EQ(result.lubricant.vogel_viscosity_prefactor, lubricant.vogel_viscosity_prefactor);
  EXPECT_EQ(result.lubricant.density_temperature_slope, lubricant.density_temperature_slope);
  EXPECT_EQ(result.lubricant.relaxation_time, 0);
  EXPECT_EQ(result.lubricant.pressure_viscosity_temperature, kFortyCelsius);
  EXPECT_TRUE(warns(result, "TEMPERATURE_ASSUMED", "pressure_viscosity_temperature"));
  EXPECT_TRUE(warns(result, "TEMPERATURE_ASSUMED", "rheology_reference_temperature"));
  EXPECT_FALSE(result.viscosity_fit.has_value());
  EXPECT_EQ(codes(result).count("PARAMETER_ESTIMATED"), 5);
  EXPECT_EQ(result.grade.designation, "");  // nothing measured at 100 C
  EXPECT_EQ(result.grade.note,
            "SAE J306 grades measured viscosities, and KV100 was not measured; that of the law "
            "would make grade 90.");
}

TEST(Characterisation, UsesColdViscosities) {
  FluidMeasurements fluid = three_numbers(98, 14.8, 865);
  fluid.sheared_kinematic_viscosity_100 = 13.9e-6;
  fluid.cold_viscosities = {{233.15, 120, 0}, {247.15, 17, 0}};
  const CharacterisedFluid result = characterise(fluid);
  EXPECT_EQ(result.grade.designation, "75W-90");
  EXPECT_EQ(result.measured_viscosities.size(), 4);
  EXPECT_EQ(result.viscosity_fit->degrees_of_freedom, 1);
  EXPECT_EQ(result.measured_viscosities[2].point.relative_standard_uncertainty, 0.05);
  EXPECT_NEAR(std::log(ambient_viscosity(result.lubricant, 233.15) / 120), 0, 0.15);
  EXPECT_NEAR(1e6 * kinematic_viscosity(result.lubricant, kHundredCelsius), 14.8, 0.2);
  // without them the law extrapolates and says what it would earn
  fluid.cold_viscosities.clear();
  const CharacterisedFluid bare = characterise(fluid);
  EXPECT_EQ(bare.grade.designation, "90");
  EXPECT_EQ(bare.expected_low_temperature_grade, "75W");
  EXPECT_NEAR(ambient_viscosity(bare.lubricant, bare.temperature_of_150_pascal_seconds), 150, 1e-9);
}

TEST(Characterisation, WarnsOfAMisfitAndOfExtrapolation) {
  FluidMeasurements fluid = three_numbers();
  fluid.viscosities = {{343.15, 0.05, 0.01}, {293.15, 0.25, 0.01}};  // 40 % off at 70 C
  const CharacterisedFluid result = characterise(fluid);
  EXPECT_TRUE(warns(result, "VISCOSITY_MISFIT"));
  FluidMeasurements narrow;
  narrow.viscosities = {{293.15, 0.2, 0}, {333.15, 0.03, 0}};
  const CharacterisedFluid two = characterise(narrow);
  EXPECT_TRUE(warns(two, "VISCOSITY_EXTRAPOLATED"));
  EXPECT_TRUE(warns(two, "VOGEL_REFERENCE_TEMPERATURE_ASSUMED", "vogel_reference_temperature"));
  EXPECT_EQ(two.parameters.vogel_reference_temperature.provenance, Provenance::kAssumed);
}

TEST(Characterisation, WarnsOfAViscosityIndexThatGearOilsDoNotHave) {
  const auto is_unusual = [](double kv40, double kv100) {
    return warns(characterise(three_numbers(kv40, kv100)), "VISCOSITY_INDEX_UNUSUAL");
  };
  EXPECT_FALSE(is_unusual(100, 14.5));
  EXPECT_FALSE(is_unusual(30, 4.24)) << "index -25, naphthenic";
  EXPECT_TRUE(is_unusual(400, 15)) << "index -71";
  EXPECT_TRUE(is_unusual(120, 50)) << "index 423, silicone";
}

TEST(Characterisation, RefusesNonsense) {
  const auto reason = [](auto&& change) {
    FluidMeasurements fluid = three_numbers();
    change(fluid);
    return refusal_reason([&] { characterise(fluid); });
  };
  EXPECT_EQ(reason([](auto& f) { f = {}; }), "FLUID_UNDERDETERMINED");
  EXPECT_EQ(reason([](auto& f) { f.kinematic_viscosity_40.reset(); }), "FLUID_UNDERDETERMINED");
  EXPECT_EQ(reason([](auto& f) { f.kinematic_viscosity_100 = 2e-4; }),
            "VISCOSITY_TEMPERATURE_LINE");
  EXPECT_EQ(reason([](auto& f) { f.kinematic_viscosity_40 = 100; }), "PARAMETER_OUT_OF_RANGE");
  EXPECT_EQ(reason([](auto& f) { f.kinematic_viscosity_40 = NAN; }), "PARAMETER_OUT_OF_RANGE");
  EXPECT_EQ(reason([](auto& f) { f.sheared_kinematic_viscosity_100 = -1; }),
            "PARAMETER_OUT_OF_RANGE");
  EXPECT_EQ(reason([](auto& f) { f.density_15 = 0.86; }), "DENSITY_OUT_OF_RANGE");
  EXPECT_EQ(reason([](auto& f) { f.stated.vogel_viscosity_prefactor = measured(1e-4); }),
            "PARAMETER_INCOMPLETE");
  EXPECT_EQ(reason([](auto& f) { f.stated.density_temperature_slope = measured(-0.6); }),
            "PARAMETER_INCOMPLETE");
  EXPECT_EQ(reason([](auto& f) { f.stated.thermal_conductivity = measured(-0.1); }),
            "PARAMETER_OUT_OF_RANGE");
  EXPECT_EQ(reason([](auto& f) { f.stated.thermal_conductivity = measured(NAN); }),
            "PARAMETER_OUT_OF_RANGE");
  EXPECT_EQ(reason([](auto& f) {
              f.stated.thermal_conductivity = measured(0.14);
              f.stated.thermal_conductivity->standard_uncertainty = -1;
            }),
            "PARAMETER_OUT_OF_RANGE");
  EXPECT_EQ(reason([](auto& f) {
              f.stated.vogel_viscosity_prefactor = measured(1e-4);
              f.stated.vogel_temperature_coefficient = measured(900);
              f.stated.vogel_reference_temperature = measured(350);
            }),
            "PARAMETER_OUT_OF_RANGE");
  EXPECT_EQ(reason([](auto& f) {
              f.viscosities = {{343.15, -1, 0}};
            }),
            "VISCOSITY_TABLE_OUT_OF_RANGE");
}

TEST(Characterisation, AnswersInFiniteNumbersOrRefuses) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(0, 1);
  const auto lg = [&](double lower, double upper) {
    return std::pow(10, lower + (upper - lower) * unit(random));
  };
  const auto maybe = [&](double share) { return unit(random) < share; };
  int answered = 0;
  for (int trial = 0; trial < 5000; ++trial) {
    FluidMeasurements fluid;
    fluid.base_oil = static_cast<BaseOilClass>(static_cast<int>(8 * unit(random)));
    if (maybe(0.8)) fluid.kinematic_viscosity_40 = lg(-6, -2);
    if (maybe(0.8)) {
      fluid.kinematic_viscosity_100 =
          fluid.kinematic_viscosity_40.value_or(1e-4) * lg(-1.4, maybe(0.1) ? 1 : -0.2);
    }
    if (maybe(0.3)) fluid.sheared_kinematic_viscosity_100 = lg(-6, -4);
    if (maybe(0.7)) fluid.density_15 = 700 + 500 * unit(random);
    for (int i = maybe(0.3) ? 3 : 0; i > 0; --i) {
      fluid.densities.push_back({220 + 200 * unit(random), 800 + 100 * unit(random)});
    }
    for (int i = maybe(0.3) ? 4 : 0; i > 0; --i) {
      fluid.viscosities.push_back({220 + 250 * unit(random), lg(-3, 2), 0.5 * unit(random)});
    }
    if (maybe(0.3)) fluid.cold_viscosities.push_back({205 + 60 * unit(random), lg(-1, 4), 0});
    if (maybe(0.1)) fluid.stated.thermal_conductivity = measured(unit(random) - 0.1);
    if (maybe(0.1)) fluid.stated.pressure_viscosity_coefficient = measured(lg(-9, -7));
    try {
      const CharacterisedFluid result = characterise(fluid);
      ++answered;
      for_each(result, [](const KnownParameter& known, double value) {
        EXPECT_TRUE(std::isfinite(value));
        EXPECT_EQ(known.value, value);
        const double uncertainty = known.standard_uncertainty.value_or(0);
        EXPECT_TRUE(uncertainty >= 0 && std::isfinite(uncertainty));
        EXPECT_FALSE(known.source.empty());
      });
      EXPECT_TRUE(std::isfinite(result.kinematic_viscosity_40));
      EXPECT_TRUE(std::isfinite(result.kinematic_viscosity_100));
      EXPECT_TRUE(std::isfinite(result.temperature_of_150_pascal_seconds));
      EXPECT_TRUE(std::isfinite(result.viscosity_index.value_or(0)));
      // whatever nobody measured is confessed
      for (const auto& [known, parameter] :
           {std::pair{&result.parameters.pressure_viscosity_coefficient,
                      "pressure_viscosity_coefficient"},
            {&result.parameters.thermal_conductivity, "thermal_conductivity"},
            {&result.parameters.limiting_shear_stress_coefficient,
             "limiting_shear_stress_coefficient"}}) {
        EXPECT_EQ(known->provenance == Provenance::kAssumed,
                  warns(result, "PARAMETER_ESTIMATED", parameter));
      }
    } catch (const Refusal& refusal) {
      EXPECT_FALSE(refusal.reason().empty());
    }
  }
  EXPECT_GT(answered, 1500);
}

}  // namespace
}  // namespace tribodyn
