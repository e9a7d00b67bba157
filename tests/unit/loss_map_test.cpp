#include "core/study/loss_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <utility>
#include <vector>

#include "core/refusal.h"

namespace tribodyn {
namespace {

using Loss = std::function<double(const MapPlace&)>;

/// A model of known losses that counts what it is asked for.
struct Model {
  Loss loss;
  /// Whether the response takes long to find.
  std::function<bool(const MapPlace&)> is_hard = [](const MapPlace&) { return false; };
  double relative_solver_error = 0;
  Loss quasi_static = loss;
  int brief = 0, missed = 0, thorough = 0, quasi_static_points = 0;

  LossForces forces() {
    return [this](const std::vector<MapPlace>& places, LossEffort effort) {
      std::vector<std::optional<LossForce>> out;
      for (const MapPlace& place : places) {
        EXPECT_NE(place[1], 0) << "no torque takes no point";
        const bool is_quasi_static = effort == LossEffort::kQuasiStatic;
        const double force = (is_quasi_static ? quasi_static : loss)(place);
        ++(is_quasi_static                   ? quasi_static_points
           : effort == LossEffort::kThorough ? thorough
                                             : brief);
        if (effort == LossEffort::kBrief && is_hard(place)) {
          ++missed;
          out.push_back(std::nullopt);
        } else {
          out.push_back(LossForce{force, relative_solver_error * force});
        }
      }
      return out;
    };
  }
};

/// Readings of a speed from 1 to 38 m/s and a torque from `-most_torque` to `most_torque`, spread
/// over all of them without a period.
std::vector<MapReading> scattered_readings(int count, double most_torque = 400) {
  std::vector<MapReading> out;
  for (int i = 0; i < count; ++i) {
    const double turn = 0.6180339887 * i, other = 0.4142135624 * i;
    const double speed = 1 + 37 * (turn - std::floor(turn));
    out.push_back({{speed, most_torque * (2 * (other - std::floor(other)) - 1), 313}, speed});
  }
  return out;
}

double energy_of(const std::vector<MapReading>& readings, const Loss& loss) {
  double out = 0;
  for (const MapReading& each : readings) out += loss(each.place) * each.distance;
  return out;
}

/// Linear in torque but for a kink at 0, and a parabola in speed.
double simple_loss(const MapPlace& place) {
  return std::abs(place[1]) * (0.012 + 2e-4 * place[0] + 1e-5 * place[0] * place[0]);
}

/// With a resonance, and curved in torque.
double smooth_loss(const MapPlace& place) {
  const double resonance = (place[0] - 20) / 1.5;
  return std::abs(place[1]) * (0.012 + 2e-4 * place[0] + 1e-6 * place[1]) *
         (1 + 0.3 * std::exp(-resonance * resonance)) * (1 - 0.001 * (place[2] - 313));
}

/// With ripples that no large box follows.
double jagged_loss(const MapPlace& place) {
  return smooth_loss(place) * (1 + 0.2 * std::sin(3 * place[0]) * std::sin(0.05 * place[1]));
}

TEST(LossMap, IsExactForALossThatIsLinearInTorqueAndAParabolaInSpeed) {
  const std::vector<MapReading> readings = scattered_readings(5000);
  Model model{simple_loss};
  const MappedLoss map = map_losses(readings, model.forces());
  const double exact = energy_of(readings, simple_loss);
  EXPECT_NEAR(map.energy, exact, 1e-12 * exact);
  for (std::size_t i = 0; i < readings.size(); ++i) {
    EXPECT_NEAR(map.forces[i], simple_loss(readings[i].place), 1e-12);
  }
  EXPECT_LT(map.points, 500) << "the first boxes are enough";
}

TEST(LossMap, StatesHalfOfTheErrorThatLinearInterpolationWouldHave) {
  constexpr int kCount = 12'000;  // of even speeds; a thousand in each of the twelve first boxes
  std::vector<MapReading> readings;
  for (int i = 0; i <= kCount; ++i) readings.push_back({{12 + 12.0 * i / kCount, 100, 313}, 1});
  Model model{[](const MapPlace& place) { return place[0] * place[0]; }};
  const MappedLoss map = map_losses(readings, model.forces(), {0.1});
  EXPECT_NEAR(map.energy, energy_of(readings, model.loss), 1e-12 * map.energy);
  // Boxes are one wide: the error of linear interpolation is at most 1/4, and 1/6 in the mean.
  EXPECT_NEAR(map.map_error, kCount / 12.0, 1e-5 * kCount);
  EXPECT_EQ(map.points, 25);
}

TEST(LossMap, EnergyIsWithinTheStatedErrorOfThePointByPointIntegration) {
  for (const double last_sump : {313.0, 353.0}) {
    std::vector<MapReading> readings;
    for (int i = 0; i < 3000; ++i) {
      const double share = i / 2999.0;
      const double speed = 1 + 37 * std::abs(std::sin(7 * share));
      readings.push_back(
          {{speed, 400 * std::sin(31 * share), 313 + (last_sump - 313) * share}, speed});
    }
    const double exact = energy_of(readings, smooth_loss);
    for (const double tolerance : {1e-2, 2e-3}) {
      Model model{smooth_loss};
      const MappedLoss map = map_losses(readings, model.forces(), {tolerance, 100'000});
      EXPECT_LE(map.map_error, tolerance * map.energy);
      EXPECT_LE(std::abs(map.energy - exact), map.map_error);
      EXPECT_LT(map.points, 3000);
      double sum = 0;
      for (std::size_t i = 0; i < readings.size(); ++i) sum += map.forces[i] * readings[i].distance;
      EXPECT_NEAR(sum, map.energy, 1e-9 * exact);
    }
  }
}

TEST(LossMap, BoundsItsErrorWhereverHumpsKinksAndJumpsAre) {
  const std::vector<MapReading> readings = scattered_readings(4000);
  std::mt19937_64 random(1);
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  for (int k = 0; k < 150; ++k) {
    const double first = between(2, 37), width = between(0.7, 4), height = between(-0.5, 2);
    const double drift = between(-0.01, 0.01), exponent = between(0.7, 1.1);
    const double kink = k % 3 == 1 ? between(-0.02, 0.1) : 0;
    const double jump = k % 3 == 2 ? between(-0.3, 0.6) : 0;
    const auto loss = [=](const MapPlace& place) {
      const double off = place[0] - first - drift * place[1];
      const double main = off / width, half = (place[0] - 0.5 * first) / width;
      return std::pow(std::abs(place[1]), exponent) *
             (1 + height * std::exp(-main * main) + 0.3 * height / (1 + half * half)) *
             (1 + kink * std::max(0.0, off)) * (off > 0 && off < 3 * width ? 1 + jump : 1);
    };
    Model model{loss};
    const MappedLoss map = map_losses(readings, model.forces());
    EXPECT_LE(std::abs(map.energy - energy_of(readings, loss)), map.map_error) << k;
    EXPECT_LE(map.map_error, 2e-3 * map.energy) << k;
    EXPECT_LE(map.points, 8000) << k;
  }
}

TEST(LossMap, OfFewPlacesIsThePointByPointIntegration) {
  std::vector<MapReading> readings = scattered_readings(150);
  readings.insert(readings.end(), readings.begin(), readings.end());  // driven twice
  Model model{jagged_loss}, same = model;
  const MappedLoss map = map_losses(readings, model.forces());
  const MappedLoss each = map_losses(readings, same.forces(), {2e-3, 20'000, true});
  EXPECT_EQ(map.forces, each.forces);
  EXPECT_EQ(map.energy, each.energy);
  EXPECT_EQ(map.map_error, 0);
  EXPECT_EQ(each.map_error, 0);
  EXPECT_EQ(model.brief, 150);
  EXPECT_EQ(same.thorough, 150);
  EXPECT_EQ(map.points, 150);
}

TEST(LossMap, OfOnePlaceAndOfNoneIsExact) {
  const MapPlace place{10, 100, 313};
  Model model{smooth_loss};
  const MappedLoss map = map_losses({{place, 5}, {place, 5}}, model.forces());
  EXPECT_DOUBLE_EQ(map.energy, 10 * smooth_loss(place));
  EXPECT_EQ(map.map_error, 0);
  EXPECT_EQ(map.points, 1);
  EXPECT_EQ(map_losses({}, model.forces()).energy, 0);
}

TEST(LossMap, TakesAtMostTwiceThePointsOfItsPlacesHoweverJaggedTheLoss) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> share(-1, 1);
  for (const int count : {500, 1500, 5000}) {
    std::vector<MapReading> readings = scattered_readings(count);
    for (MapReading& each : readings) each.place[2] += 20 * share(random);
    const auto noise = [](const MapPlace& place) {
      return std::abs(place[1]) * (1 + 0.5 * std::sin(1e5 * place[0] + 1e4 * place[1]));
    };
    Model model{noise};
    EXPECT_LE(map_losses(readings, model.forces()).points, 2 * count);
  }
}

TEST(LossMap, StatesALargerErrorWhereItsPointsEnd) {
  const std::vector<MapReading> readings = scattered_readings(20'000);
  Model model{jagged_loss};
  const MappedLoss map = map_losses(readings, model.forces(), {1e-5, 2000});
  EXPECT_LE(map.points, 2000);
  EXPECT_GT(map.map_error, 1e-5 * map.energy);
  EXPECT_LE(std::abs(map.energy - energy_of(readings, jagged_loss)), map.map_error);
}

/// Hard where flanks rattle: under torques of less than `torque`.
auto hard_below(double torque) {
  return [torque](const MapPlace& place) { return std::abs(place[1]) < torque; };
}

TEST(LossMap, DoesNotSearchForResponsesUnderLightTorques) {
  const std::vector<MapReading> readings = scattered_readings(4000);
  for (const double factor : {0.5, 1.0, 3.0}) {  // of the loss over the quasi-static model's
    const auto is_hard = hard_below(4);
    const auto loss = [=](const MapPlace& place) {
      return smooth_loss(place) * (is_hard(place) ? factor : 1);
    };
    Model model{loss, is_hard, 0, smooth_loss};
    const MappedLoss map = map_losses(readings, model.forces());
    EXPECT_EQ(model.missed + model.thorough, 0);
    EXPECT_GT(model.quasi_static_points, 0);
    EXPECT_LE(map.map_error, 2e-3 * map.energy);
    EXPECT_LE(std::abs(map.energy - energy_of(readings, loss)), map.map_error) << factor;
  }
}

TEST(LossMap, GivesUpSearchingUnderTorquesAtWhichResponsesAreOftenMissed) {
  const std::vector<MapReading> readings = scattered_readings(20'000);
  const auto is_hard = [](const MapPlace& place) {
    return std::abs(place[1]) < 100 + 5 * place[0];
  };
  const auto loss = [=](const MapPlace& place) {
    return simple_loss(place) * (is_hard(place) ? 0.5 : 1);
  };
  Model model{loss, is_hard, 0, simple_loss};
  const MappedLoss map = map_losses(readings, model.forces());
  EXPECT_LE(model.missed, 150);
  EXPECT_EQ(model.thorough, 0);
  EXPECT_LE(std::abs(map.energy - energy_of(readings, loss)), map.map_error);
}

TEST(LossMap, SearchesThoroughlyAtAFewPlacesThatDecideTheError) {
  const std::vector<MapReading> readings{
      {{10, 100, 313}, 100}, {{20, 3, 313}, 100}, {{15, 2, 313}, 1}, {{30, -200, 313}, 100}};
  Model model{smooth_loss, hard_below(5), 0, simple_loss};
  const MappedLoss map = map_losses(readings, model.forces());
  EXPECT_EQ(model.thorough, 1);
  EXPECT_EQ(map.forces[1], smooth_loss(readings[1].place));
  EXPECT_EQ(map.forces[2], simple_loss(readings[2].place));
  EXPECT_EQ(map.map_error, simple_loss(readings[2].place));
}

TEST(LossMap, StatesTheLossOfPlacesThatAreNotFoundAsErrorWhereTheyAreMany) {
  const std::vector<MapReading> readings = scattered_readings(3000, 20);
  const auto loss = [](const MapPlace& place) { return 1.9 * simple_loss(place); };
  Model model{loss, hard_below(15), 0, simple_loss};
  const MappedLoss map = map_losses(readings, model.forces());
  EXPECT_EQ(model.thorough, 0) << "a few would not help";
  EXPECT_LE(std::abs(map.energy - energy_of(readings, loss)), map.map_error);
  EXPECT_LE(map.points, 6000);
}

TEST(LossMap, KeepsTheQuasiStaticLossWhereAThoroughSearchIsRefused) {
  Model model{smooth_loss, hard_below(5), 0, simple_loss};
  const LossForces forces = [&, found = model.forces()](const std::vector<MapPlace>& places,
                                                        LossEffort effort) {
    if (effort == LossEffort::kThorough) throw Refusal("TOO_SLOW_TO_MARCH", "too slow");
    return found(places, effort);
  };
  const MapPlace light{20, 3, 313};
  const MappedLoss map = map_losses({{light, 100}}, forces);
  EXPECT_EQ(map.forces.front(), simple_loss(light));
  EXPECT_EQ(map.map_error, map.energy);
}

TEST(LossMap, AddsTheErrorsOfTheSolver) {
  for (const int count : {100, 4000}) {
    std::vector<MapReading> readings = scattered_readings(count);
    Model model{simple_loss};
    model.relative_solver_error = 1e-3;
    const MappedLoss map = map_losses(readings, model.forces());
    // Without those under light torques, whose whole loss is in the map's error.
    // Weights of a parabola's nodes add up to at most 5/4 in each of the two coordinates.
    EXPECT_LE(map.solver_error, 1e-3 * map.energy * (count == 100 ? 1 + 1e-9 : 25.0 / 16));
    EXPECT_GE(map.solver_error, 1e-3 * (map.energy - map.map_error) * (1 - 1e-9));
    model.relative_solver_error = std::numeric_limits<double>::quiet_NaN();
    EXPECT_TRUE(std::isnan(map_losses(readings, model.forces()).solver_error));
  }
}

TEST(LossMap, EndsWithoutANumberWhereAForceIsNone) {
  for (const int count : {2, 4000}) {
    Model model{[](const MapPlace&) { return std::nan(""); }};
    EXPECT_TRUE(std::isnan(map_losses(scattered_readings(count), model.forces()).energy));
  }
}

}  // namespace
}  // namespace tribodyn
