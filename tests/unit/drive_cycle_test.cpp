#include "core/vehicle/drive_cycle.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "core/refusal.h"
#include "core/study/cycle_loss.h"
#include "core/study/loss_map.h"
#include "core/vehicle/vehicle.h"

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

TEST(DriveCycle, TheTemperatureOfTheSumpIsLinearBetweenPlaces) {
  double seconds = 0;
  for (const CyclePiece& piece :
       pieces_of({"", {{0, 5, 0, 300}, {10, 5, 0, 320}, {20, 5, 0, 320}}})) {
    const double middle = piece.start + 0.5 * piece.duration;
    EXPECT_NEAR(piece.sump_temperature, std::min(300 + 2 * middle, 320.0), 1e-9);
    seconds += piece.duration;
  }
  EXPECT_NEAR(seconds, 20, 1e-12);
}

/// A loss that grows with torque, has a kink at none, and a narrow resonance.
double smooth_loss(const MapPlace& place) {
  const double resonance = (place[0] - 20) / 1.5;
  return std::abs(place[1]) * (0.012 + 2e-4 * place[0] + 1e-6 * place[1]) *
         (1 + 0.3 * std::exp(-resonance * resonance)) * (1 - 0.001 * (place[2] - 313));
}

/// A loss with ripples that no large box follows.
double jagged_loss(const MapPlace& place) {
  return smooth_loss(place) * (1 + 0.2 * std::sin(3 * place[0]) * std::sin(0.05 * place[1]));
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

TEST(LossMap, OfScatteredReadingsTakesFewMorePointsThanTheyAre) {
  constexpr int kReadings = 1500;
  std::vector<MapReading> readings;
  double exact = 0;
  for (int i = 0; i < kReadings; ++i) {
    const double turn = 0.6180339887 * i, other = 0.4142135624 * i;  // of no common period
    const MapPlace place{1 + 37 * (turn - std::floor(turn)),
                         800 * (other - std::floor(other)) - 400, 313};
    readings.push_back({place, place[0]});
    exact += jagged_loss(place) * place[0];
  }
  const LossMap map(readings,
                    [](const std::vector<MapPlace>& places) {
                      std::vector<double> out;
                      for (const MapPlace& place : places) out.push_back(jagged_loss(place));
                      return out;
                    },
                    {2e-3, 20'000});
  EXPECT_LE(map.estimated_error(), 2e-3 * map.energy());
  EXPECT_LE(std::abs(map.energy() - exact), map.estimated_error());
  EXPECT_LT(map.points(), 2 * kReadings);
}

TEST(LossMap, SolvesReadingsInPlaceOfCornersWhereTheyAreFew) {
  // In no box are more than two, and none reaches torque 0.
  std::vector<MapReading> readings;
  for (int i = 0; i < 8; ++i) readings.push_back({{1.0 + 4 * i, 800.0 - 100 * i, 313}, 1});
  const LossMap map(readings, [](const std::vector<MapPlace>& places) {
    std::vector<double> out;
    for (const MapPlace& place : places) {
      EXPECT_NEAR(place[1], 825 - 25 * place[0], 1e-9) << "no reading";
      out.push_back(smooth_loss(place));
    }
    return out;
  });
  EXPECT_EQ(map.points(), 8);
  EXPECT_EQ(map.estimated_error(), 0);
  EXPECT_EQ(map.at(3), smooth_loss(readings[3].place));
}

TEST(LossMap, EndsWithoutANumberWhereAForceIsNone) {
  const std::vector<MapReading> readings{{{10, 100, 313}, 5}, {{20, 200, 313}, 5}};
  const LossMap map(readings, [](const std::vector<MapPlace>& places) {
    return std::vector<double>(places.size(), std::nan(""));
  });
  EXPECT_TRUE(std::isnan(map.energy()));
}

constexpr Vehicle kCar{1300, 0.0125, 0.3, 2.2, 1.225, 0.28, 9.81};

std::vector<double> smooth_losses(const std::vector<MapPlace>& places) {
  std::vector<double> out;
  for (const MapPlace& place : places) out.push_back(smooth_loss(place));
  return out;
}

TEST(CycleLoss, OfTheMapIsWithinItsErrorOfThatOfEachPieceAndAsksForFewerPoints) {
  const DrivenCycle cycle = driven_cycle(pieces_of(nedc()), kCar);
  CycleLossOptions options;
  const CycleLoss by_map = cycle_loss(cycle, smooth_losses, options);
  options.is_point_by_point = true;
  const CycleLoss by_piece = cycle_loss(cycle, smooth_losses, options);
  EXPECT_EQ(by_piece.map_error, 0);
  double expected = 0, sum = 0;
  for (std::size_t i = 0; i < cycle.pieces.size(); ++i) {
    const CyclePiece& piece = cycle.pieces[i];
    const double torque =
        piece.speed == 0 ? 0 : wheel_torque(kCar, piece.speed, 0, piece.acceleration);
    EXPECT_EQ(cycle.wheel_torques[i], torque);
    expected +=
        smooth_loss({piece.speed, torque, piece.sump_temperature}) * piece.speed * piece.duration;
    sum += by_map.energies[i];
  }
  double each = 0;
  for (const double energy : by_piece.energies) each += energy;
  EXPECT_NEAR(each, expected, 1e-12 * expected);
  EXPECT_LE(std::abs(sum - expected), by_map.map_error);
  EXPECT_LE(by_map.map_error, 2e-3 * sum);
  EXPECT_LT(by_piece.points, 400) << "the urban part is repeated four times, and solved once";
}

TEST(CycleLoss, PartsCoverTheCycleAndInputIsAtThePinionInDriveAndAtTheWheelsInCoast) {
  const DrivenCycle cycle = driven_cycle(pieces_of(nedc()), kCar);
  const std::vector<double> losses(cycle.pieces.size(), 2.0);
  double phases = 0, bands = 0;
  for (const CyclePart& part : parts_of(cycle)) {
    const bool is_band = part.kind == CyclePartKind::kSpeedBand;
    if (part.kind == CyclePartKind::kStandstill || is_band) bands += part.duration;
    if (part.kind == CyclePartKind::kStandstill || part.kind == CyclePartKind::kDrive ||
        part.kind == CyclePartKind::kCoast) {
      phases += part.duration;
    }
    if (part.kind == CyclePartKind::kAll) {
      EXPECT_NEAR(part.duration, 1180, 1e-9);
      EXPECT_NEAR(part.distance, 11028, 1);
    }
    double input = 0;
    for (const std::size_t i : part.pieces) {
      const double wheel = cycle.wheel_torques[i] / kCar.wheel_radius * cycle.pieces[i].speed *
                           cycle.pieces[i].duration;
      input += wheel > 0 ? wheel + 2 : -wheel;
    }
    const CycleEnergy energy = energy_of(part, cycle, losses);
    EXPECT_NEAR(energy.input, input, 1e-9 * input + 1e-12);
    EXPECT_EQ(energy.loss, 2.0 * static_cast<double>(part.pieces.size()));
  }
  EXPECT_NEAR(phases, 1180, 1e-9);
  EXPECT_NEAR(bands, 1180, 1e-9);
}

}  // namespace
}  // namespace tribodyn
