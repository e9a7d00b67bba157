#include "core/study/cycle_loss.h"

#include <cmath>
#include <functional>
#include <iterator>
#include <utility>

namespace tribodyn {
namespace {

constexpr double kBandEnds[] = {0, 30 / 3.6, 60 / 3.6, 90 / 3.6, 130 / 3.6, 0};  // [m/s]; 0: none

CyclePart cycle_part(CyclePartKind kind, const DrivenCycle& cycle,
                     const std::function<bool(std::size_t)>& belongs) {
  CyclePart out;
  out.kind = kind;
  for (std::size_t i = 0; i < cycle.pieces.size(); ++i) {
    if (!belongs(i)) continue;
    out.pieces.push_back(i);
    out.duration += cycle.pieces[i].duration;
    out.distance += cycle.pieces[i].duration * cycle.pieces[i].speed;
  }
  return out;
}

}  // namespace

DrivenCycle driven_cycle(std::vector<CyclePiece> pieces, const Vehicle& vehicle) {
  DrivenCycle out;
  for (const CyclePiece& piece : pieces) {
    const bool moves = piece.speed >= kStandstillSpeed;
    const double torque =
        moves ? wheel_torque(vehicle, piece.speed, piece.ascent_angle, piece.acceleration) : 0;
    out.wheel_torques.push_back(torque);
    out.wheel_energies.push_back(torque / vehicle.wheel_radius * piece.speed * piece.duration);
  }
  out.pieces = std::move(pieces);
  return out;
}

CycleLoss cycle_loss(const DrivenCycle& cycle, const LossForces& loss_forces,
                     const LossMapOptions& options) {
  std::vector<MapReading> readings;
  std::vector<std::size_t> pieces;  // of the readings
  for (std::size_t i = 0; i < cycle.pieces.size(); ++i) {
    if (cycle.wheel_torques[i] == 0) continue;
    const CyclePiece& piece = cycle.pieces[i];
    readings.push_back({{piece.speed, cycle.wheel_torques[i], piece.sump_temperature},
                        piece.speed * piece.duration});
    pieces.push_back(i);
  }
  CycleLoss out;
  out.energies.resize(cycle.pieces.size());
  const MappedLoss mapped = map_losses(readings, loss_forces, options);
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    out.energies[pieces[k]] = mapped.forces[k] * readings[k].distance;
  }
  out.map_error = mapped.map_error;
  out.solver_error = mapped.solver_error;
  out.points = mapped.points;
  return out;
}

std::vector<CyclePart> parts_of(const DrivenCycle& cycle) {
  const auto& pieces = cycle.pieces;
  const auto moves = [&](std::size_t i) { return pieces[i].speed >= kStandstillSpeed; };
  const auto drives = [&](std::size_t i) { return cycle.wheel_torques[i] > 0; };
  const auto gains = [&](std::size_t i) { return pieces[i].acceleration; };
  std::vector<CyclePart> out;
  const auto add = [&](CyclePartKind kind, const std::function<bool(std::size_t)>& belongs) {
    out.push_back(cycle_part(kind, cycle, belongs));
  };
  add(CyclePartKind::kAll, [](std::size_t) { return true; });
  add(CyclePartKind::kStandstill, [&](std::size_t i) { return !moves(i); });
  add(CyclePartKind::kDrive, drives);
  add(CyclePartKind::kDriveAccelerating,
      [&](std::size_t i) { return drives(i) && gains(i) > kSteadyAcceleration; });
  add(CyclePartKind::kDriveSteady,
      [&](std::size_t i) { return drives(i) && std::abs(gains(i)) <= kSteadyAcceleration; });
  add(CyclePartKind::kDriveDecelerating,
      [&](std::size_t i) { return drives(i) && gains(i) < -kSteadyAcceleration; });
  add(CyclePartKind::kCoast, [&](std::size_t i) { return cycle.wheel_torques[i] < 0; });
  for (std::size_t k = 0; k + 1 < std::size(kBandEnds); ++k) {
    const double low = kBandEnds[k], high = kBandEnds[k + 1];
    CyclePart band = cycle_part(CyclePartKind::kSpeedBand, cycle, [&](std::size_t i) {
      return moves(i) && pieces[i].speed >= low && (high == 0 || pieces[i].speed < high);
    });
    if (band.pieces.empty()) continue;
    band.low = low;
    band.high = high;
    out.push_back(std::move(band));
  }
  return out;
}

CycleEnergy energy_of(const CyclePart& part, const DrivenCycle& cycle,
                      const std::vector<double>& losses) {
  CycleEnergy out;
  for (const std::size_t i : part.pieces) {
    const double wheel = cycle.wheel_energies[i];
    out.loss += losses[i];
    out.input += wheel > 0 ? wheel + losses[i] : -wheel;
  }
  return out;
}

}  // namespace tribodyn
