#include "client/cpp/report/curve_report.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "client/cpp/report/comparison_report.h"
#include "client/cpp/report/limits_report.h"
#include "client/cpp/report/precision.h"
#include "client/cpp/report/sensitivity_report.h"
#include "client/cpp/text/csv.h"
#include "client/cpp/text/inputs.h"
#include "client/cpp/text/table.h"
#include "client/cpp/text/text.h"
#include "client/cpp/text/units.h"
#include "client/cpp/text/warnings.h"

namespace tribodyn::client {
namespace {

/// Whether the losses of a curve are shown in kilowatts.
bool is_in_kilowatts(const v1::SimulationResult& result) {
  return std::any_of(result.points().begin(), result.points().end(),
                     [](const v1::CurvePoint& point) {
                       return std::abs(point.result().mesh_loss_power_watts()) >= 1000;
                     });
}

Table curve_table(const v1::Simulation& simulation, const CurveUncertainty* uncertainty) {
  const bool kilowatts = is_in_kilowatts(simulation.result());
  constexpr auto kDecimal = Table::Align::kDecimal;
  std::vector<Table::Column> columns = {{"speed", "km/h", kDecimal},
                                        {"inefficiency", "energy mean %", kDecimal},
                                        {"inefficiency", "solver error", kDecimal},
                                        {"inefficiency", "RMS %", kDecimal},
                                        {"mesh loss", kilowatts ? "kW" : "W", kDecimal},
                                        {"pinion torque", "N m", kDecimal},
                                        {"film", "mean um", kDecimal},
                                        {"lambda", "min", kDecimal},
                                        {"lambda", "mean", kDecimal},
                                        {"T contact", "mean C", kDecimal},
                                        {"T contact", "max C", kDecimal},
                                        {"contact", "lost"}};
  constexpr std::ptrdiff_t kUncertaintyColumn = 2;
  if (uncertainty != nullptr) {
    columns.insert(columns.begin() + kUncertaintyColumn, {"inefficiency", "+/- 95 %", kDecimal});
  }
  Table table(columns);
  for (const v1::CurvePoint& point : simulation.result().points()) {
    const std::string speed = significant(point.speed_kilometres_per_hour());
    if (!point.has_result()) {
      table.add_row({speed, "no result"});
      continue;
    }
    const v1::PointResult& at = point.result();
    const Precision precision(simulation, at);
    const double loss = at.mesh_loss_power_watts();
    std::vector<std::string> row = {
        speed,
        at.has_inefficiency_energy_mean_percent()
            ? precision.estimated(at.inefficiency_energy_mean_percent(), 3)
            : "-",
        at.has_inefficiency_energy_mean_percent()
            ? precision.error_of(at.inefficiency_energy_mean_percent())
            : "-",
        at.has_inefficiency_rms_percent() ? precision.estimated(at.inefficiency_rms_percent(), 3)
                                          : "-",
        kilowatts ? precision.estimated(1e-3 * loss, 4) : precision.estimated(loss, 1),
        precision.estimated(at.pinion_torque_newton_metres(), 2),
        precision.other(1e6 * at.central_film_thickness_metres().mean(), 3),
        precision.other(at.film_ratio().minimum(), 2),
        precision.other(at.film_ratio().mean(), 2),
        precision.other(at.contact_temperature_kelvin().mean() - kZeroCelsius, 1),
        precision.other(at.contact_temperature_kelvin().maximum() - kZeroCelsius, 1),
        at.contact_loss() ? "yes" : "no"};
    if (uncertainty != nullptr) {
      const auto* figure = uncertainty->at(point.speed_kilometres_per_hour());
      row.insert(row.begin() + kUncertaintyColumn,
                 figure != nullptr ? input_error_text(*figure) : "-");
    }
    table.add_row(std::move(row));
  }
  return table;
}

/// Adds the speeds without a result; speeds with the same reason share one remark.
void add_refusals(const v1::SimulationResult& result, Sheet& sheet) {
  std::vector<std::pair<std::string, std::string>> refusals;  // why, at which speeds
  for (const v1::CurvePoint& point : result.points()) {
    if (point.has_result()) continue;
    std::string why = point.refusal_message();
    why.append(" [").append(point.refusal_reason()).append("]");
    const std::string speed = significant(point.speed_kilometres_per_hour());
    if (refusals.empty() || refusals.back().first != why) {
      refusals.emplace_back(why, speed);
    } else {
      refusals.back().second += ", " + speed;
    }
  }
  if (!refusals.empty()) sheet.heading("Speeds without a result");
  for (const auto& [why, speeds] : refusals) sheet.remark(speeds + " km/h: " + why);
}

void add_jumps(const v1::SimulationResult& result, Sheet& sheet) {
  bool is_first = true;
  for (const v1::CurvePoint& point : result.points()) {
    if (!point.has_branch_end()) continue;
    if (std::exchange(is_first, false)) sheet.heading("Jumps of the response");
    const auto& end = point.branch_end();
    sheet.remark(
        "With " +
        std::string(result.direction() == v1::SWEEP_DIRECTION_DOWN ? "falling" : "rising") +
        " speed the branch of steady states that the curve follows ends between " +
        fixed(end.followed_to_kilometres_per_hour(), 2) + " and " +
        fixed(end.gone_at_kilometres_per_hour(), 2) + " km/h; the response jumps there.");
  }
}

void add_solver_remarks(const v1::SimulationResult& result, Sheet& sheet) {
  int without_period = 0;
  int without_estimate = 0;
  for (const v1::CurvePoint& point : result.points()) {
    if (!point.has_result()) continue;
    if (!point.result().settled()) ++without_period;
    if (!point.result().has_estimated_relative_error()) ++without_estimate;
  }
  if (result.independent_points() || without_period > 0 || without_estimate > 0) {
    sheet.heading("How the speeds were solved");
  }
  if (result.independent_points()) {
    sheet.remark(
        "Each speed was solved independently: the solver neither followed a branch of steady "
        "states nor searched for jumps between branches.");
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
  if (simulation.inefficiency_curve().independent_points()) return "INDEPENDENT_POINTS";
  return simulation.inefficiency_curve().direction() == v1::SWEEP_DIRECTION_DOWN ? "DOWN" : "UP";
}

}  // namespace

std::string curve_report(const v1::Simulation& simulation, const ResultDetails& details,
                         const CurveUncertainty* uncertainty) {
  const v1::SimulationResult& result = simulation.result();
  const double seconds = run_seconds(simulation);
  Sheet head;
  head.heading(simulation.lubricant() + ": " + study_text(simulation));
  head.remark(
      simulation.name() + (seconds >= 0 ? ", solved in " + duration_text(seconds) : std::string()) +
      "; " + inputs_text(simulation) + "; model " + model_options_text(simulation.model_options()));
  Sheet notes;
  add_refusals(result, notes);
  add_warnings(simulation, notes);
  add_jumps(result, notes);
  add_solver_remarks(result, notes);
  if (uncertainty != nullptr && !uncertainty->remark.empty()) {
    notes.heading("Uncertainty of the inputs");
    notes.remark(uncertainty->remark);
    notes.remark(kModelErrorRemark);
  }
  add_provenance(result, details.assumptions, notes);
  add_input_warnings(result.input_warnings(), notes);
  const std::string limits = limits_report(result);
  const bool differentiated = simulation.inefficiency_curve().sensitivities();
  return head.text() + "\n" + curve_table(simulation, uncertainty).text() + "\n" +
         (limits.empty() ? "" : limits + "\n") + notes.text() +
         (differentiated ? "\n" + curve_sensitivity_report(result) : "");
}

std::string points_csv(const std::vector<v1::Simulation>& simulations) {
  std::vector<CsvRow> rows;
  const CsvRow no_sensitivities = empty_sensitivity_cells(simulations);
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
          {"lubricant_condition", simulation.sheared_lubricant() ? "sheared" : "fresh"},
          {"model_options", model_options_text(simulation.model_options())},
          {"direction", direction_word(simulation)}};
      row.emplace_back("speed_kilometres_per_hour", shortest(point.speed_kilometres_per_hour()));
      // A speed without a result keeps its line, with empty cells instead of zeros.
      if (point.has_result()) {
        append_fields(point.result(), "", row);
      } else {
        append_empty_fields(point.result(), "", row);
      }
      row.emplace_back("refusal_reason", point.refusal_reason());
      row.emplace_back("refusal_message", point.refusal_message());
      row.emplace_back("input_warnings", codes_of(simulation.result().input_warnings()));
      row.emplace_back("model_version", simulation.result().model_version());
      row.emplace_back("input_hash", simulation.result().input_hash());
      CsvRow sensitivities = no_sensitivities;
      fill_sensitivity_cells(point.result(), sensitivities);
      row.insert(row.end(), sensitivities.begin(), sensitivities.end());
      rows.push_back(std::move(row));
    }
  }
  return csv_text(rows);
}

}  // namespace tribodyn::client
