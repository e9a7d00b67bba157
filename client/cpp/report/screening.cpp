#include "client/cpp/report/screening.h"

#include <charconv>
#include <cmath>
#include <iterator>

#include "client/cpp/text/csv.h"
#include "client/cpp/text/output.h"
#include "client/cpp/text/text.h"

namespace tribodyn::client {
namespace {

constexpr const char* kConditionColumns[] = {"speed_kilometres_per_hour", "ascent_angle_degrees",
                                             "sump_temperature_celsius",
                                             "inlet_temperature_rise_kelvin"};
constexpr const char* kStateColumns[] = {"contact_loss",     "settled", "period_in_mesh_cycles",
                                         "verdict_withheld", "model",   "refusal_reason",
                                         "refusal_message"};
constexpr const char* kOriginColumns[] = {"lubricant_revision", "surface_revision",
                                          "gear_set_revision", "vehicle_revision", "model_version"};

/// A cell of a row: its column, its text, and whether the text is a number or a truth value.
struct ScreeningCell {
  std::string column, text;
  bool is_text = true;
};

bool is_number_text(const std::string& text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size() && std::isfinite(value);
}

using Cells = std::vector<ScreeningCell>;

ScreeningCell number_cell(const std::string& column, double value) {
  return {column, shortest(value), false};
}

Cells candidate_cells(const Screening& screening, std::size_t candidate) {
  const CandidateTable& table = screening.table;
  Cells out = {{"candidate", table.names[candidate]}};
  for (std::size_t i = 0; i < table.headers.size(); ++i) {
    const std::string& cell = table.cells[candidate][i];
    out.push_back({table.headers[i], cell, !is_number_text(cell)});
  }
  return out;
}

Cells condition_cells(const v1::PointCondition& condition) {
  const double values[] = {condition.speed_kilometres_per_hour(), condition.ascent_angle_degrees(),
                           condition.sump_temperature_celsius(),
                           condition.inlet_temperature_rise_kelvin()};
  Cells out;
  for (std::size_t i = 0; i < 4; ++i) out.push_back(number_cell(kConditionColumns[i], values[i]));
  return out;
}

Cells figure_cells(const ScreenedPoint& point, bool has_contact_figures,
                   const v1::PointRefusal& refusal) {
  Cells out;
  for (std::size_t i = 0; i < point.figures.size(); ++i) {
    out.push_back(number_cell(screened_figures()[i], point.figures[i]));
  }
  for (std::size_t i = 0; has_contact_figures && i < point.contact.size(); ++i) {
    out.push_back(number_cell(contact_figures_of_points()[i], point.contact[i]));
  }
  out.push_back({kStateColumns[0], point.contact_loss ? "true" : "false", false});
  out.push_back({kStateColumns[1], point.settled ? "true" : "false", false});
  out.push_back({kStateColumns[2], std::to_string(point.period_in_mesh_cycles), false});
  out.push_back({kStateColumns[3], point.verdict_withheld ? "true" : "false", false});
  out.push_back({kStateColumns[4], v1::PointModel_Name(point.model)});
  out.push_back({kStateColumns[5], refusal.reason()});
  out.push_back({kStateColumns[6], printable(refusal.message())});
  return out;
}

Cells origin_cells(const v1::EvaluatePointsResponse& base) {
  const std::string values[] = {base.lubricant_revision(), base.surface_revision(),
                                base.gear_set_revision(), base.vehicle_revision(),
                                base.model_version()};
  Cells out;
  for (std::size_t i = 0; i < std::size(values); ++i) {
    out.push_back({kOriginColumns[i], values[i]});
  }
  return out;
}

/// Returns the texts of cells as a part of a CSV line.
std::string csv_part(const Cells& cells) {
  std::vector<std::string> texts;
  texts.reserve(cells.size());
  for (const ScreeningCell& each : cells) texts.push_back(each.text);
  std::string out = csv_line(texts);
  out.pop_back();
  return out;
}

std::string csv_header_part(Cells cells) {
  for (ScreeningCell& each : cells) each.text = each.column;
  return csv_part(cells);
}

/// Returns cells as members of a JSON object.
std::string json_part(const Cells& cells) {
  std::string out;
  for (const ScreeningCell& cell : cells) {
    const bool is_absent = !cell.is_text && (cell.text == "NaN" || cell.text.empty());
    out += (out.empty() ? "" : ", ") + json_quoted(cell.column) + ": " +
           (is_absent      ? "null"
            : cell.is_text ? json_quoted(cell.text)
                           : cell.text);
  }
  return out;
}

/// Writes a line for each point. Parts of it that repeat are formatted once.
void write_points(const Screening& screening, std::string (*part)(const Cells&),
                  const std::string& begin, const std::string& separator, const std::string& end,
                  std::ostream& out) {
  std::vector<std::string> conditions;
  for (const v1::PointCondition& each : screening.request.conditions()) {
    conditions.push_back(separator + part(condition_cells(each)) + separator);
  }
  const std::string origin = separator + part(origin_cells(screening.base)) + end + "\n";
  for (std::size_t i = 0; i < screening.table.size(); ++i) {
    const std::string candidate = begin + part(candidate_cells(screening, i));
    for (std::size_t k = 0; k < screening.conditions(); ++k) {
      out << candidate << conditions[k]
          << part(figure_cells(screening.point(i, k), screening.has_contact_figures(),
                               refusal_of(screening, i, k)))
          << origin;
    }
  }
}

}  // namespace

const std::array<const char*, ScreenedPoint::kFigures>& screened_figures() {
  static constexpr std::array<const char*, ScreenedPoint::kFigures> kNames = {
      "pinion_torque_newton_metres",
      "wheel_torque_newton_metres",
      "inefficiency_rms_percent",
      "inefficiency_energy_mean_percent",
      "mesh_loss_power_watts",
      "dynamic_transmission_error_minimum_metres",
      "dynamic_transmission_error_maximum_metres",
      "estimated_relative_error"};
  return kNames;
}

const std::array<const char*, ScreenedPoint::kContactFigures>& contact_figures_of_points() {
  static constexpr std::array<const char*, ScreenedPoint::kContactFigures> kNames = {
      "film_ratio_minimum",
      "film_ratio_mean",
      "contact_temperature_maximum_kelvin",
      "contact_temperature_mean_kelvin",
      "viscous_loss_power_watts",
      "boundary_loss_power_watts",
      "mean_friction_coefficient",
      "maximum_pressure_maximum_pascals",
      "flash_temperature_rise_maximum_kelvin"};
  return kNames;
}

ScreenedPoint screened_point(const v1::EvaluatePointsResponse& answer, int row) {
  ScreenedPoint out;
  out.figures = {answer.pinion_torque_newton_metres(row),
                 answer.wheel_torque_newton_metres(row),
                 answer.inefficiency_rms_percent(row),
                 answer.inefficiency_energy_mean_percent(row),
                 answer.mesh_loss_power_watts(row),
                 answer.dynamic_transmission_error_minimum_metres(row),
                 answer.dynamic_transmission_error_maximum_metres(row),
                 answer.estimated_relative_error(row)};
  if (!answer.film_ratio_mean().empty()) {
    out.contact = {answer.film_ratio_minimum(row),
                   answer.film_ratio_mean(row),
                   answer.contact_temperature_maximum_kelvin(row),
                   answer.contact_temperature_mean_kelvin(row),
                   answer.viscous_loss_power_watts(row),
                   answer.boundary_loss_power_watts(row),
                   answer.mean_friction_coefficient(row),
                   answer.maximum_pressure_maximum_pascals(row),
                   answer.flash_temperature_rise_maximum_kelvin(row)};
  }
  out.contact_loss = answer.contact_loss(row);
  out.settled = answer.settled(row);
  out.verdict_withheld = row < answer.verdict_withheld_size() && answer.verdict_withheld(row);
  out.period_in_mesh_cycles = answer.period_in_mesh_cycles(row);
  out.model = answer.model(row);
  out.refusal_number = answer.refusal_numbers(row);
  return out;
}

std::vector<std::string> screened_columns(bool has_contact_figures) {
  std::vector<std::string> out(screened_figures().begin(), screened_figures().end());
  out.insert(out.end(), {"contact_loss", "settled", "period_in_mesh_cycles", "model",
                         "verdict_withheld", "refusal_number"});
  if (has_contact_figures) {
    out.insert(out.end(), contact_figures_of_points().begin(), contact_figures_of_points().end());
  }
  return out;
}

ScreenedPoint screened_point(const std::vector<std::vector<double>>& columns, std::size_t row) {
  ScreenedPoint out;
  std::size_t column = 0;
  for (double& each : out.figures) each = columns[column++][row];
  // The other columns are NaN where there are no figures.
  const auto next = [&] {
    const double value = columns[column++][row];
    return std::isnan(value) ? 0 : static_cast<int>(value);
  };
  out.contact_loss = next() != 0;
  out.settled = next() != 0;
  out.period_in_mesh_cycles = next();
  out.model = static_cast<v1::PointModel>(next());
  out.verdict_withheld = next() != 0;
  out.refusal_number = next();
  for (std::size_t i = 0; column < columns.size(); ++i) out.contact[i] = columns[column++][row];
  return out;
}

v1::PointRefusal refusal_of(const Screening& screening, std::size_t candidate,
                            std::size_t condition) {
  v1::PointRefusal out;
  const int number = screening.point(candidate, condition).refusal_number;
  if (!screening.table.refusals[candidate].empty()) {
    out.set_reason("INVALID_CANDIDATE");
    out.set_message(screening.table.refusals[candidate]);
  } else if (number < 0) {
    out.set_reason("NOT_COMPUTED");
    out.set_message("not computed: the campaign has not come to its end");
  } else if (number > 0 && static_cast<std::size_t>(number) <= screening.refusals.size()) {
    out = screening.refusals[static_cast<std::size_t>(number) - 1];
  } else if (number > 0) {
    out.set_reason("UNKNOWN");
  }
  return out;
}

void write_screening_csv(const Screening& screening, std::ostream& out) {
  out << csv_header_part(candidate_cells(screening, 0)) << ","
      << csv_header_part(condition_cells({})) << ","
      << csv_header_part(figure_cells({}, screening.has_contact_figures(), {})) << ","
      << csv_header_part(origin_cells(screening.base)) << "\n";
  write_points(screening, csv_part, "", ",", "", out);
}

void write_screening_json_lines(const Screening& screening, std::ostream& out) {
  write_points(screening, json_part, "{", ", ", "}", out);
}

}  // namespace tribodyn::client
