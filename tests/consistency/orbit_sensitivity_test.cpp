// Derivatives of an orbit's figures against central differences of orbits on the same grid, by the
// same method and on the same branch.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <memory>
#include <optional>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "core/contact/hertz.h"
#include "core/periodic/orbit_solver.h"
#include "core/periodic/steady_state.h"
#include "core/refusal.h"
#include "core/study/operating_point.h"
#include "core/study/operating_target.h"
#include "core/study/orbit_record.h"
#include "core/study/speed_sweep.h"
#include "tests/support/cruise.h"
#include "tests/support/random_place.h"
#include "tests/support/reference_scene.h"
#include "tests/support/run_length.h"

namespace tribodyn {
namespace {

using OrbitFigureValues = std::array<double, kOrbitFigures>;

/// A scene with the speed and the torques of a point.
struct DifferentiatedPlace {
  Scene scene;
  OperatingTarget target;
};

/// Where parameters stand in a place, with the columns of OrbitSensitivity that they are.
struct PlacedParameter {
  double* at;
  std::vector<int> columns;
};

std::vector<PlacedParameter> parameters_of(DifferentiatedPlace& place) {
  Scene& s = place.scene;
  Lubricant& l = s.lubricant;
  std::vector<PlacedParameter> out;
  for (double* at :
       {&l.vogel_viscosity_prefactor, &l.vogel_temperature_coefficient,
        &l.vogel_reference_temperature, &l.pressure_viscosity_coefficient,
        &l.pressure_viscosity_temperature, &l.relaxation_time, &l.havriliak_negami_alpha,
        &l.havriliak_negami_beta, &l.rheology_reference_temperature,
        &l.limiting_shear_stress_at_zero_pressure, &l.limiting_shear_stress_coefficient,
        &l.thermal_conductivity, &l.density_at_zero_kelvin, &l.density_temperature_slope}) {
    out.push_back({at, {static_cast<int>(out.size())}});
  }
  int column = static_cast<int>(ContactInput::kAsperityDensity);
  for (double* at : {&s.roughness.asperity_density, &s.roughness.asperity_radius,
                     &s.roughness.composite_rms_height, &s.boundary.tribofilm_shear_strength,
                     &s.boundary.asperity_friction_coefficient}) {
    out.push_back({at, {column++}});
  }
  for (double* at :
       {&s.solid.youngs_modulus, &s.solid.poissons_ratio, &s.solid.thermal_conductivity,
        &s.solid.density, &s.solid.specific_heat_capacity}) {
    out.push_back({at, {column, column + 5}});  // of both bodies
    ++column;
  }
  const int bath = static_cast<int>(ContactInput::kBathTemperature);
  out.push_back({&s.sump_temperature, {bath}});
  out.push_back({&s.inlet_temperature_rise, {bath + 1}});
  Torques& torques = place.target.torques;
  out.push_back({place.target.solve_wheel_torque ? &torques.pinion : &torques.wheel,
                 {kKnownTorqueParameter}});
  out.push_back({&place.target.mean_pinion_speed, {kMeanSpeedParameter}});
  return out;
}

/// One grid on which the orbit of a place is solved for.
struct OrbitOnGrid {
  OrbitOnGrid(const DifferentiatedPlace& of, int steps, bool in_contact)
      : place(of),
        scene(place.scene),
        mesh(scene.gear_set),
        contacts(FlankContactModel(scene.lubricant, scene.solid, scene.roughness, scene.boundary,
                                   scene.sump_temperature, scene.inlet_temperature_rise,
                                   scene.options)),
        system(mesh, scene.gear_set.dynamics, scene.options),
        grids(mesh, scene.gear_set.dynamics.half_backlash,
              reduced_modulus(scene.solid.youngs_modulus, scene.solid.poissons_ratio),
              scene.options),
        grid(grids.with_steps(steps)),
        problem{system,
                contacts,
                grids,
                tally,
                place.target.torques,
                place.target.mean_pinion_speed,
                place.target.solve_wheel_torque,
                1e-5,
                {}},
        solver(problem, work) {
    options.bilateral_contact = in_contact;
  }

