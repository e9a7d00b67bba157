#include "core/study/response_record.h"

#include <algorithm>
#include <cmath>

namespace tribodyn {
namespace {

/// Extreme of a smooth function sampled at even distances: the largest sample, or the vertex of the
/// parabola through it and its neighbours where that lies inside the step.
template <std::size_t kCount>
double refined_maximum(const std::array<double, kCount>& v) {
  const auto top = std::max_element(v.begin(), v.end());
  const int middle = std::clamp(static_cast<int>(top - v.begin()), 1, static_cast<int>(kCount) - 2);
  const double curvature = v[middle - 1] - 2 * v[middle] + v[middle + 1];
  if (!(curvature < 0)) return *top;
  const double shift = 0.5 * (v[middle - 1] - v[middle + 1]) / curvature;
  const bool inside = std::abs(shift) < 1;
  const double vertex = v[middle] - 0.25 * (v[middle - 1] - v[middle + 1]) * shift;
  return inside ? std::max(*top, vertex) : *top;
}

template <std::size_t kCount>
std::array<double, kCount> negated(std::array<double, kCount> v) {
  for (double& x : v) x = -x;
  return v;
}

}  // namespace

void ResponseRecord::Range::add(double low_value, double high_value) {
  low = seen ? std::min(low, low_value) : low_value;
  high = seen ? std::max(high, high_value) : high_value;
  seen = true;
}

template <std::size_t kCount, class Value>
void ResponseRecord::add_samples(const std::array<Instant, kCount>& instants, Range& range,
                                 Value value) {
  std::array<double, kCount> v;
  for (std::size_t i = 0; i < kCount; ++i) v[i] = value(instants[i]);
  range.add(-refined_maximum(negated(v)), refined_maximum(v));
}

template <std::size_t kCount>
void ResponseRecord::add_all(const std::array<Instant, kCount>& instants) {
  add_samples(instants, transmission_error_, [](const Instant& i) { return i.transmission_error; });
  add_samples(instants, mesh_force_, [](const Instant& i) { return i.mesh_force; });
  add_samples(instants, pinion_friction_,
              [](const Instant& i) { return i.pinion_friction_torque; });
  add_samples(instants, gear_friction_, [](const Instant& i) { return i.gear_friction_torque; });
  for (int k = 0; k < kFlankPairs; ++k) {
    const bool all = std::all_of(instants.begin(), instants.end(),
                                 [&](const Instant& i) { return counts(i, k); });
    const auto add = [&](Range& range, double ContactSolution::*member) {
      if (all) {
        add_samples(instants, range, [&](const Instant& i) { return i.contact[k].*member; });
        return;
      }
      for (std::size_t n = 0; n < kCount; ++n) {
        const Instant& i = instants[n];
        if (counts(i, k)) range.add(i.contact[k].*member, i.contact[k].*member);
        if (n == 0 || counts(i, k) == counts(instants[n - 1], k)) continue;
        // Where the load that counts is crossed.
        const Instant& before = instants[n - 1];
        if (!(i.load[k] > 0 && before.load[k] > 0)) continue;
        // Film, pressure and temperature go like powers of a small load.
        const double t =
            std::log(load_floor_ / before.load[k]) / std::log(i.load[k] / before.load[k]);
        const double a = before.contact[k].*member, b = i.contact[k].*member;
        const double value = a > 0 && b > 0 ? a * std::pow(b / a, t) : a + t * (b - a);
        range.add(value, value);
      }
    };
    add(film_, &ContactSolution::central_film_thickness);
    add(film_ratio_, &ContactSolution::film_ratio);
    add(temperature_, &ContactSolution::contact_temperature);
    add(pressure_, &ContactSolution::maximum_pressure);
    add(shear_rate_, &ContactSolution::shear_rate);
  }
}

void ResponseRecord::add_step(const std::array<Instant, kSamples>& instants) { add_all(instants); }

void ResponseRecord::add_piece(const std::array<Instant, 3>& instants) { add_all(instants); }

void ResponseRecord::set_transmission_error_range(double minimum, double maximum) {
  transmission_error_ = {minimum, maximum, true};
}

void ResponseRecord::add_instant(const Instant& instant) {
  std::array<Instant, kSamples> all;
  all.fill(instant);
  add_step(all);
}

Extremes ResponseRecord::extremes(const Range& range, double mean) {
  return {range.low, mean, range.high};
}

void ResponseRecord::fill(const Torques& torques, double cycles, bool periodic,
                          PointResult& out) const {
  const Integrals& y = integrals;
  const double time = y[kTime];
  out.pinion_torque = torques.pinion;
  out.wheel_torque = torques.wheel;
  out.input_power = torques.pinion * y[kPinionShaftAngle] / time;
  out.mesh_frequency = cycles / time;
  out.mesh_loss_power = y[kLossWork] / time;
  for (int k = 0; k < kFlankPairs; ++k) {
    out.flank_losses[k] = {y[kFlankViscousWork0 + k] / time, y[kFlankBoundaryWork0 + k] / time};
    out.viscous_loss_power += out.flank_losses[k].viscous;
    out.boundary_loss_power += out.flank_losses[k].boundary;
  }
  out.mesh_loss_torque = out.mesh_loss_power / out.mean_pinion_speed;
  if (std::abs(out.input_power) > 1e-9 * (std::abs(out.input_power) + out.mesh_loss_power) &&
      out.input_power != 0) {
    out.inefficiency_rms = 100 / std::abs(torques.pinion) * std::sqrt(y[kLossShareSquared] / time);
    out.inefficiency_energy_mean = 100 * out.mesh_loss_power / std::abs(out.input_power);
  }
  if (y[kViscousForceSquared] > 0) {
    out.boundary_to_viscous_friction_ratio =
        std::sqrt(y[kBoundaryForceSquared] / y[kViscousForceSquared]);
  }
  out.dynamic_transmission_error = extremes(transmission_error_, y[kTransmissionErrorTime] / time);
  out.mesh_force = extremes(mesh_force_, y[kMeshForceTime] / time);
  out.pinion_friction_torque = extremes(pinion_friction_, y[kPinionFrictionTorqueTime] / time);
  out.gear_friction_torque = extremes(gear_friction_, y[kGearFrictionTorqueTime] / time);
  if (y[kLoadTime] > 0) {
    const double load_time = y[kLoadTime];
    out.central_film_thickness = extremes(film_, y[kFilmLoadTime] / load_time);
    out.film_ratio = extremes(film_ratio_, y[kFilmRatioLoadTime] / load_time);
    out.contact_temperature = extremes(temperature_, y[kTemperatureLoadTime] / load_time);
    out.maximum_pressure = extremes(pressure_, y[kPressureLoadTime] / load_time);
    out.shear_rate = extremes(shear_rate_, y[kShearRateLoadTime] / load_time);
    out.limiting_stress_area_share = y[kLimitedAreaLoadTime] / load_time;
  }
  out.limiting_stress_time_share = y[kLimitedCentreTime] / time;
  out.contact_loss_time_share = y[kGapTime] / time;
  out.coast_side_contact = y[kCoastTime] > 0;
  out.contact_loss = y[kGapTime] > 0;

  double opened_phase = 0, opened_time = 0;
  bool open = starts_in_gap;
  for (const GapEvent& event : gap_events) {
    if (event.opens) {
      opened_phase = event.phase;
      opened_time = event.time;
      open = true;
    } else if (open) {
      out.contact_losses.push_back({opened_phase, event.phase, event.time - opened_time});
      open = false;
    }
  }
  if (open) {
    if (periodic && starts_in_gap && !out.contact_losses.empty()) {
      // The loss at the end of the period goes on at its beginning.
      ContactLoss first = out.contact_losses.front();
      out.contact_losses.erase(out.contact_losses.begin());
      out.contact_losses.push_back(
          {opened_phase, cycles + first.end_mesh_phase, time - opened_time + first.duration});
    } else {
      out.contact_losses.push_back({opened_phase, cycles, time - opened_time});
    }
  }

  PowerBalance& balance = out.power_balance;
  balance.input = torques.pinion * y[kPinionShaftAngle];
  balance.output = torques.wheel * y[kWheelAngle];
  balance.friction = y[kLossWork];
  balance.shaft_damping = y[kShaftDampingWork];
  balance.mesh_damping = y[kMeshDampingWork];
  balance.parametric = y[kParametricWork];
}

}  // namespace tribodyn
