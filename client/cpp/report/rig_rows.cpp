#include "client/cpp/report/rig_rows.h"

#include <google/protobuf/descriptor.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <set>

#include "client/cpp/failure.h"
#include "client/cpp/report/comparison_report.h"
#include "client/cpp/text/csv.h"
#include "client/cpp/text/table.h"
#include "client/cpp/text/text.h"
#include "client/cpp/text/units.h"

namespace tribodyn::client {
namespace {

using google::protobuf::FieldDescriptor;

CsvRow csv_row(const RigRow& row, const RigView& view, int draws) {
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
  out.emplace_back("warnings", codes_of(row.warnings));
  if (draws == 0) return out;
  for (const std::string& column : rig_columns()) {
    const auto band = row.bands.find(column);
    const auto add = [&](const char* end, double RigBand::*value) {
      out.emplace_back(column + end, band == row.bands.end() ? "" : shortest(band->second.*value));
    };
    add("_standard_uncertainty", &RigBand::standard_uncertainty);
    add("_interval_minimum", &RigBand::interval_minimum);
    add("_interval_maximum", &RigBand::interval_maximum);
  }
  out.emplace_back("refused_draws", std::to_string(row.refused_draws));
  return out;
}

std::string json_of(const std::vector<RigRow>& rows, const RigView& view, const RigDraws& draws) {
  std::string out = "{\"rows\": [";
  for (const RigRow& row : rows) {
    out += &row == &rows.front() ? "\n {" : ",\n {";
    bool is_first = true;
    for (const auto& [header, cell] : csv_row(row, view, draws.draws)) {
      if (cell.empty()) continue;
      const bool is_text = header == "lubricant" || header == "model" || header == "refusal" ||
                           header == "warnings" ||
                           cell.find_first_of("NI") != std::string::npos;  // NaN, Infinity
      out += (is_first ? "" : ", ") + json_quoted(header) + ": " +
             (is_text ? json_quoted(cell) : cell);
      is_first = false;
    }
    out += "}";
  }
  out += "\n],\n\"warnings\": " + warnings_json(rig_warnings(rows, view));
  if (draws.draws > 0) {
    out += ",\n\"draws\": " + std::to_string(draws.draws) + ",\n\"inputs_without_uncertainty\": {";
    bool is_first_fluid = true;
    for (const auto& [fluid, inputs] : draws.exact_inputs) {
      std::vector<std::string> words;
      for (const std::string& input : inputs) words.push_back(json_quoted(input));
      out += (is_first_fluid ? "" : ",") + ("\n " + json_quoted(fluid)) + ": [" +
             joined(words, ", ") + "]";
      is_first_fluid = false;
    }
    out += "\n}";
  }
  return out + "}\n";
}

/// A figure as a table shows it.
struct ShownFigure {
  const char *column, *title, *unit;
  double factor, offset;
  int digits;
  bool is_share;  ///< with one decimal
};
constexpr ShownFigure kShownFigures[] = {
    {"traction_coefficient", "traction", "", 1, 0, 4, false},
    {"central_film_thickness_metres", "h_cen", "nm", 1e9, 0, 4, false},
    {"minimum_film_thickness_metres", "h_min", "nm", 1e9, 0, 4, false},
    {"film_ratio", "lambda", "", 1, 0, 3, false},
    {"mean_pressure_pascals", "p_mean", "GPa", 1e-9, 0, 4, false},
    {"maximum_pressure_pascals", "p_max", "GPa", 1e-9, 0, 4, false},
    {"contact_temperature_kelvin", "contact", "C", 1, -kZeroCelsius, 4, false},
    {"boundary_friction_share", "boundary", "%", 100, 0, 0, true},
    {"limiting_stress_area_share", "limited", "% area", 100, 0, 0, true}};

/// Returns the band of the view's y; nullptr if no uncertainty of the inputs moves it.
const RigBand* shown_band(const RigRow& row, const RigView& view) {
  const auto found = row.bands.find(view.y);
  return found == row.bands.end() ? nullptr : &found->second;
}

std::string table_of(const std::vector<RigRow>& rows, const RigView& view) {
  using enum Table::Align;
  std::vector<Table::Column> columns{{"lubricant", "", kLeft},      {"model", "", kLeft},
                                     {"load", "N", kDecimal},       {"speed", "m/s", kDecimal},
                                     {"slide-roll", "%", kDecimal}, {"oil", "C", kDecimal}};
  bool is_measured = false, has_bands = false;
  for (const RigRow& row : rows) {
    is_measured = is_measured || row.measured.has_value();
    has_bands = has_bands || shown_band(row, view) != nullptr;
  }
  for (const ShownFigure& figure : kShownFigures) {
    columns.push_back({figure.title, figure.unit, kDecimal});
    if (has_bands && std::string(figure.column) == view.y) {
      columns.push_back({"+/- 95 %", figure.unit, kDecimal});
    }
  }
  if (is_measured) {
    columns.push_back({"measured", "", kDecimal});
    columns.push_back({"residual", "%", kDecimal});
  }
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
      for (const ShownFigure& figure : kShownFigures) {
        const double value = row.figures.at(figure.column) * figure.factor + figure.offset;
        cells.push_back(figure.is_share ? fixed(value, 1) : significant(value, figure.digits));
        if (!has_bands || std::string(figure.column) != view.y) continue;
        const RigBand* band = shown_band(row, view);
        cells.push_back(
            band == nullptr
                ? ""
                : significant(
                      0.5 * figure.factor * (band->interval_maximum - band->interval_minimum), 2));
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

/// Returns what stands behind the uncertainties of a table.
std::string draws_summary(const std::vector<RigRow>& rows, const RigView& view,
                          const RigDraws& draws) {
  if (draws.draws == 0) return "";
  std::set<std::string> uncertain, computed;
  int refusing_rows = 0;
  for (const RigRow& row : rows) {
    if (shown_band(row, view) != nullptr) uncertain.insert(row.fluid);
    if (!row.figures.empty()) computed.insert(row.fluid);
    if (row.refused_draws > 0) ++refusing_rows;
  }
  if (computed.empty()) return "";
  Sheet sheet;
  sheet.heading("Uncertainty");
  if (!uncertain.empty()) {
    sheet.remark("+/-: half the 95 % interval by the stated uncertainties of the inputs, from " +
                 std::to_string(draws.draws) + " draws of them.");
  }
  if (refusing_rows > 0) {
    sheet.remark("The model refuses draws in " + std::to_string(refusing_rows) +
                 " rows. Where it refuses more than 5 %, no uncertainty is stated.");
  }
  for (const auto& [fluid, inputs] : draws.exact_inputs) {
    const std::string id = fluid.substr(fluid.find('/') + 1);
    std::vector<std::string> names;
    for (const std::string& input : inputs) names.push_back(input_text(input));
    if (!computed.contains(fluid) || (uncertain.contains(fluid) && names.empty())) continue;
    sheet.remark(uncertain.contains(fluid)
                     ? "Taken as exact, because no uncertainty is stated, of " + id + ": " +
                           joined(names, ", ") + "."
                     : id + ": no stated uncertainty of an input moves the " +
                           label_of_field(view.y) + ".");
  }
  return sheet.text();
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
    if (answer.refused_draws_size() > 0) row.refused_draws = answer.refused_draws(i);
    const int refusal = answer.refusal_numbers(i);
    if (refusal > 0) {
      row.refusal = answer.refusals(refusal - 1).message();
    } else {
      for (const std::string& column : rig_columns()) {
        row.figures[column] = answer.GetReflection()->GetRepeatedDouble(
            answer, descriptor.FindFieldByName(column), i);
      }
      for (const v1::UncertainRigFigure& each : answer.uncertainties()) {
        if (std::isnan(row.figures.at(each.figure()))) continue;
        row.bands[each.figure()] = {each.standard_uncertainty(i), each.interval_minimum(i),
                                    each.interval_maximum(i)};
      }
    }
    out.push_back(std::move(row));
  }
  for (const v1::PointWarning& each : answer.range_warnings()) {
    for (const int row : each.rows()) {
      if (static_cast<std::size_t>(row) < out.size()) {
        out[static_cast<std::size_t>(row)].warnings.push_back(shown_warning(each));
      }
    }
  }
  return out;
}

std::vector<ShownWarning> rig_warnings(const std::vector<RigRow>& rows, const RigView& view) {
  const auto* field = v1::RigCondition::descriptor()->FindFieldByName(view.x);
  const auto x_of = [field](const RigRow& row) {
    return row.condition.GetReflection()->GetDouble(row.condition, field);
  };
  std::vector<std::string> fluids;
  std::vector<double> x;
  for (const RigRow& row : rows) {
    if (std::find(fluids.begin(), fluids.end(), row.fluid) == fluids.end()) {
      fluids.push_back(row.fluid);
    }
    x.push_back(x_of(row));
  }
  std::sort(x.begin(), x.end());
  x.erase(std::unique(x.begin(), x.end()), x.end());
  std::vector<std::string> places, names;
  for (const double each : x) places.push_back(significant(each, 3));
  for (const std::string& each : fluids) names.push_back(resource_id(each));
  const std::string unit = unit_of_field(view.x);
  WarningCollector out(places, unit == "percent" ? "%" : unit, "all rows", names);
  for (const RigRow& row : rows) {
    const auto fluid = std::find(fluids.begin(), fluids.end(), row.fluid) - fluids.begin();
    const auto place = std::lower_bound(x.begin(), x.end(), x_of(row)) - x.begin();
    out.add(row.warnings, static_cast<std::size_t>(fluid), static_cast<std::size_t>(place));
  }
  return out.warnings();
}

std::optional<double> residual_percent(const RigRow& row, const RigView& view) {
  if (!row.measured || row.figures.empty()) return std::nullopt;
  return 100 * (row.figures.at(view.y) / *row.measured - 1);
}

std::string rig_text(const std::vector<RigRow>& rows, const RigView& view, OutputFormat format,
                     const RigDraws& draws) {
  if (format == OutputFormat::kJson) return json_of(rows, view, draws);
  if (format == OutputFormat::kTable) {
    return table_of(rows, view) + residual_summary(rows, view) + draws_summary(rows, view, draws) +
           warnings_text(rig_warnings(rows, view));
  }
  std::vector<CsvRow> lines;
  for (const RigRow& row : rows) {
    lines.push_back(csv_row(row, view, draws.draws));
    for (auto& [header, cell] : lines.back()) {
      if (cell == "NaN") cell.clear();
    }
  }
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
