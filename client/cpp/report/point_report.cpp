#include "client/cpp/report/point_report.h"

#include <string>

#include "client/cpp/report/inputs.h"
#include "client/cpp/text/table.h"
#include "client/cpp/text/text.h"

namespace tribodyn::client {
namespace {

constexpr double kKelvinOfZeroCelsius = 273.15;

void add_heading(const v1::Simulation& simulation, Sheet& sheet) {
  const double seconds = run_seconds(simulation);
  sheet.heading(simulation.name() + ": " + study_text(simulation) +
                (seconds >= 0 ? " (solved in " + duration_text(seconds) + ")" : ""));
  sheet.remark(simulation.lubricant() + ", " + inputs_text(simulation));
  sheet.remark("model: " + model_options_text(simulation.model_options()));
}

std::string share_of(double part, double whole) {
  return whole > 0 ? fixed(100 * part / whole, 1) + " % of it" : "";
}

void add_losses(const v1::PointResult& result, Sheet& sheet) {
  sheet.heading("Mesh loss (conjunctional; bearings, churning and seals are not in it)");
  sheet.line("inefficiency, energy mean",
             result.has_inefficiency_energy_mean_percent()
                 ? fixed(result.inefficiency_energy_mean_percent(), 4)
                 : "-",
             "%", "loss energy over input energy");
  sheet.line(
      "inefficiency, RMS",
      result.has_inefficiency_rms_percent() ? fixed(result.inefficiency_rms_percent(), 4) : "-",
      "%", "eq 30, RMS over time");
  const double loss = result.mesh_loss_power_watts();
  sheet.line("mesh loss", fixed(loss, 2), "W",
             "of " + fixed(result.input_power_watts(), 1) + " W input");
  sheet.line("  viscous", fixed(result.viscous_loss_power_watts(), 2), "W",
             share_of(result.viscous_loss_power_watts(), loss));
  sheet.line("  boundary", fixed(result.boundary_loss_power_watts(), 2), "W",
             share_of(result.boundary_loss_power_watts(), loss));
  for (int slot = 0; slot < result.flank_losses_size(); ++slot) {
    const auto& flank = result.flank_losses(slot);
    sheet.line("  flank slot " + std::to_string(slot),
               fixed(flank.viscous_watts() + flank.boundary_watts(), 2), "W",
               fixed(flank.viscous_watts(), 2) + " viscous + " + fixed(flank.boundary_watts(), 2) +
                   " boundary");
  }
  sheet.line("mesh loss torque", fixed(result.mesh_loss_torque_newton_metres(), 4), "N m",
             "at the pinion");
  sheet.line("boundary / viscous friction", fixed(result.boundary_to_viscous_friction_ratio(), 4),
             "", "of RMS forces");
}

void add_operation(const v1::PointResult& result, Sheet& sheet) {
  sheet.heading("Operation");
  sheet.line("vehicle speed", fixed(result.vehicle_speed_kilometers_per_hour(), 2), "km/h");
  sheet.line("pinion speed", fixed(result.mean_pinion_speed_radians_per_second(), 3), "rad/s");
  sheet.line("mesh frequency", fixed(result.mesh_frequency_hertz(), 2), "Hz");
  sheet.line("pinion torque T_s", fixed(result.pinion_torque_newton_metres(), 3), "N m");
  sheet.line("wheel torque T_w", fixed(result.wheel_torque_newton_metres(), 3), "N m");
}

void add_extremes(const char* label, const char* unit, const v1::Extremes& extremes, double factor,
                  double offset, int decimals, Table& table) {
  const auto cell = [&](double value) { return fixed(factor * value + offset, decimals); };
  table.add_row(
      {label, unit, cell(extremes.minimum()), cell(extremes.mean()), cell(extremes.maximum())});
}

std::string cycle_table(const v1::PointResult& result) {
  Table table({{"Over the steady state", "", Table::Align::kLeft},
               {"unit", "", Table::Align::kLeft},
               {"minimum", ""},
               {"mean", ""},
               {"maximum", ""}});
  add_extremes("central film thickness", "um", result.central_film_thickness_metres(), 1e6, 0, 4,
               table);
  add_extremes("film ratio lambda", "", result.film_ratio(), 1, 0, 3, table);
  add_extremes("contact temperature", "C", result.contact_temperature_kelvin(), 1,
               -kKelvinOfZeroCelsius, 2, table);
  add_extremes("maximum pressure", "GPa", result.maximum_pressure_pascals(), 1e-9, 0, 4, table);
  add_extremes("shear rate", "1e6/s", result.shear_rate_per_second(), 1e-6, 0, 3, table);
  add_extremes("transmission error (DTE)", "um", result.dynamic_transmission_error_metres(), 1e6, 0,
               3, table);
  add_extremes("mesh force", "N", result.mesh_force_newtons(), 1, 0, 1, table);
  add_extremes("friction torque, pinion", "N m", result.pinion_friction_torque_newton_metres(), 1,
               0, 4, table);
  add_extremes("friction torque, gear", "N m", result.gear_friction_torque_newton_metres(), 1, 0, 4,
               table);
  return table.text();
}

void add_contact(const v1::PointResult& result, bool probed, Sheet& sheet) {
  sheet.heading("Contact");
  sheet.line("contact loss", result.contact_loss() ? "yes" : "no");
  if (result.contact_loss()) {
    sheet.line("  share of time", fixed(100 * result.contact_loss_time_share(), 2), "%");
    for (const auto& loss : result.contact_losses()) {
      sheet.line("  apart", fixed(1e3 * loss.duration_seconds(), 4), "ms",
                 "from mesh phase " + fixed(loss.start_mesh_phase(), 4) + " to " +
                     fixed(loss.end_mesh_phase(), 4) + " cycles");
    }
    if (result.contact_losses_left_out() > 0) {
      sheet.line("  and more of them", std::to_string(result.contact_losses_left_out()));
    }
  }
  sheet.line("coast side contact", result.coast_side_contact() ? "yes" : "no");
  sheet.line("limiting stress at a centre", fixed(100 * result.limiting_stress_time_share(), 2),
             "%", "of time");
  sheet.line("limiting stress, area", fixed(100 * result.limiting_stress_area_share(), 2), "%",
             "load-time mean");
  if (!result.has_coexisting_response()) {
    if (probed) sheet.line("another steady state", "none found from the other start");
    return;
  }
  const auto& other = result.coexisting_response();
  sheet.heading("Another steady state exists at this point");
  sheet.line("inefficiency, energy mean", fixed(other.inefficiency_energy_mean_percent(), 4), "%");
  sheet.line("inefficiency, RMS", fixed(other.inefficiency_rms_percent(), 4), "%");
  sheet.line("pinion torque T_s", fixed(other.pinion_torque_newton_metres(), 3), "N m");
  sheet.line("transmission error (DTE)",
             fixed(1e6 * other.dynamic_transmission_error_minimum_metres(), 3), "um",
             "to " + fixed(1e6 * other.dynamic_transmission_error_maximum_metres(), 3) + " um");
  sheet.line("contact loss", other.contact_loss() ? "yes" : "no");
}

void add_solver(const v1::PointResult& result, Sheet& sheet) {
  sheet.heading("Solver");
  sheet.line("model used",
             result.model() == v1::QUASI_STATIC ? "quasi-static" : "full (4 degrees of freedom)");
  if (result.steady_state_method() != v1::STEADY_STATE_METHOD_UNSPECIFIED) {
    sheet.line("steady state by", result.steady_state_method() == v1::SHOOTING
                                      ? "shooting under lagged friction"
                                      : "marching");
  }
  sheet.line("estimated relative error", result.has_estimated_relative_error()
                                             ? significant(result.estimated_relative_error(), 2)
                                             : "not estimated");
  sheet.line("steady state", result.settled() ? "settled" : "not settled: averages of a record");
  sheet.line("period",
             result.period_in_mesh_cycles() > 0
                 ? std::to_string(result.period_in_mesh_cycles()) +
                       (result.period_in_mesh_cycles() == 1 ? " mesh cycle" : " mesh cycles")
                 : "none found; averages over " + std::to_string(result.recorded_mesh_cycles()) +
                       " mesh cycles");
  const auto& statistics = result.statistics();
  sheet.line("periodicity defect", significant(statistics.periodicity_defect(), 3));
  sheet.line("largest Floquet multiplier", significant(statistics.largest_multiplier(), 4));
  sheet.line("marched", std::to_string(statistics.mesh_cycles()) + " mesh cycles, " +
                            std::to_string(statistics.accepted_steps()) + " steps (" +
                            std::to_string(statistics.rejected_steps()) + " rejected), " +
                            std::to_string(statistics.events()) + " events, " +
                            std::to_string(statistics.accelerations()) + " accelerations");
  sheet.line("evaluated", std::to_string(statistics.right_hand_sides()) + " right-hand sides, " +
                              std::to_string(statistics.contact_solutions()) + " contacts");
  const auto& power = result.power_balance();
  if (power.input_joules() == 0) return;
  const double gap = power.input_joules() - power.output_joules() - power.friction_joules() -
                     power.shaft_damping_joules() - power.mesh_damping_joules() -
                     power.stored_joules() - power.parametric_joules();
  sheet.line("energy balance",
             significant(power.input_joules(), 6) +
                 " J in = " + significant(power.output_joules(), 6) + " out + " +
                 significant(power.friction_joules(), 4) + " friction + " +
                 significant(power.shaft_damping_joules() + power.mesh_damping_joules(), 4) +
                 " dampers + " + significant(power.stored_joules(), 3) + " stored + " +
                 significant(power.parametric_joules(), 3) + " parametric (gap " +
                 significant(gap, 2) + ")");
}

}  // namespace

std::string point_report(const v1::Simulation& simulation, bool shows_assumptions) {
  const auto& point = simulation.result().points_size() > 0 ? simulation.result().points(0)
                                                            : v1::CurvePoint::default_instance();
  Sheet head;
  add_heading(simulation, head);
  if (!point.has_result()) {
    head.remark("no result: " + point.refusal_message() + " [" + point.refusal_reason() + "]");
    return head.text();
  }
  const v1::PointResult& result = point.result();
  Sheet losses;
  add_losses(result, losses);
  add_operation(result, losses);
  Sheet rest;
  add_contact(result, simulation.operating_point().probe_coexisting_response(), rest);
  add_solver(result, rest);
  add_provenance(simulation.result(), shows_assumptions, rest);
  if (result.warnings_size() > 0) rest.heading("Outside the validated range");
  for (const auto& warning : result.warnings()) {
    rest.remark(warning.code() + ": " + warning.message());
  }
  return head.text() + "\n" + losses.text() + "\n" + cycle_table(result) + "\n" + rest.text();
}

}  // namespace tribodyn::client