  /// From the state of a point.
  bool find(const PointResult& point, PeriodicOrbit& orbit) {
    orbit.torques = {point.pinion_torque, point.wheel_torque};
    orbit.period = point.period_in_mesh_cycles;
    system.to_march(point.section_state, orbit.state.data());
    const bool near = options.bilateral_contact && orbit.period == 1
                          ? solver.solve_without_friction(grid, options, orbit)
                          : solver.march_one_period(grid, options, orbit);
    return near && settle(orbit);
  }
  /// From the orbit of a place beside.
  bool follow(PeriodicOrbit& orbit) {
    (problem.solve_wheel_torque ? orbit.torques.pinion : orbit.torques.wheel) =
        problem.solve_wheel_torque ? place.target.torques.pinion : place.target.torques.wheel;
    orbit.jacobian.reset();
    return settle(orbit);
  }
  /// Until friction and motion move no more than rounding lets them.
  bool settle(PeriodicOrbit& orbit) {
    bool settled = false;
    for (const double tolerance : {1e-6, 1e-9, 1e-10, 1e-10}) {
      PeriodicOrbit next = orbit;
      options.tolerance = tolerance;
      if (!solver.solve(grid, options, next)) break;
      orbit = std::move(next);
      settled = tolerance <= 1e-9;
    }
    return settled;
  }

  std::optional<OrbitFigureValues> figures(const PeriodicOrbit& orbit) {
    PointResult r;
    r.mean_pinion_speed = place.target.mean_pinion_speed;
    const SolvedPieces solved =
        solved_pieces(system, grid, orbit.pieces, *orbit.contacts, contacts.model());
    ResponseRecord record(1, contacts.model());
    record_orbit(system, orbit, solved, record);
    record.fill(orbit.torques, orbit.period, true, r);
    if (!r.inefficiency_rms) return std::nullopt;
    return OrbitFigureValues{*r.inefficiency_rms,
                             *r.inefficiency_energy_mean,
                             r.mesh_loss_power,
                             r.mesh_loss_torque,
                             r.pinion_friction_torque.mean,
                             r.film_ratio.mean,
                             r.contact_temperature.mean,
                             r.dynamic_transmission_error.minimum,
                             r.dynamic_transmission_error.maximum};
  }

