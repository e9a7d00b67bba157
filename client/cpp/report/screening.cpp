#include "client/cpp/report/screening.h"

#include <charconv>
#include <cmath>
#include <limits>

#include "client/cpp/text/csv.h"
#include "client/cpp/text/text.h"

namespace tribodyn::client {
namespace {

constexpr const char* kConditionColumns[] = {"speed_kilometres_per_hour", "ascent_angle_degrees",
                                             "sump_temperature_celsius",
                                             "inlet_temperature_rise_kelvin"};
constexpr const char* kStateColumns[] = {"contact_loss", "settled",        "period_in_mesh_cycles",
                                         "model",        "refusal_reason", "refusal_message"};
constexpr const char* kOriginColumns[] = {"lubricant_revision", "surface_revision",
                                          "gear_set_revision", "vehicle_revision", "model_version"};

/// FNV-1a of 64 bits (Fowler, Noll and Vo): the same on every machine.
class Fnv {
 public:
  void add(const std::string& text) {
    for (const char c : text) mix(static_cast<unsigned char>(c));
    mix(0);  // "a", "bc" differs from "ab", "c"
  }
  std::string hex() const {
    std::string out(16, '0');
    for (std::size_t i = 0; i < out.size(); ++i) {
      out[i] = "0123456789abcdef"[(state_ >> (4 * (15 - i))) & 15U];
    }
    return out;
  }

