#include "core/study/history_sampler.h"

#include <iterator>
#include <utility>

namespace tribodyn {
namespace {

/// 0 without a torque at the pinion, as then no inefficiency is told.
double inefficiency(const Torques& torques, const double* y, double loss_power) {
  const double speed = y[kPinionShaftSpeed];
  const double power = input_torque(torques, y[kWheelSpeed] / speed) * speed;
  return torques.pinion != 0 && power > 0 ? 100 * loss_power / power : 0;
}

/// One sample of the drive.
struct Sample {
  double phase;
  const double* state;
  const Instant& at;
  const Torques& torques;
};

/// The columns of the whole drive, in the order of HistoryColumn.
constexpr double (*kWholeValues[])(const Sample&) = {
    [](const Sample& s) { return s.state[kTime]; },
    [](const Sample& s) { return s.phase; },
    [](const Sample& s) { return s.state[kPinionShaftSpeed]; },
    [](const Sample& s) { return s.state[kPinionSpeed]; },
    [](const Sample& s) { return s.state[kGearSpeed]; },
    [](const Sample& s) { return s.state[kWheelSpeed]; },
    [](const Sample& s) { return s.at.transmission_error; },
    [](const Sample& s) { return s.at.transmission_velocity; },
    [](const Sample& s) { return s.at.mesh_force; },
    [](const Sample& s) { return s.at.pinion_shaft_torque; },
    [](const Sample& s) { return s.at.gear_shaft_torque; },
    [](const Sample& s) { return s.at.pinion_friction_torque; },
    [](const Sample& s) { return s.at.gear_friction_torque; },
    [](const Sample& s) { return s.at.loss_power; },
    [](const Sample& s) { return inefficiency(s.torques, s.state, s.at.loss_power); },
};
constexpr int kFirstFlankColumn = static_cast<int>(HistoryColumn::kFlankLoad);
static_assert(std::size(kWholeValues) == kFirstFlankColumn);

/// The columns of each flank under load, from kFlankLoad on.
constexpr double (*kFlankValues[])(const Instant&, int) = {
    [](const Instant& at, int k) { return at.load[k]; },
    [](const Instant& at, int k) { return at.contact[k].friction; },
    [](const Instant& at, int k) { return at.contact[k].viscous_friction; },
    [](const Instant& at, int k) { return at.contact[k].boundary_friction; },
    [](const Instant& at, int k) { return at.contact[k].central_film_thickness; },
    [](const Instant& at, int k) { return at.contact[k].film_ratio; },
    [](const Instant& at, int k) { return at.contact[k].contact_temperature; },
    [](const Instant& at, int k) { return at.contact[k].maximum_pressure; },
    [](const Instant& at, int k) { return at.contact[k].shear_rate; },
    [](const Instant& at, int k) { return at.motion[k].sliding_speed; },
    [](const Instant& at, int k) { return at.contact[k].friction_coefficient; },
    [](const Instant& at, int k) { return at.contact[k].flash_temperature_rise; },
    [](const Instant& at, int k) { return at.contact[k].specific_sliding_1; },
    [](const Instant& at, int k) { return at.contact[k].specific_sliding_2; },
    [](const Instant& at, int k) { return at.contact[k].entrainment_speed; },
    [](const Instant& at, int k) { return at.contact[k].mean_shear_stress; },
    [](const Instant& at, int k) { return at.contact[k].limiting_stress_area_share; },
    [](const Instant& at, int k) { return at.contact[k].asperity_load; },
};
static_assert(kFirstFlankColumn + std::size(kFlankValues) == kHistoryColumns);

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
    const int number = static_cast<int>(column);
    if (is_per_flank(column)) {
      for (int k = 0; k < kFlankPairs; ++k) {
        const double value = at.load[k] > 0 ? kFlankValues[number - kFirstFlankColumn](at, k) : 0.0;
        history_.values[slot++].push_back(value);
      }
    } else {
      history_.values[slot++].push_back(kWholeValues[number]({phase, state, at, torques}));
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