  DifferentiatedPlace place;
  const Scene& scene;
  MeshData mesh;
  FlankContactBatch contacts;
  GearPairSystem system;
  MeshGrids grids;
  const MeshGrid& grid;
  ContactTally tally;
  SolverWork work;
  PeriodicProblem problem;
  OrbitSolver solver;
  ShootingOptions options;
};

/// By parameter and figure; of the extremes of the transmission error by the larger one.
using OrbitElasticities = std::vector<OrbitFigureValues>;

OrbitFigureValues figure_sizes_of(const OrbitFigureValues& f) {
  OrbitFigureValues out = f;
  constexpr auto kMinimum = static_cast<std::size_t>(OrbitFigure::kTransmissionErrorMinimum);
  constexpr auto kMaximum = static_cast<std::size_t>(OrbitFigure::kTransmissionErrorMaximum);
  out[kMinimum] = out[kMaximum] = std::max(std::abs(f[kMinimum]), std::abs(f[kMaximum]));
  return out;
}

struct ElasticityComparison {
  bool one_sided = false;
  OrbitElasticities found, expected;
  double largest_error() const {
    double largest = 0;
    for (std::size_t p = 0; p < found.size(); ++p) {
      for (int f = 0; f < kOrbitFigures; ++f) {
        largest = std::max(largest, std::abs(found[p][f] - expected[p][f]));
      }
    }
    return largest;
  }
  /// The elasticities of one parameter and figure that are farthest from each other.
  std::string worst() const {
    std::string out;
    double largest = -1;
    for (std::size_t p = 0; p < found.size(); ++p) {
      for (int f = 0; f < kOrbitFigures; ++f) {
        if (!(std::abs(found[p][f] - expected[p][f]) > largest)) continue;
        largest = std::abs(found[p][f] - expected[p][f]);
        out = "parameter " + std::to_string(p) + ", figure " + std::to_string(f) + ": " +
              std::to_string(found[p][f]) + ", by differences " + std::to_string(expected[p][f]);
      }
    }
    return out;
  }
};

/// Nothing where the orbit, or one beside it, is not found on the grid, or has no derivatives.
std::optional<ElasticityComparison> compare_elasticities(const DifferentiatedPlace& at,
                                                         const PointResult& point, int steps,
                                                         double relative_step) {
  OrbitOnGrid bench(at, steps, !point.contact_loss);
  PeriodicOrbit orbit;
  if (!bench.find(point, orbit)) return std::nullopt;
  const auto base = bench.figures(orbit);
  const auto sensitivity = orbit_sensitivity(bench.problem, orbit);
  if (!base || !sensitivity) return std::nullopt;
  ElasticityComparison out;
  out.one_sided = sensitivity->one_sided;
  const OrbitFigureValues size = figure_sizes_of(*base);
  for (int f = 0; f < kOrbitFigures; ++f) {
    EXPECT_NEAR(sensitivity->figure[f], (*base)[f], 1e-7 * std::abs(size[f])) << f;
  }
  DifferentiatedPlace copy = at;
  const std::size_t count = parameters_of(copy).size();
  for (std::size_t p = 0; p < count; ++p) {
    // Two central differences, extrapolated to a step of 0.
    OrbitFigureValues difference[2];
    const PlacedParameter original = parameters_of(copy)[p];
    if (*original.at == 0) continue;
    for (const int half : {0, 1}) {
      const double step = half == 0 ? relative_step : relative_step / 2;
      OrbitFigureValues ends[2];
      for (const int side : {0, 1}) {
        DifferentiatedPlace beside = at;
        *parameters_of(beside)[p].at *= 1 + (side == 0 ? -step : step);
        OrbitOnGrid other(beside, steps, !point.contact_loss);
        PeriodicOrbit moved = orbit;
        if (!other.follow(moved)) return std::nullopt;
        const auto figures = other.figures(moved);
        if (!figures) return std::nullopt;
        ends[side] = *figures;
      }
      for (int f = 0; f < kOrbitFigures; ++f) {
        difference[half][f] = (ends[1][f] - ends[0][f]) / (2 * step * size[f]);
      }
    }
    OrbitFigureValues found{}, expected{};
    for (int f = 0; f < kOrbitFigures; ++f) {
      for (const int column : original.columns) {
        found[f] += sensitivity->derivative[f][column] * *original.at / size[f];
      }
      expected[f] = (4 * difference[1][f] - difference[0][f]) / 3;
    }
    out.found.push_back(found);
    out.expected.push_back(expected);
  }
  return out;
}

/// Random points, of those that lose contact or of those that do not, and what they are held to.
struct RandomPoints {
  bool lose_contact;
  unsigned seed;
  double least_speed, greatest_speed;  ///< [km/h]
  int steps;                           ///< a mesh cycle
  double relative_step;                ///< of the differences
  double allowed_error;                ///< of elasticities, absolute
  int count;
};

void compare_random_points(const RandomPoints& points) {
  std::mt19937_64 random(points.seed);
  int compared = 0, tried = 0, left_out = 0;
  double largest = 0;
  while (compared < points.count && tried < 200 * points.count) {
    ++tried;
    const double speed =
        std::uniform_real_distribution<double>(points.least_speed, points.greatest_speed)(random);
    const RandomPlace place = random_place(random, speed);
    PointOptions options;
    options.model = PointModel::kFull;
    options.method = SteadyStateMethod::kShooting;
    try {
      const PointResult point = solve_operating_point(place.scene, place.condition, options);
      if (point.contact_loss != points.lose_contact) continue;
      const auto comparison =
          compare_elasticities({place.scene, target_of(place.scene, place.condition)}, point,
                               points.steps, points.relative_step);
      if (!comparison || comparison->one_sided) {
        ++left_out;
        continue;
      }
      ++compared;
      largest = std::max(largest, comparison->largest_error());
      EXPECT_LT(comparison->largest_error(), points.allowed_error)
          << "try " << tried << " at " << speed << " km/h: " << comparison->worst();
    } catch (const Refusal&) {
    }
  }
  std::cout << compared << " of " << tried << " points compared, largest error " << largest << ", "
            << left_out << " left out: an orbit beside is not found, or an event is at its edge\n";
  EXPECT_EQ(compared, points.count);
  EXPECT_LE(left_out, std::max(2, points.count / 3));
}

// Larger steps pass kinks of the response at 6 of the 200 points of a full run: at 4e-4 their
// differences err by up to 4e-5, below 2e-4 they agree.
TEST(OrbitSensitivity, IsThatOfDifferencesAtSmoothPoints) {
  compare_random_points({false, 11, 10, 160, 48, 1e-4, 1e-5,
                         full_run()  ? 200
                         : kShortRun ? 1
                                     : 10});
}

// Steps of 1e-4 take an event past a node of the grid at some of the 100 points of a full run, and
// their differences then err by up to 1.2e-3.
TEST(OrbitSensitivity, IsThatOfDifferencesWhereFlanksPart) {
  compare_random_points({true, 12, 20, 160, 192, 2e-5, 1e-3, full_run() ? 100 : kShortRun ? 1 : 6});
}

// Where friction decides most of the response: half of the mesh's resonance, coast, and the options
// that move its arms.
TEST(OrbitSensitivity, HoldsInEveryModeOfTheModel) {
  const auto largest_error = [](const Scene& scene, const OperatingCondition& condition) {
    PointOptions options;
    options.model = PointModel::kFull;
    const PointResult point = solve_operating_point(scene, condition, options);
    const auto comparison =
        compare_elasticities({scene, target_of(scene, condition)}, point, 48, 4e-4);
    return comparison ? comparison->largest_error() : 1;
  };
  Scene scene = reference_scene();
  EXPECT_LT(largest_error(scene, cruise(37.5)), 1e-5);
  EXPECT_LT(largest_error(scene, prescribed(-30, 300)), 1e-5);
  if (kShortRun) return;
  scene.options.energy_consistent = scene.options.subtract_contact_point_motion = true;
  EXPECT_LT(largest_error(scene, cruise(100)), 1e-5);
  scene.options.tabulated_friction_arms = true;
  EXPECT_LT(largest_error(scene, prescribed(40, 230)), 1e-5);
}

TEST(PointSensitivities, AreThoseOfTheWholePoint) {
  const Scene scene = reference_scene();
  PointOptions options;
  options.model = PointModel::kFull;
  options.tolerance = 1e-7;
  const auto at = [&](double kilometres_per_hour) {
    return solve_operating_point(scene, cruise(kilometres_per_hour), options);
  };
  constexpr double kStep = 0.1;  // [km/h]: truncation 1e-6
  const PointResult below = at(100 - kStep), above = at(100 + kStep);
  options.sensitivities = true;
  const PointResult point = at(100);
  ASSERT_TRUE(point.sensitivities.has_value());
  const PointSensitivities& s = *point.sensitivities;
  std::set<std::string> names;
  for (const ParameterSensitivity& each : s.parameters) names.insert(each.parameter);
  EXPECT_EQ(names.size(), 28U);
  EXPECT_EQ(names.size(), s.parameters.size());
  const auto by_speed =
      std::find_if(s.parameters.begin(), s.parameters.end(),
                   [](const auto& each) { return each.parameter == "vehicle_speed"; });
  ASSERT_NE(by_speed, s.parameters.end());
  const double relative_step = kStep / 100;
  const auto difference = [&](double low, double high, double value) {
    return (high - low) / (2 * relative_step * value);
  };
  EXPECT_NEAR(s.elasticity(*by_speed, OrbitFigure::kInefficiencyRms),
              difference(*below.inefficiency_rms, *above.inefficiency_rms, *point.inefficiency_rms),
              1e-4);
  EXPECT_NEAR(s.elasticity(*by_speed, OrbitFigure::kMeshLossPower),
              difference(below.mesh_loss_power, above.mesh_loss_power, point.mesh_loss_power),
              1e-4);
  EXPECT_NEAR(s.figure[static_cast<std::size_t>(OrbitFigure::kFilmRatio)], point.film_ratio.mean,
              1e-6 * point.film_ratio.mean);
}

TEST(PointSensitivities, AreThoseOfTheWholePointWhereFlanksPart) {
  const Scene scene = reference_scene();
  PointOptions options;
  options.tolerance = 1e-6;
  options.sensitivities = true;
  const PointResult point = solve_operating_point(scene, cruise(75), options);
  ASSERT_TRUE(point.contact_loss);
  ASSERT_TRUE(point.sensitivities.has_value());
  options.sensitivities = false;
  constexpr double kStep = 1e-2;  // relative
  const auto with = [&](double factor) {
    Scene other = scene;
    other.lubricant.limiting_shear_stress_coefficient *= factor;
    return *solve_operating_point(other, cruise(75), options).inefficiency_energy_mean;
  };
  const double difference =
      std::log(with(1 + kStep) / with(1 - kStep)) / std::log((1 + kStep) / (1 - kStep));
  for (const ParameterSensitivity& each : point.sensitivities->parameters) {
    if (each.parameter != "lubricant.limiting_shear_stress_coefficient") continue;
    EXPECT_NEAR(point.sensitivities->elasticity(each, OrbitFigure::kInefficiencyEnergyMean),
                difference, 1e-3);
  }
}

TEST(PointSensitivities, ChangeNothingElseAndAreTheFullModels) {
  PointOptions options;
  options.model = PointModel::kFull;
  const PointResult plain = solve_operating_point(reference_scene(), cruise(90), options);
  EXPECT_FALSE(plain.sensitivities.has_value());
  options.model = PointModel::kAutomatic;
  options.sensitivities = true;
  const PointResult with = solve_operating_point(reference_scene(), cruise(90), options);
  EXPECT_TRUE(with.sensitivities.has_value());
  EXPECT_EQ(with.inefficiency_rms, plain.inefficiency_rms);
  EXPECT_EQ(with.power_balance.stored, plain.power_balance.stored);
  const PointResult slow = solve_operating_point(reference_scene(), cruise(2), options);
  EXPECT_EQ(slow.model, PointModel::kFull);
  EXPECT_TRUE(slow.sensitivities.has_value());
}

TEST(SweepSensitivities, AreThoseOfThePointsOnTheBranchThatIsFollowed) {
  const Scene scene = reference_scene();
  SweepOptions options;
  options.point.tolerance = 1e-6;
  options.point.sensitivities = true;
  const std::vector<double> speeds{30 / 3.6, 60 / 3.6, 70 / 3.6, 75 / 3.6, 100 / 3.6};
  const std::vector<SweepPoint> curve = sweep_speed(scene, speeds, 0, options);
  PointOptions point = options.point;
  point.model = PointModel::kFull;
  for (const SweepPoint& each : curve) {
    const double speed = 3.6 * each.vehicle_speed;
    OperatingCondition condition = cruise(speed);
    condition.vehicle_speed = each.vehicle_speed;  // to the last bit
    ASSERT_TRUE(each.result && each.result->sensitivities) << speed;
    const auto& parameters = each.result->sensitivities->parameters;
    // From a start of its own, on the same branch: up to the errors of both solutions.
    PointOptions alone = point;
    alone.carried_state.reset();
    const PointResult own = solve_operating_point(scene, condition, alone);
    ASSERT_EQ(own.contact_loss, each.result->contact_loss) << speed;
    ASSERT_EQ(own.sensitivities->parameters.size(), parameters.size());
    for (std::size_t i = 0; i < parameters.size(); ++i) {
      for (int f = 0; f < kOrbitFigures; ++f) {
        const auto figure = static_cast<OrbitFigure>(f);
        EXPECT_NEAR(own.sensitivities->elasticity(own.sensitivities->parameters[i], figure),
                    each.result->sensitivities->elasticity(parameters[i], figure),
                    options.point.tolerance)
            << parameters[i].parameter << " at " << speed;
      }
    }
  }
}

// The quiet response ends between 71.4 and 71.5 km/h.
TEST(SweepSensitivities, AreThoseOfEachSideOfAJumpAndMoveNoEndOfABranch) {
  const Scene scene = reference_scene();
  const std::vector<double> speeds{70.6 / 3.6, 71.2 / 3.6, 71.5 / 3.6};
  SweepOptions options;
  const std::vector<SweepPoint> plain = sweep_speed(scene, speeds, 0, options);
  options.point.sensitivities = true;
  const std::vector<SweepPoint> curve = sweep_speed(scene, speeds, 0, options);
  ASSERT_TRUE(plain[2].branch_end && curve[2].branch_end);
  EXPECT_EQ(curve[2].branch_end->followed_to, plain[2].branch_end->followed_to);
  EXPECT_EQ(curve[2].branch_end->gone_at, plain[2].branch_end->gone_at);
  EXPECT_FALSE(curve[1].branch_end);
  EXPECT_GT(plain[2].contact_solutions_of_search, 0);
  EXPECT_EQ(plain[1].contact_solutions_of_search, 0);
  for (std::size_t i = 0; i < speeds.size(); ++i) {
    ASSERT_TRUE(curve[i].result && curve[i].result->sensitivities) << i;
    EXPECT_EQ(curve[i].result->contact_loss, i == 2) << "quiet before the jump, loud after it";
    EXPECT_EQ(curve[i].result->inefficiency_rms, plain[i].result->inefficiency_rms);
  }
  PointOptions loud = options.point;
  loud.start = PointStart::kLargeVibration;
  OperatingCondition beyond = cruise(71.5);
  beyond.vehicle_speed = speeds[2];
  const PointResult alone = solve_operating_point(scene, beyond, loud);
  ASSERT_TRUE(alone.sensitivities && alone.contact_loss);
  const PointSensitivities& found = *curve[2].result->sensitivities;
  for (std::size_t i = 0; i < found.parameters.size(); ++i) {
    EXPECT_NEAR(found.elasticity(found.parameters[i], OrbitFigure::kInefficiencyRms),
                alone.sensitivities->elasticity(alone.sensitivities->parameters[i],
                                                OrbitFigure::kInefficiencyRms),
                1e-2)
        << found.parameters[i].parameter;
  }
}

TEST(SweepSensitivities, AreAbsentWithTheirCauseWhereAPointHasNone) {
  SweepOptions options;
  options.point.sensitivities = true;
  options.point.method = SteadyStateMethod::kMarch;
  options.point.tolerance = 1e-2;
  for (const SweepPoint& each : sweep_speed(reference_scene(), {90 / 3.6, 100 / 3.6}, 0, options)) {
    ASSERT_TRUE(each.result.has_value());
    EXPECT_FALSE(each.result->sensitivities.has_value());
    EXPECT_TRUE(std::ranges::any_of(each.result->warnings, [](const RangeWarning& warning) {
      return warning.code == "NO_SENSITIVITIES" &&
             warning.sentence.find("marched") != std::string::npos;
    }));
  }
}

TEST(PointSensitivities, AreAbsentWithTheirCauseWhereThePointIsMarchedOrQuasiStatic) {
  const auto expect_none = [](const PointOptions& options, double kilometres_per_hour,
                              const std::string& cause) {
    const PointResult r =
        solve_operating_point(reference_scene(), cruise(kilometres_per_hour), options);
    EXPECT_FALSE(r.sensitivities.has_value());
    EXPECT_TRUE(std::any_of(r.warnings.begin(), r.warnings.end(), [&](const RangeWarning& w) {
      return w.code == "NO_SENSITIVITIES" && w.sentence.find(cause) != std::string::npos;
    })) << cause;
  };
  PointOptions options;
  options.sensitivities = true;
  options.model = PointModel::kQuasiStatic;
  expect_none(options, 100, "quasi-static model");
  options.model = PointModel::kFull;
  options.method = SteadyStateMethod::kMarch;
  options.tolerance = 1e-2;
  expect_none(options, 100, "marched");
}

}  // namespace
}  // namespace tribodyn
