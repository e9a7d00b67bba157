// What the paper states and the corrected model must show (figures 6 to 16), as numbers. Where a
// figure's claim does not follow from the model, the test says what comes out instead.
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "core/contact/flank_contact.h"
#include "core/study/speed_sweep.h"
#include "tests/support/reference_scene.h"

namespace tribodyn {
namespace {

using Curve = std::map<int, PointResult>;  // by km/h

Curve sweep(const Scene& scene, const std::vector<int>& kilometres_per_hour,
            SweepDirection direction = SweepDirection::kUp) {
  std::vector<double> speeds;
  for (const int v : kilometres_per_hour) speeds.push_back(v / 3.6);
  SweepOptions options;
  options.direction = direction;
  Curve out;
  for (const SweepPoint& p : sweep_speed(scene, speeds, 0, options)) {
    EXPECT_TRUE(p.result.has_value()) << p.refusal_sentence;
    if (p.result) out[static_cast<int>(std::lround(p.vehicle_speed * 3.6))] = *p.result;
  }
  return out;
}

/// Up-sweep of a fluid at 40 C on gear set A.
Curve curve_of(int fluid) {
  return sweep(reference_scene(fluid), {20, 35, 50, 60, 90, 100, 120, 140});
}

PointResult point(const Scene& scene, double kilometres_per_hour) {
  OperatingCondition condition;
  condition.vehicle_speed = kilometres_per_hour / 3.6;
  return solve_operating_point(scene, condition, {});
}

double energy_mean(const PointResult& r) { return r.inefficiency_energy_mean.value(); }

/// Equal to the digits printed in the reference figures.
void expect_printed(double value, double printed, double digit) {
  EXPECT_NEAR(value, printed, 0.5001 * digit);
}

TEST(Figure6And7, ContactIsLostNearTheFirstResonanceUpTo80KilometresPerHour) {
  const Curve up = sweep(reference_scene(), {67, 68, 69, 70, 71, 72, 73, 76, 79, 80, 81, 82});
  const Curve down = sweep(reference_scene(), {64, 65, 66, 67, 68, 70, 73, 76, 79, 80, 81, 82},
                           SweepDirection::kDown);
  const auto band = [](const Curve& curve) {
    int first = 0, last = 0;
    for (const auto& [speed, r] : curve) {
      if (!r.contact_loss) continue;
      if (first == 0) first = speed;
      last = speed;
    }
    return std::pair(first, last);
  };
  const auto [up_first, up_last] = band(up);
  const auto [down_first, down_last] = band(down);
  // Frictionless reference: 65-80 km/h at 29-36 N m on the way down, 71-80 on the way up. Friction
  // moves the lower end to 66 km/h and adds its 1 % to the torque: 30.3 to 36.8 N m.
  EXPECT_EQ(down_first, 66);
  EXPECT_EQ(down_last, 80);
  EXPECT_GE(up_first, 70);
  EXPECT_LE(up_first, 72);
  EXPECT_EQ(up_last, down_last);
  EXPECT_NEAR(down.at(down_first).pinion_torque, 30.3, 0.1);
  EXPECT_NEAR(down.at(down_last).pinion_torque, 36.8, 0.1);
  for (const auto& [speed, r] : down) {
    if (r.contact_loss) {
      EXPECT_EQ(r.pinion_friction_torque.maximum, 0) << speed << ": friction vanishes in the gap";
      EXPECT_FALSE(r.coast_side_contact) << speed << ": impacts are single-sided";
      EXPECT_GT(r.dynamic_transmission_error.minimum, 50e-6);
    } else if (speed > 81) {
      EXPECT_LT(r.pinion_friction_torque.maximum, -0.01) << speed;
    }
  }
}

// To half a kilometre per hour: 71.5 to 80.5 on the way up, 65.5 to 80.5 at 30.1 to 37.0 N m on the
// way down.
TEST(Figure6And7, EdgesOfContactLossToHalfAKilometrePerHour) {
  const auto lost = [](std::vector<double> kilometres_per_hour, SweepDirection direction) {
    for (double& speed : kilometres_per_hour) speed /= 3.6;
    SweepOptions options;
    options.direction = direction;
    std::map<double, double> torque_where_lost;
    for (const SweepPoint& at : sweep_speed(reference_scene(), kilometres_per_hour, 0, options)) {
      if (!at.result->contact_loss) continue;
      torque_where_lost[std::round(36 * at.vehicle_speed) / 10] = at.result->pinion_torque;
    }
    return torque_where_lost;
  };
  const auto up = lost({70, 70.5, 71, 71.5, 72, 76, 80, 80.5, 81}, SweepDirection::kUp);
  EXPECT_EQ(up.begin()->first, 71.5);
  EXPECT_EQ(up.rbegin()->first, 80.5);
  const auto down =
      lost({64.5, 65, 65.5, 66, 66.5, 67, 68, 70, 73, 76, 80, 80.5, 81}, SweepDirection::kDown);
  EXPECT_EQ(down.begin()->first, 65.5);
  EXPECT_EQ(down.rbegin()->first, 80.5);
  EXPECT_NEAR(down.begin()->second, 30.1, 0.05);
  EXPECT_NEAR(down.rbegin()->second, 37.0, 0.05);
}

// "None above 80 km/h" does not follow: near twice the frequency of the mesh mode impacts repeat
// every second mesh cycle. On the way down they last beyond the speeds at which they begin on the
// way up.
TEST(Figure6And7, ContactIsLostAgainAbove115KilometresPerHourEverySecondMeshCycle) {
  const std::vector<int> speeds{110, 115, 120, 125, 130, 135, 140, 145, 150, 155, 160};
  const Curve up = sweep(reference_scene(), speeds);
  const Curve down = sweep(reference_scene(), speeds, SweepDirection::kDown);
  for (const int speed : speeds) {
    EXPECT_EQ(up.at(speed).contact_loss, speed >= 150 && speed <= 155) << speed;
    EXPECT_EQ(down.at(speed).contact_loss, speed >= 120 && speed <= 155) << speed;
    for (const Curve* curve : {&up, &down}) {
      const PointResult& r = curve->at(speed);
      EXPECT_EQ(r.period_in_mesh_cycles, r.contact_loss ? 2 : 1) << speed;
      EXPECT_FALSE(r.coast_side_contact) << speed;
    }
  }
}

TEST(Figure8, BoundaryShareFallsWithSpeedAndFluid2IsClearlyLowest) {
  const Curve curves[3] = {curve_of(1), curve_of(2), curve_of(3)};
  for (const Curve& c : curves) {
    EXPECT_GT(c.at(20).boundary_to_viscous_friction_ratio,
              1.5 * c.at(60).boundary_to_viscous_friction_ratio);
    EXPECT_GT(c.at(60).boundary_to_viscous_friction_ratio,
              1.5 * c.at(140).boundary_to_viscous_friction_ratio);
  }
  for (const auto& [speed, r] : curves[1]) {
    EXPECT_LT(r.boundary_to_viscous_friction_ratio,
              0.8 * curves[0].at(speed).boundary_to_viscous_friction_ratio)
        << speed;
    EXPECT_LT(r.boundary_to_viscous_friction_ratio,
              0.8 * curves[2].at(speed).boundary_to_viscous_friction_ratio)
        << speed;
  }
}

TEST(Figure9, FilmGrowsAsThe068PowerOfSpeedAndFluid2IsThickest) {
  // The interferometer: 19.05 mm steel ball on glass (E 75 GPa, nu 0.22), 20 N, pure rolling, 40 C.
  const Solid steel{206e9, 0.3, 46, 7850, 470}, glass{75e9, 0.22, 1.1, 2500, 840};
  std::map<int, double> film;
  for (int fluid = 1; fluid <= 3; ++fluid) {
    const FlankContactModel model(reference_lubricant(fluid), {steel, glass}, {2.5e9, 4e-8, 1e-9},
                                  {0, 0}, 313.15, 0, {});
    const auto at = [&](double u) {
      return model.solve({20, 0.009525, 0.009525, u, 0, u, 0}).central_film_thickness;
    };
    EXPECT_NEAR(std::log(at(2.0) / at(0.2)) / std::log(10.0), 0.68, 1e-9);
    film[fluid] = at(1.0);
  }
  EXPECT_GT(film[2], 1.1 * film[1]);
  EXPECT_GT(film[2], 1.1 * film[3]);
}

TEST(Figure10, ThermalInefficiencyFallsIsothermalRisesAndLiesAbove) {
  const Curve c = curve_of(1);
  expect_printed(energy_mean(c.at(20)), 1.320, 1e-3);
  expect_printed(energy_mean(c.at(50)), 1.270, 1e-3);
  expect_printed(energy_mean(c.at(100)), 1.195, 1e-3);
  expect_printed(energy_mean(c.at(140)), 1.056, 1e-3);
  Scene scene = reference_scene();
  scene.options.isothermal = true;
  expect_printed(energy_mean(point(scene, 20)), 1.500, 1e-3);
  expect_printed(energy_mean(point(scene, 100)), 1.831, 1e-3);
  // The claimed order of magnitude between them does not follow: the limiting stress caps it.
  EXPECT_LT(energy_mean(point(scene, 140)), 2.2);
  EXPECT_GT(energy_mean(c.at(90)), energy_mean(c.at(100)));
  EXPECT_GT(energy_mean(c.at(100)), energy_mean(c.at(120)));
  EXPECT_GT(energy_mean(c.at(120)), energy_mean(c.at(140)));
}

TEST(Figure11, TemperatureRiseGrowsWithSpeedAndFallsWithSumpTemperature) {
  const auto rise = [](const PointResult& r, double sump) {
    return r.contact_temperature.maximum - (sump + 273.15 + 20);
  };
  const Curve c = curve_of(1);
  expect_printed(rise(c.at(20), 40), 7, 1);
  expect_printed(rise(c.at(100), 40), 40, 1);
  expect_printed(rise(c.at(140), 40), 61, 1);
  expect_printed(rise(point(reference_scene(1, 90), 20), 90), 4, 1);
  expect_printed(rise(point(reference_scene(1, 90), 100), 90), 22, 1);
}

TEST(Figure12, InefficiencyAgainstSumpTemperature) {
  expect_printed(energy_mean(point(reference_scene(1, 10), 20)), 1.587, 1e-3);
  expect_printed(energy_mean(point(reference_scene(1, 90), 20)), 1.147, 1e-3);
  // At 100 km/h the paper's fall with sump temperature does not follow from 10 to 40 C: no inlet
  // heating or starvation in the model.
  expect_printed(energy_mean(point(reference_scene(1, 10), 100)), 0.978, 1e-3);
  expect_printed(energy_mean(point(reference_scene(1, 90), 100)), 1.081, 1e-3);
}

TEST(Figure13, Fluid1CloseToFluid3AndFluid2ClearlyHigher) {
  const Curve first = curve_of(1), second = curve_of(2), third_curve = curve_of(3);
  expect_printed(energy_mean(third_curve.at(20)), 1.352, 1e-3);
  expect_printed(energy_mean(second.at(20)), 1.722, 1e-3);
  expect_printed(energy_mean(third_curve.at(100)), 1.220, 1e-3);
  expect_printed(energy_mean(second.at(100)), 1.374, 1e-3);
  for (const auto& [speed, r] : first) {
    const double own = energy_mean(r), third = energy_mean(third_curve.at(speed));
    EXPECT_GT(third, own) << speed;
    EXPECT_LT(third, 1.04 * own) << speed;
    EXPECT_GT(energy_mean(second.at(speed)), 1.07 * third) << speed;
  }
}

TEST(Figure14, OnTheTractionMachineFluid2IsHigherOnlyWhileTheStressIsNotLimited) {
  const Solid steel{210e9, 0.3, 46, 7850, 470};
  const auto traction = [&](int fluid, double slide_roll_ratio) {
    const FlankContactModel model(reference_lubricant(fluid), steel, {2.5e9, 4e-7, 1e-8}, {0, 0},
                                  313.15, 0, {});
    const double u = 2.5, half = 0.5 * slide_roll_ratio;
    const ContactSolution s =
        model.solve({35.2, 0.009525, 0.009525, u * (1 + half), 0, u * (1 - half), 0});
    EXPECT_NEAR(s.maximum_pressure, 1e9, 0.07e9);
    return s.friction_coefficient;
  };
  EXPECT_GT(traction(2, 0.01), 1.15 * traction(1, 0.01));
  // One limiting stress for all fluids: above 10 % most of the contact sits on it, and the
  // measured difference is not reproduced.
  EXPECT_NEAR(traction(2, 0.3) / traction(1, 0.3), 1, 0.1);
}

TEST(Figure5, HeatingBendsTheTractionCurveDown) {
  // Fluid 1 stands in for Shell T9, whose viscosity is not published; 25.4 mm ball, 154 N, 2 m/s.
  const Solid steel{206e9, 0.3, 46, 7850, 470};
  ModelOptions cold;
  cold.isothermal = true;
  const auto traction = [&](const ModelOptions& options, double slide_roll_ratio) {
    const FlankContactModel model(reference_lubricant(1), steel, {2.5e9, 4e-7, 1e-8}, {0, 0},
                                  313.15, 0, options);
    const double half = 0.5 * slide_roll_ratio;
    return model.solve({154, 0.0127, 0.0127, 2 * (1 + half), 0, 2 * (1 - half), 0})
        .friction_coefficient;
  };
  // With heat the curve has its top near 30 % and falls beyond; without, it never falls.
  EXPECT_GT(traction({}, 0.3), traction({}, 0.1));
  EXPECT_GT(traction({}, 0.3), 1.01 * traction({}, 1.0));
  EXPECT_GT(traction(cold, 0.3), traction(cold, 0.1));
  EXPECT_GT(traction(cold, 1.0), traction(cold, 0.3));
  EXPECT_LT(traction({}, 1.0), 0.96 * traction(cold, 1.0));
}

// The paper's fall does not start at 20 km/h: the excess first rises to 9.8 % at 25 to 30.
TEST(Figures15And16, NeglectingShearThinningCostsLessFrom30KilometresPerHourUp) {
  Scene scene = reference_scene();
  scene.options.newtonian = true;
  const Curve thinning = curve_of(1);
  const auto excess = [&](int speed) {
    return 100 * (point(scene, speed).inefficiency_rms.value() /
                      thinning.at(speed).inefficiency_rms.value() -
                  1);
  };
  const double at_20 = excess(20), at_50 = excess(50), at_100 = excess(100), at_140 = excess(140);
  EXPECT_NEAR(at_20, 9.5, 0.15);
  const double at_25 = 100 * (point(scene, 25).inefficiency_rms.value() /
                                  point(reference_scene(), 25).inefficiency_rms.value() -
                              1);
  EXPECT_GT(at_25, at_20);
  EXPECT_NEAR(at_25, 9.78, 0.02);
  EXPECT_GT(at_25, at_50);
  EXPECT_GT(at_50, at_100);
  EXPECT_GT(at_100, at_140);
  EXPECT_NEAR(at_140, 4, 0.5);
}

}  // namespace
}  // namespace tribodyn
