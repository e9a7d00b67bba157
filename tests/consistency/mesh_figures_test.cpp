// Figures of the mesh that formulators speak of: friction coefficient, specific sliding, flash
// temperature, and the limits beside them.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "core/contact/specific_sliding.h"
#include "core/study/figure_limits.h"
#include "core/study/operating_point.h"
#include "tests/consistency/contact_case.h"
#include "tests/support/reference_scene.h"

namespace tribodyn {
namespace {

SpecificSliding of_rollers(double first, double second, double across_second = 0) {
  return specific_sliding({.load = 1,
                           .radius_x = 1,
                           .radius_y = 1,
                           .velocity_1_x = first,
                           .velocity_1_y = 0,
                           .velocity_2_x = second,
                           .velocity_2_y = across_second});
}

TEST(SpecificSliding, OfTwoRollersIsTheDifferenceOfTheirSpeedsOverEach) {
  const SpecificSliding slow_second = of_rollers(3, 1);
  EXPECT_DOUBLE_EQ(slow_second.surface_1, 2.0 / 3);
  EXPECT_DOUBLE_EQ(slow_second.surface_2, 2);
  const SpecificSliding opposed = of_rollers(2, -2);
  EXPECT_DOUBLE_EQ(opposed.surface_1, 2);
  EXPECT_DOUBLE_EQ(opposed.surface_2, 2);
  const SpecificSliding crossed = of_rollers(4, 0, 3);
  EXPECT_DOUBLE_EQ(crossed.surface_1, 5.0 / 4);
  EXPECT_DOUBLE_EQ(crossed.surface_2, 5.0 / 3);
}

TEST(SpecificSliding, IsZeroInPureRollingAndInfiniteForASurfaceAtRest) {
  EXPECT_EQ(of_rollers(2, 2).surface_1, 0);
  EXPECT_EQ(of_rollers(0, 0).surface_2, 0);
  EXPECT_EQ(of_rollers(0, 1).surface_1, std::numeric_limits<double>::infinity());
  EXPECT_EQ(of_rollers(0, 1).surface_2, 1);
}

TEST(ContactFigures, ThatFollowFromOthersAreThoseOfTheScalarKernel) {
  Draw draw(5);
  for (int n = 0; n < 200; ++n) {
    SCOPED_TRACE(n);
    ContactCase c = random_contact_case(draw);
    c.options.isothermal = n % 5 == 0;
    const FlankContactModel model = c.model();
    const ContactSolution s = model.solve(c.conditions);
    if (s.status != ContactStatus::kOk) continue;
    ContactFigures figures = s;
    figures.friction_coefficient = figures.flash_temperature_rise = -1;
    figures.specific_sliding_1 = figures.specific_sliding_2 = -1;
    model.complete(c.conditions, figures);
    EXPECT_EQ(figures.friction_coefficient, s.friction_coefficient);
    EXPECT_EQ(figures.specific_sliding_1, s.specific_sliding_1);
    EXPECT_EQ(figures.specific_sliding_2, s.specific_sliding_2);
    // The root that the scalar kernel finds of eq 38 is that good.
    EXPECT_NEAR(figures.flash_temperature_rise, s.flash_temperature_rise,
                1e-7 * s.contact_temperature);
  }
}

/// A point with one period of all that the figures of the mesh are made of.
struct RecordedPoint {
  PointResult result;
  std::map<std::string, std::vector<double>> columns;

  RecordedPoint(double kilometres_per_hour, PointModel model, SteadyStateMethod method) {
    const Scene scene = reference_scene();
    OperatingCondition condition;
    condition.vehicle_speed = kilometres_per_hour / 3.6;
    PointOptions options;
    options.model = model;
    options.method = method;
    options.history.samples_per_mesh_cycle = 2000;
    options.history.columns = {HistoryColumn::kTime,
                               HistoryColumn::kFlankLoad,
                               HistoryColumn::kFlankFriction,
                               HistoryColumn::kFlankSlidingSpeed,
                               HistoryColumn::kFlankFrictionCoefficient,
                               HistoryColumn::kFlankFlashTemperatureRise,
                               HistoryColumn::kFlankPinionSpecificSliding,
                               HistoryColumn::kFlankGearSpecificSliding,
                               HistoryColumn::kFlankViscousFriction,
                               HistoryColumn::kFlankBoundaryFriction,
                               HistoryColumn::kFlankMaximumPressure,
                               HistoryColumn::kFlankEntrainmentSpeed,
                               HistoryColumn::kFlankMeanShearStress,
                               HistoryColumn::kFlankLimitingStressAreaShare,
                               HistoryColumn::kFlankAsperityLoad};
    result = solve_operating_point(scene, condition, options);
    EXPECT_EQ(result.period_in_mesh_cycles, 1);
    for (std::size_t c = 0; c < result.history.names.size(); ++c) {
      columns[result.history.names[c]] = result.history.values[c];
    }
  }

  const std::vector<double>& flank(const std::string& name, int slot) const {
    return columns.at(name + "_flank_" + std::to_string(slot));
  }

