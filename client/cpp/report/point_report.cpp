#include "client/cpp/report/point_report.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "client/cpp/report/limits_report.h"
#include "client/cpp/report/precision.h"
#include "client/cpp/text/inputs.h"
#include "client/cpp/text/table.h"
#include "client/cpp/text/text.h"
#include "client/cpp/text/units.h"
#include "client/cpp/text/warnings.h"

namespace tribodyn::client {
namespace {

void add_heading(const v1::Simulation& simulation, Sheet& sheet) {
  const double seconds = run_seconds(simulation);
  sheet.heading(simulation.name() + ": " + study_text(simulation) +
                (seconds >= 0 ? " (solved in " + duration_text(seconds) + ")" : ""));
  sheet.remark(simulation.lubricant() + ", " + inputs_text(simulation));
  sheet.remark("model: " + model_options_text(simulation.model_options()));
}

/// Whether the wheel drives the pinion.
bool is_coast(const v1::PointResult& result) { return result.pinion_torque_newton_metres() < 0; }

std::string share_of(double part, double whole) {
  return whole > 0 ? fixed(100 * part / whole, 1) + " % of mesh loss" : "";
}

void add_losses(const v1::PointResult& result, const Precision& precision, Sheet& sheet) {
  sheet.heading("Mesh loss (at the tooth contact; excludes bearings, churning and seals)");
  const double mean = result.inefficiency_energy_mean_percent();
  const bool has_mean = result.has_inefficiency_energy_mean_percent();
  sheet.line(
      "inefficiency, energy mean", has_mean ? precision.estimated(mean, 4) : "-", "%",
      (has_mean && precision.is_estimated() ? "solver error " + precision.error_of(mean) + "; "
                                            : "") +
          "loss energy / input energy");
  sheet.line("inefficiency, RMS",
             result.has_inefficiency_rms_percent()
                 ? precision.estimated(result.inefficiency_rms_percent(), 4)
                 : "-",
             "%", "eq 30, RMS over time");
  if (precision.is_estimated()) {
    sheet.line("relative solver error", precision.error_percent(), "%",
               result.settled() ? "of each inefficiency, loss, torque and transmission error"
                                : "of each inefficiency, loss and torque: 95 % interval");
  } else {
    sheet.line("relative solver error", "not estimated", "", "three digits are given");
  }
  const double loss = result.mesh_loss_power_watts();
  const bool kilowatts = std::abs(loss) >= 1000;
  const double unit = kilowatts ? 1e3 : 1;
  const auto power = [&](double part) {
    return precision.part(part / unit, loss / unit, kilowatts ? 4 : 2);
  };
  const char* unit_text = kilowatts ? "kW" : "W";
  sheet.line("mesh loss", power(loss), unit_text,
             "of " + precision.estimated(1e-3 * result.input_power_watts(), 4) + " kW input " +
                 (is_coast(result) ? "at the wheel: coast" : "at the pinion"));
  sheet.line("  viscous", power(result.viscous_loss_power_watts()), unit_text,
             share_of(result.viscous_loss_power_watts(), loss));
  sheet.line("  boundary", power(result.boundary_loss_power_watts()), unit_text,
             share_of(result.boundary_loss_power_watts(), loss));
  for (int slot = 0; slot < result.flank_losses_size(); ++slot) {
    const auto& flank = result.flank_losses(slot);
    sheet.line("  flank slot " + std::to_string(slot),
               power(flank.viscous_watts() + flank.boundary_watts()), unit_text,
               power(flank.viscous_watts()) + " viscous + " + power(flank.boundary_watts()) +
                   " boundary; friction coefficient " +
                   precision.other(flank.friction_coefficient(), 5));
  }
  sheet.line("mesh friction coefficient", precision.other(result.friction_coefficient().mean(), 5),
             "", "friction / normal load, load-weighted mean of all flanks");
  sheet.line("mesh loss torque", precision.estimated(result.mesh_loss_torque_newton_metres(), 4),
             "N m", "at the pinion");
  sheet.line("boundary / viscous friction",
             precision.other(result.boundary_to_viscous_friction_ratio(), 4), "", "of RMS forces");
}

/// Adds the operating conditions. One of the torques is an input or follows from the vehicle; the
/// solver determines the other.
void add_operation(const v1::PointResult& result, bool is_pinion_torque_given,
                   const Precision& precision, Sheet& sheet) {
  const auto torque = [&](double value, bool is_given) {
    return is_given ? fixed(value, 3) : precision.estimated(value, 3);
  };
  sheet.heading("Operation");
  sheet.line("vehicle speed", fixed(result.vehicle_speed_kilometres_per_hour(), 2), "km/h");
  sheet.line("pinion speed", fixed(result.mean_pinion_speed_radians_per_second(), 3), "rad/s");
  sheet.line("mesh frequency", fixed(result.mesh_frequency_hertz(), 2), "Hz");
  sheet.line("pinion torque", torque(result.pinion_torque_newton_metres(), is_pinion_torque_given),
             "N m");
  sheet.line("wheel torque", torque(result.wheel_torque_newton_metres(), !is_pinion_torque_given),
             "N m");
}

template <class Cell>
void add_extremes(const char* label, const char* unit, const v1::Extremes& extremes,
                  const Cell& cell, Table& table) {
  table.add_row(
      {label, unit, cell(extremes.minimum()), cell(extremes.mean()), cell(extremes.maximum())});
}

std::string cycle_table(const v1::PointResult& result, const Precision& precision) {
  Table table({{"Over the steady state", "", Table::Align::kLeft},
               {"unit", "", Table::Align::kLeft},
               {"minimum", "", Table::Align::kDecimal},
               {"mean", "", Table::Align::kDecimal},
               {"maximum", "", Table::Align::kDecimal}});
  const auto add = [&](const char* label, const char* unit, const v1::Extremes& extremes,
                       double factor, double offset, int decimals) {
    add_extremes(
        label, unit, extremes,
        [&](double value) { return precision.other(factor * value + offset, decimals); }, table);
  };
  add("central film thickness", "um", result.central_film_thickness_metres(), 1e6, 0, 4);
  add("film ratio lambda", "", result.film_ratio(), 1, 0, 3);
  add("contact temperature", "C", result.contact_temperature_kelvin(), 1, -kZeroCelsius, 2);
  add("maximum pressure", "GPa", result.maximum_pressure_pascals(), 1e-9, 0, 4);
  add("shear rate", "1e6/s", result.shear_rate_per_second(), 1e-6, 0, 3);
  add("flash temperature rise", "K", result.flash_temperature_rise_kelvin(), 1, 0, 2);
  add("friction coefficient", "", result.friction_coefficient(), 1, 0, 5);
  add("specific sliding, pinion", "", result.pinion_specific_sliding(), 1, 0, 3);
  add("specific sliding, gear", "", result.gear_specific_sliding(), 1, 0, 3);
  const v1::Extremes& error = result.dynamic_transmission_error_metres();
  const double largest = std::max(std::abs(error.minimum()), std::abs(error.maximum()));
  add_extremes(
      "transmission error (DTE)", "um", error,
      [&](double value) {
        return result.settled() ? precision.part(1e6 * value, 1e6 * largest, 3)
                                : precision.other(1e6 * value, 3);
      },
      table);
  add("mesh force", "kN", result.mesh_force_newtons(), 1e-3, 0, 4);
  add("friction torque, pinion", "N m", result.pinion_friction_torque_newton_metres(), 1, 0, 4);
  add("friction torque, gear", "N m", result.gear_friction_torque_newton_metres(), 1, 0, 4);
  return table.text();
}

/// Adds the coexisting response with three digits: the error estimate applies only to the requested
/// response.
void add_coexisting(const v1::CoexistingResponse& other, Sheet& sheet) {
  const Precision precision({}, {});
  const auto figure = [&](double value, int decimals) { return precision.other(value, decimals); };
  sheet.heading("Another steady state exists at this point");
  sheet.line("inefficiency, energy mean", figure(other.inefficiency_energy_mean_percent(), 4), "%");
  sheet.line("inefficiency, RMS", figure(other.inefficiency_rms_percent(), 4), "%");
  sheet.line("pinion torque", figure(other.pinion_torque_newton_metres(), 3), "N m");
  sheet.line("transmission error (DTE)",
             figure(1e6 * other.dynamic_transmission_error_minimum_metres(), 3), "um",
             "to " + figure(1e6 * other.dynamic_transmission_error_maximum_metres(), 3) + " um");
  sheet.line("contact loss", other.contact_loss() ? "yes" : "no");
}

void add_contact(const v1::PointResult& result, bool probed, const Precision& precision,
                 Sheet& sheet) {
  const auto figure = [&](double value, int decimals) { return precision.other(value, decimals); };
  sheet.heading("Contact");
  sheet.line("contact loss", result.contact_loss() ? "yes" : "no");
  if (result.contact_loss()) {
    sheet.line("  share of time", figure(100 * result.contact_loss_time_share(), 2), "%");
    for (const auto& loss : result.contact_losses()) {
      sheet.line("  apart", figure(1e3 * loss.duration_seconds(), 4), "ms",
                 "from mesh phase " + figure(loss.start_mesh_phase(), 4) + " to " +
                     figure(loss.end_mesh_phase(), 4) + " cycles");
    }
    if (result.contact_losses_left_out() > 0) {
      sheet.line("  further separations", std::to_string(result.contact_losses_left_out()));
    }
  }
  sheet.line("coast side contact", result.coast_side_contact() ? "yes" : "no");
  sheet.line("limiting stress at a centre", figure(100 * result.limiting_stress_time_share(), 2),
             "%", "of time");
  sheet.line("limiting stress, area", figure(100 * result.limiting_stress_area_share(), 2), "%",
             "load-time mean");
  if (result.has_coexisting_response()) {
    add_coexisting(result.coexisting_response(), sheet);
  } else if (probed) {
    sheet.line("another steady state", "not found from a second initial state");
  }
}

void add_energy_balance(const v1::PointResult& result, const Precision& precision, Sheet& sheet) {
  const v1::PowerBalance& power = result.power_balance();
  const bool coast = is_coast(result);
  const double input = coast ? -power.output_joules() : power.input_joules();
  const double output = coast ? -power.input_joules() : power.output_joules();
  if (input == 0) return;
  const double dampers = power.shaft_damping_joules() + power.mesh_damping_joules();
  const double gap = input - output - power.friction_joules() - dampers - power.stored_joules() -
                     power.parametric_joules();
  const auto joules = [&](double part) { return precision.part(part, input, 4); };
  sheet.line("energy balance", joules(input) + " J in = " + joules(output) + " out + " +
                                   joules(power.friction_joules()) + " friction + " +
                                   joules(dampers) + " dampers + " + joules(power.stored_joules()) +
                                   " stored + " + joules(power.parametric_joules()) +
                                   " parametric (gap " + significant(gap, 2) + ")");
}

std::string model_name(v1::PointModel model) {
  return model == v1::POINT_MODEL_QUASI_STATIC ? "quasi-static" : "full (4 degrees of freedom)";
}

/// Returns the reason for the model that was used.
std::string model_reason(const v1::Simulation& simulation, const v1::PointResult& result) {
  const v1::OperatingPointStudy& study = simulation.operating_point();
  if (simulation.has_inefficiency_curve()) return "";
  if (study.model() == v1::POINT_MODEL_FULL || study.model() == v1::POINT_MODEL_QUASI_STATIC) {
    return "as requested";
  }
  if (result.model() == v1::POINT_MODEL_QUASI_STATIC)
    return "its estimated error is within the tolerance";
  if (study.probe_coexisting_response() || study.has_history() ||
      study.start() == v1::POINT_START_LARGE_VIBRATION ||
      simulation.solver_options().method() == v1::STEADY_STATE_METHOD_MARCH) {
    return "required for the requested output";
  }
  return "the error of a cheaper model may exceed the tolerance";
}

std::string cycles_text(int mesh_cycles) {
  return std::to_string(mesh_cycles) + (mesh_cycles == 1 ? " mesh cycle" : " mesh cycles");
}

/// Adds the model and the steady state in one line each, and the statistics if `with_statistics`.
void add_solver(const v1::Simulation& simulation, const v1::PointResult& result,
                const Precision& precision, bool with_statistics, Sheet& sheet) {
  sheet.heading("Solver");
  sheet.line("model used", model_name(result.model()), "", model_reason(simulation, result));
  if (!with_statistics) {
    sheet.line("steady state", "settled, period of " + cycles_text(result.period_in_mesh_cycles()),
               "", "its statistics: --solver-details");
    return;
  }
  if (result.steady_state_method() != v1::STEADY_STATE_METHOD_UNSPECIFIED) {
    sheet.line("steady state by", result.steady_state_method() == v1::STEADY_STATE_METHOD_SHOOTING
                                      ? "shooting under lagged friction"
                                      : "marching");
  }
  sheet.line("steady state", result.settled() ? "settled" : "not settled: averages of a record");
  sheet.line("period", result.period_in_mesh_cycles() > 0
                           ? cycles_text(result.period_in_mesh_cycles())
                           : "none found; averages over " +
                                 std::to_string(result.recorded_mesh_cycles()) + " mesh cycles");
  const auto& statistics = result.statistics();
  sheet.line("periodicity defect", significant(statistics.periodicity_defect(), 3));
  sheet.line("largest Floquet multiplier", significant(statistics.largest_multiplier(), 3));
  if (statistics.slowest_decay_rate_per_second() != 0) {
    sheet.line("slowest disturbance decays at",
               significant(statistics.slowest_decay_rate_per_second(), 3), "1/s");
  }
  sheet.line("marched", std::to_string(statistics.mesh_cycles()) + " mesh cycles, " +
                            std::to_string(statistics.accepted_steps()) + " steps (" +
                            std::to_string(statistics.rejected_steps()) + " rejected), " +
                            std::to_string(statistics.events()) + " events, " +
                            std::to_string(statistics.accelerations()) + " accelerations");
  sheet.line("evaluated", std::to_string(statistics.right_hand_sides()) + " right-hand sides, " +
                              std::to_string(statistics.contact_solutions()) + " contacts");
  add_energy_balance(result, precision, sheet);
}

}  // namespace

std::string point_report(const v1::Simulation& simulation, const ResultDetails& details) {
  const auto& point = simulation.result().points_size() > 0 ? simulation.result().points(0)
                                                            : v1::CurvePoint::default_instance();
  Sheet head;
  add_heading(simulation, head);
  if (!point.has_result()) {
    head.remark("no result: " + point.refusal_message() + " [" + point.refusal_reason() + "]");
    return head.text();
  }
  const v1::PointResult& result = point.result();
  const Precision precision(simulation, result);
  Sheet losses;
  add_losses(result, precision, losses);
  add_operation(result, simulation.operating_point().has_prescribed_torque(), precision, losses);
  Sheet rest;
  add_contact(result, simulation.operating_point().probe_coexisting_response(), precision, rest);
  const bool unusual = !result.settled() || result.period_in_mesh_cycles() == 0;
  add_solver(simulation, result, precision, details.solver || unusual, rest);
  add_provenance(simulation.result(), details.assumptions, rest);
  add_input_warnings(simulation.result().input_warnings(), rest);
  add_warnings(simulation, rest);
  const std::string limits = limits_report(simulation.result());
  return head.text() + "\n" + losses.text() + "\n" + cycle_table(result, precision) + "\n" +
         (limits.empty() ? "" : limits + "\n") + rest.text();
}

}  // namespace tribodyn::client
