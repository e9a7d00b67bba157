#include "core/vehicle/drive_cycle.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
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

constexpr Vehicle kCar{1300, 0.0125, 0.3, 2.2, 1.225, 0.28, 9.81};

/// A loss that depends on speed, torque and temperature.
double loss_at(const MapPlace& place) {
  return std::abs(place[1]) * (0.012 + 2e-4 * place[0]) * (1 - 0.001 * (place[2] - 313));
}

std::vector<std::optional<LossForce>> losses_at(const std::vector<MapPlace>& places, LossEffort) {
  std::vector<std::optional<LossForce>> out;
  for (const MapPlace& place : places) out.push_back(LossForce{loss_at(place), 0});
  return out;
}

TEST(CycleLoss, OfThePiecesIsThatAtTheirSpeedAndTorqueOverTheirDistance) {
  const DrivenCycle cycle = driven_cycle(pieces_of(nedc()), kCar);
  const CycleLoss loss = cycle_loss(cycle, losses_at, {});
  double sum = 0;
  for (std::size_t i = 0; i < cycle.pieces.size(); ++i) {
    const CyclePiece& piece = cycle.pieces[i];
    const double torque =
        piece.speed == 0 ? 0 : wheel_torque(kCar, piece.speed, 0, piece.acceleration);
    EXPECT_EQ(cycle.wheel_torques[i], torque);
    const double energy =
        loss_at({piece.speed, torque, piece.sump_temperature}) * piece.speed * piece.duration;
    EXPECT_NEAR(loss.energies[i], energy, 1e-12 * energy + loss.map_error);
    sum += energy;
  }
  EXPECT_LE(loss.map_error, 2e-3 * sum);
  EXPECT_LT(loss.points, 200) << "the urban part is repeated four times, and solved once";
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
