#include "core/study/orbit_record.h"

#include <algorithm>
#include <cmath>

namespace tribodyn {

void record_orbit(const GearPairSystem& system, const PeriodicOrbit& orbit,
                  const SolvedPieces& solved, ResponseRecord& record) {
  record.integrals = {};
  std::array<double, kRecordComponents> rate{};
  int side = orbit.pieces.front().regime.side;
  record.starts_in_gap = side == 0;
  for (std::size_t piece = 0; piece < orbit.pieces.size(); ++piece) {
    const OrbitPiece& p = orbit.pieces[piece];
    const auto at = solved.of(piece);
    const MarchState* states[3] = {&p.start, &p.middle, &p.end};
    for (int n = 0; n < 3; ++n) {
      if (n > 0 || !solved.goes_on(piece)) {
        system.record_derivative(states[n]->data(), at[n], p.regime, orbit.torques, rate.data());
      }
      const double weight = p.length * (n == 1 ? 4 : 1) / 6;
      for (int i = 0; i < kRecordComponents; ++i) record.integrals[i] += weight * rate[i];
    }
    record.add_piece(at, p.end[kTime] - p.start[kTime]);
    if ((side == 0) != (p.regime.side == 0)) {
      record.gap_events.push_back({p.phase, p.start[kTime], p.regime.side == 0});
    }
    side = p.regime.side;
  }
  // The first components are the state itself, at the end.
  const MarchState& end = orbit.pieces.back().end;
  for (int i = kTime; i <= kWheelSpeed; ++i) record.integrals[i] = end[i];
  // In a period the shafts turn as far as the teeth say: exact, without quadrature.
  record.integrals[kPinionShaftAngle] = orbit.period * system.cycle_angle();
  record.integrals[kWheelAngle] = record.integrals[kPinionShaftAngle] *
                                  system.mesh().pinion_teeth() / system.mesh().gear_teeth();
  record.set_transmission_error_range(orbit.figures.dte_minimum, orbit.figures.dte_maximum);
}

void sample_orbit(const GearPairSystem& system, const PeriodicOrbit& orbit,
                  const SolvedPieces& solved, ContactSolver& contacts, HistorySampler& history) {
  MarchState slope_start, slope_end, at{};
  Instant instant;
  std::size_t piece = 0;
  while (history.wanted_in_first_cycles(orbit.period)) {
    const double phase = history.next_phase();
    while (piece + 1 < orbit.pieces.size() && orbit.pieces[piece + 1].phase <= phase) ++piece;
    const OrbitPiece& p = orbit.pieces[piece];
    const auto solved_at = solved.of(piece);
    system.derivative(p.start.data(), solved_at[0], orbit.torques, slope_start.data());
    system.derivative(p.end.data(), solved_at[2], orbit.torques, slope_end.data());
    const double t = std::clamp((phase - p.phase) / p.length, 0.0, 1.0), u = 1 - t;
    for (int i = kTime; i <= kWheelSpeed; ++i) {
      at[i] = u * u * (1 + 2 * t) * p.start[i] + t * t * (1 + 2 * u) * p.end[i] +
              p.length * t * u * (u * slope_start[i] - t * slope_end[i]);
    }
    const double inside = std::min(phase - std::floor(p.phase + 1e-9), 1.0);
    system.evaluate(inside, system.mesh().interval_at(inside), p.regime, at.data(), contacts,
                    instant);
    history.add(phase, at.data(), instant, orbit.torques);
  }
  history.repeat_first_cycles(orbit.period, orbit.pieces.back().end[kTime]);
}

}  // namespace tribodyn
