#include "client/cpp/report/curve_report.h"

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "client/cpp/report/inputs.h"
#include "client/cpp/report/precision.h"
#include "client/cpp/text/csv.h"
#include "client/cpp/text/table.h"
#include "client/cpp/text/text.h"
#include "client/cpp/text/units.h"

namespace tribodyn::client {
namespace {

Table curve_table(const v1::Simulation& simulation) {
  Table table({{"speed", "km/h"},
               {"inefficiency", "energy mean %"},
               {"inefficiency", "RMS %"},
               {"error", "estimated %"},
               {"mesh loss", "W"},
               {"T_s", "N m"},
               {"film", "mean um"},
               {"lambda", "min"},
               {"lambda", "mean"},
               {"T contact", "mean C"},
               {"T contact", "max C"},
               {"contact", "lost"}});
  for (const v1::CurvePoint& point : simulation.result().points()) {
    const std::string speed = significant(point.speed_kilometers_per_hour());
    if (!point.has_result()) {
      table.add_row({speed, "refused"});
      continue;
    }
    const v1::PointResult& at = point.result();
    const Precision precision(simulation, at);
    table.add_row(
        {speed,
         at.has_inefficiency_energy_mean_percent()
             ? precision.estimated(at.inefficiency_energy_mean_percent(), 3)
             : "-",
         at.has_inefficiency_rms_percent() ? precision.estimated(at.inefficiency_rms_percent(), 3)
                                           : "-",
         precision.error_percent(), precision.estimated(at.mesh_loss_power_watts(), 1),
         precision.estimated(at.pinion_torque_newton_metres(), 2),
         precision.other(1e6 * at.central_film_thickness_metres().mean(), 3),
         precision.other(at.film_ratio().minimum(), 2), precision.other(at.film_ratio().mean(), 2),
         precision.other(at.contact_temperature_kelvin().mean() - kZeroCelsius, 1),
         precision.other(at.contact_temperature_kelvin().maximum() - kZeroCelsius, 1),
         at.contact_loss() ? "yes" : "no"});
  }
  return table;
}

/// The same warning at many speeds is one remark.
void add_warnings(const v1::SimulationResult& result, Sheet& sheet) {
  std::map<std::string, std::pair<int, std::string>> warnings;  // by code: count, first message
  for (const v1::CurvePoint& point : result.points()) {
    for (const auto& warning : point.result().warnings()) {
      auto& [count, message] = warnings[warning.code()];
      if (count++ == 0) {
        message =
            "at " + significant(point.speed_kilometers_per_hour()) + " km/h: " + warning.message();
      }
    }
  }
  if (!warnings.empty()) sheet.heading("Outside the validated range");
  for (const auto& [code, warning] : warnings) {
    sheet.remark(code + " (" + std::to_string(warning.first) +
                 (warning.first == 1 ? " speed), " : " speeds), ") + warning.second);
  }
}

/// So is the same refusal.
void add_refusals(const v1::SimulationResult& result, Sheet& sheet) {
  std::vector<std::pair<std::string, std::string>> refusals;  // why, at which speeds
  for (const v1::CurvePoint& point : result.points()) {
    if (point.has_result()) continue;
    std::string why = point.refusal_message();
    why.append(" [").append(point.refusal_reason()).append("]");
    const std::string speed = significant(point.speed_kilometers_per_hour());
    if (refusals.empty() || refusals.back().first != why) {
      refusals.emplace_back(why, speed);
    } else {
      refusals.back().second += ", " + speed;
    }
  }
  if (!refusals.empty()) sheet.heading("Speeds without a result");
  for (const auto& [why, speeds] : refusals) sheet.remark(speeds + " km/h: " + why);
}

void add_solver_remarks(const v1::SimulationResult& result, Sheet& sheet) {
  int without_period = 0;
  int without_estimate = 0;
  for (const v1::CurvePoint& point : result.points()) {
    if (!point.has_result()) continue;
    if (!point.result().settled()) ++without_period;
    if (!point.result().has_estimated_relative_error()) ++without_estimate;
  }
  for (const v1::CurvePoint& point : result.points()) {
    if (!point.has_branch_end()) continue;
    const auto& end = point.branch_end();
    sheet.remark("The branch of steady states that the curve follows " +
                 std::string(result.direction() == v1::DOWN ? "down" : "up") + " ends between " +
                 fixed(end.followed_to_kilometers_per_hour(), 2) + " and " +
                 fixed(end.gone_at_kilometers_per_hour(), 2) + " km/h: there the response jumps.");
  }
  if (without_period > 0) {
    sheet.remark(std::to_string(without_period) +
                 " of the speeds did not settle to a period: they are averages over a record.");
  }
  if (without_estimate > 0) {
    sheet.remark("The error of " + std::to_string(without_estimate) +
                 " of the speeds is not estimated: their figures are given to three digits.");
  }
}

std::string direction_word(const v1::Simulation& simulation) {
  if (!simulation.has_inefficiency_curve()) return "";
  return simulation.inefficiency_curve().direction() == v1::DOWN ? "DOWN" : "UP";
}

}  // namespace

std::string curve_report(const v1::Simulation& simulation, bool shows_assumptions) {
  const v1::SimulationResult& result = simulation.result();
  const double seconds = run_seconds(simulation);
  Sheet head;
  head.heading(simulation.lubricant() + ": " + study_text(simulation));
  head.remark(
      simulation.name() + (seconds >= 0 ? ", solved in " + duration_text(seconds) : std::string()) +
      "; " + inputs_text(simulation) + "; model " + model_options_text(simulation.model_options()));
  Sheet notes;
  add_refusals(result, notes);
  add_warnings(result, notes);
  add_solver_remarks(result, notes);
  add_provenance(result, shows_assumptions, notes);
  return head.text() + "\n" + curve_table(simulation).text() + "\n" + notes.text();
}

std::string points_csv(const std::vector<v1::Simulation>& simulations) {
  std::vector<CsvRow> rows;
  for (const v1::Simulation& simulation : simulations) {
    const Inputs inputs = inputs_of(simulation);
    for (const v1::CurvePoint& point : simulation.result().points()) {
      CsvRow row = {
          {"simulation", simulation.name()},
          {"lubricant", inputs.lubricant},
          {"gear_set", inputs.gear_set},
          {"surface", inputs.surface},
          {"vehicle", inputs.vehicle},
          {"sump_temperature_celsius", shortest(inputs.sump_temperature_celsius)},
          {"inlet_temperature_rise_kelvin", shortest(inputs.inlet_temperature_rise_kelvin)},
          {"model_options", model_options_text(simulation.model_options())},
          {"direction", direction_word(simulation)}};
      row.emplace_back("speed_kilometers_per_hour", shortest(point.speed_kilometers_per_hour()));
      // A refused speed keeps its line, with empty cells: a gap must not pass for zeros.
      if (point.has_result()) {
        append_fields(point.result(), "", row);
      } else {
        append_empty_fields(point.result(), "", row);
      }
      row.emplace_back("refusal_reason", point.refusal_reason());
      row.emplace_back("refusal_message", point.refusal_message());
      row.emplace_back("model_version", simulation.result().model_version());
      row.emplace_back("input_hash", simulation.result().input_hash());
      rows.push_back(std::move(row));
    }
  }
  return csv_text(rows);
}

}  // namespace tribodyn::client
