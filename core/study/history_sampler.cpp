#include "core/study/history_sampler.h"

#include <cmath>
#include <utility>

namespace tribodyn {
namespace {

/// 0 without a torque at the pinion, as then no inefficiency is told.
double inefficiency(const Torques& torques, const double* y, double loss_power) {
  const double speed = y[kPinionShaftSpeed];
  const double power = input_torque(torques, y[kWheelSpeed] / speed) * speed;
  return torques.pinion != 0 && power > 0 ? 100 * loss_power / power : 0;
}

double whole_value(HistoryColumn column, double phase, const double* y, const Instant& at,
                   const Torques& torques) {
  switch (column) {
    case HistoryColumn::kTime:
      return y[kTime];
    case HistoryColumn::kMeshPhase:
      return phase;
    case HistoryColumn::kPinionShaftSpeed:
      return y[kPinionShaftSpeed];
    case HistoryColumn::kPinionSpeed:
      return y[kPinionSpeed];
    case HistoryColumn::kGearSpeed:
      return y[kGearSpeed];
    case HistoryColumn::kWheelSpeed:
      return y[kWheelSpeed];
    case HistoryColumn::kDynamicTransmissionError:
      return at.transmission_error;
    case HistoryColumn::kDynamicTransmissionErrorVelocity:
      return at.transmission_velocity;
    case HistoryColumn::kMeshForce:
      return at.mesh_force;
    case HistoryColumn::kPinionShaftTorque:
      return at.pinion_shaft_torque;
    case HistoryColumn::kGearShaftTorque:
      return at.gear_shaft_torque;
    case HistoryColumn::kPinionFrictionTorque:
      return at.pinion_friction_torque;
    case HistoryColumn::kGearFrictionTorque:
      return at.gear_friction_torque;
    case HistoryColumn::kMeshLossPower:
      return at.loss_power;
    case HistoryColumn::kInefficiency:
      return inefficiency(torques, y, at.loss_power);
    default:
      return 0;
  }
}

double flank_value(HistoryColumn column, int k, const Instant& at) {
  const ContactFigures& c = at.contact[k];
  if (!(at.load[k] > 0)) return 0;
  switch (column) {
    case HistoryColumn::kFlankLoad:
      return at.load[k];
    case HistoryColumn::kFlankFriction:
      return c.friction;
    case HistoryColumn::kFlankViscousFriction:
      return c.viscous_friction;
    case HistoryColumn::kFlankBoundaryFriction:
      return c.boundary_friction;
    case HistoryColumn::kFlankFilmThickness:
      return c.central_film_thickness;
    case HistoryColumn::kFlankFilmRatio:
      return c.film_ratio;
    case HistoryColumn::kFlankContactTemperature:
      return c.contact_temperature;
    case HistoryColumn::kFlankMaximumPressure:
      return c.maximum_pressure;
    case HistoryColumn::kFlankShearRate:
      return c.shear_rate;
    case HistoryColumn::kFlankSlidingSpeed:
      return at.motion[k].sliding_speed;
    case HistoryColumn::kFlankFrictionCoefficient:
      return c.friction_coefficient;
    case HistoryColumn::kFlankFlashTemperatureRise:
      return c.flash_temperature_rise;
    case HistoryColumn::kFlankPinionSpecificSliding:
      return c.specific_sliding.surface_1;
    case HistoryColumn::kFlankGearSpecificSliding:
      return c.specific_sliding.surface_2;
    case HistoryColumn::kFlankEntrainmentSpeed:
      return c.entrainment_speed;
    case HistoryColumn::kFlankMeanShearStress:
      return c.mean_shear_stress;
    case HistoryColumn::kFlankLimitingStressAreaShare:
      return c.limiting_stress_area_share;
    case HistoryColumn::kFlankAsperityLoad:
      return c.asperity_load;
    default:
      return 0;
  }
}

}  // namespace

HistorySampler::HistorySampler(const HistoryRequest& request) : request_(request) {
  if (request.columns.empty()) return;
  total_ = static_cast<long>(request.mesh_cycles) * request.samples_per_mesh_cycle;
  for (const HistoryColumn column : request.columns) {
    const std::string name(history_column_name(column));
    if (is_per_flank(column)) {
      for (int k = 0; k < kFlankPairs; ++k) {
        history_.names.push_back(name + "_flank_" + std::to_string(k));
      }
    } else {
      history_.names.push_back(name);
    }
  }
  history_.values.resize(history_.names.size());
  for (auto& column : history_.values) column.reserve(static_cast<std::size_t>(total_));
}

void HistorySampler::add(double phase, const double* state, const Instant& at,
                         const Torques& torques) {
  std::size_t slot = 0;
  for (const HistoryColumn column : request_.columns) {
    if (is_per_flank(column)) {
      for (int k = 0; k < kFlankPairs; ++k) {
        history_.values[slot++].push_back(flank_value(column, k, at));
      }
    } else {
      history_.values[slot++].push_back(whole_value(column, phase, state, at, torques));
    }
  }
  ++next_;
}

void HistorySampler::repeat_first_cycles(int cycles, double period) {
  const long first = static_cast<long>(cycles) * request_.samples_per_mesh_cycle;
  for (; wanted(); ++next_) {
    const long periods_before = next_ / first;
    const double passed = static_cast<double>(periods_before);
    std::size_t slot = 0;
    for (const HistoryColumn column : request_.columns) {
      const int copies = is_per_flank(column) ? kFlankPairs : 1;
      for (int k = 0; k < copies; ++k, ++slot) {
        double value = history_.values[slot][static_cast<std::size_t>(next_ % first)];
        if (column == HistoryColumn::kTime) value += passed * period;
        if (column == HistoryColumn::kMeshPhase) value += passed * cycles;
        history_.values[slot].push_back(value);
      }
    }
  }
}

}  // namespace tribodyn
