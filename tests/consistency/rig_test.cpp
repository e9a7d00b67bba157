// Rigs: the paper's figures 5 and 9, closed forms, and an independent implementation.
#include "core/rig/rig.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "core/refusal.h"
#include "tests/support/reference_scene.h"
#include "tests/yardstick/yardstick_friction.h"

namespace tribodyn {
namespace {

const Solid kRigSteel{210e9, 0.3, 46, 7850, 470};
const Solid kRigGlass{75e9, 0.22, 1.1, 2500, 840};
constexpr double kSmooth = 0;  // asperities per area

/// Shell T9, from what tests/data/published_checks.json says of it: the viscosity is the improved
/// Yasutomi law at ambient pressure, which has Vogel's form; density and conductivity are those at
/// ambient pressure near 25 C. F = 1: no law of its shear thinning is at hand.
Lubricant shell_t9() {
  const double c_1 = 16.09, c_2 = 17.38, glass = 273.15 - 83.2;
  return {1e12 * std::pow(10, -c_1),
          std::log(10.0) * c_1 * c_2,
          glass - c_2,
          20.3e-9,
          313.15,
          0,
          1,
          0,
          298,
          0,
          0.083,
          0.111,
          872 * (1 + 0.0007734 * 298),
          -872 * 0.0007734};
}

/// A 25.4 mm ball of steel on steel.
RigScene traction_machine(const Lubricant& oil) {
  RigScene scene{oil, kRigSteel, {0.0127, 0.0127}, {kSmooth, 0, 0}, {0, 0}, {}};
  scene.options.hertz_solution = HertzSolution::kExact;
  return scene;
}

double rig_traction(const RigScene& scene, double celsius, const RigCondition& condition) {
  return Rig(scene, celsius + 273.15).at(condition).traction_coefficient;
}

TEST(Rig, ThermalTractionOfT9LiesBelowIsothermalAndFallsBeyondItsTop) {
  RigScene hot = traction_machine(shell_t9()), cold = hot;
  cold.options.isothermal = true;
  for (const double load : {38.0, 154.0}) {
    SCOPED_TRACE(std::to_string(load) + " N");
    std::vector<double> thermal, isothermal;
    for (int percent = 1; percent <= 60; ++percent) {
      const RigCondition condition{load, 2, 0.01 * percent};
      thermal.push_back(rig_traction(hot, 25, condition));
      isothermal.push_back(rig_traction(cold, 25, condition));
      EXPECT_LT(thermal.back(), isothermal.back());
    }
    EXPECT_TRUE(std::is_sorted(isothermal.begin(), isothermal.end()));
    const auto top = std::max_element(thermal.begin(), thermal.end());
    EXPECT_TRUE(std::is_sorted(thermal.begin(), top));
    EXPECT_TRUE(std::is_sorted(top, thermal.end(), std::greater<>()));
    const auto at_percent = top - thermal.begin() + 1;
    EXPECT_GT(at_percent, load > 100 ? 5 : 15);
    EXPECT_LT(at_percent, load > 100 ? 20 : 35);
    EXPECT_LT(thermal.back(), 0.995 * *top);
  }
  EXPECT_NEAR(rig_traction(hot, 25, {154, 2, 0.1}), 0.0814, 1e-4);
  EXPECT_NEAR(rig_traction(hot, 25, {154, 2, 0.5}), 0.0802, 1e-4);
  EXPECT_NEAR(rig_traction(cold, 25, {154, 2, 0.1}), 0.0820, 1e-4);
  EXPECT_NEAR(rig_traction(cold, 25, {154, 2, 0.5}), 0.0826, 1e-4);
}

TEST(Rig, IsothermalTractionOfT9TendsToItsLimitingCoefficient) {
  RigScene scene = traction_machine(shell_t9());
  scene.options.isothermal = true;
  for (const double load : {38.0, 154.0}) {
    const double plateau = rig_traction(scene, 25, {load, 2, 2});
    EXPECT_LT(plateau, 0.083);
    EXPECT_GT(plateau, 0.99 * 0.083);
  }
}

TEST(Rig, TractionOfALimitedFilmIsTheLimitOverTheMeanPressure) {
  Lubricant oil = shell_t9();
  oil.limiting_shear_stress_at_zero_pressure = 4e6;
  oil.limiting_shear_stress_coefficient = 0.029;
  oil.vogel_viscosity_prefactor *= 1e4;  // so that even the edge sits on the limit
  RigScene scene = traction_machine(oil);
  scene.options.isothermal = true;
  const std::vector<std::pair<double, double>> expected{{38, 0.03609}, {154, 0.03344}};
  for (const auto& [load, coefficient] : expected) {
    const RigPoint point = Rig(scene, 298.15).at({load, 2, 2});
    ASSERT_EQ(point.limiting_stress_area_share, 1);
    EXPECT_NEAR(point.traction_coefficient, coefficient, 5e-6);
    EXPECT_NEAR(point.traction_coefficient / (0.029 + 4e6 / point.mean_pressure), 1, 1e-12);
    EXPECT_EQ(Rig(scene, 298.15).at({load, 2, -2}).traction_coefficient,
              -point.traction_coefficient);
  }
}

/// The interferometer of figure 9: a 19.05 mm ball of steel on glass, 20 N.
RigScene film_machine(const Lubricant& oil) {
  RigScene scene{oil, {kRigSteel, kRigGlass}, {0.009525, 0.009525}, {kSmooth, 0, 0}, {0, 0}, {}};
  scene.options.hertz_solution = HertzSolution::kExact;
  return scene;
}

TEST(Rig, FilmGrowsAsThe068PowerOfSpeedUnlessShearHeatsTheInlet) {
  RigScene scene = film_machine(reference_lubricant(1));
  const double celsius = 40;  // 70 mPa s
  EXPECT_NEAR(std::exp(FlankContactModel(scene.lubricant, scene.solids, {0, 1e-6, 1e-9}, {},
                                         celsius + 273.15, 0, scene.options)
                           .constants()
                           .log_inlet_viscosity),
              0.070, 0.002);
  const auto film = [&](double speed) {
    return Rig(scene, celsius + 273.15).at({20, speed, 0}).central_film_thickness;
  };
  const double slow = film(0.03), fast = film(3);
  EXPECT_NEAR(std::log(fast / slow) / std::log(100.0), 0.68, 1e-12);
  scene.options.inlet_shear_heating = true;
  EXPECT_NEAR(film(0.03) / slow, 1, 0.002);
  const double deficit = 1 - film(3) / fast;
  EXPECT_GT(deficit, 0.05);
  EXPECT_LT(deficit, 0.20);
  EXPECT_LT(film(3) / film(1), std::pow(3, 0.68));
}

yardstick::Solid rig_yardstick_of(const Solid& solid) {
  return {solid.youngs_modulus, solid.poissons_ratio, solid.thermal_conductivity, solid.density,
          solid.specific_heat_capacity};
}

TEST(Rig, AgreesWithTheYardstick) {
  const Lubricant oil = reference_lubricant(2);
  int compared = 0;
  for (const SolidPair& solids :
       {SolidPair(kRigSteel), SolidPair(kRigSteel, kRigGlass), SolidPair(kRigGlass, kRigSteel)}) {
    for (const bool heats_inlet : {false, true}) {
      for (const double roughness : {0.02e-6, 0.2e-6}) {
        RigScene scene{
            oil,        solids, {0.0127, 0.05}, {0.04 / (roughness * 20e-6), 20e-6, roughness},
            {2e6, 0.1}, {}};
        scene.options.hertz_solution = HertzSolution::kExact;
        scene.options.inlet_shear_heating = heats_inlet;
        const Rig rig(scene, 333.15);
        yardstick::FrictionOptions options;
        options.elliptic_integral_hertz = true;
        options.inlet_shear_heating = heats_inlet;
        options.quadrature_nodes = 64;
        const yardstick::ContactFriction theirs(
            {oil.vogel_viscosity_prefactor, oil.vogel_temperature_coefficient,
             oil.vogel_reference_temperature, oil.pressure_viscosity_coefficient,
             oil.pressure_viscosity_temperature, oil.relaxation_time, oil.havriliak_negami_alpha,
             oil.havriliak_negami_beta, oil.rheology_reference_temperature,
             oil.limiting_shear_stress_at_zero_pressure, oil.limiting_shear_stress_coefficient,
             oil.density_temperature_slope, oil.density_at_zero_kelvin, oil.thermal_conductivity},
            rig_yardstick_of(solids.body_1), rig_yardstick_of(solids.body_2),
            {scene.roughness.asperity_density, scene.roughness.asperity_radius, roughness, 2e6,
             0.1},
            333.15, 0, options);
        for (const double load : {5.0, 80.0}) {
          for (const double slide : {-1.5, -0.05, 0.001, 0.3}) {
            const double speed = 1.2;
            const RigPoint p = rig.at({load, speed, slide});
            const yardstick::ContactResult y = theirs.evaluate(
                {load, 0.0127, 0.05, speed * (1 + slide / 2), 0, speed * (1 - slide / 2), 0});
            const double creep = std::abs(slide) / (std::abs(slide) + 1e-4);
            const double friction = y.viscous_friction + creep * y.boundary_friction;
            EXPECT_NEAR(p.traction_coefficient * load / std::copysign(friction, slide), 1, 1e-9);
            EXPECT_NEAR(p.boundary_friction_share * friction / (creep * y.boundary_friction), 1,
                        1e-8);
            EXPECT_NEAR(p.central_film_thickness / y.central_film_thickness, 1, 1e-9);
            EXPECT_NEAR(p.maximum_pressure / y.maximum_pressure, 1, 1e-9);
            EXPECT_NEAR(p.contact_temperature / y.temperature, 1, 1e-9);
            EXPECT_NEAR(p.flash_temperature_rise / y.flash_temperature_rise, 1, 1e-8);
            ++compared;
          }
        }
      }
    }
  }
  EXPECT_EQ(compared, 96);
}

TEST(Rig, TractionPassesThroughZeroAtZeroSliding) {
  RigScene scene = traction_machine(reference_lubricant(1));
  scene.roughness = {2.5e9, 40e-6, 0.4e-6};
  scene.boundary = {2e6, 0.17};
  const Rig rig(scene, 313.15);
  EXPECT_EQ(rig.at({38, 0.05, 0}).traction_coefficient, 0);
  double before = 0;
  for (const double slide : {1e-9, 1e-6, 1e-4, 1e-2}) {
    const double traction = rig.at({38, 0.05, slide}).traction_coefficient;
    EXPECT_GT(traction, before);
    // Eq 39 heats the film by the surface of body 1, which alone tells the two directions apart.
    EXPECT_NEAR(rig.at({38, 0.05, -slide}).traction_coefficient / -traction, 1, 1e-6);
    before = traction;
  }
  EXPECT_LT(rig.at({38, 0.05, 1e-9}).traction_coefficient, 3e-6);
}

TEST(Rig, MinimumFilmOfACircularContactIsItsShareOfTheCentral) {
  const RigPoint point = Rig(film_machine(reference_lubricant(1)), 313.15).at({20, 1, 0});
  EXPECT_NEAR(point.minimum_film_thickness / point.central_film_thickness,
              3.68 * (1 - std::exp(-0.67)) / (4.31 * (1 - std::exp(-1.23))), 1e-12);
}

TEST(Rig, ReportsNoFilmRatioForSmoothSpecimens) {
  const RigPoint point = Rig(film_machine(reference_lubricant(1)), 313.15).at({20, 1, 0.1});
  EXPECT_TRUE(std::isnan(point.film_ratio));
  EXPECT_EQ(point.boundary_friction_share, 0);
}

TEST(Rig, RefusesWhatHasNoAnswer) {
  const auto reason = [](double celsius, const RigCondition& condition) -> std::string {
    try {
      Rig(traction_machine(reference_lubricant(1)), celsius + 273.15).at(condition);
    } catch (const Refusal& refusal) {
      return refusal.reason();
    }
    return "";
  };
  EXPECT_EQ(reason(-150, {38, 2, 0.1}), "BELOW_VOGEL_TEMPERATURE");
  EXPECT_EQ(reason(40, {0, 2, 0.1}), "NO_LOAD");
  EXPECT_EQ(reason(40, {38, std::nan(""), 0.1}), "NOT_FINITE");
  EXPECT_EQ(reason(40, {38, 2, 0.1}), "");
}

}  // namespace
}  // namespace tribodyn
