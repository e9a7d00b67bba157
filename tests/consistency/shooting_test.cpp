// Periodic responses by shooting under frozen friction, held against the event-exact march, which
// shares the equations and the contacts with it but neither steps nor the way to the steady state.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "core/refusal.h"
#include "core/study/operating_point.h"
#include "core/study/screening.h"
#include "core/study/speed_sweep.h"
#include "tests/support/cruise.h"
#include "tests/support/figure_error.h"
#include "tests/support/random_place.h"
#include "tests/support/reference_scene.h"
#include "tests/support/refusal_reason.h"
#include "tests/support/run_length.h"

namespace tribodyn {
namespace {

PointOptions marched(PointStart start = PointStart::kQuasiStatic) {
  PointOptions options;
  options.method = SteadyStateMethod::kMarch;
  options.start = start;
  options.march_step_tolerance = 1e-10;
  options.march_settling_tolerance = 1e-9;
  return options;
}

struct ShootingPlace {
  double kilometres_per_hour;
  PointStart start;
};

class ShotResponse : public testing::TestWithParam<ShootingPlace> {};

TEST_P(ShotResponse, ErrsLessThanItSaysAndAskedAtEveryTolerance) {
  const ShootingPlace place = GetParam();
  if (kShortRun && place.kilometres_per_hour != 72.5 && place.kilometres_per_hour != 100) {
    GTEST_SKIP() << "a march takes ten seconds under ASan: two speeds are marched there";
  }
  const Scene scene = reference_scene();
  const PointResult exact =
      solve_operating_point(scene, cruise(place.kilometres_per_hour), marched(place.start));
  for (const double tolerance : {1e-2, 1e-3, 1e-4, 1e-5, 1e-6}) {
    if (kShortRun && tolerance != 1e-3 && tolerance != 1e-6) continue;
    PointOptions options;
    options.model = PointModel::kFull;
    options.start = place.start;
    options.tolerance = tolerance;
    const PointResult r = solve_operating_point(scene, cruise(place.kilometres_per_hour), options);
    SCOPED_TRACE(tolerance);
    ASSERT_EQ(r.method, SteadyStateMethod::kShooting);
    EXPECT_TRUE(r.settled);
    EXPECT_EQ(r.period_in_mesh_cycles, exact.period_in_mesh_cycles);
    EXPECT_LE(r.estimated_relative_error.value(), tolerance);
    EXPECT_LT(true_error(r, exact), tolerance);
    // The estimate speaks of errors that fall as the second power of the steps, or faster.
    EXPECT_LT(true_error(r, exact), 3 * r.estimated_relative_error.value());
    EXPECT_NEAR(r.statistics.largest_multiplier, exact.statistics.largest_multiplier, 3e-3);
    EXPECT_LT(10 * r.statistics.contact_solutions, exact.statistics.contact_solutions);
    if (tolerance > 1e-6) continue;
    EXPECT_EQ(r.contact_loss, exact.contact_loss);
    ASSERT_EQ(r.contact_losses.size(), exact.contact_losses.size());
    for (std::size_t i = 0; i < r.contact_losses.size(); ++i) {
      EXPECT_NEAR(r.contact_losses[i].start_mesh_phase, exact.contact_losses[i].start_mesh_phase,
                  1e-5);
      EXPECT_NEAR(r.contact_losses[i].duration / exact.contact_losses[i].duration, 1, 1e-4);
    }
    // All else that a report holds.
    const auto near = [](double a, double b, double error) {
      EXPECT_NEAR(a, b, error * std::abs(b));
    };
    near(r.viscous_loss_power, exact.viscous_loss_power, 1e-5);
    near(r.boundary_loss_power, exact.boundary_loss_power, 1e-5);
    near(r.boundary_to_viscous_friction_ratio, exact.boundary_to_viscous_friction_ratio, 1e-5);
    near(r.input_power, exact.input_power, 1e-6);
    near(r.mesh_frequency, exact.mesh_frequency, 1e-8);
    for (const auto member : {&PointResult::mesh_force, &PointResult::pinion_friction_torque,
                              &PointResult::central_film_thickness, &PointResult::film_ratio,
                              &PointResult::contact_temperature, &PointResult::maximum_pressure,
                              &PointResult::shear_rate}) {
      near((r.*member).mean, (exact.*member).mean, 1e-5);
      // Extremes of contacts are those of parabolas through the nodes, and of where a flank begins
      // to count: steep while the load comes back. The estimate does not speak of them.
      const double span = (exact.*member).maximum - (exact.*member).minimum;
      EXPECT_NEAR((r.*member).maximum, (exact.*member).maximum, 0.02 * span);
      EXPECT_NEAR((r.*member).minimum, (exact.*member).minimum, 0.02 * span);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Speeds, ShotResponse,
                         testing::Values(ShootingPlace{20, PointStart::kQuasiStatic},
                                         ShootingPlace{37.5, PointStart::kQuasiStatic},
                                         ShootingPlace{67.5, PointStart::kQuasiStatic},
                                         ShootingPlace{67.5, PointStart::kLargeVibration},
                                         ShootingPlace{72.5, PointStart::kQuasiStatic},
                                         ShootingPlace{80, PointStart::kQuasiStatic},
                                         ShootingPlace{100, PointStart::kQuasiStatic},
                                         ShootingPlace{140, PointStart::kQuasiStatic}),
                         [](const auto& place) {
                           std::string name = std::to_string(
                               static_cast<int>(10 * place.param.kilometres_per_hour));
                           return name + (place.param.start == PointStart::kLargeVibration ? "_down"
                                                                                           : "_up");
                         });

// The truth is the same response at 1e-8; in every sixth scene a march that starts on the response
// found: it must stay there. Which of two coexisting responses a start leads to is not asked here.
TEST(ShootingOverRandomScenes, EstimatesBoundTheErrorAndAreNotFarAbove) {
  if (kShortRun) GTEST_SKIP() << "minutes under sanitizers";
  const char* chosen = std::getenv("TRIBODYN_TEST_SEED");
  const unsigned long seed = chosen != nullptr ? std::stoul(chosen) : std::random_device{}();
  std::cout << "seed " << seed << '\n';
  RecordProperty("seed", std::to_string(seed));
  std::mt19937_64 random(seed);
  const int count = full_run() ? 500 : 40;
  int shot = 0, above = 0, screened_above = 0, unscreened = 0, untold = 0;
  std::vector<double> over, screened_over;
  for (int i = 0; i < count; ++i) {
    const double speed = std::uniform_real_distribution<double>(3, 220)(random);
    const RandomPlace place = random_place(random, speed);
    PointOptions options;
    options.model = PointModel::kFull;
    options.maximum_mesh_cycles = 400;
    if (i % 2 == 1) {
      options.tolerance = std::pow(10, -std::uniform_real_distribution<double>(2, 6)(random));
    }
    try {
      const PointResult r = solve_operating_point(place.scene, place.condition, options);
      if (r.method != SteadyStateMethod::kShooting) continue;
      ++shot;
      const bool by_march = full_run() || i % 6 == 0;
      PointOptions from_there;
      if (by_march) from_there = marched();
      if (full_run()) from_there.march_step_tolerance = 1e-11;
      if (!by_march) from_there.method = SteadyStateMethod::kShooting;
      from_there.model = PointModel::kFull;
      from_there.tolerance = by_march ? from_there.tolerance : 1e-8;
      from_there.maximum_mesh_cycles = 400;
      from_there.carried_state = carried_from(r);
      const PointResult exact = solve_operating_point(place.scene, place.condition, from_there);
      if (!exact.settled) {
        ++untold;  // the march rattles on and tells nothing
        std::cout << "scene " << i << ": the march does not settle\n";
        continue;
      }
      const double error = true_error(r, exact), estimate = r.estimated_relative_error.value();
      EXPECT_LT(error, std::max(options.tolerance, 2 * estimate)) << "scene " << i;
      if (error > std::max(estimate, 1e-8)) {
        ++above;
        std::cout << "scene " << i << ": error " << error << ", estimate " << estimate << '\n';
      }
      if (i % 2 == 0) over.push_back(estimate / std::max(error, 1e-12));
      PreparedScene prepared(place.scene);
      const PointFigures screened = screen_point(prepared, place.condition, options);
      if (!screened.estimated_relative_error) {
        ++unscreened;
        continue;
      }
      const double its_error = true_error(screened, exact);
      const double its_estimate = *screened.estimated_relative_error;
      EXPECT_LT(its_error, std::max(options.tolerance, 2 * its_estimate)) << "scene " << i;
      if (its_error > std::max(its_estimate, 1e-8)) {
        ++screened_above;
        std::cout << "scene " << i << " screened: error " << its_error << ", estimate "
                  << its_estimate << '\n';
      }
      if (i % 2 == 0) screened_over.push_back(its_estimate / std::max(its_error, 1e-12));
    } catch (const Refusal& refusal) {
      EXPECT_NE(refusal.reason(), "NOT_FINITE");
    }
  }
  const auto median_of = [](std::vector<double>& values) {
    std::sort(values.begin(), values.end());
    return values[values.size() / 2];
  };
  const double median = median_of(over), screened_median = median_of(screened_over);
  std::cout << shot << " of " << count << " by shooting, " << above
            << " err more than estimated, median of estimate over error by default " << median
            << "; screened: " << screened_above << " and " << screened_median << '\n';
  EXPECT_GT(shot, 0.75 * count);
  EXPECT_LE(untold, std::max(2.0, 0.1 * count));
  EXPECT_LE(above, std::max(1.0, 0.01 * count));
  EXPECT_GT(median, 1);
  EXPECT_LT(median, full_run() ? 10 : 20);  // few scenes scatter
  EXPECT_LE(unscreened, std::max(1.0, 0.02 * count));
  EXPECT_LE(screened_above, std::max(1.0, 0.01 * count));
  EXPECT_GT(screened_median, 1);
  EXPECT_LT(screened_median, full_run() ? 10 : 20);
}

// Under Coulomb's friction of 0.05 the errors of 16 steps cancel at this speed, and under no
// lubricant's.
TEST(ScreenedPoint, ErrsLessThanItSaysWhereTheErrorsOfFewStepsCancelUnderOneFriction) {
  Scene scene = reference_scene(1, 99.216129596160783);
  scene.options.energy_consistent = scene.options.isothermal = scene.options.newtonian = true;
  FourierSeries& k = scene.gear_set.series.mesh_stiffness;
  for (std::vector<double>* series : {&k.sine, &k.cosine}) {
    for (double& c : *series) c *= 0.412574;
  }
  const OperatingCondition condition = cruise(37.656680896876871);
  PointOptions options;
  options.model = PointModel::kFull;
  options.tolerance = 1e-6;
  const PointResult exact = solve_operating_point(scene, condition, options);
  ASSERT_EQ(exact.method, SteadyStateMethod::kShooting);
  for (const double tolerance : {1e-2, 3e-3, 1e-3, 4e-4}) {
    SCOPED_TRACE(tolerance);
    options.tolerance = tolerance;
    PreparedScene prepared(scene);
    const PointFigures screened = screen_point(prepared, condition, options);
    ASSERT_TRUE(screened.estimated_relative_error);
    EXPECT_LE(true_error(screened, exact), *screened.estimated_relative_error);
    EXPECT_LE(*screened.estimated_relative_error, tolerance);
  }
}

TEST(ShootingAtPrescribedTorque, FindsTheWheelTorqueOfTheMarch) {
  for (const double torque : {60.0, 8.0, -25.0}) {
    for (const double pinion_speed : {60.0, 190.0, 300.0}) {
      if (kShortRun && pinion_speed != 190) continue;
      SCOPED_TRACE(testing::Message() << torque << " N m at " << pinion_speed << " rad/s");
      const OperatingCondition condition = prescribed(torque, pinion_speed);
      PointOptions options;
      options.model = PointModel::kFull;
      options.method = SteadyStateMethod::kShooting;
      options.tolerance = 1e-5;
      const PointResult shot = solve_operating_point(reference_scene(), condition, options);
      PointOptions march = marched();
      march.carried_state = carried_from(shot);
      const PointResult exact = solve_operating_point(reference_scene(), condition, march);
      EXPECT_EQ(shot.pinion_torque, torque);
      EXPECT_EQ(shot.contact_loss, exact.contact_loss);
      EXPECT_LT(true_error(shot, exact), 1e-5);
      // What the loss power takes from the wheel.
      const double ratio = 36.0 / 13;
      EXPECT_NEAR((torque - shot.wheel_torque / ratio) * pinion_speed, shot.mesh_loss_power,
                  0.3 * shot.mesh_loss_power);
    }
  }
}

/// The same gear set, described so that no power series are made of it: harmonics of nothing.
GearSet without_series(GearSet gear_set) {
  MeshSeries& s = gear_set.series;
  for (FourierSeries* each : {&s.pinion_contact_radius, &s.gear_contact_radius, &s.mesh_stiffness,
                              &s.static_transmission_error}) {
    each->sine.resize(80, 0.0);
    each->cosine.resize(80, 0.0);
  }
  return gear_set;
}

TEST(GearSetsWithoutSeries, HaveTheSameResponsesByShootingStepAfterStep) {
  const Scene scene = reference_scene();
  Scene plain = scene;
  plain.gear_set = without_series(scene.gear_set);
  ASSERT_EQ(PreparedScene(plain).gear_set().grids().with_steps(24).series_reach(), 0);
  ASSERT_GT(PreparedScene(scene).gear_set().grids().with_steps(24).series_reach(), 0);
  for (const OperatingCondition& condition :
       {cruise(20), cruise(72.5), cruise(100), prescribed(-25, 300)}) {
    for (const PointModel model : {PointModel::kFull, PointModel::kQuasiStatic}) {
      SCOPED_TRACE(testing::Message()
                   << 3.6 * condition.vehicle_speed << " km/h, model " << static_cast<int>(model));
      PointOptions options;
      options.model = model;
      options.tolerance = 1e-5;
      const PointResult with = solve_operating_point(scene, condition, options);
      const PointResult without = solve_operating_point(plain, condition, options);
      EXPECT_EQ(without.method, with.method);
      EXPECT_EQ(without.contact_loss, with.contact_loss);
      EXPECT_LT(true_error(without, with), 2e-5) << "each is good to 1e-5";
      EXPECT_NEAR(without.statistics.largest_multiplier, with.statistics.largest_multiplier, 3e-3);
    }
  }
}

TEST(ShootingAlone, RefusesByNameWithTheValuesWhatItCannotFind) {
  PointOptions options;
  options.method = SteadyStateMethod::kShooting;
  const auto said = [&](const Scene& scene, const OperatingCondition& condition) {
    return refusal_of([&] { solve_operating_point(scene, condition, options); });
  };
  // The response of one mesh cycle repels.
  const std::string repelled = said(reference_scene(), cruise(150));
  EXPECT_TRUE(repelled.starts_with("NOT_FOUND_BY_SHOOTING: method = SHOOTING")) << repelled;
  EXPECT_NE(repelled.find("412.088 rad/s"), std::string::npos) << repelled;
  EXPECT_NE(repelled.find("241.146 N m"), std::string::npos) << repelled;
}

TEST(ShootingAlone, TellsTheRefusalOfAContactAsTheMarchDoes) {
  Scene scene = reference_scene();
  scene.options.no_limiting_shear_stress = true;
  scene.lubricant.vogel_viscosity_prefactor = 1e-300;  // no film
  std::string reasons[2];
  for (const SteadyStateMethod method : {SteadyStateMethod::kShooting, SteadyStateMethod::kMarch}) {
    PointOptions options;
    options.method = method;
    reasons[method == SteadyStateMethod::kMarch] =
        refusal_reason([&] { solve_operating_point(scene, cruise(72.5), options); });
  }
  EXPECT_EQ(reasons[0], reasons[1]);
  EXPECT_NE(reasons[0], "none");
  EXPECT_NE(reasons[0], "NOT_FOUND_BY_SHOOTING");
}

TEST(GivingUpEarly, RefusesWhatTakesLongToFindAndChangesNoOtherPoint) {
  const Scene scene = reference_scene();
  PreparedScene prepared(scene);
  PointOptions early;
  early.gives_up_early = true;
  // The response of one mesh cycle repels; flanks rattle.
  for (const OperatingCondition& condition : {cruise(150), prescribed(-0.3, 200)}) {
    EXPECT_EQ(refusal_reason([&] { solve_point_figures(prepared, condition, early); }),
              "NOT_FOUND_BY_SHOOTING");
    EXPECT_EQ(refusal_reason([&] { solve_prepared_point(prepared, condition, early); }),
              "NOT_FOUND_BY_SHOOTING");
  }
  for (const OperatingCondition& condition : {cruise(0.5), cruise(20), cruise(67.5), cruise(80),
                                              prescribed(-20, 200), prescribed(1e-3, 200)}) {
    SCOPED_TRACE(testing::Message() << condition.vehicle_speed << " m/s");
    EXPECT_EQ(solve_point_figures(prepared, condition, early).mesh_loss_power,
              solve_point_figures(prepared, condition, {}).mesh_loss_power);
    EXPECT_EQ(solve_prepared_point(prepared, condition, early).mesh_loss_power,
              solve_prepared_point(prepared, condition, {}).mesh_loss_power);
  }
}

TEST(ShootingHistories, AreThoseOfTheMarch) {
  for (const double speed : {72.5, 100.0}) {
    if (kShortRun && speed != 72.5) continue;
    SCOPED_TRACE(speed);
    PointOptions march = marched(), shoot;
    shoot.tolerance = 1e-6;
    for (PointOptions* options : {&march, &shoot}) {
      options->history.columns = {HistoryColumn::kTime,
                                  HistoryColumn::kMeshPhase,
                                  HistoryColumn::kDynamicTransmissionError,
                                  HistoryColumn::kMeshForce,
                                  HistoryColumn::kMeshLossPower,
                                  HistoryColumn::kFlankLoad};
      options->history.mesh_cycles = 3;
      options->history.samples_per_mesh_cycle = 50;
    }
    const PointResult a = solve_operating_point(reference_scene(), cruise(speed), march);
    const PointResult b = solve_operating_point(reference_scene(), cruise(speed), shoot);
    ASSERT_EQ(b.method, SteadyStateMethod::kShooting);
    ASSERT_EQ(a.history.names, b.history.names);
    for (std::size_t column = 0; column < a.history.names.size(); ++column) {
      const auto &x = a.history.values[column], &y = b.history.values[column];
      ASSERT_EQ(x.size(), 150u);
      ASSERT_EQ(y.size(), 150u);
      const double size = *std::max_element(x.begin(), x.end());
      for (std::size_t i = 0; i < x.size(); ++i) {
        EXPECT_NEAR(x[i], y[i], 2e-4 * size) << a.history.names[column] << ' ' << i;
      }
    }
  }
}

TEST(ShootingResults, DoNotDependOnAHistoryBeingAskedFor) {
  PointOptions plain, with_history;
  with_history.history.columns = {HistoryColumn::kMeshForce};
  with_history.history.mesh_cycles = 1;
  with_history.history.samples_per_mesh_cycle = 10;
  const PointResult a = solve_operating_point(reference_scene(), cruise(72.5), plain);
  const PointResult b = solve_operating_point(reference_scene(), cruise(72.5), with_history);
  EXPECT_EQ(a.inefficiency_rms, b.inefficiency_rms);
  EXPECT_EQ(a.dynamic_transmission_error.maximum, b.dynamic_transmission_error.maximum);
}

// Friction is where the time goes: a scene that takes more of it than this has got slow.
TEST(ShootingWork, FrictionEvaluationsOfAPointAreFew) {
  struct Scenario {
    double kilometres_per_hour;
    PointStart start;
    long most;
  };
  for (const Scenario& at :
       {Scenario{20, PointStart::kQuasiStatic, 720}, Scenario{37.5, PointStart::kQuasiStatic, 1200},
        Scenario{67.5, PointStart::kQuasiStatic, 370},
        Scenario{67.5, PointStart::kLargeVibration, 510},
        Scenario{72.5, PointStart::kQuasiStatic, 340}, Scenario{80, PointStart::kQuasiStatic, 800},
        Scenario{100, PointStart::kQuasiStatic, 280},
        Scenario{140, PointStart::kQuasiStatic, 280}}) {
    SCOPED_TRACE(at.kilometres_per_hour);
    PointOptions options;
    options.model = PointModel::kFull;
    options.start = at.start;
    const PointResult r =
        solve_operating_point(reference_scene(), cruise(at.kilometres_per_hour), options);
    EXPECT_EQ(r.method, SteadyStateMethod::kShooting);
    EXPECT_LE(r.statistics.contact_solutions, at.most);
    EXPECT_GT(r.statistics.contact_solutions, 100);
  }
}

// Company asks for the same before: another lubricant, cancelled at one stage after another.
TEST(ScreenedPoints, AreTheSameBitsAloneAndInCompany) {
  const Scene thin = reference_scene(1, 90), thick = reference_scene(2, 20);
  const auto shared = std::make_shared<PreparedGearSet>(thin.gear_set, thin.solid, thin.options);
  PreparedScene first(thick, shared), second(thin, shared);
  PointOptions by_default, coarse, fine, loud;
  coarse.tolerance = 1e-2;
  fine.tolerance = 3e-5;
  loud.start = PointStart::kLargeVibration;
  for (const OperatingCondition& condition : {cruise(20), cruise(67.5), cruise(72.5), cruise(80),
                                              cruise(100), cruise(150), prescribed(-20, 300)}) {
    for (const PointOptions& options : {by_default, coarse, fine, loud}) {
      SCOPED_TRACE(testing::Message()
                   << 3.6 * condition.vehicle_speed << " km/h, tolerance " << options.tolerance);
      for (int stage = 0; stage < 20; stage += 4) {
        PointOptions cancelled = options;
        cancelled.progress = [left = stage](double) mutable { return left-- > 0; };
        try {
          screen_point(first, condition, cancelled);
        } catch (const Cancelled&) {
        }
      }
      screen_point(first, condition, options);
      const PointFigures company = screen_point(second, condition, options);
      PreparedScene lonely(thin);
      const PointFigures alone = screen_point(lonely, condition, options);
      EXPECT_EQ(alone.inefficiency_rms, company.inefficiency_rms);
      EXPECT_EQ(alone.inefficiency_energy_mean, company.inefficiency_energy_mean);
      EXPECT_EQ(alone.pinion_torque, company.pinion_torque);
      EXPECT_EQ(alone.dte_minimum, company.dte_minimum);
      EXPECT_EQ(alone.dte_maximum, company.dte_maximum);
      EXPECT_EQ(alone.estimated_relative_error, company.estimated_relative_error);
      EXPECT_EQ(alone.contact_solutions, company.contact_solutions);
    }
  }
}

// Through the resonance, where contact is lost, on the branch that the point alone finds.
TEST(ScreenedPoints, AreThoseOfThePointAlone) {
  long contacts = 0, contacts_alone = 0;
  for (const double sump : {20.0, 90.0}) {
    for (const int fluid : {1, 2, 3}) {
      const Scene scene = reference_scene(fluid, sump);
      PreparedScene prepared(scene);
      for (double speed = 15; speed <= 145; speed += full_run() ? 0.5 : 2.5) {
        SCOPED_TRACE(std::to_string(speed) + " km/h, lubricant " + std::to_string(fluid));
        const PointFigures screened = screen_point(prepared, cruise(speed), {});
        const PointFigures alone = solve_point_figures(prepared, cruise(speed), {});
        EXPECT_EQ(screened.contact_loss, alone.contact_loss);
        EXPECT_EQ(screened.period_in_mesh_cycles, alone.period_in_mesh_cycles);
        const double estimate = screened.estimated_relative_error.value();
        EXPECT_LE(estimate, 1e-3);
        const double doubt = estimate + alone.estimated_relative_error.value();
        const auto expect_near = [&](double a, double b) {
          EXPECT_NEAR(a, b, doubt * std::abs(b));
        };
        expect_near(screened.inefficiency_rms.value(), alone.inefficiency_rms.value());
        expect_near(screened.inefficiency_energy_mean.value(),
                    alone.inefficiency_energy_mean.value());
        expect_near(screened.pinion_torque, alone.pinion_torque);
        const double dte = std::max(std::abs(alone.dte_minimum), std::abs(alone.dte_maximum));
        EXPECT_NEAR(screened.dte_minimum, alone.dte_minimum, doubt * dte);
        EXPECT_NEAR(screened.dte_maximum, alone.dte_maximum, doubt * dte);
        contacts += screened.contact_solutions;
        contacts_alone += alone.contact_solutions;
      }
    }
  }
  EXPECT_LT(contacts, 0.7 * contacts_alone);
}

TEST(PointFigures, AreThoseOfTheWholeResult) {
  const Scene scene = reference_scene();
  PreparedScene prepared(scene);
  for (const OperatingCondition& condition : {cruise(72.5), cruise(100), prescribed(-20, 300)}) {
    const PointFigures brief = solve_point_figures(prepared, condition, {});
    const PointResult whole = solve_operating_point(scene, condition, {});
    const double error =
        brief.estimated_relative_error.value() + whole.estimated_relative_error.value();
    EXPECT_EQ(brief.contact_loss, whole.contact_loss);
    EXPECT_EQ(brief.period_in_mesh_cycles, whole.period_in_mesh_cycles);
    const auto expect_near = [&](double a, double b) { EXPECT_NEAR(a, b, error * std::abs(b)); };
    expect_near(brief.inefficiency_rms.value(), whole.inefficiency_rms.value());
    expect_near(brief.inefficiency_energy_mean.value(), whole.inefficiency_energy_mean.value());
    expect_near(brief.pinion_torque, whole.pinion_torque);
    expect_near(brief.wheel_torque, whole.wheel_torque);
    expect_near(brief.mesh_loss_power, whole.mesh_loss_power);
    expect_near(brief.dte_maximum, whole.dynamic_transmission_error.maximum);
  }
}

TEST(PointFigures, HaveTheContactsOfTheWholeResult) {
  PointOptions options;
  options.contact_summary = true;
  PointOptions impacts = options;
  impacts.start = PointStart::kLargeVibration;
  Scene isothermal = reference_scene();
  isothermal.options.isothermal = true;
  const Scene scene = reference_scene();
  const struct {
    const Scene& scene;
    OperatingCondition condition;
    const PointOptions& options;
  } places[] = {{scene, cruise(2), options},          {scene, cruise(20), options},
                {scene, cruise(67.5), impacts},       {scene, cruise(80), options},
                {scene, cruise(100), options},        {scene, prescribed(-20, 300), options},
                {scene, prescribed(1, 600), options}, {isothermal, cruise(60), options}};
  for (const auto& place : places) {
    SCOPED_TRACE(place.condition.vehicle_speed * 3.6);
    PreparedScene prepared(place.scene);
    const PointFigures brief = solve_point_figures(prepared, place.condition, place.options);
    const PointResult whole = solve_operating_point(place.scene, place.condition, place.options);
    ASSERT_TRUE(brief.contact);
    const ContactSummary expected = contact_summary(whole).value();
    const auto expect_same = [&](double ContactSummary::*figure) {
      EXPECT_EQ(*brief.contact.*figure, expected.*figure);
    };
    expect_same(&ContactSummary::film_ratio_minimum);
    expect_same(&ContactSummary::film_ratio_mean);
    expect_same(&ContactSummary::contact_temperature_maximum);
    expect_same(&ContactSummary::contact_temperature_mean);
    expect_same(&ContactSummary::viscous_loss_power);
    expect_same(&ContactSummary::boundary_loss_power);
    expect_same(&ContactSummary::friction_coefficient_mean);
    expect_same(&ContactSummary::pressure_maximum);
    expect_same(&ContactSummary::flash_temperature_rise_maximum);
  }
}

TEST(ShootingRequests, AreCancelled) {
  PointOptions options;
  int asked = 0;
  options.progress = [&](double) { return ++asked < 3; };
  EXPECT_THROW(solve_operating_point(reference_scene(), cruise(72.5), options), Cancelled);
}

}  // namespace
}  // namespace tribodyn