  /// Mean over time of a function of flank slot and sample.
  template <class Function>
  double mean(Function&& at) const {
    const std::vector<double>& time = columns.at("time_seconds");
    const std::size_t count = time.size();
    const double period = 1 / result.mesh_frequency;
    double sum = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const double before = i == 0 ? time[count - 1] - period : time[i - 1];
      const double after = i + 1 == count ? time[0] + period : time[i + 1];
      sum += 0.5 * (after - before) * at(i);
    }
    return sum / period;
  }

  template <class Function>
  double mean_of_flanks(Function&& at) const {
    return mean([&](std::size_t i) {
      double sum = 0;
      for (int k = 0; k < kFlankPairs; ++k) sum += at(k, i);
      return sum;
    });
  }

  /// Mean over time and flanks of a column, weighted with the load.
  double weighted(const std::string& name) const {
    const auto load = [&](int k, std::size_t i) { return flank("flank_load_newtons", k)[i]; };
    return mean_of_flanks([&](int k, std::size_t i) { return load(k, i) * flank(name, k)[i]; }) /
           mean_of_flanks(load);
  }
};

void expect_mesh_figures(const RecordedPoint& point, double tolerance) {
  const PointResult& r = point.result;
  // P = mean of sum mu W V_s.
  const double power = point.mean_of_flanks([&](int k, std::size_t i) {
    return point.flank("flank_friction_coefficient", k)[i] *
           point.flank("flank_load_newtons", k)[i] *
           point.flank("flank_sliding_speed_metres_per_second", k)[i];
  });
  EXPECT_NEAR(power, r.mesh_loss_power, tolerance * r.mesh_loss_power);
  const double friction = point.mean_of_flanks(
      [&](int k, std::size_t i) { return point.flank("flank_friction_newtons", k)[i]; });
  const double load = point.mean_of_flanks(
      [&](int k, std::size_t i) { return point.flank("flank_load_newtons", k)[i]; });
  EXPECT_NEAR(r.friction_coefficient.mean, friction / load,
              tolerance * r.friction_coefficient.mean);
  for (int k = 0; k < kFlankPairs; ++k) {
    SCOPED_TRACE(k);
    const double of_slot = point.mean([&](std::size_t i) {
      return point.flank("flank_friction_newtons", k)[i];
    }) / point.mean([&](std::size_t i) { return point.flank("flank_load_newtons", k)[i]; });
    EXPECT_NEAR(r.flank_losses[static_cast<std::size_t>(k)].friction_coefficient, of_slot,
                5 * tolerance * of_slot);
  }
  const auto expect_extremes = [&](const char* name, const Extremes& extremes) {
    SCOPED_TRACE(name);
    EXPECT_NEAR(extremes.mean, point.weighted(name), tolerance * extremes.mean);
    EXPECT_LE(extremes.minimum, extremes.mean);
    EXPECT_GE(extremes.maximum, extremes.mean);
    EXPECT_GE(extremes.minimum, 0);
  };
  expect_extremes("flank_friction_coefficient", r.friction_coefficient);
  expect_extremes("flank_flash_temperature_rise_kelvin", r.flash_temperature_rise);
  expect_extremes("flank_pinion_specific_sliding", r.pinion_specific_sliding);
  expect_extremes("flank_gear_specific_sliding", r.gear_specific_sliding);
}

/// Loads, stresses and speeds of flanks make up their friction (eqs 19, 27, 40) and their sliding.
void expect_flank_identities(const RecordedPoint& point) {
  const BoundaryFriction boundary = reference_scene().boundary;
  int loaded = 0;
  for (int k = 0; k < kFlankPairs; ++k) {
    const std::vector<double>& loads = point.flank("flank_load_newtons", k);
    for (std::size_t i = 0; i < loads.size(); ++i) {
      const auto at = [&](const char* name) { return point.flank(name, k)[i]; };
      const double asperity_load = at("flank_asperity_load_newtons");
      const double share = at("flank_limiting_stress_area_share");
      if (loads[i] == 0) {
        EXPECT_EQ(asperity_load, 0);
        EXPECT_EQ(at("flank_entrainment_speed_metres_per_second"), 0);
        continue;
      }
      ++loaded;
      ASSERT_GT(asperity_load, 0);
      ASSERT_LT(asperity_load, loads[i]);
      ASSERT_GE(share, 0);
      ASSERT_LE(share, 1);
      const double contact_area =
          1.5 * (loads[i] - asperity_load) / at("flank_maximum_pressure_pascals");
      const double asperity_area = (at("flank_boundary_friction_newtons") -
                                    boundary.asperity_friction_coefficient * asperity_load) /
                                   boundary.tribofilm_shear_strength;
      const double viscous = at("flank_mean_shear_stress_pascals") * (contact_area - asperity_area);
      ASSERT_NEAR(viscous, at("flank_viscous_friction_newtons"), 1e-7 * viscous) << k << ' ' << i;
      // Both surfaces: u_1^2 + u_2^2 = 2 U^2 + V_s^2/2.
      const double sliding = at("flank_sliding_speed_metres_per_second");
      const double entrainment = at("flank_entrainment_speed_metres_per_second");
      const double pinion = sliding / at("flank_pinion_specific_sliding");
      const double gear = sliding / at("flank_gear_specific_sliding");
      const double expected = 2 * entrainment * entrainment + 0.5 * sliding * sliding;
      ASSERT_NEAR(pinion * pinion + gear * gear, expected, 1e-9 * expected) << k << ' ' << i;
    }
  }
  EXPECT_GT(loaded, 2000);
}

TEST(FlankHistories, OfShootingMakeUpFrictionAndSliding) {
  expect_flank_identities({72.5, PointModel::kFull, SteadyStateMethod::kShooting});
}

TEST(FlankHistories, OfAMarchMakeUpFrictionAndSliding) {
  expect_flank_identities({50, PointModel::kFull, SteadyStateMethod::kMarch});
}

TEST(FlankHistories, OfTheQuasiStaticModelMakeUpFrictionAndSliding) {
  expect_flank_identities({50, PointModel::kQuasiStatic, SteadyStateMethod::kAutomatic});
}

TEST(MeshFigures, OfASmoothPointAreThoseOfItsHistory) {
  expect_mesh_figures({50, PointModel::kFull, SteadyStateMethod::kShooting}, 2e-3);
}

TEST(MeshFigures, WhereFlanksPartAreThoseOfItsHistory) {
  const RecordedPoint point(72.5, PointModel::kFull, SteadyStateMethod::kShooting);
  EXPECT_TRUE(point.result.contact_loss);
  expect_mesh_figures(point, 5e-3);
}

TEST(MeshFigures, OfTheQuasiStaticModelAreThoseOfItsHistory) {
  expect_mesh_figures({50, PointModel::kQuasiStatic, SteadyStateMethod::kAutomatic}, 2e-3);
}

TEST(MeshFigures, OfAMarchAreThoseOfShooting) {
  const PointResult marched =
      RecordedPoint(50, PointModel::kFull, SteadyStateMethod::kMarch).result;
  const PointResult shot =
      RecordedPoint(50, PointModel::kFull, SteadyStateMethod::kShooting).result;
  for (const auto member :
       {&PointResult::friction_coefficient, &PointResult::flash_temperature_rise,
        &PointResult::pinion_specific_sliding, &PointResult::gear_specific_sliding}) {
    const Extremes &a = marched.*member, &b = shot.*member;
    // The least lies where a flank begins to count, at 1 % of the load: few steps resolve it.
    EXPECT_NEAR(a.minimum, b.minimum, 2e-2 * a.maximum);
    EXPECT_NEAR(a.mean, b.mean, 2e-3 * a.mean);
    EXPECT_NEAR(a.maximum, b.maximum, 5e-3 * a.maximum);
  }
}

/// Limits of one figure.
std::vector<FigureLimit> limits_of(LimitedFigure figure, const FluidGrounds& fluid,
                                   const StatedLimits& stated) {
  std::vector<FigureLimit> out;
  for (const FigureLimit& each : figure_limits(fluid, stated)) {
    if (each.figure == figure) out.push_back(each);
  }
  return out;
}

TEST(FigureLimits, AreThoseOfTheLawsAndOfTheTemperaturesAtWhichTheFluidWasMeasured) {
  FluidGrounds fluid;
  EXPECT_EQ(limits_of(LimitedFigure::kFilmRatioMinimum, fluid, {}).size(), 2U);
  const auto pressure = limits_of(LimitedFigure::kPressureMaximum, fluid, {});
  ASSERT_EQ(pressure.size(), 1U);
  EXPECT_EQ(pressure[0].minimum, 0.85e9);
  EXPECT_EQ(pressure[0].maximum, 1.35e9);
  EXPECT_TRUE(limits_of(LimitedFigure::kContactTemperatureMaximum, fluid, {}).empty())
      << "nobody knows where the viscosity was measured";
  fluid.viscosity_measured = {313.15, 373.15};
  EXPECT_EQ(limits_of(LimitedFigure::kContactTemperatureMaximum, fluid, {}).at(0).maximum, 373.15);
  EXPECT_EQ(limits_of(LimitedFigure::kContactTemperatureMinimum, fluid, {}).at(0).minimum, 313.15);
}

TEST(FigureLimits, ThatAreStatedNameTheirSource) {
  EXPECT_TRUE(limits_of(LimitedFigure::kFlashTemperatureMaximum, {}, {}).empty())
      << "no law has a limit of it";
  StatedLimits stated;
  stated.flash_temperature_maximum = 120;
  stated.film_ratio_minimum = 0.7;
  EXPECT_EQ(limits_of(LimitedFigure::kFlashTemperatureMaximum, {}, stated).at(0).source, "stated");
  stated.source = "FZG A/8.3/90";
  const auto flash = limits_of(LimitedFigure::kFlashTemperatureMaximum, {}, stated);
  ASSERT_EQ(flash.size(), 1U);
  EXPECT_EQ(flash[0].maximum, 120);
  EXPECT_EQ(flash[0].source, "stated: FZG A/8.3/90");
  EXPECT_EQ(limits_of(LimitedFigure::kFilmRatioMinimum, {}, stated).size(), 3U);
}

}  // namespace
}  // namespace tribodyn
