#include "core/vehicle/drive_cycle.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "core/refusal.h"
#include "core/study/loss_map.h"

namespace tribodyn {
namespace {

TEST(DriveCycle, TheNedcIs1180SecondsAnd1102KilometresWith280SecondsOfStandstill) {
  double time = 0, distance = 0, standstill = 0;
  for (const CyclePiece& piece : pieces_of(nedc())) {
    EXPECT_LE(piece.duration, 1);
    time += piece.duration;
    distance += piece.duration * piece.speed;
    if (piece.speed == 0) standstill += piece.duration;
  }
  EXPECT_NEAR(time, 1180, 1e-9);
  EXPECT_NEAR(distance, 11020, 0.002 * 11020);
  EXPECT_NEAR(standstill, 4 * 60 + 40, 1e-9);
}

TEST(DriveCycle, PiecesKeepDistanceAndChangeOfSpeed) {
  const DriveCycle cycle{"", {{0, 0, 0.1}, {0.5, 3, 0}, {4.1, 10, -0.1}, {6, 10, 0}}};
  double distance = 0, speed = 0;
  for (const CyclePiece& piece : pieces_of(cycle)) {
    distance += piece.speed * piece.duration;
    speed += piece.acceleration * piece.duration;
    EXPECT_EQ(piece.ascent_angle, piece.start < 0.5 ? 0.1 : piece.start < 4.1 ? 0 : -0.1);
  }
  EXPECT_NEAR(distance, 0.5 * 1.5 + 3.6 * 6.5 + 1.9 * 10, 1e-12);
  EXPECT_NEAR(speed, 10, 1e-12);
}

TEST(DriveCycle, ACycleThatCannotBeDrivenIsRefusedAtItsPlace) {
  const auto refusal = [](const DriveCycle& cycle) -> std::string {
    try {
      pieces_of(cycle);
    } catch (const Refusal& refused) {
      return refused.what();
    }
    return "";
  };
  EXPECT_NE(refusal({"", {{0, 0}}}).find("two places"), std::string::npos);
  EXPECT_NE(refusal({"", {{0, 0}, {1, 1}, {1, 2}}}).find("place 3"), std::string::npos);
  EXPECT_NE(refusal({"", {{0, 0}, {1e12, 1}}}).find("1000000 pieces"), std::string::npos);
  EXPECT_NE(refusal({"", {{0, 0}, {1, -1}}}).find("negative"), std::string::npos);
  EXPECT_NE(refusal({"", {{0, 0}, {1, std::nan("")}}}).find("not finite"), std::string::npos);
}

/// A loss that grows with torque, has a kink at none, and a narrow resonance.
double smooth_loss(const MapPlace& place) {
  const double resonance = (place[0] - 20) / 1.5;
  return std::abs(place[1]) * (0.012 + 2e-4 * place[0] + 1e-6 * place[1]) *
         (1 + 0.3 * std::exp(-resonance * resonance)) * (1 - 0.001 * (place[2] - 313));
}

TEST(LossMap, EnergyIsWithinTheStatedErrorOfThePointByPointIntegration) {
  for (const double last_sump : {313.0, 353.0}) {
    std::vector<MapReading> readings;
    double exact = 0;
    for (int i = 0; i < 2000; ++i) {
      const double share = i / 1999.0;
      const MapPlace place{1 + 37 * std::abs(std::sin(7 * share)), 400 * std::sin(31 * share),
                           313 + (last_sump - 313) * share};
      readings.push_back({place, place[0]});
      exact += smooth_loss(place) * place[0];
    }
    const auto forces = [](const std::vector<MapPlace>& places) {
      std::vector<double> out;
      for (const MapPlace& place : places) {
        EXPECT_NE(place[1], 0) << "no torque needs no point";
        out.push_back(smooth_loss(place));
      }
      return out;
    };
    for (const double tolerance : {1e-2, 2e-3}) {
      const LossMap map(readings, forces, {tolerance, 100'000});
      EXPECT_LE(map.estimated_error(), tolerance * map.energy());
      EXPECT_LE(std::abs(map.energy() - exact), map.estimated_error());
      double sum = 0;
      for (std::size_t i = 0; i < readings.size(); ++i) sum += map.at(i) * readings[i].distance;
      EXPECT_NEAR(sum, map.energy(), 1e-9 * exact);
    }
    const LossMap short_of_points(readings, forces, {1e-6, 300});
    EXPECT_GT(short_of_points.estimated_error(), 1e-6 * short_of_points.energy());
    EXPECT_LE(std::abs(short_of_points.energy() - exact), short_of_points.estimated_error());
  }
}

TEST(LossMap, ReadingsOfOnePlaceAreExact) {
  const MapPlace place{10, 100, 313};
  const LossMap map({{place, 5}, {place, 5}}, [](const std::vector<MapPlace>& places) {
    return std::vector<double>(places.size(), smooth_loss(places.front()));
  });
  EXPECT_DOUBLE_EQ(map.energy(), 10 * smooth_loss(place));
  EXPECT_EQ(map.estimated_error(), 0);
  EXPECT_EQ(LossMap({}, {}).energy(), 0);
}

TEST(LossMap, EndsWithoutANumberWhereAForceIsNone) {
  const std::vector<MapReading> readings{{{10, 100, 313}, 5}, {{20, 200, 313}, 5}};
  const LossMap map(readings, [](const std::vector<MapPlace>& places) {
    return std::vector<double>(places.size(), std::nan(""));
  });
  EXPECT_TRUE(std::isnan(map.energy()));
}

}  // namespace
}  // namespace tribodyn
