#include "client/cpp/report/rig_rows.h"

#include <google/protobuf/descriptor.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "client/cpp/failure.h"
#include "client/cpp/text/csv.h"
#include "client/cpp/text/table.h"
#include "client/cpp/text/text.h"
#include "client/cpp/text/units.h"

namespace tribodyn::client {
namespace {

using google::protobuf::FieldDescriptor;

CsvRow csv_row(const RigRow& row, const RigView& view) {
  CsvRow out{{"lubricant", row.fluid}, {"model", row.is_isothermal ? "isothermal" : "thermal"}};
  append_fields(row.condition, "", out);
  for (const std::string& column : rig_columns()) {
    const auto figure = row.figures.find(column);
    out.emplace_back(column, figure == row.figures.end() ? "" : shortest(figure->second));
  }
  const auto residual = residual_percent(row, view);
  out.emplace_back(std::string("measured_") + view.y, row.measured ? shortest(*row.measured) : "");
  out.emplace_back("residual_percent", residual ? shortest(*residual) : "");
  out.emplace_back("refusal", row.refusal);
  return out;
}

std::string json_of(const std::vector<RigRow>& rows, const RigView& view) {
  const auto quoted = [](const std::string& text) {
    std::string out = "\"";
    for (const char c : text) {
      if (c == '"' || c == '\\') out += '\\';
      out += c;
    }
    return out + '"';
  };
  std::string out = "{\"rows\": [";
  for (const RigRow& row : rows) {
    out += &row == &rows.front() ? "\n {" : ",\n {";
    bool is_first = true;
    for (const auto& [header, cell] : csv_row(row, view)) {
      if (cell.empty()) continue;
      const bool is_text = header == "lubricant" || header == "model" || header == "refusal" ||
                           cell.find_first_of("NI") != std::string::npos;  // NaN, Infinity
      out += (is_first ? "" : ", ") + quoted(header) + ": " + (is_text ? quoted(cell) : cell);
      is_first = false;
    }
    out += "}";
  }
  return out + "\n]}\n";
}

std::string table_of(const std::vector<RigRow>& rows, const RigView& view) {
  using enum Table::Align;
  std::vector<Table::Column> columns{
      {"lubricant", "", kLeft},   {"model", "", kLeft},          {"load", "N", kDecimal},
      {"speed", "m/s", kDecimal}, {"slide-roll", "%", kDecimal}, {"oil", "C", kDecimal},
      {"traction", "", kDecimal}, {"h_cen", "nm", kDecimal},     {"h_min", "nm", kDecimal},
      {"lambda", "", kDecimal},   {"p_mean", "GPa", kDecimal},   {"p_max", "GPa", kDecimal},
      {"contact", "C", kDecimal}, {"boundary", "%", kDecimal},   {"limited", "% area", kDecimal},
      {"measured", "", kDecimal}, {"residual", "%", kDecimal}};
  bool is_measured = false;
  for (const RigRow& row : rows) is_measured = is_measured || row.measured.has_value();
  if (!is_measured) columns.resize(columns.size() - 2);
  Table table(columns);
  std::string refusals;
  for (const RigRow& row : rows) {
    const v1::RigCondition& at = row.condition;
    std::vector<std::string> cells{row.fluid.substr(row.fluid.find('/') + 1),
                                   row.is_isothermal ? "isothermal" : "thermal",
                                   significant(at.load_newtons()),
                                   significant(at.entrainment_speed_metres_per_second(), 4),
                                   significant(at.slide_roll_ratio_percent(), 4),
                                   significant(at.supply_temperature_celsius(), 4)};
    if (row.figures.empty()) {
      refusals += "refused: " + row.refusal + "\n";
    } else {
      const auto cell = [&](const char* column, double factor, double offset, int digits) {
        cells.push_back(significant(row.figures.at(column) * factor + offset, digits));
      };
      cell("traction_coefficient", 1, 0, 4);
      cell("central_film_thickness_metres", 1e9, 0, 4);
      cell("minimum_film_thickness_metres", 1e9, 0, 4);
      cell("film_ratio", 1, 0, 3);
      cell("mean_pressure_pascals", 1e-9, 0, 4);
      cell("maximum_pressure_pascals", 1e-9, 0, 4);
      cell("contact_temperature_kelvin", 1, -kZeroCelsius, 4);
      for (const char* share : {"boundary_friction_share", "limiting_stress_area_share"}) {
        cells.push_back(fixed(100 * row.figures.at(share), 1));
      }
      if (const auto residual = residual_percent(row, view)) {
        cells.push_back(significant(*row.measured * view.y_factor, 4));
        cells.push_back(significant(*residual, 3));
      }
    }
    table.add_row(std::move(cells));
  }
  return table.text() + refusals;
}

std::string residual_summary(const std::vector<RigRow>& rows, const RigView& view) {
  struct Sum {
    double squares = 0;
    int count = 0;
  };
  std::map<std::string, Sum> sums;
  for (const RigRow& row : rows) {
    const auto residual = residual_percent(row, view);
    if (!residual) continue;
    Sum& sum =
        sums[row.fluid.substr(row.fluid.find('/') + 1) + (row.is_isothermal ? ", isothermal" : "")];
    sum.squares += *residual * *residual;
    ++sum.count;
  }
  std::string out;
  for (const auto& [name, sum] : sums) {
    out += name + ": RMS residual " + significant(std::sqrt(sum.squares / sum.count), 3) +
           " % of " + std::to_string(sum.count) + " measured points\n";
  }
  return out;
}

}  // namespace

const std::vector<std::string>& rig_columns() {
  static const std::vector<std::string> columns = [] {
    std::vector<std::string> out;
    const auto& descriptor = *v1::EvaluateRigResponse::descriptor();
    for (int i = 0; i < descriptor.field_count(); ++i) {
      const FieldDescriptor& field = *descriptor.field(i);
      if (field.is_repeated() && field.cpp_type() == FieldDescriptor::CPPTYPE_DOUBLE &&
          field.name() != "load_newtons") {  // of the condition
        out.push_back(field.name());
      }
    }
    return out;
  }();
  return columns;
}

std::vector<RigRow> rig_rows(const v1::EvaluateRigRequest& request,
                             const v1::EvaluateRigResponse& answer,
                             const std::vector<std::optional<double>>& measured) {
  const auto& descriptor = *v1::EvaluateRigResponse::descriptor();
  std::vector<RigRow> out;
  for (int i = 0; i < request.conditions_size() && i < answer.refusal_numbers_size(); ++i) {
    RigRow row;
    row.fluid = answer.lubricant_revision();
    row.is_isothermal = request.model_options().isothermal();
    row.condition = request.conditions(i);
    if (!measured.empty()) row.measured = measured[static_cast<std::size_t>(i)];
    const int refusal = answer.refusal_numbers(i);
    if (refusal > 0) {
      row.refusal = answer.refusals(refusal - 1).message();
    } else {
      for (const std::string& column : rig_columns()) {
        row.figures[column] = answer.GetReflection()->GetRepeatedDouble(
            answer, descriptor.FindFieldByName(column), i);
      }
    }
    out.push_back(std::move(row));
  }
  return out;
}

std::optional<double> residual_percent(const RigRow& row, const RigView& view) {
  if (!row.measured || row.figures.empty()) return std::nullopt;
  return 100 * (row.figures.at(view.y) / *row.measured - 1);
}

std::string rig_text(const std::vector<RigRow>& rows, const RigView& view, OutputFormat format) {
  if (format == OutputFormat::kJson) return json_of(rows, view);
  if (format == OutputFormat::kTable) return table_of(rows, view) + residual_summary(rows, view);
  std::vector<CsvRow> lines;
  for (const RigRow& row : rows) lines.push_back(csv_row(row, view));
  return csv_text(lines);
}

std::vector<MeasuredPoint> read_measured(const std::string& text, const std::string& path,
                                         const RigView& view, const v1::RigCondition& usual) {
  const auto& descriptor = *v1::RigCondition::descriptor();
  std::vector<std::string> known{view.y};
  for (int i = 0; i < descriptor.field_count(); ++i) known.push_back(descriptor.field(i)->name());
  const auto fail = [&path](const CsvLine& line, const std::string& what) -> Failure {
    return {kExitUsage, path + ", line " + std::to_string(line.number) + ": " + what};
  };
  const std::vector<CsvLine> lines = read_csv(text);
  if (lines.size() < 2) {
    throw Failure(kExitUsage, path + ": " + std::to_string(lines.size()) +
                                  " lines; allowed: a line of headers and at least one of numbers");
  }
  const std::vector<std::string>& headers = lines.front().cells;
  for (const char* needed : {view.x, view.y}) {
    if (std::find(headers.begin(), headers.end(), needed) == headers.end()) {
      throw fail(lines.front(), std::string("no column ") + needed + "; needed: " + view.x +
                                    " and " + view.y + ", optional: the other settings of the rig");
    }
  }
  std::vector<MeasuredPoint> out;
  for (std::size_t n = 1; n < lines.size(); ++n) {
    if (lines[n].cells.size() > headers.size()) {
      throw fail(lines[n], std::to_string(lines[n].cells.size()) + " cells; allowed: " +
                               std::to_string(headers.size()) + ", one for each header");
    }
    MeasuredPoint point{usual, 0};
    for (std::size_t c = 0; c < headers.size(); ++c) {
      if (std::find(known.begin(), known.end(), headers[c]) == known.end()) continue;
      const std::string cell = c < lines[n].cells.size() ? lines[n].cells[c] : "";
      double value = 0;
      const auto read = std::from_chars(cell.data(), cell.data() + cell.size(), value);
      if (read.ec != std::errc() || read.ptr != cell.data() + cell.size() ||
          !std::isfinite(value)) {
        throw fail(lines[n], headers[c] + " = \"" + cell + "\" is not a number");
      }
      if (headers[c] != view.y) {
        point.condition.GetReflection()->SetDouble(&point.condition,
                                                   descriptor.FindFieldByName(headers[c]), value);
      } else if (value == 0) {
        throw fail(lines[n], headers[c] + " = 0; a residual is relative to it");
      } else {
        point.value = value;
      }
    }
    out.push_back(std::move(point));
  }
  return out;
}

}  // namespace tribodyn::client
