#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <iostream>
#include <numbers>
#include <string>

#include "core/integrate/mesh_cycle_march.h"
#include "core/study/operating_point.h"
#include "tests/consistency/contact_case.h"
#include "tests/support/cruise.h"
#include "tests/support/run_length.h"

// What the kinematics and the power of the gear pair must add up to, by formulas of the test's own.
namespace tribodyn {
namespace {

/// A system with all that it refers to.
struct Bench {
  Scene scene;
  MeshData mesh;
  FlankContactModel contact;
  GearPairSystem system;
  ContactTally tally;
  ContactSolver contacts;

  explicit Bench(const Scene& of)
      : scene(of),
        mesh(scene.gear_set),
        contact(scene.lubricant, scene.solid, scene.roughness, scene.boundary,
                scene.sump_temperature, scene.inlet_temperature_rise, scene.options),
        system(mesh, scene.gear_set.dynamics, scene.options),
        contacts(contact, tally) {}
  Bench(const Bench&) = delete;
  Bench& operator=(const Bench&) = delete;
};

double value_of(const FourierSeries& s, double theta) {
  double sum = s.mean;
  for (std::size_t i = 0; i < s.sine.size(); ++i) {
    const double angle = static_cast<double>(i + 1) * theta;
    sum += s.sine[i] * std::sin(angle) + s.cosine[i] * std::cos(angle);
  }
  return sum;
}

/// Mean-free part of the integral over phi, theta = teeth phi.
double ripple_integral(const FourierSeries& s, double theta, int teeth) {
  double sum = 0;
  for (std::size_t i = 0; i < s.sine.size(); ++i) {
    const double order = static_cast<double>(i + 1);
    sum += (s.cosine[i] * std::sin(order * theta) - s.sine[i] * std::cos(order * theta)) /
           (order * teeth);
  }
  return sum;
}

/// Eq 6 in closed form.
double transmission_error(const GearSet& set, double phase, double approach) {
  const double theta_p = 2 * std::numbers::pi * phase;
  const double mean_gear_radius =
      set.series.pinion_contact_radius.mean * set.gear_teeth / set.pinion_teeth;
  const double theta_g = theta_p - set.gear_teeth * approach / mean_gear_radius;
  return set.dynamics.half_backlash + approach +
         ripple_integral(set.series.pinion_contact_radius, theta_p, set.pinion_teeth) -
         ripple_integral(set.series.gear_contact_radius, theta_g, set.gear_teeth) -
         value_of(set.series.static_transmission_error, theta_p);
}

/// Kinetic and elastic energy at a mesh phase.
double stored_energy(const GearSet& set, double phase, const double* y) {
  const DrivelineDynamics& d = set.dynamics;
  const double x = transmission_error(set, phase, y[kMeshApproach]);
  const double b = d.half_backlash;
  const double f = x > b ? x - b : x < -b ? x + b : 0;
  const double stiffness = value_of(set.series.mesh_stiffness, 2 * std::numbers::pi * phase);
  const auto half_square = [](double factor, double v) { return 0.5 * factor * v * v; };
  return half_square(d.pinion_shaft_inertia, y[kPinionShaftSpeed]) +
         half_square(d.pinion_inertia, y[kPinionSpeed]) +
         half_square(d.gear_inertia, y[kGearSpeed]) + half_square(d.wheel_inertia, y[kWheelSpeed]) +
         half_square(d.pinion_shaft_stiffness, y[kPinionShaftTwist]) +
         half_square(d.gear_shaft_stiffness, y[kGearShaftTwist]) + half_square(stiffness, f);
}

TEST(FlankMotionIdentities, FrictionArmsTakeExactlyTheSlidingPower) {
  Draw draw(71);
  SCOPED_TRACE(draw.seed());
  double worst = 0;
  for (int i = 0; i < 100 * kRandomStates; ++i) {
    FlankKinematics k{};
    k.pinion_velocity_x = draw.signed_log_between(1e-6, 1);
    k.pinion_velocity_y = draw.signed_log_between(1e-6, 1);
    k.gear_velocity_x = draw.signed_log_between(1e-6, 1);
    k.gear_velocity_y = draw.signed_log_between(1e-6, 1);
    const double pinion_speed = draw.signed_log_between(1e-3, 2e3);  // backwards as well
    const double gear_speed = draw.signed_log_between(1e-3, 2e3);
    const FlankMotion m = flank_motion(k, pinion_speed, gear_speed);
    const double power_per_newton =
        m.pinion_friction_arm * pinion_speed + m.gear_friction_arm * gear_speed;
    const double terms =
        std::abs(m.pinion_x) + std::abs(m.pinion_y) + std::abs(m.gear_x) + std::abs(m.gear_y);
    worst = std::max(worst, std::abs(power_per_newton + m.sliding_speed) / terms);
    EXPECT_GE(m.sliding_speed, 0);
  }
  std::cout << "r_p w_p + r_g w_g + V_s: " << worst << " of its terms\n";
  EXPECT_LT(worst, 1e-15);
}

TEST(FlankMotionIdentities, NothingSlidesInPureRolling) {
  FlankKinematics k{};
  k.pinion_velocity_x = 0.02;
  k.gear_velocity_x = 0.04;
  const FlankMotion m = flank_motion(k, 200, 100);
  EXPECT_EQ(m.sliding_speed, 0);
  EXPECT_EQ(m.pinion_friction_arm, 0);
  EXPECT_EQ(m.gear_friction_arm, 0);
}

TEST(FlankMotionIdentities, DerivedArmsAreThoseOfTheTablesAtTheNominalRatio) {
  const Bench bench(reference_scene());
  const GearSet& set = bench.scene.gear_set;
  // At the samples; between them a straight line of arms is not the arm of straight velocities.
  double at_samples = 0, between = 0;
  std::array<FlankKinematics, kFlankPairs> flanks;
  for (int interval = 0; interval < bench.mesh.intervals(); ++interval) {
    for (const double inside : {0.0, 0.5, 1.0}) {
      double& worst = inside == 0.5 ? between : at_samples;
      bench.mesh.flanks(interval, (interval + inside) / bench.mesh.intervals(), flanks);
      for (const FlankKinematics& k : flanks) {
        if (!(k.load_share > 0)) continue;
        const double speed = 300;
        const FlankMotion m = flank_motion(k, speed, speed * set.pinion_teeth / set.gear_teeth);
        worst = std::max({worst, std::abs(m.pinion_friction_arm - k.pinion_friction_arm),
                          std::abs(m.gear_friction_arm - k.gear_friction_arm)});
      }
    }
  }
  std::cout << "derived arms: " << at_samples << " m from the tables, between samples " << between
            << " m\n";
  EXPECT_LT(at_samples, 3.3e-9);
  EXPECT_LT(between, 7e-8);
}

/// Series of so many random harmonics, falling.
FourierSeries random_series(Draw& draw, int harmonics) {
  FourierSeries s{draw.between(1, 2), {}, {}};
  for (int n = 1; n <= harmonics; ++n) {
    s.sine.push_back(draw.between(-1, 1) / n);
    s.cosine.push_back(draw.between(-1, 1) / n);
  }
  return s;
}

/// A sum's terms with their n-th factors `weight(n)`, at an angle; and what may be wrong with it.
struct Sum {
  double value = 0, doubt = 0;
};
template <class Weight>
Sum sum_of(const std::vector<double>& sine, const std::vector<double>& cosine, double theta,
           Weight&& weight) {
  Sum sum;
  for (std::size_t i = 0; i < sine.size(); ++i) {
    const double order = static_cast<double>(i + 1);
    sum.value +=
        weight(order) * (sine[i] * std::sin(order * theta) + cosine[i] * std::cos(order * theta));
    sum.doubt += std::abs(weight(order)) * (std::abs(sine[i]) + std::abs(cosine[i])) *
                 (2e-14 + 1e-15 * order * (1 + std::abs(theta)));
  }
  return sum;
}

// Expansions around even angles, where there are few harmonics; a lag leads out of the reach of
// one.
TEST(MeshFunctionIdentities, AreTheSeriesAtAnyAngleLagAndNumberOfHarmonics) {
  Draw draw(74);
  SCOPED_TRACE(draw.seed());
  for (const int harmonics : {0, 1, 8, 32, 33, 100}) {
    SCOPED_TRACE(harmonics);
    GearSet set = reference_scene().gear_set;
    MeshSeries& s = set.series;
    for (FourierSeries* series : {&s.pinion_contact_radius, &s.gear_contact_radius,
                                  &s.mesh_stiffness, &s.static_transmission_error}) {
      *series = random_series(draw, harmonics);
    }
    const MeshData mesh(set);
    const double pinion_teeth = set.pinion_teeth, gear_teeth = set.gear_teeth;
    for (int i = 0; i < kRandomStates; ++i) {
      const double theta = draw.between(-20, 20);
      const double lag = i % 2 == 0 ? draw.between(-0.05, 0.05) : draw.between(-5, 5);
      const MeshFunctions f = mesh.functions(theta, theta - lag);
      const auto expect = [&](double value, double mean, const Sum& sum) {
        EXPECT_NEAR(value, mean + sum.value, sum.doubt + 1e-15);
      };
      const auto one = [](double) { return 1.0; };
      const auto pinion_order = [&](double n) { return n * pinion_teeth; };
      const auto negative = [](std::vector<double> v) {
        for (double& x : v) x = -x;
        return v;
      };
      const auto plain = [&](const FourierSeries& of, double at) {
        return sum_of(of.sine, of.cosine, at, one);
      };
      const auto slope = [&](const FourierSeries& of) {
        return sum_of(negative(of.cosine), of.sine, theta, pinion_order);
      };
      const auto integral = [&](const FourierSeries& of, double at, double teeth) {
        return sum_of(of.cosine, negative(of.sine), at, [&](double n) { return 1 / (n * teeth); });
      };
      expect(f.pinion_contact_radius, s.pinion_contact_radius.mean,
             plain(s.pinion_contact_radius, theta));
      expect(f.gear_contact_radius, mesh.mean_gear_contact_radius(),
             plain(s.gear_contact_radius, theta - lag));
      expect(f.mesh_stiffness, s.mesh_stiffness.mean, plain(s.mesh_stiffness, theta));
      expect(f.mesh_stiffness_slope, 0, slope(s.mesh_stiffness));
      expect(f.static_transmission_error, s.static_transmission_error.mean,
             plain(s.static_transmission_error, theta));
      expect(f.static_transmission_error_slope, 0, slope(s.static_transmission_error));
      const Sum pinion = integral(s.pinion_contact_radius, theta, pinion_teeth);
      const Sum gear = integral(s.gear_contact_radius, theta - lag, gear_teeth);
      expect(f.radius_integral, 0, {pinion.value - gear.value, pinion.doubt + gear.doubt});
    }
    const MeshFunctions nowhere = mesh.functions(std::nan(""), 0);
    EXPECT_TRUE(harmonics == 0 || std::isnan(nowhere.mesh_stiffness));
  }
}

TEST(TransmissionErrorIdentities, ClosedFormIsThatOfTheSeries) {
  const Bench bench(reference_scene());
  Draw draw(72);
  SCOPED_TRACE(draw.seed());
  for (int i = 0; i < kRandomStates; ++i) {
    MarchState y{};
    const double phase = draw.between(0, 1);
    y[kMeshApproach] = draw.between(-200e-6, 200e-6);
    Instant at;
    bench.system.kinematics(phase, {}, y.data(), at);
    EXPECT_NEAR(at.transmission_error,
                transmission_error(bench.scene.gear_set, phase, y[kMeshApproach]),
                1e-18 + 1e-15 * 75e-6);
  }
}

// x depends on angles alone: along steady turning its eight-point derivative is xdot.
TEST(TransmissionErrorIdentities, VelocityIsTheDerivativeAlongTheMotion) {
  const Bench bench(reference_scene());
  Draw draw(73);
  SCOPED_TRACE(draw.seed());
  const double cycle = bench.system.cycle_angle();
  double worst = 0;
  for (int i = 0; i < kRandomStates; ++i) {
    MarchState y{};
    const double phase = draw.between(0.1, 0.9);
    y[kMeshApproach] = draw.between(-200e-6, 200e-6);
    y[kPinionSpeed] = draw.between(50, 600);
    y[kGearSpeed] = y[kPinionSpeed] * 13 / 36 * draw.between(0.98, 1.02);
    Instant at;
    bench.system.kinematics(phase, {}, y.data(), at);
    const double step = 1e-3 * cycle / y[kPinionSpeed];  // a thousandth of a mesh cycle
    const double approach_speed = bench.mesh.mean_pinion_contact_radius() * y[kPinionSpeed] -
                                  bench.mesh.mean_gear_contact_radius() * y[kGearSpeed];
    const auto x = [&](double time) {
      return transmission_error(bench.scene.gear_set, phase + time * y[kPinionSpeed] / cycle,
                                y[kMeshApproach] + time * approach_speed);
    };
    const auto difference = [&](double n) { return x(n * step) - x(-n * step); };
    const double slope = (4.0 / 5 * difference(1) - 1.0 / 5 * difference(2) +
                          4.0 / 105 * difference(3) - 1.0 / 280 * difference(4)) /
                         step;
    const double scale = bench.mesh.mean_pinion_contact_radius() * y[kPinionSpeed];
    worst = std::max(worst, std::abs(at.transmission_velocity - slope) / scale);
  }
  std::cout << "xdot: " << worst << " of R_p w_p from the derivative of x\n";
  EXPECT_LT(worst, 1e-12);
}

TEST(TransmissionErrorIdentities, AThousandCyclesOfTurningDoNotWindUp) {
  const Bench bench(reference_scene());
  for (const double phase : {0.0, 0.3, 0.71}) {
    MarchState y{};
    y[kMeshApproach] = 30e-6;
    Instant first, later;
    bench.system.kinematics(phase, {}, y.data(), first);
    bench.system.kinematics(phase + 1000, {}, y.data(), later);
    EXPECT_NEAR(later.transmission_error, first.transmission_error, 1e-15);
    EXPECT_NEAR(later.mesh.mesh_stiffness, first.mesh.mesh_stiffness, 1e-9 * 1e8);
  }
}

Torques torques_of(const PointResult& point) { return {point.pinion_torque, point.wheel_torque}; }

TEST(TransmissionErrorIdentities, MarchedCyclesDoNotWindUp) {
  Bench bench(reference_scene());
  const PointResult point = solve_operating_point(bench.scene, cruise(100), {});
  ASSERT_TRUE(point.settled);
  MarchState state{};
  bench.system.to_march(point.section_state, state.data());
  SectionPoint at = bench.system.at_section(state, torques_of(point));
  const MarchScales scales = march_scales(bench.system, at.torques, point.mean_pinion_speed);
  SolverWork work;
  const int cycles = full_run() ? 1000 : kShortRun ? 20 : 200;
  for (int i = 0; i < cycles; ++i) {
    march_mesh_cycle(bench.system, scales, {}, bench.contacts, at, work);
  }
  // The speed may drift with the torque's last digits, the flanks may not part from each other.
  EXPECT_NEAR(at.state[kMeshApproach], state[kMeshApproach], 1e-3 * scales.length);
}

/// Work of one march by term [J].
struct Works {
  double input, output, friction, shaft_damping, mesh_damping, stored, parametric;
  double residual() const {
    return input - output - friction - shaft_damping - mesh_damping - stored - parametric;
  }
};

/// Marches ten mesh cycles with all integrals. `disturb` may change the state first.
template <class Disturb>
Works works_of_ten_cycles(Bench& bench, const PointResult& point, Disturb disturb) {
  using Phases = MeshCycleSystem<true>;
  const Torques torques = torques_of(point);
  Phases::State y{};
  bench.system.to_march(point.section_state, y.data());
  disturb(y);
  ContactRegime regime = bench.system.regime_of(0, y.data());
  const MarchScales scales = march_scales(bench.system, torques, point.mean_pinion_speed);
  MarchOptions options;
  options.relative_tolerance = 1e-10;
  const double before = stored_energy(bench.scene.gear_set, 0, y.data());
  for (int cycle = 0; cycle < 10; ++cycle) {
    Phases phases(bench.system, torques, scales, regime, bench.contacts);
    DormandPrinceWithEvents<Phases> march(phases, options);
    double phase = 0;
    march.run(phase, y, 1.0);
    regime = phases.regime();
  }
  const Works works{point.pinion_torque * y[kPinionShaftAngle],
                    point.wheel_torque * y[kWheelAngle],
                    y[kLossWork],
                    y[kShaftDampingWork],
                    y[kMeshDampingWork],
                    stored_energy(bench.scene.gear_set, 0, y.data()) - before,
                    y[kParametricWork]};
  double by_flank = 0;
  for (int k = 0; k < kFlankPairs; ++k) {
    by_flank += y[kFlankViscousWork0 + k] + y[kFlankBoundaryWork0 + k];
  }
  EXPECT_NEAR(by_flank, works.friction, 1e-12 * works.friction);
  EXPECT_GT(works.mesh_damping, 0);
  return works;
}

struct PowerCase {
  double kilometres_per_hour;
  bool energy_consistent;
  bool vibro_impact;
};

class PowerBalanceIdentities : public testing::TestWithParam<PowerCase> {};

TEST_P(PowerBalanceIdentities, ClosesOverTenPeriodsAndInTransients) {
  const PowerCase p = GetParam();
  Scene scene = reference_scene();
  scene.options.energy_consistent = p.energy_consistent;
  Bench bench(scene);
  const PointResult point = solve_operating_point(scene, cruise(p.kilometres_per_hour), {});
  ASSERT_TRUE(point.settled);
  ASSERT_EQ(point.contact_loss, p.vibro_impact);

  const Works steady = works_of_ten_cycles(bench, point, [](auto&) {});
  std::cout << "steady: residual " << steady.residual() / steady.input << " of the input, stored "
            << steady.stored / steady.input << ", parametric " << steady.parametric / steady.input
            << "\n";
  EXPECT_NEAR(steady.residual(), 0, 1e-8 * steady.input);
  EXPECT_NEAR(steady.stored, 0, 1e-4 * steady.input);

  const Works transient = works_of_ten_cycles(bench, point, [](auto& y) {
    y[kPinionSpeed] += 3;
    y[kWheelSpeed] -= 0.2;
  });
  std::cout << "transient: residual " << transient.residual() / transient.input
            << " of the input, stored " << transient.stored / transient.input << "\n";
  EXPECT_NEAR(transient.residual(), 0, 1e-8 * transient.input);
  EXPECT_GT(std::abs(transient.stored), 1e-3 * transient.input);

  if (p.energy_consistent) {
    EXPECT_EQ(steady.parametric, 0);
  } else {
    EXPECT_GT(std::abs(steady.parametric), 1e-6 * steady.input);
  }
}

TEST_P(PowerBalanceIdentities, ClosesInTheReportOfAPoint) {
  const PowerCase p = GetParam();
  Scene scene = reference_scene();
  scene.options.energy_consistent = p.energy_consistent;
  for (const SteadyStateMethod method :
       {SteadyStateMethod::kMarch, SteadyStateMethod::kAutomatic}) {
    PointOptions options;
    options.method = method;
    options.march_step_tolerance = kShortRun ? 1e-6 : 1e-8;
    const PointResult point = solve_operating_point(scene, cruise(p.kilometres_per_hour), options);
    const PowerBalance& w = point.power_balance;
    const double residual = w.input - w.output - w.friction - w.shaft_damping - w.mesh_damping -
                            w.stored - w.parametric;
    std::cout << "reported: residual " << residual / w.input << " of the input\n";
    const bool shot = method == SteadyStateMethod::kAutomatic;
    ASSERT_EQ(point.method == SteadyStateMethod::kShooting, shot);
    EXPECT_NEAR(
        residual, 0,
        (shot ? point.estimated_relative_error.value() : options.march_step_tolerance) * w.input);
    const double cycle_time = point.recorded_mesh_cycles / point.mesh_frequency;
    EXPECT_NEAR(w.input, point.input_power * cycle_time, 1e-12 * w.input);
    EXPECT_NEAR(w.friction, point.mesh_loss_power * cycle_time, 1e-12 * w.input);
  }
}

INSTANTIATE_TEST_SUITE_P(Points, PowerBalanceIdentities,
                         testing::Values(PowerCase{100, false, false}, PowerCase{100, true, false},
                                         PowerCase{72.5, false, true}, PowerCase{72.5, true, true}),
                         [](const testing::TestParamInfo<PowerCase>& point) {
                           return std::string(point.param.vibro_impact ? "VibroImpact" : "Smooth") +
                                  (point.param.energy_consistent ? "EnergyConsistent" : "Paper");
                         });

}  // namespace
}  // namespace tribodyn
