#include "core/study/response_record.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "core/numerics/bracketed_root.h"
#include "core/numerics/square.h"

namespace tribodyn {
namespace {

/// A figure of contacts whose extremes and load-time weighted mean a result has.
struct ContactFigure {
  double ContactFigures::*of_contact;
  Extremes PointResult::*of_result;
  int first_integral;  ///< of the record: those that add up to int sum W figure dt
  int integral_count = 1;
};
using Contact = ContactFigures;
using Result = PointResult;
constexpr ContactFigure kContactFigures[] = {
    {&Contact::central_film_thickness, &Result::central_film_thickness, kFilmLoadTime},
    {&Contact::film_ratio, &Result::film_ratio, kFilmRatioLoadTime},
    {&Contact::contact_temperature, &Result::contact_temperature, kTemperatureLoadTime},
    {&Contact::maximum_pressure, &Result::maximum_pressure, kPressureLoadTime},
    {&Contact::shear_rate, &Result::shear_rate, kShearRateLoadTime},
    {&Contact::flash_temperature_rise, &Result::flash_temperature_rise, kFlashLoadTime},
    {&Contact::friction_coefficient, &Result::friction_coefficient, kFlankFrictionTime0,
     kFlankPairs},
    {&Contact::specific_sliding_1, &Result::pinion_specific_sliding, kPinionSlidingLoadTime},
    {&Contact::specific_sliding_2, &Result::gear_specific_sliding, kGearSlidingLoadTime},
};

/// Through three values at 0, 1/2 and 1.
struct Parabola {
  double constant = 0, linear = 0, quadratic = 0;

  Parabola() = default;
  explicit Parabola(const std::array<double, 3>& v)
      : constant(v[0]),
        linear(4 * v[1] - 3 * v[0] - v[2]),
        quadratic(2 * (v[0] - 2 * v[1] + v[2])) {}
  double at(double t) const { return constant + t * (linear + t * quadratic); }
};

/// ln(tau/tau_L) at the centre of a flank's contact over three samples at 0, 1/2 and 1, by
/// parabolas through p_max^3, which follows the load through 0, T_c and the logarithm of the shear
/// rate; -1 without load.
class CentreExcess {
 public:
  CentreExcess(std::span<const Instant, 3> samples, int flank, const FlankContactModel& model)
      : model_(model) {
    std::array<double, 3> cube{}, temperature{}, log_rate{};
    int last = -1;  // of the samples under load
    for (const int n : {1, 0, 2, 1, 0}) {
      const ContactFigures& contact = samples[n].contact[flank];
      if (samples[n].load[flank] > 0) {
        cube[n] = contact.maximum_pressure * square(contact.maximum_pressure);
        temperature[n] = contact.contact_temperature;
        log_rate[n] = std::log(contact.shear_rate);
        last = n;
      } else if (last >= 0) {
        temperature[n] = temperature[last];
        log_rate[n] = log_rate[last];
      }
    }
    pressure_cubed_ = Parabola(cube);
    temperature_ = Parabola(temperature);
    log_shear_rate_ = Parabola(log_rate);
  }
  double operator()(double t) const {
    const double cubed = pressure_cubed_.at(t);
    if (!(cubed > 0)) return -1;
    ContactFigures figures;
    figures.maximum_pressure = std::cbrt(cubed);
    figures.contact_temperature = temperature_.at(t);
    figures.shear_rate = std::exp(log_shear_rate_.at(t));
    return model_.log_stress_over_limit(figures);
  }

