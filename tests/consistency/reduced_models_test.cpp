// Models cheaper than the full one: right for what they claim to be, honest about how far that is
// from the full model, and chosen only where that is near enough.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <functional>
#include <iostream>
#include <memory>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "core/integrate/order_weights.h"
#include "core/reduced/linear_response.h"
#include "core/reduced/quasi_static.h"
#include "core/refusal.h"
#include "core/study/operating_point.h"
#include "core/study/quasi_static_point.h"
#include "core/study/screening.h"
#include "core/study/speed_sweep.h"
#include "tests/support/cruise.h"
#include "tests/support/figure_error.h"
#include "tests/support/random_place.h"
#include "tests/support/realistic_contacts.h"
#include "tests/support/reference_scene.h"
#include "tests/support/run_length.h"

namespace tribodyn {
namespace {

PointOptions pinned(PointModel model, double tolerance = 1e-3) {
  PointOptions options;
  options.model = model;
  options.tolerance = tolerance;
  return options;
}

struct Loss {
  double pinion_torque, rms, energy_mean;  // [N m], [%]
};

/// Phase by phase, contact by contact, by the scalar kernel: two Gauss points in each interval
/// of the tables, on whose ends the integrand has its kinks. T_w given.
Loss plain_quasi_static(const Scene& scene, double kilometres_per_hour) {
  const MeshData mesh(scene.gear_set);
  const FlankContactModel model = contact_model(scene);
  const double wheel = wheel_torque(scene.vehicle, kilometres_per_hour / 3.6, 0, 0);
  const double ratio = static_cast<double>(mesh.pinion_teeth()) / mesh.gear_teeth();
  const double speed = kilometres_per_hour / 3.6 / scene.vehicle.wheel_radius / ratio;
  const int points = 2 * mesh.intervals();
  std::vector<double> friction_torque(points, 0.0);
  Loss out{ratio * wheel, 0, 0};
  for (int sweep = 0; sweep < 8; ++sweep) {
    double sum = 0, squares = 0;
    for (int i = 0; i < points; ++i) {
      const int interval = i / 2;
      const double phase =
          (interval + 0.5 + (i % 2 == 0 ? -0.5 : 0.5) / std::sqrt(3.0)) / mesh.intervals();
      const double theta = 2 * std::numbers::pi * phase;
      // R_g at the angle where the gear is: behind by the mesh approach.
      double approach = 0;
      MeshFunctions f{};
      double force = 0;
      for (int j = 0; j < 6; ++j) {
        f = mesh.functions(theta,
                           theta - mesh.gear_teeth() / mesh.mean_gear_contact_radius() * approach);
        force = (out.pinion_torque + friction_torque[i]) / f.pinion_contact_radius;
        approach = force / f.mesh_stiffness + f.static_transmission_error - f.radius_integral;
      }
      const double gear_speed = (f.pinion_contact_radius - f.static_transmission_error_slope) *
                                speed / f.gear_contact_radius;
      std::array<FlankKinematics, kFlankPairs> flanks;
      mesh.flanks(interval, phase, flanks);
      double torque = 0, loss = 0;
      for (const FlankKinematics& flank : flanks) {
        if (!(flank.load_share * force > 0)) continue;
        const FlankMotion motion = flank_motion(flank, speed, gear_speed);
        const double friction =
            model
                .solve({flank.load_share * force, flank.radius_x, flank.radius_y, motion.pinion_x,
                        motion.pinion_y, motion.gear_x, motion.gear_y})
                .friction;
        torque += motion.pinion_friction_arm * friction;
        loss += motion.sliding_speed * friction;
      }
      friction_torque[i] = torque;
      sum += loss / points;
      squares += loss * loss / points;
    }
    out.pinion_torque = ratio * wheel + sum / speed;
    out.rms = 100 * std::sqrt(squares) / (speed * out.pinion_torque);
    out.energy_mean = 100 * sum / (speed * out.pinion_torque);
  }
  return out;
}

TEST(QuasiStatic, IsWhatPhaseByPhaseGivesWithinItsOwnEstimateAtEveryTolerance) {
  for (const int fluid : {1, 2}) {
    const Scene scene = reference_scene(fluid, fluid == 1 ? 40 : 90);
    PreparedScene prepared(scene);
    PreparedGearSet& gear_set = prepared.gear_set();
    for (const double kilometres_per_hour : {1.0, 20.0, 100.0}) {
      const Loss plain = plain_quasi_static(scene, kilometres_per_hour);
      for (const double tolerance : {1e-2, 1e-3, 1e-4, 1e-5}) {
        SCOPED_TRACE(testing::Message() << kilometres_per_hour << " km/h at " << tolerance);
        PointOptions options;
        options.tolerance = tolerance;
        const OperatingTarget target = target_of(scene, cruise(kilometres_per_hour));
        ContactTally tally;
        const auto r = solve_quasi_static(
            quasi_static_problem({prepared.contacts(), gear_set, target, options, tally}));
        ASSERT_TRUE(r.has_value());
        EXPECT_LE(r->estimated_error, 0.5 * tolerance);
        const double torque = r->figures.torque;
        const double rms = 100 * r->figures.loss_rms / torque;
        const double energy =
            100 * r->figures.loss_energy / (torque * gear_set.system().cycle_angle());
        const double error =
            std::max({std::abs(torque / plain.pinion_torque - 1), std::abs(rms / plain.rms - 1),
                      std::abs(energy / plain.energy_mean - 1)});
        // Two Gauss points an interval are good to a millionth.
        EXPECT_LT(error, r->estimated_error + 1e-6);
      }
    }
  }
}

TEST(QuasiStatic, PowerBalancesAndNothingIsStored) {
  for (const OperatingCondition& condition :
       {cruise(1), cruise(50), cruise(140), prescribed(60, 200), prescribed(-40, 200)}) {
    const PointResult r =
        solve_operating_point(reference_scene(), condition, pinned(PointModel::kQuasiStatic));
    const PowerBalance& p = r.power_balance;
    const double size = std::abs(p.input);
    EXPECT_NEAR(p.input - p.output - p.friction - p.shaft_damping - p.mesh_damping - p.parametric,
                0, 1e-12 * size);
    EXPECT_NEAR(p.stored, 0, 1e-12 * size);
    EXPECT_GT(p.friction, 0);
    EXPECT_NEAR(r.viscous_loss_power + r.boundary_loss_power, r.mesh_loss_power,
                1e-9 * r.mesh_loss_power);
  }
}

TEST(QuasiStatic, HistoriesAreEquilibriaOfThePinion) {
  for (const double torque : {60.0, -40.0}) {
    const Scene scene = reference_scene();
    PointOptions options = pinned(PointModel::kQuasiStatic, 1e-4);
    options.history.columns = {HistoryColumn::kMeshPhase,
                               HistoryColumn::kDynamicTransmissionError,
                               HistoryColumn::kDynamicTransmissionErrorVelocity,
                               HistoryColumn::kMeshForce,
                               HistoryColumn::kPinionFrictionTorque,
                               HistoryColumn::kMeshLossPower};
    options.history.mesh_cycles = 2;
    options.history.samples_per_mesh_cycle = 200;
    const PointResult r = solve_operating_point(scene, prescribed(torque, 200), options);
    const auto& v = r.history.values;
    ASSERT_EQ(v[0].size(), 400u);
    const MeshData mesh(scene.gear_set);
    double low = 1, high = -1, loss = 0;
    for (std::size_t i = 0; i < 400; ++i) {
      const double theta = 2 * std::numbers::pi * v[0][i];
      const MeshFunctions f = mesh.functions(theta, theta);
      const double side = torque > 0 ? 1 : -1;
      const double force = v[3][i], x = v[1][i];
      EXPECT_NEAR(f.pinion_contact_radius * force, torque + v[4][i], 1e-9 * std::abs(torque));
      EXPECT_NEAR(x, side * scene.gear_set.dynamics.half_backlash + force / f.mesh_stiffness,
                  1e-9 * std::abs(x));
      EXPECT_NEAR(v[2][i], 0, 1e-12);
      low = std::min(low, x);
      high = std::max(high, x);
      loss += v[5][i] / 400;
    }
    EXPECT_NEAR(r.dynamic_transmission_error.minimum, low, 2e-5 * std::abs(low));
    EXPECT_NEAR(r.dynamic_transmission_error.maximum, high, 2e-5 * std::abs(high));
    EXPECT_NEAR(loss / r.mesh_loss_power, 1, 1e-3);
  }
}

TEST(QuasiStatic, IsCancelled) {
  PointOptions options = pinned(PointModel::kQuasiStatic);
  int asked = 0;
  options.progress = [&](double) { return ++asked < 3; };
  EXPECT_THROW(solve_operating_point(reference_scene(), cruise(1), options), Cancelled);
}

/// A gear pair whose shafts are infinitely soft: the mesh alone holds its two rotors.
struct Oscillator {
  Scene scene = reference_scene();
  std::unique_ptr<PreparedScene> prepared;
  const GearPairSystem* system;
  double natural, damping;  // [rad/s], of critical