 private:
  void mix(unsigned char byte) { state_ = (state_ ^ byte) * 0x100000001b3U; }
  std::uint64_t state_ = 0xcbf29ce484222325U;
};

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

std::vector<std::string> origin_of(const v1::EvaluatePointsResponse& base) {
  return {base.lubricant_revision(), base.surface_revision(), base.gear_set_revision(),
          base.vehicle_revision(), base.model_version()};
}

/// Returns the cells of a row; without a point only their columns.
std::vector<ScreeningCell> cells_of_row(const Screening& screening, std::size_t candidate,
                                        std::size_t k, const ScreenedPoint* point) {
  std::vector<ScreeningCell> out;
  const bool is_header = point == nullptr;
  const auto text = [&](const std::string& column, const std::string& value) {
    out.push_back({column, value, true});
  };
  const auto number = [&](const std::string& column, double value) {
    out.push_back({column, is_header ? "" : shortest(value), false});
  };
  const CandidateTable& table = screening.table;
  text("candidate", is_header ? "" : table.names[candidate]);
  for (std::size_t i = 0; i < table.headers.size(); ++i) {
    const std::string cell = is_header ? "" : table.cells[candidate][i];
    out.push_back({table.headers[i], cell, !is_number_text(cell)});
  }
  const v1::PointCondition& condition = screening.request.conditions(static_cast<int>(k));
  const double values[] = {condition.speed_kilometres_per_hour(), condition.ascent_angle_degrees(),
                           condition.sump_temperature_celsius(),
                           condition.inlet_temperature_rise_kelvin()};
  for (std::size_t i = 0; i < 4; ++i) number(kConditionColumns[i], values[i]);
  const ScreenedPoint none{};
  const ScreenedPoint& at = is_header ? none : *point;
  for (std::size_t i = 0; i < at.figures.size(); ++i) number(screened_figures()[i], at.figures[i]);
  out.push_back({kStateColumns[0], at.contact_loss ? "true" : "false", false});
  out.push_back({kStateColumns[1], at.settled ? "true" : "false", false});
  out.push_back({kStateColumns[2], std::to_string(at.period_in_mesh_cycles), false});
  text(kStateColumns[3], v1::PointModel_Name(at.model));
  text(kStateColumns[4], at.refusal_reason);
  text(kStateColumns[5], printable(at.refusal_message));
  const std::vector<std::string> origin = origin_of(screening.base);
  for (std::size_t i = 0; i < origin.size(); ++i) text(kOriginColumns[i], origin[i]);
  return out;
}

const ScreenedPoint& point_at(const Screening& screening, std::size_t candidate, std::size_t k) {
  return screening.points[candidate * screening.conditions() + k];
}

double number_in(const std::string& text) {
  double value = std::numeric_limits<double>::quiet_NaN();
  std::from_chars(text.data(), text.data() + text.size(), value);
  return value;
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
  out.contact_loss = answer.contact_loss(row);
  out.settled = answer.settled(row);
  out.period_in_mesh_cycles = answer.period_in_mesh_cycles(row);
  out.model = answer.model(row);
  if (const int number = answer.refusal_numbers(row); number > 0) {
    out.refusal_reason = answer.refusals(number - 1).reason();
    out.refusal_message = answer.refusals(number - 1).message();
  }
  return out;
}

std::string screening_identity(const Screening& screening) {
  Fnv hash;
  hash.add(screening_header(screening));
  hash.add(screening.request.SerializeAsString());
  for (const std::string& each : origin_of(screening.base)) hash.add(each);
  const CandidateTable& table = screening.table;
  for (std::size_t i = 0; i < table.size(); ++i) {
    hash.add(table.names[i]);
    for (const std::string& cell : table.cells[i]) hash.add(cell);
    for (const CandidateParameter& each : table.parameters) {
      hash.add(each.field->full_name() + "=" + shortest(each.values[i]));
    }
  }
  return hash.hex();
}

std::string screening_header(const Screening& screening) {
  std::vector<std::string> cells;
  for (const ScreeningCell& cell : cells_of_row(screening, 0, 0, nullptr)) {
    cells.push_back(cell.column);
  }
  return csv_line(cells);
}

std::string screening_rows(const Screening& screening, std::size_t first, std::size_t end) {
  std::string out;
  std::vector<std::string> cells;
  for (std::size_t i = first; i < end; ++i) {
    for (std::size_t k = 0; k < screening.conditions(); ++k) {
      cells.clear();
      for (ScreeningCell& cell : cells_of_row(screening, i, k, &point_at(screening, i, k))) {
        cells.push_back(std::move(cell.text));
      }
      out += csv_line(cells);
    }
  }
  return out;
}

std::string screening_json_lines(const Screening& screening) {
  std::string out;
  for (std::size_t i = 0; i < screening.table.size(); ++i) {
    for (std::size_t k = 0; k < screening.conditions(); ++k) {
      std::string line;
      for (const ScreeningCell& cell : cells_of_row(screening, i, k, &point_at(screening, i, k))) {
        const bool is_absent = !cell.is_text && (cell.text == "NaN" || cell.text.empty());
        line += (line.empty() ? "{" : ", ") + json_quoted(cell.column) + ": " +
                (is_absent      ? "null"
                 : cell.is_text ? json_quoted(cell.text)
                                : cell.text);
      }
      out += line + "}\n";
    }
  }
  return out;
}

std::size_t read_screening_rows(const std::string& csv, Screening& screening) {
  const std::size_t first = 1 + screening.table.headers.size();
  const std::size_t figures = first + std::size(kConditionColumns);
  const std::size_t states = figures + ScreenedPoint::kFigures;
  const std::vector<CsvLine> lines = read_csv(csv);
  std::size_t rows = 0;
  for (; rows + 1 < lines.size() && rows < screening.points.size(); ++rows) {
    const std::vector<std::string>& cells = lines[rows + 1].cells;
    if (cells.size() != states + std::size(kStateColumns) + std::size(kOriginColumns)) break;
    ScreenedPoint& point = screening.points[rows];
    for (std::size_t i = 0; i < point.figures.size(); ++i) {
      point.figures[i] = number_in(cells[figures + i]);
    }
    point.contact_loss = cells[states] == "true";
    point.settled = cells[states + 1] == "true";
    point.period_in_mesh_cycles = static_cast<int>(number_in(cells[states + 2]));
    if (!v1::PointModel_Parse(cells[states + 3], &point.model)) break;
    point.refusal_reason = cells[states + 4];
    point.refusal_message = cells[states + 5];
  }
  return rows;
}

std::string json_quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : printable(text)) {
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + "\"";
}

std::string json_number(double value) { return std::isfinite(value) ? shortest(value) : "null"; }

}  // namespace tribodyn::client