 private:
  const FlankContactModel& model_;
  Parabola pressure_cubed_, temperature_, log_shear_rate_;
};

bool centre_limited(const Instant& at) {
  bool out = false;
  for (int k = 0; k < kFlankPairs; ++k) {
    out = out || (at.load[k] > 0 && at.contact[k].limiting_stress_at_centre);
  }
  return out;
}

/// The share of the time over three samples at even distances during which a contact's centre is on
/// tau_L. Where that changes from sample to sample, the places of the changes are roots of
/// CentreExcess.
double limited_share(std::span<const Instant, 3> samples, const FlankContactModel& model) {
  const bool first = centre_limited(samples[0]);
  if (centre_limited(samples[1]) == first && centre_limited(samples[2]) == first) return first;
  std::vector<CentreExcess> flanks;
  std::vector<double> places{0, 1};
  for (int k = 0; k < kFlankPairs; ++k) {
    const CentreExcess& excess = flanks.emplace_back(samples, k, model);
    const double at[] = {excess(0), excess(0.5), excess(1)};
    for (int n = 0; n < 2; ++n) {
      if ((at[n] > 0) == (at[n + 1] > 0)) continue;
      places.push_back(bracketed_root(excess, 0.5 * n, 0.5 * (n + 1), at[n], at[n + 1]));
    }
  }
  std::sort(places.begin(), places.end());
  double share = 0;
  for (std::size_t i = 1; i < places.size(); ++i) {
    const double middle = 0.5 * (places[i - 1] + places[i]);
    const bool limited = std::any_of(flanks.begin(), flanks.end(), [&](const CentreExcess& excess) {
      return excess(middle) > 0;
    });
    if (limited) share += places[i] - places[i - 1];
  }
  return share;
}

}  // namespace

template <std::size_t kCount>
void ResponseRecord::add(std::span<const Instant, kCount> instants, double duration) {
  constexpr std::size_t kParabolas = (kCount - 1) / 2;
  for (std::size_t i = 0; i < kParabolas; ++i) {
    limited_centre_time_ +=
        duration / kParabolas * limited_share(instants.subspan(2 * i).template first<3>(), model_);
  }
  const auto add_to = [&](SampledRange& range, double Mechanics::*member) {
    std::array<double, kCount> v;
    for (std::size_t n = 0; n < kCount; ++n) v[n] = instants[n].*member;
    range.add(v);
  };
  add_to(transmission_error_, &Mechanics::transmission_error);
  add_to(mesh_force_, &Mechanics::mesh_force);
  add_to(pinion_friction_, &Mechanics::pinion_friction_torque);
  add_to(gear_friction_, &Mechanics::gear_friction_torque);
  for (int k = 0; k < kFlankPairs; ++k) add_flank(instants, k);
}

template <std::size_t kCount>
void ResponseRecord::add_flank(std::span<const Instant, kCount> instants, int k) {
  std::array<double, kCount> load;
  for (std::size_t n = 0; n < kCount; ++n) load[n] = instants[n].load[k];
  const auto value = [&](std::size_t figure, std::size_t n) {
    return instants[n].contact[k].*kContactFigures[figure].of_contact;
  };
  add_counted(load, load_floor_, value, contact_);
}

template void ResponseRecord::add(std::span<const Instant, kSamples> instants, double duration);
template void ResponseRecord::add(std::span<const Instant, 3> instants, double duration);

void ResponseRecord::append(const ResponseRecord& next, double cycles) {
  for (GapEvent event : next.gap_events) {
    event.phase += cycles;
    event.time += integrals[kTime];
    gap_events.push_back(event);
  }
  for (std::size_t i = 0; i < integrals.size(); ++i) integrals[i] += next.integrals[i];
  limited_centre_time_ += next.limited_centre_time_;
  for (const auto range : {&ResponseRecord::transmission_error_, &ResponseRecord::mesh_force_,
                           &ResponseRecord::pinion_friction_, &ResponseRecord::gear_friction_}) {
    (this->*range).add(next.*range);
  }
  for (std::size_t c = 0; c < contact_.size(); ++c) contact_[c].add(next.contact_[c]);
}

void ResponseRecord::set_transmission_error_range(double minimum, double maximum) {
  transmission_error_ = {minimum, maximum};
}

void ResponseRecord::fill(const Torques& torques, double cycles, bool periodic,
                          PointResult& out) const {
  const Integrals& y = integrals;
  const double time = y[kTime];
  out.pinion_torque = torques.pinion;
  out.wheel_torque = torques.wheel;
  const double input = input_torque(torques, y[kWheelAngle] / y[kPinionShaftAngle]);
  out.input_power = input * y[kPinionShaftAngle] / time;
  out.mesh_frequency = cycles / time;
  out.mesh_loss_power = y[kLossWork] / time;
  for (int k = 0; k < kFlankPairs; ++k) {
    out.flank_losses[k] = {y[kFlankViscousWork0 + k] / time, y[kFlankBoundaryWork0 + k] / time};
    if (y[kFlankLoadTime0 + k] > 0) {
      out.flank_losses[k].friction_coefficient =
          y[kFlankFrictionTime0 + k] / y[kFlankLoadTime0 + k];
    }
    out.viscous_loss_power += out.flank_losses[k].viscous;
    out.boundary_loss_power += out.flank_losses[k].boundary;
  }
  out.mesh_loss_torque = out.mesh_loss_power / out.mean_pinion_speed;
  // Without a pinion torque the flanks float, and what turns them is not known.
  if (torques.pinion != 0 && out.input_power > 1e-9 * out.mesh_loss_power) {
    out.inefficiency_rms = inefficiency_rms(std::sqrt(y[kLossShareSquared] / time), input);
    out.inefficiency_energy_mean = 100 * out.mesh_loss_power / out.input_power;
  }
  if (y[kViscousForceSquared] > 0) {
    out.boundary_to_viscous_friction_ratio =
        std::sqrt(y[kBoundaryForceSquared] / y[kViscousForceSquared]);
  }
  out.dynamic_transmission_error = transmission_error_.with_mean(y[kTransmissionErrorTime] / time);
  out.mesh_force = mesh_force_.with_mean(y[kMeshForceTime] / time);
  out.pinion_friction_torque = pinion_friction_.with_mean(y[kPinionFrictionTorqueTime] / time);
  out.gear_friction_torque = gear_friction_.with_mean(y[kGearFrictionTorqueTime] / time);
  if (y[kLoadTime] > 0) {
    static_assert(std::size(kContactFigures) == std::tuple_size_v<decltype(contact_)>);
    const double load_time = y[kLoadTime];
    for (std::size_t c = 0; c < contact_.size(); ++c) {
      const ContactFigure& figure = kContactFigures[c];
      double integral = 0;
      for (int n = 0; n < figure.integral_count; ++n) integral += y[figure.first_integral + n];
      out.*figure.of_result = contact_[c].with_mean(integral / load_time);
    }
    out.limiting_stress_area_share = y[kLimitedAreaLoadTime] / load_time;
  }
  out.limiting_stress_time_share = limited_centre_time_ / time;
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