  explicit Oscillator(double damping_factor) {
    DrivelineDynamics& d = scene.gear_set.dynamics;
    d.pinion_shaft_stiffness = d.gear_shaft_stiffness = 1e-9;
    d.pinion_shaft_damping = d.gear_shaft_damping = 0;
    d.mesh_damping *= damping_factor;
    prepared = std::make_unique<PreparedScene>(scene);
    system = &prepared->gear_set().system();
    const MeshData& mesh = system->mesh();
    const double per_mass = std::pow(mesh.mean_pinion_contact_radius(), 2) / d.pinion_inertia +
                            std::pow(mesh.mean_gear_contact_radius(), 2) / d.gear_inertia;
    natural = std::sqrt(mesh.mean_mesh_stiffness() * per_mass);
    damping = 0.5 * d.mesh_damping * per_mass / natural;
  }

  /// Largest |of x| when a mesh approach of 1 um is imposed, `order` times a mesh cycle.
  double answer(double frequency_ratio, int order) const {
    constexpr int kPhases = 48;
    ImposedMotion motion;
    motion.resize(kPhases);
    for (int n = 0; n < kPhases; ++n) {
      motion.mesh_approach[n] = 1e-6 * std::cos(2 * std::numbers::pi * order * n / kPhases);
      motion.mesh_stiffness[n] = system->mesh().mean_mesh_stiffness();
    }
    const double speed = frequency_ratio * natural / (order * system->mesh().pinion_teeth());
    const InertialCorrection change = inertial_correction(*system, speed, motion);
    EXPECT_LT(change.growth, 1e-12);
    return change.largest;
  }
};

TEST(InertialCorrection, IsTheResonanceCurveOfAnOscillator) {
  for (const double damping_factor : {0.0, 1.0, 5.0}) {
    const Oscillator oscillator(damping_factor);
    for (const int order : {1, 3}) {
      for (const double r : {0.01, 0.31, 0.9, 1.1, 2.9}) {
        const double expected =
            1e-6 * r * r / std::abs(std::complex<double>(1 - r * r, 2 * oscillator.damping * r));
        // Of the phases one is within a quarter of 1/16 cycle of the extreme.
        EXPECT_NEAR(oscillator.answer(r, order) / expected, 1, order == 1 ? 3e-3 : 2e-2)
            << damping_factor << ' ' << order << ' ' << r;
      }
    }
  }
}

TEST(InertialCorrection, KnowsWhereTheStiffnessMayKeepAVibrationGoing) {
  const Oscillator bare(0), damped(1), calm(20);
  const auto possible = [](const Oscillator& o, double ripple, double frequency_ratio) {
    std::vector<double> stiffness(48);
    for (int n = 0; n < 48; ++n) {
      stiffness[n] = o.system->mesh().mean_mesh_stiffness() *
                     (1 + ripple * std::cos(2 * std::numbers::pi * n / 48));
    }
    return parametric_resonance_possible(
        *o.system, frequency_ratio * o.natural / o.system->mesh().pinion_teeth(), stiffness);
  };
  EXPECT_TRUE(possible(bare, 0.1, 2));
  EXPECT_TRUE(possible(bare, 0.1, 2 * (1 + 0.1 / 4)));
  EXPECT_FALSE(possible(bare, 0.1, 1.5));
  EXPECT_FALSE(possible(bare, 0.1, 3));
  EXPECT_TRUE(possible(damped, 0.15, 2));
  EXPECT_FALSE(possible(calm, 0.15, 2));
}

/// Of a cheaper model, over random scenes. `on_known` sees those with an estimate, and their truth.
void expect_honest_estimates(
    PointModel model, double tolerance,
    const std::function<void(const RandomPlace&, const PointResult& full)>& on_known) {
  const unsigned long seed = std::random_device{}();
  std::cout << "seed " << seed << '\n';
  testing::Test::RecordProperty("seed", std::to_string(seed));
  std::mt19937_64 random(seed);
  const int count = full_run() ? 500 : 60;
  int known = 0, above = 0;
  std::vector<double> over;
  for (int i = 0; i < count; ++i) {
    SCOPED_TRACE(testing::Message() << "scene " << i);
    const double log_speed =
        std::uniform_real_distribution<double>(std::log(1.0), std::log(220.0))(random);
    const RandomPlace place = random_place(random, std::exp(log_speed));
    try {
      const PointResult cheap =
          solve_operating_point(place.scene, place.condition, pinned(model, tolerance));
      const PointResult full = solve_operating_point(
          place.scene, place.condition, pinned(PointModel::kFull, std::min(1e-5, tolerance)));
      if (!cheap.estimated_relative_error) continue;
      EXPECT_TRUE(full.settled);
      EXPECT_FALSE(full.contact_loss);
      EXPECT_EQ(full.period_in_mesh_cycles, 1);
      ++known;
      const double error = true_error(cheap, full);
      const double estimate = *cheap.estimated_relative_error;
      EXPECT_LT(error, 2 * estimate);
      above += error > estimate;
      over.push_back(estimate / error);
      on_known(place, full);
    } catch (const Refusal& refusal) {
      EXPECT_NE(refusal.reason(), "NOT_FINITE");
    }
  }
  std::sort(over.begin(), over.end());
  const double median = over[over.size() / 2];
  std::cout << known << " of " << count << " with an estimate, " << above
            << " err more than estimated, median of estimate over error " << median << '\n';
  EXPECT_GT(known, 0.7 * count);
  EXPECT_LE(above, std::max(1.0, 0.01 * count));
  EXPECT_GT(median, 1);
  EXPECT_LT(median, 10);
}

TEST(QuasiStaticOverRandomScenes, EstimatesBoundTheDistanceFromTheFullModelAndAreNotFarAbove) {
  if (kShortRun) GTEST_SKIP() << "minutes under sanitizers";
  int known = 0, chosen = 0;
  const auto on_known = [&](const RandomPlace& place, const PointResult& full) {
    PointOptions automatic;
    automatic.tolerance = 1e-2;
    const PointResult r = solve_operating_point(place.scene, place.condition, automatic);
    EXPECT_LE(true_error(r, full), automatic.tolerance);
    ++known;
    chosen += r.model == PointModel::kQuasiStatic;
  };
  expect_honest_estimates(PointModel::kQuasiStatic, 1e-3, on_known);
  std::cout << "chosen at 1e-2 in " << chosen << '\n';
  EXPECT_GT(chosen, 0.1 * known);
}

TEST(QuasiStaticEstimate, SaysThatItCannotTellWhereFlanksPartOrTheMeshResonates) {
  for (const double speed : {70.0, 72.5, 80.0, 150.0}) {
    SCOPED_TRACE(speed);
    const PointResult r =
        solve_operating_point(reference_scene(), cruise(speed), pinned(PointModel::kQuasiStatic));
    EXPECT_FALSE(r.estimated_relative_error.has_value());
    ASSERT_FALSE(r.warnings.empty());
    EXPECT_TRUE(std::any_of(r.warnings.begin(), r.warnings.end(), [](const RangeWarning& w) {
      return w.code == "QUASI_STATIC" && w.sentence.find("cannot be told") != std::string::npos;
    }));
  }
  const PointResult slow =
      solve_operating_point(reference_scene(), cruise(1), pinned(PointModel::kQuasiStatic));
  EXPECT_LT(slow.estimated_relative_error.value(), 1e-3);
  EXPECT_TRUE(std::any_of(slow.warnings.begin(), slow.warnings.end(), [](const RangeWarning& w) {
    return w.code == "QUASI_STATIC" &&
           w.sentence.find("estimated to be within") != std::string::npos;
  }));
}

TEST(QuasiStaticEstimate, FallsWithTheSpeed) {
  double last = 1;
  for (const double speed : {20.0, 5.0, 1.0}) {
    const PointResult r = solve_operating_point(reference_scene(), cruise(speed),
                                                pinned(PointModel::kQuasiStatic, 1e-6));
    EXPECT_LT(r.estimated_relative_error.value(), 0.3 * last);
    last = r.estimated_relative_error.value();
  }
}

TEST(ModelChoice, IsTheCheapestWithinTheTolerance) {
  const Scene scene = reference_scene();
  for (const double speed : {0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 45.0, 72.5, 100.0, 140.0}) {
    for (const double tolerance : {1e-2, 1e-3, 1e-4}) {
      SCOPED_TRACE(testing::Message() << speed << " km/h at " << tolerance);
      const PointResult r =
          solve_operating_point(scene, cruise(speed), pinned(PointModel::kAutomatic, tolerance));
      EXPECT_LE(r.estimated_relative_error.value(), tolerance);
      const PointResult cheap =
          solve_operating_point(scene, cruise(speed), pinned(PointModel::kQuasiStatic, tolerance));
      PreparedGearSet set(scene.gear_set, scene.solid, scene.options);
      const OperatingTarget target = target_of(scene, cruise(speed));
      const bool resonates =
          resonant_weight(set.system(), target.torques, target.mean_pinion_speed) > tolerance;
      const bool enough = !resonates && cheap.estimated_relative_error.value_or(1) <= tolerance;
      EXPECT_EQ(r.model, enough ? PointModel::kQuasiStatic : PointModel::kFull);
      if (speed <= 2 && tolerance >= 1e-3) {
        EXPECT_EQ(r.model, PointModel::kQuasiStatic);
      }
      if (speed > 60) {
        EXPECT_EQ(r.model, PointModel::kFull);
      }
    }
  }
}

TEST(ModelChoice, IsTheFullModelWhereABranchOrAHistoryIsAskedFor) {
  const Scene scene = reference_scene();
  const auto used = [&](const std::function<void(PointOptions&)>& ask) {
    PointOptions options;
    options.tolerance = 1e-2;
    ask(options);
    return solve_operating_point(scene, cruise(2), options).model;
  };
  const PointResult neighbour =
      solve_operating_point(scene, cruise(2.2), pinned(PointModel::kFull, 1e-2));
  EXPECT_EQ(used([](PointOptions&) {}), PointModel::kQuasiStatic);
  EXPECT_EQ(used([](PointOptions& o) { o.start = PointStart::kLargeVibration; }),
            PointModel::kFull);
  EXPECT_EQ(used([](PointOptions& o) { o.probe_coexisting_response = true; }), PointModel::kFull);
  EXPECT_EQ(used([](PointOptions& o) { o.history.columns = {HistoryColumn::kMeshForce}; }),
            PointModel::kFull);
  EXPECT_EQ(used([&](PointOptions& o) { o.carried_state = carried_from(neighbour); }),
            PointModel::kFull);
  EXPECT_EQ(used([](PointOptions& o) { o.model = PointModel::kFull; }), PointModel::kFull);
}

TEST(ModelChoice, CurvesFollowTheirBranchWithTheFullModel) {
  SweepOptions options;
  options.point.tolerance = 1e-2;
  for (const SweepDirection direction : {SweepDirection::kUp, SweepDirection::kDown}) {
    options.direction = direction;
    for (const SweepPoint& point : sweep_speed(
             reference_scene(), {3 / 3.6, 67.5 / 3.6, 69 / 3.6, 72.5 / 3.6}, 0, options, {})) {
      ASSERT_TRUE(point.result.has_value());
      EXPECT_EQ(point.result->model, PointModel::kFull);
      const double speed = point.vehicle_speed * 3.6;
      // Between the folds the branch is that of the direction.
      if (speed > 66 && speed < 71) {
        EXPECT_EQ(point.result->contact_loss, direction == SweepDirection::kDown);
      }
    }
  }
}

TEST(ModelChoice, FiguresForScreeningAreThoseOfTheWholeResultAndTheSameBitsInCompany) {
  const Scene thin = reference_scene(1, 90), thick = reference_scene(2, 20);
  const auto shared = std::make_shared<PreparedGearSet>(thin.gear_set, thin.solid, thin.options);
  PreparedScene first(thick, shared), second(thin, shared);
  for (const double speed : {1.0, 2.0, 4.0}) {
    SCOPED_TRACE(speed);
    PointOptions options;
    options.tolerance = 2e-3;
    screen_point(first, cruise(speed), options);
    const PointFigures company = screen_point(second, cruise(speed), options);
    PreparedScene lonely(thin);
    const PointFigures alone = screen_point(lonely, cruise(speed), options);
    const PointResult whole = solve_operating_point(thin, cruise(speed), options);
    EXPECT_EQ(company.model, PointModel::kQuasiStatic);
    EXPECT_EQ(whole.model, PointModel::kQuasiStatic);
    EXPECT_EQ(alone.inefficiency_rms, company.inefficiency_rms);
    EXPECT_EQ(alone.pinion_torque, company.pinion_torque);
    EXPECT_EQ(alone.dte_minimum, company.dte_minimum);
    EXPECT_EQ(alone.estimated_relative_error, company.estimated_relative_error);
    EXPECT_EQ(alone.contact_solutions, company.contact_solutions);
    EXPECT_EQ(alone.dte_maximum, whole.dynamic_transmission_error.maximum);
    EXPECT_EQ(alone.pinion_torque, whole.pinion_torque);
    EXPECT_NEAR(alone.inefficiency_rms.value(), whole.inefficiency_rms.value(),
                1e-12 * alone.inefficiency_rms.value());
  }
  const PointFigures unsure =
      solve_point_figures(second, cruise(72.5), pinned(PointModel::kQuasiStatic));
  EXPECT_EQ(unsure.model, PointModel::kQuasiStatic);
  EXPECT_FALSE(unsure.estimated_relative_error.has_value());
}

// Friction is where the time goes. A choice that does not fall on the cheaper model costs none.
TEST(ModelChoice, FrictionEvaluationsArePaidOnlyWhereTheCheaperModelIsLikelyToDo) {
  const Scene thermal = reference_scene();
  Scene isothermal = thermal, newtonian = thermal, dry = thermal;
  isothermal.options.isothermal = true;
  newtonian.options.newtonian = true;
  dry.options.no_boundary_friction = true;
  for (const Scene& scene : {thermal, isothermal, newtonian, dry}) {
    PreparedScene prepared(scene);
    for (const double speed : {0.5, 1.0}) {
      const PointFigures r = solve_point_figures(prepared, cruise(speed), {});
      EXPECT_EQ(r.model, PointModel::kQuasiStatic);
      EXPECT_LE(r.contact_solutions, 320);
      EXPECT_GT(r.contact_solutions, 100);
    }
    for (const double speed : {20.0, 45.0, 72.5, 100.0, 140.0}) {
      const PointFigures automatic = solve_point_figures(prepared, cruise(speed), {});
      const PointFigures full =
          solve_point_figures(prepared, cruise(speed), pinned(PointModel::kFull));
      EXPECT_EQ(automatic.model, PointModel::kFull);
      EXPECT_EQ(automatic.contact_solutions, full.contact_solutions);
      EXPECT_EQ(automatic.inefficiency_rms, full.inefficiency_rms);
    }
  }
}

}  // namespace
}  // namespace tribodyn
