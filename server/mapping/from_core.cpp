#include "server/mapping/from_core.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/study/warning_kinds.h"
#include "core/version.h"
#include "server/support/value_of.h"

namespace tribodyn::server {
namespace {

constexpr int kContactLossesOfAPoint = 1000;
constexpr int kContactLossesOfACurvePoint = 20;  // keeps a curve of 1000 points below 4 MB

void set(v1::Extremes* out, const Extremes& extremes) {
  out->set_minimum(extremes.minimum);
  out->set_mean(extremes.mean);
  out->set_maximum(extremes.maximum);
}

void set(v1::SolverStatistics* out, const SolverStatistics& statistics) {
  out->set_right_hand_sides(statistics.right_hand_sides);
  out->set_contact_solutions(statistics.contact_solutions);
  out->set_accepted_steps(statistics.accepted_steps);
  out->set_rejected_steps(statistics.rejected_steps);
  out->set_events(statistics.events);
  out->set_mesh_cycles(statistics.mesh_cycles);
  out->set_accelerations(statistics.accelerations);
  out->set_periodicity_defect(statistics.periodicity_defect);
  out->set_largest_multiplier(statistics.largest_multiplier);
  out->set_slowest_decay_rate_per_second(statistics.slowest_decay_rate);
}

void set(v1::PowerBalance* out, const PowerBalance& balance) {
  out->set_input_joules(balance.input);
  out->set_output_joules(balance.output);
  out->set_friction_joules(balance.friction);
  out->set_shaft_damping_joules(balance.shaft_damping);
  out->set_mesh_damping_joules(balance.mesh_damping);
  out->set_stored_joules(balance.stored);
  out->set_parametric_joules(balance.parametric);
}

void set(v1::CoexistingResponse* out, const CoexistingResponse& response) {
  out->set_inefficiency_rms_percent(response.inefficiency_rms);
  out->set_inefficiency_energy_mean_percent(response.inefficiency_energy_mean);
  out->set_pinion_torque_newton_metres(response.pinion_torque);
  out->set_dynamic_transmission_error_minimum_metres(response.dte_minimum);
  out->set_dynamic_transmission_error_maximum_metres(response.dte_maximum);
  out->set_contact_loss(response.contact_loss);
}

void set(v1::SectionState* out, const SectionState& state) {
  out->set_pinion_shaft_twist_radians(state.pinion_shaft_twist);
  out->set_gear_shaft_twist_radians(state.gear_shaft_twist);
  out->set_pinion_shaft_speed_radians_per_second(state.pinion_shaft_speed);
  out->set_pinion_speed_radians_per_second(state.pinion_speed);
  out->set_gear_speed_radians_per_second(state.gear_speed);
  out->set_wheel_speed_radians_per_second(state.wheel_speed);
  out->set_mesh_deflection_metres(state.mesh_deflection);
}

void set_contact_losses(v1::PointResult* out, const PointResult& result, int maximum) {
  const int count = static_cast<int>(result.contact_losses.size());
  const int kept = std::min(count, maximum);
  for (int i = 0; i < kept; ++i) {
    const ContactLoss& loss = result.contact_losses[static_cast<std::size_t>(i)];
    v1::ContactLoss* added = out->add_contact_losses();
    added->set_start_mesh_phase(loss.start_mesh_phase);
    added->set_end_mesh_phase(loss.end_mesh_phase);
    added->set_duration_seconds(loss.duration);
  }
  out->set_contact_losses_left_out(count - kept);
}

void set_losses(v1::PointResult* out, const PointResult& result) {
  if (result.inefficiency_rms) out->set_inefficiency_rms_percent(*result.inefficiency_rms);
  if (result.inefficiency_energy_mean) {
    out->set_inefficiency_energy_mean_percent(*result.inefficiency_energy_mean);
  }
  out->set_mesh_loss_power_watts(result.mesh_loss_power);
  out->set_mesh_loss_torque_newton_metres(result.mesh_loss_torque);
  out->set_viscous_loss_power_watts(result.viscous_loss_power);
  out->set_boundary_loss_power_watts(result.boundary_loss_power);
  for (const FlankLoss& loss : result.flank_losses) {
    v1::FlankLoss* added = out->add_flank_losses();
    added->set_viscous_watts(loss.viscous);
    added->set_boundary_watts(loss.boundary);
    added->set_friction_coefficient(loss.friction_coefficient);
  }
  out->set_boundary_to_viscous_friction_ratio(result.boundary_to_viscous_friction_ratio);
}

constexpr std::pair<OrbitFigure, const char*> kOrbitFigureNames[] = {
    {OrbitFigure::kInefficiencyRms, "inefficiency_rms_percent"},
    {OrbitFigure::kInefficiencyEnergyMean, "inefficiency_energy_mean_percent"},
    {OrbitFigure::kMeshLossPower, "mesh_loss_power_watts"},
    {OrbitFigure::kMeshLossTorque, "mesh_loss_torque_newton_metres"},
    {OrbitFigure::kPinionFrictionTorque, "pinion_friction_torque_newton_metres.mean"},
    {OrbitFigure::kFilmRatio, "film_ratio.mean"},
    {OrbitFigure::kContactTemperature, "contact_temperature_kelvin.mean"},
    {OrbitFigure::kTransmissionErrorMinimum, "dynamic_transmission_error_metres.minimum"},
    {OrbitFigure::kTransmissionErrorMaximum, "dynamic_transmission_error_metres.maximum"}};
static_assert(std::size(kOrbitFigureNames) == kOrbitFigures);

constexpr std::pair<LimitedFigure, const char*> kLimitedFigureNames[] = {
    {LimitedFigure::kFilmRatioMinimum, "film_ratio.minimum"},
    {LimitedFigure::kPressureMaximum, "maximum_pressure_pascals.maximum"},
    {LimitedFigure::kContactTemperatureMinimum, "contact_temperature_kelvin.minimum"},
    {LimitedFigure::kContactTemperatureMaximum, "contact_temperature_kelvin.maximum"},
    {LimitedFigure::kFlashTemperatureMaximum, "flash_temperature_rise_kelvin.maximum"}};

constexpr std::pair<WarningKind::Level, v1::WarningLevel> kWarningLevels[] = {
    {WarningKind::Level::kNote, v1::WARNING_LEVEL_NOTE},
    {WarningKind::Level::kCaution, v1::WARNING_LEVEL_CAUTION},
    {WarningKind::Level::kWithholdsVerdict, v1::WARNING_LEVEL_WITHHOLDS_VERDICT}};

void set(v1::PointSensitivities* out, const PointSensitivities& sensitivities) {
  for (int f = 0; f < kOrbitFigures; ++f) {
    out->add_figures(value_of(kOrbitFigureNames, static_cast<OrbitFigure>(f), ""));
    out->add_values(sensitivities.figure[static_cast<std::size_t>(f)]);
  }
  for (const ParameterSensitivity& parameter : sensitivities.parameters) {
    v1::ParameterSensitivity& added = *out->add_parameters();
    added.set_parameter(parameter.parameter);
    added.set_unit(parameter.unit);
    added.set_value(parameter.value);
    for (int f = 0; f < kOrbitFigures; ++f) {
      added.add_derivatives(parameter.derivative[static_cast<std::size_t>(f)]);
      const double elasticity = sensitivities.elasticity(parameter, static_cast<OrbitFigure>(f));
      added.add_elasticities(std::isfinite(elasticity) ? elasticity : 0);
    }
  }
  out->set_one_sided(sensitivities.one_sided);
}

void set_solver(v1::PointResult* out, const PointResult& result) {
  out->set_model(to_message(result.model));
  if (result.model != PointModel::kQuasiStatic) {
    out->set_steady_state_method(result.method == SteadyStateMethod::kShooting
                                     ? v1::STEADY_STATE_METHOD_SHOOTING
                                     : v1::STEADY_STATE_METHOD_MARCH);
  }
  out->set_settled(result.settled);
  out->set_period_in_mesh_cycles(result.period_in_mesh_cycles);
  out->set_recorded_mesh_cycles(result.recorded_mesh_cycles);
  if (result.estimated_relative_error) {
    out->set_estimated_relative_error(*result.estimated_relative_error);
  }
  set(out->mutable_statistics(), result.statistics);
  set(out->mutable_power_balance(), result.power_balance);
  if (result.coexisting_response) {
    set(out->mutable_coexisting_response(), *result.coexisting_response);
  }
  add_warnings(result.warnings, out->mutable_warnings());
  set(out->mutable_section_state(), result.section_state);
}

}  // namespace

template <class Warning>
void set_kind(Warning& warning) {
  const int number = warning_number(warning.code());
  warning.set_level(v1::WARNING_LEVEL_NOTE);
  if (number < 0) return;
  const WarningKind& kind = warning_kinds()[static_cast<std::size_t>(number)];
  warning.set_summary(std::string(kind.summary));
  warning.set_level(value_of(kWarningLevels, kind.level, v1::WARNING_LEVEL_NOTE));
}
template void set_kind(v1::RangeWarning&);
template void set_kind(v1::PointWarning&);
template void set_kind(v1::CandidateWarning&);

v1::RangeWarning to_message(const RangeWarning& warning) {
  v1::RangeWarning out;
  out.set_code(warning.code);
  out.set_message(warning.sentence);
  set_kind(out);
  return out;
}

void add_warnings(const std::vector<RangeWarning>& warnings,
                  google::protobuf::RepeatedPtrField<v1::RangeWarning>* out) {
  for (const RangeWarning& warning : warnings) *out->Add() = to_message(warning);
}

v1::EvaluateContactResponse to_message(const ContactSolution& s) {
  v1::EvaluateContactResponse out;
  out.set_status(s.status == ContactStatus::kNoLoad ? v1::CONTACT_STATUS_NO_LOAD
                                                    : v1::CONTACT_STATUS_OK);
  out.set_film_load_newtons(s.film_load);
  out.set_asperity_load_newtons(s.asperity_load);
  out.set_contact_area_square_metres(s.contact_area);
  out.set_asperity_area_square_metres(s.asperity_area);
  out.set_semi_major_axis_metres(s.semi_major_axis);
  out.set_semi_minor_axis_metres(s.semi_minor_axis);
  out.set_maximum_pressure_pascals(s.maximum_pressure);
  out.set_entrainment_angle_radians(s.entrainment_angle);
  out.set_entrainment_radius_metres(s.entrainment_radius);
  out.set_side_leakage_radius_metres(s.side_leakage_radius);
  out.set_entrainment_speed_metres_per_second(s.entrainment_speed);
  out.set_sliding_speed_metres_per_second(s.sliding_speed);
  out.set_inlet_viscosity_pascal_seconds(s.inlet_viscosity);
  out.set_inlet_pressure_viscosity_coefficient_per_pascal(s.inlet_pressure_viscosity_coefficient);
  out.set_pressure_viscosity_index(s.pressure_viscosity_index);
  out.set_reduced_modulus_pascals(s.reduced_modulus);
  out.set_central_film_thickness_metres(s.central_film_thickness);
  out.set_film_ratio(s.film_ratio);
  out.set_shear_rate_per_second(s.shear_rate);
  out.set_contact_temperature_kelvin(s.contact_temperature);
  out.set_flash_temperature_rise_kelvin(s.flash_temperature_rise);
  out.set_oil_temperature_rise_kelvin(s.oil_temperature_rise);
  out.set_pinion_active_length_metres(s.active_length_1);
  out.set_gear_active_length_metres(s.active_length_2);
  out.set_film_thermal_resistance_kelvin_per_watt(s.film_thermal_resistance);
  out.set_pinion_thermal_resistance_kelvin_per_watt(s.thermal_resistance_1);
  out.set_gear_thermal_resistance_kelvin_per_watt(s.thermal_resistance_2);
  out.set_heat_partition(s.heat_partition);
  out.set_mean_shear_stress_pascals(s.mean_shear_stress);
  out.set_viscous_friction_newtons(s.viscous_friction);
  out.set_boundary_friction_newtons(s.boundary_friction);
  out.set_friction_newtons(s.friction);
  out.set_heat_rate_watts(s.heat_rate);
  out.set_friction_coefficient(s.friction_coefficient);
  out.set_pinion_specific_sliding(s.specific_sliding_1);
  out.set_gear_specific_sliding(s.specific_sliding_2);
  out.set_limiting_stress_area_share(s.limiting_stress_area_share);
  out.set_limiting_stress_switches(s.limiting_stress_switches);
  out.set_limiting_stress_at_centre(s.limiting_stress_at_centre);
  out.set_thermal_roots(s.thermal_roots);
  out.set_model_version(kModelVersion);
  return out;
}

v1::FigureLimit to_message(const FigureLimit& limit) {
  v1::FigureLimit out;
  out.set_figure(value_of(kLimitedFigureNames, limit.figure, ""));
  if (limit.minimum) out.set_minimum(*limit.minimum);
  if (limit.maximum) out.set_maximum(*limit.maximum);
  out.set_source(limit.source);
  return out;
}

v1::PointModel to_message(PointModel model) {
  return model == PointModel::kQuasiStatic ? v1::POINT_MODEL_QUASI_STATIC : v1::POINT_MODEL_FULL;
}

v1::PointResult to_message(const PointResult& result, int maximum_contact_losses) {
  v1::PointResult out;
  out.set_vehicle_speed_kilometres_per_hour(kilometres_per_hour(result.vehicle_speed));
  out.set_mean_pinion_speed_radians_per_second(result.mean_pinion_speed);
  out.set_mesh_frequency_hertz(result.mesh_frequency);
  out.set_pinion_torque_newton_metres(result.pinion_torque);
  out.set_wheel_torque_newton_metres(result.wheel_torque);
  out.set_input_power_watts(result.input_power);
  set_losses(&out, result);
  set(out.mutable_dynamic_transmission_error_metres(), result.dynamic_transmission_error);
  set(out.mutable_mesh_force_newtons(), result.mesh_force);
  set(out.mutable_pinion_friction_torque_newton_metres(), result.pinion_friction_torque);
  set(out.mutable_gear_friction_torque_newton_metres(), result.gear_friction_torque);
  out.set_contact_loss(result.contact_loss);
  out.set_coast_side_contact(result.coast_side_contact);
  out.set_contact_loss_time_share(result.contact_loss_time_share);
  set_contact_losses(&out, result, maximum_contact_losses);
  set(out.mutable_central_film_thickness_metres(), result.central_film_thickness);
  set(out.mutable_film_ratio(), result.film_ratio);
  set(out.mutable_contact_temperature_kelvin(), result.contact_temperature);
  set(out.mutable_maximum_pressure_pascals(), result.maximum_pressure);
  set(out.mutable_shear_rate_per_second(), result.shear_rate);
  set(out.mutable_flash_temperature_rise_kelvin(), result.flash_temperature_rise);
  set(out.mutable_friction_coefficient(), result.friction_coefficient);
  set(out.mutable_pinion_specific_sliding(), result.pinion_specific_sliding);
  set(out.mutable_gear_specific_sliding(), result.gear_specific_sliding);
  out.set_limiting_stress_time_share(result.limiting_stress_time_share);
  out.set_limiting_stress_area_share(result.limiting_stress_area_share);
  out.set_inlet_heating_factor(result.inlet_heating_factor);
  set_solver(&out, result);
  if (result.sensitivities) set(out.mutable_sensitivities(), *result.sensitivities);
  return out;
}

v1::CurvePoint to_curve_point(const PointResult& result) {
  v1::CurvePoint out;
  out.set_speed_kilometres_per_hour(kilometres_per_hour(result.vehicle_speed));
  *out.mutable_result() = to_message(result, kContactLossesOfAPoint);
  return out;
}

v1::CurvePoint to_curve_point(const SweepPoint& point) {
  v1::CurvePoint out;
  out.set_speed_kilometres_per_hour(kilometres_per_hour(point.vehicle_speed));
  if (point.result) {
    *out.mutable_result() = to_message(*point.result, kContactLossesOfACurvePoint);
  } else {
    out.set_refusal_reason(point.refusal_reason);
    out.set_refusal_message(point.refusal_sentence);
  }
  if (point.branch_end) {
    out.mutable_branch_end()->set_followed_to_kilometres_per_hour(
        kilometres_per_hour(point.branch_end->followed_to));
    out.mutable_branch_end()->set_gone_at_kilometres_per_hour(
        kilometres_per_hour(point.branch_end->gone_at));
  }
  return out;
}

double kilometres_per_hour(double metres_per_second) {
  const double value = metres_per_second * 3.6;
  if (value == 0 || !std::isfinite(value)) return value;
  const double scale = std::pow(10.0, 11 - std::floor(std::log10(std::abs(value))));
  return std::round(value * scale) / scale;
}

}  // namespace tribodyn::server
