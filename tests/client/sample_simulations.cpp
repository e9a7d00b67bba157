#include "tests/client/sample_simulations.h"

#include <cmath>

namespace tribodyn::client {
namespace {

void set_extremes(v1::Extremes& extremes, double minimum, double mean, double maximum) {
  extremes.set_minimum(minimum);
  extremes.set_mean(mean);
  extremes.set_maximum(maximum);
}

void fill_result(double speed, double level, v1::PointResult& result) {
  const bool separates = speed >= 65 && speed <= 80;
  const double inefficiency = level * (1.35 - 0.002 * (speed - 20)) + (separates ? 0.08 : 0);
  const double input = 20 * speed * (1 + speed * speed / 5000);
  result.set_vehicle_speed_kilometres_per_hour(speed);
  result.set_mean_pinion_speed_radians_per_second(2.75 * speed);
  result.set_mesh_frequency_hertz(5.68 * speed);
  result.set_pinion_torque_newton_metres(input / (2.75 * speed));
  result.set_wheel_torque_newton_metres(2.7 * input / (2.75 * speed));
  result.set_input_power_watts(input);
  result.set_inefficiency_energy_mean_percent(inefficiency);
  result.set_inefficiency_rms_percent(inefficiency * (separates ? 1.3 : 1.03));
  result.set_mesh_loss_power_watts(input * inefficiency / 100);
  result.set_viscous_loss_power_watts(input * inefficiency / 130);
  result.set_boundary_loss_power_watts(input * inefficiency * (1 / 100.0 - 1 / 130.0));
  for (int slot = 0; slot < 3; ++slot) {
    auto& flank = *result.add_flank_losses();
    flank.set_viscous_watts(slot + 1);
    flank.set_boundary_watts(0.1 * slot);
  }
  set_extremes(*result.mutable_central_film_thickness_metres(), 2e-7, 3e-9 * speed, 4e-9 * speed);
  set_extremes(*result.mutable_film_ratio(), 0.5, 3e-9 * speed / 4e-7, 1.5);
  set_extremes(*result.mutable_contact_temperature_kelvin(), 333, 335 + 0.2 * speed,
               340 + 0.4 * speed);
  set_extremes(*result.mutable_maximum_pressure_pascals(), 4e8, 5e8, 6.016e8);
  set_extremes(*result.mutable_dynamic_transmission_error_metres(), 7e-5, 8e-5, 9e-5);
  result.set_contact_loss(separates);
  result.set_model(v1::POINT_MODEL_FULL);
  result.set_settled(true);
  result.set_period_in_mesh_cycles(1);
  result.mutable_power_balance()->set_input_joules(10);
}

void succeed(v1::Simulation& simulation) {
  simulation.set_gear_set("gearSets/A");
  simulation.set_surface("surfaces/run-in");
  simulation.set_vehicle("vehicles/passenger-car");
  simulation.set_sump_temperature_celsius(40);
  simulation.set_inlet_temperature_rise_kelvin(20);
  simulation.set_state(v1::Simulation::SUCCEEDED);
  simulation.mutable_start_time()->set_seconds(100);
  simulation.mutable_end_time()->set_seconds(103);
  simulation.mutable_result()->set_model_version("tribodyn-model-2");
  simulation.mutable_result()->set_input_hash("abc123");
}

}  // namespace

v1::Simulation sample_curve(const std::string& lubricant, double level) {
  v1::Simulation simulation;
  simulation.set_name("simulations/curve" + lubricant);
  simulation.set_lubricant("lubricants/" + lubricant);
  succeed(simulation);
  auto& study = *simulation.mutable_inefficiency_curve();
  study.set_direction(v1::SWEEP_DIRECTION_UP);
  for (int speed = 20; speed <= 140; speed += 5) {
    study.add_speeds_kilometres_per_hour(speed);
    v1::CurvePoint& point = *simulation.mutable_result()->add_points();
    point.set_speed_kilometres_per_hour(speed);
    fill_result(speed, level, *point.mutable_result());
  }
  return simulation;
}

v1::Simulation sample_point() {
  v1::Simulation simulation;
  simulation.set_name("simulations/p1");
  simulation.set_lubricant("lubricants/1");
  succeed(simulation);
  simulation.mutable_model_options()->set_isothermal(true);
  simulation.mutable_model_options()->mutable_as_published()->set_eq17_atan(true);
  simulation.mutable_operating_point()->mutable_cruise()->set_speed_kilometres_per_hour(72.5);
  v1::CurvePoint& point = *simulation.mutable_result()->add_points();
  point.set_speed_kilometres_per_hour(72.5);
  v1::PointResult& result = *point.mutable_result();
  fill_result(72.5, 1, result);
  v1::ContactLoss& loss = *result.add_contact_losses();
  loss.set_start_mesh_phase(0.25);
  loss.set_end_mesh_phase(0.5);
  loss.set_duration_seconds(6e-4);
  result.mutable_coexisting_response()->set_inefficiency_energy_mean_percent(1.11);
  result.set_estimated_relative_error(1.2e-6);
  v1::RangeWarning& warning = *result.add_warnings();
  warning.set_code("FILM_RATIO_LOW");
  warning.set_message("lambda = 0.3 is below the validated 0.5");
  v1::Assumption& assumption = *simulation.mutable_result()->add_assumptions();
  assumption.set_resource("surfaces/run-in");
  assumption.set_field("asperity_radius_metres");
  assumption.set_value("4e-05 m");
  assumption.set_provenance(v1::PROVENANCE_ASSUMED);
  assumption.set_source("inside the published range");
  return simulation;
}

v1::History sample_history() {
  constexpr int kRows = 384;
  v1::History history;
  history.set_total_rows(kRows);
  for (const char* name : {"time_seconds", "mesh_force_newtons", "flank_load_newtons_flank_0",
                           "flank_load_newtons_flank_1", "flank_load_newtons_flank_2"}) {
    auto& column = *history.add_columns();
    column.set_name(name);
    const int index = history.columns_size();
    for (int row = 0; row < kRows; ++row) {
      column.add_values(index == 1 ? 1e-5 * row : 900 + 300 * std::sin(0.0327 * row + index));
    }
  }
  return history;
}

}  // namespace tribodyn::client
